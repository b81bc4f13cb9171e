"""The picture: warm beads on the plate with its temperatures below, and heats over time."""

import numpy as np
from cograin.plot import packing
from cograin.results import frames_in
from matplotlib.figure import Figure

MAGNIFIED = 4.0  # thickness of the plate in the picture, over its own


def draw(path, folder, plate, table):
    """Writes beads and plate at the end, and where the heat of the heater went."""
    figure = Figure(figsize=(11.5, 7.0), layout="constrained")
    above, heats, temperatures = figure.subplot_mosaic(
        [["above", "above"], ["heats", "temperatures"]], height_ratios=[1.1, 1.0]
    ).values()
    packing(frames_in(folder)[-1], by="temperature", view="y", panel=above)
    x, z = plate.mesh.p
    lengths, depths = np.unique(x), np.unique(z)
    order = np.lexsort((x, z))
    field = plate.temperature[plate.corners][order].reshape(len(depths), len(lengths))
    shown = above.pcolormesh(lengths, MAGNIFIED * depths, field, cmap="inferno", shading="gouraud")
    figure.colorbar(shown, ax=above, label="temperature of the plate [K]", shrink=0.8)
    above.set(xlim=(-0.005, 0.1), ylim=(1.2 * MAGNIFIED * depths[0], 0.016))
    for name, values, colour, kind in (
        ("heater", table["heater"], "#000000", "-"),
        ("beads", table["energy.heat"], "#d55e00", "-"),
        ("plate", table["stored"], "#0072b2", "--"),
        ("draught", table["left"], "#009e73", "-."),
        ("beads, plate and draught", table["energy.heat"] + table["stored"] + table["left"], "#cc79a7", ":"),
    ):
        heats.plot(table["time"], values, label=name, color=colour, linestyle=kind)
    heats.set(xlabel="time [s]", ylabel="heat [J]")
    heats.legend(frameon=False, fontsize="small")
    for name, values, colour, kind in (
        ("hottest of the plate", table["hottest"], "#d55e00", "-."),
        ("upper side, mean", table["plate.temperature"], "#000000", "-"),
        ("coldest of the plate", table["coldest"], "#0072b2", "--"),
    ):
        temperatures.plot(table["time"], values, label=name, color=colour, linestyle=kind)
    temperatures.set(xlabel="time [s]", ylabel="temperature [K]")
    temperatures.legend(frameon=False, fontsize="small")
    for panel in (heats, temperatures):
        panel.grid(color="#dddddd", linewidth=0.6)
    figure.savefig(path, dpi=110)
