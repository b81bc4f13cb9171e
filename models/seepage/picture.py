"""The picture: gradient and rise over the head, heads and the ground before and after it was lifted."""

import numpy as np
from cograin.plot import packing
from cograin.results import frames_in
from matplotlib.figure import Figure


def draw(path, folder, found, ground, critical):
    """Writes gradient and rise over the head, heads of the water, porosities, and beads before and after."""
    table, heads, porosities = found
    figure = Figure(figsize=(12.0, 5.6), layout="constrained")
    names = [["curve", "water", "pores"], ["curve", "still", "late"]]
    panels = figure.subplot_mosaic(names, width_ratios=[1.0, 1.2, 1.2])
    curve, water, pores, still, late = (panels[name] for name in ("curve", "water", "pores", "still", "late"))
    # Where the prism carries itself no longer.
    lifted = int(np.argmax(table["gradient"] > critical)) if table["gradient"].max() > critical else -1
    head = 1e3 * table["head"]
    curve.plot(head, table["gradient"], color="#d55e00", label="mean of the prism")
    curve.axhline(critical, color="#000000", linestyle=":", label="critical gradient, Terzaghi")
    curve.set(xlabel="head [mm]", ylabel="gradient")
    curve.grid(color="#dddddd", linewidth=0.6)
    rise = curve.twinx()
    rise.plot(head, 1e3 * table["rise"], color="#0072b2", linewidth=0.9, label="rise of the prism")
    rise.set_ylabel("rise [mm]", color="#0072b2")
    curve.legend(frameon=False, fontsize="small", loc="upper left")
    lines, _ = ground.heads()
    x, z = (1e3 * line for line in lines)
    levels = 1e3 * 0.5 * table["head"][lifted] * np.linspace(0.0, 1.0, 11)
    shown = water.contourf(x, z, 1e3 * heads[lifted].T, levels=levels, cmap="viridis")
    figure.colorbar(shown, ax=water, label="head [mm]")
    shown = pores.pcolormesh(x, z, porosities[-1].T, cmap="viridis", vmin=0.35, vmax=1.0)
    figure.colorbar(shown, ax=pores, label="porosity")
    water.set_title(f"heads at {head[lifted]:.0f} mm", fontsize=10)
    pores.set_title(f"porosity at {head[-1]:.0f} mm", fontsize=10)
    for panel in (water, pores):
        panel.plot([0.0, 0.0], [1e3 * ground.tip, z[-1]], color="#000000", linewidth=4.0)
        panel.set(xlabel="x [mm]", ylabel="z [mm]", aspect="equal")
    frames = frames_in(folder)
    times = np.array([frame.time for frame in frames])
    for panel, place in ((still, lifted), (late, -1)):
        frame = frames[int(np.argmin(abs(times - table["time"][place])))]
        packing(frame, by="velocity", view="y", panel=panel)
        panel.set_title(f"beads at {head[place]:.0f} mm", fontsize=10)
    figure.savefig(path, dpi=110)
