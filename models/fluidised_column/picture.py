"""The picture: the pressure drop over the velocity, the porosity over height, and the beads."""

import numpy as np
from cograin.plot import packing
from cograin.results import frames_in
from matplotlib.figure import Figure


def draw(path, folder, found, laws):
    """Writes the pressure drop beside Ergun's law, porosities over height and velocity, and beads at three of them."""
    figure = Figure(figsize=(12.0, 5.0), layout="constrained")
    drops, heights, *beads = figure.subplots(1, 5, width_ratios=[1.5, 1.5, 0.4, 0.4, 0.4])
    (table, porosities, weight, cell), (at_rest, fixed) = found, laws
    velocity, drop = table["velocity"], table["pressure_drop"]
    bed, _ = at_rest(table, porosities, weight)
    drops.plot(velocity, drop, color="#d55e00", linewidth=0.8, label="beads and column")
    law = fixed(velocity, bed, cell)
    slow = law < 1.3 * weight
    drops.plot(velocity[slow], law[slow], color="#0072b2", linestyle="--", label="Ergun, cell by cell")
    drops.axhline(weight, color="#000000", linestyle=":", label="weight of the beads")
    drops.set(xlabel="superficial velocity [m/s]", ylabel="pressure drop [Pa]")
    drops.legend(frameon=False, fontsize="small", loc="lower right")
    drops.grid(color="#dddddd", linewidth=0.6)
    faces = np.linspace(0.0, 60.0, porosities.shape[1] + 1)
    shown = heights.pcolormesh(
        np.append(velocity[0], velocity), faces, porosities.T, cmap="viridis", vmin=0.35, vmax=1.0
    )
    figure.colorbar(shown, ax=heights, label="porosity")
    heights.set(xlabel="superficial velocity [m/s]", ylabel="height [mm]")
    frames = frames_in(folder)
    for panel, share in zip(beads, (0.3, 0.6, 1.0), strict=True):
        frame = frames[int(share * (len(frames) - 1))]
        packing(frame, by="velocity", view="y", panel=panel)
        panel.set(title=f"{share * velocity[-1]:.2f} m/s")
    figure.savefig(path, dpi=110)
