"""The picture of the run: grains on the sagging plate, deflection with the forces of the grains, and the course."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle

PLATE, FORCE, REFERENCE, GRAIN = "#1b6ca8", "#b5482a", "#333333", "#c9a66b"
MAGNIFIED = 50.0


def draw(path, found):
    """Writes the picture as PNG, from plate, rows, frames and reference of each mesh."""
    plate, _, beds, _ = found[0]
    figure, axes = plt.subplot_mosaic(
        [["cut", "course"], ["load", "course"]],
        figsize=(11.5, 8.0),
        width_ratios=[1.0, 1.25],
        height_ratios=[1.0, 1.6],
        layout="constrained",
    )
    cut(axes["cut"], plate, beds[-1])
    load(figure, axes["load"], plate, beds[-1])
    course(axes["course"], found)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def cut(axes, plate, bed):
    """A slice through the middle of the bed, with the deflection of the plate magnified."""
    middle = 0.5 * plate.design.span
    radius = np.sqrt(np.maximum(bed.radii**2 - (bed.centres[:, 1] - middle) ** 2, 0.0))
    grains = [
        Circle(1e3 * place, 1e3 * size)
        for place, size in zip(bed.centres[:, [0, 2]], radius, strict=True)
        if size > 0.0
    ]
    axes.add_collection(PatchCollection(grains, facecolor=GRAIN, edgecolor="#6b5430", linewidth=0.5))
    row = np.isclose(plate.places[:, 1], middle)
    order = np.argsort(plate.places[row, 0])
    along = 1e3 * plate.places[row, 0][order]
    line = 1e3 * MAGNIFIED * plate.deflections[row][order]
    axes.plot(along, line, color=PLATE, linewidth=3)
    axes.plot([0.0, 120.0], [0.0, 0.0], color="0.6", linewidth=0.8, linestyle=":")
    axes.plot([0.0, 120.0], [-2.5, -2.5], linestyle="", marker="^", color="0.3", markersize=9)
    axes.set(xlim=(-4, 124), aspect="equal", xlabel="x [mm]", ylabel="z [mm]")
    axes.set_title(f"a cut; deflection of the plate drawn {MAGNIFIED:.0f} times as large", loc="left", fontsize=10)


def load(figure, axes, plate, bed):
    """Deflection of the plate, and the forces of the grains at their contacts."""
    x, y = (1e3 * plate.places[:, axis] for axis in (0, 1))
    shown = axes.tricontourf(x, y, plate.triangles, -1e6 * plate.deflections, 12, cmap="Blues")
    force = -1e3 * bed.forces
    axes.scatter(*(1e3 * bed.points[:, :2].T), s=0.8 * np.maximum(force, 0.0), color=FORCE, alpha=0.8, linewidth=0)
    axes.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    axes.set_title(f"forces of {len(force)} grains: area, largest {force.max():.0f} mN", loc="left", fontsize=10)
    figure.colorbar(shown, ax=axes, label="deflection, downwards [µm]")


def course(axes, found):
    """Deflection of the middle over time with each mesh, beside its static reference, and the force on the skin."""
    for (plate, rows, _, reference), style in zip(found, ("-", "--", ":"), strict=False):
        label = f"plate of {plate.cells} × {plate.cells} elements"
        axes.plot(1e3 * rows[:, 0], -1e6 * rows[:, 1], color=PLATE, linestyle=style, label=label)
    axes.axhline(-1e6 * reference, color=REFERENCE, linewidth=1, label="at rest, after Navier")
    axes.set(xlabel="time [ms]", ylim=(0, None))
    axes.set_ylabel("deflection of the middle, downwards [µm]", color=PLATE)
    axes.legend(loc="lower right", frameon=False)
    axes.set_title("the jacks let go in the first 50 ms", loc="left", fontsize=10)
    other = axes.twinx()
    other.plot(1e3 * rows[:, 0], -rows[:, 2], color=FORCE, linewidth=0.9)
    other.set_ylabel("force of the grains on the skin, mean of each step [N]", color=FORCE)
    other.set_ylim(0.0, None)
