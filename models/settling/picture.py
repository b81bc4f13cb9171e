"""The picture: speeds over the porosity, and the box as it settles."""

import numpy as np
from cograin.plot import packing
from cograin.results import frames_in
from matplotlib.figure import Figure


def draw(path, folder, settled, found, closed):
    """Writes speeds beside closed forms, porosities over height and time, and beads on the way."""
    (table, porosities), (slip, richardson_zaki) = settled, closed
    figure = Figure(figsize=(12.0, 5.0), layout="constrained")
    speeds, fronts, begin, end = figure.subplots(1, 4, width_ratios=[1.4, 1.4, 0.5, 0.5])
    over = np.linspace(0.5, 0.98, 60)
    single = slip(1.0)
    speeds.plot(over, [each * slip(each) / single for each in over], color="#0072b2", label="closed form, Di Felice")
    speeds.plot(
        over, [richardson_zaki(each) for each in over], color="#000000", linestyle="--", label="Richardson, Zaki"
    )
    speeds.plot(found[:, 0], found[:, 1] / single, "o", color="#d55e00", label="beads and column")
    speeds.set(xlabel="porosity", ylabel="speed over that of a single bead", xscale="log", yscale="log")
    speeds.set_xticks([0.5, 0.6, 0.7, 0.8, 0.9], ["0.5", "0.6", "0.7", "0.8", "0.9"])
    speeds.minorticks_off()
    speeds.legend(frameon=False, fontsize="small")
    speeds.grid(color="#dddddd", linewidth=0.6)
    times = np.concatenate([[0.0], table["time"]])
    heights = np.linspace(0.0, 40.0, porosities.shape[1] + 1)
    edges = np.append(times - 0.5 * times[1], times[-1])
    shown = fronts.pcolormesh(edges, heights, porosities.T, cmap="viridis")
    figure.colorbar(shown, ax=fronts, label="porosity")
    fronts.set(xlabel="time [s]", ylabel="height [mm]")
    frames = frames_in(folder)
    for panel, frame, name in ((begin, frames[0], "begin"), (end, frames[-1], "end")):
        packing(frame, by="velocity", view="y", panel=panel)
        panel.set_title(name)
    figure.savefig(path, dpi=110)
