"""The picture: temperatures of the grains, the motor's work and the heat over time."""

from cograin.plot import packing
from cograin.results import Run
from matplotlib.figure import Figure
from matplotlib.patches import Circle

RADIUS = 0.04  # of the drum [m]


def draw(path, folder, table, book):
    """Writes the warm grains, and where the motor's work is over time."""
    figure = Figure(figsize=(11.5, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=[1.0, 1.25])
    last = Run(folder).frames[-1]
    packing(last, by="temperature", view="x", panel=left)
    left.add_patch(Circle((0.0, 0.0), RADIUS, fill=False, linewidth=2.0))
    left.set(xlim=(-1.08 * RADIUS, 1.08 * RADIUS), ylim=(-1.08 * RADIUS, 1.08 * RADIUS))
    stored = book["motion and springs"] + book["height"]
    lines = [
        ("work of the motor", table["motor"], "#000000", "-"),
        ("heat of the grains", table["energy.heat"], "#d55e00", "-"),
        ("heat of the shell", table["drum.heat"], "#e69f00", "--"),
        ("motion, springs, height", stored, "#0072b2", "-."),
        ("all of it together", stored + book["heat"] + book["lost otherwise"], "#cc79a7", ":"),
    ]
    for name, values, colour, kind in lines:
        right.plot(table["time"], 1e3 * values, label=name, color=colour, linestyle=kind)
    right.set(xlabel="time [s]", ylabel="[mJ]")
    right.grid(color="#dddddd", linewidth=0.6)
    right.legend(frameon=False, fontsize="small")
    figure.savefig(path, dpi=110)
