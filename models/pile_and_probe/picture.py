"""The picture: a heap with its slope, slopes over rolling friction with the bound of the law, force over depth."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from heap import PLATE, PROBE, RIM, frame, penetration, slope
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle

COLOURS = ["#1b6ca8", "#b5482a", "#3a7d44", "#8e44ad"]


def draw(path, found, course):
    """Writes the picture as PNG, from rolling friction, seed, the folders of both stages and the angle of each heap."""
    figure, axes = plt.subplot_mosaic(
        [["side", "side"], ["angle", "force"]], figsize=(11.5, 8.4), height_ratios=[1.0, 1.25], layout="constrained"
    )
    frictions = sorted({one[0] for one in found})
    shown = next(one for one in found if one[0] == frictions[len(frictions) // 2])
    side(figure, axes["side"], shown, course)
    angles(axes["angle"], found, frictions)
    forces(axes["force"], found, frictions, course)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def side(figure, axes, one, course, part=0.75):
    """Grains near the middle plane while the probe is inside, and the line that was fitted before."""
    friction, _, pile, probe, _ = one
    count = len(list(probe.glob("particles_*.vtu")))
    number = round(part * (count - 1))
    points, radii = frame(probe, number)
    near = np.flatnonzero(np.abs(points[:, 1]) < 4e-3)
    near = near[np.argsort(-points[near, 1])]
    grains = PatchCollection(
        [Circle(1e3 * points[k, [0, 2]], 1e3 * radii[k]) for k in near], cmap="YlOrBr", edgecolor="k", linewidth=0.3
    )
    grains.set_array(np.hypot(points[near, 0], points[near, 1]) * 1e3)
    grains.set_clim(-30.0, 70.0)
    axes.add_collection(grains)
    axes.plot(
        np.array([-PLATE, -PLATE, PLATE, PLATE]) * 1e3, np.array([RIM, 0.0, 0.0, RIM]) * 1e3, color="0.25", linewidth=2
    )
    angle, spread, top = slope(pile)
    away = np.array([0.0, PLATE])
    for sign in (-1, 1):
        label = f"fitted before: {angle:.1f}° ± {spread:.1f}°" if sign > 0 else None
        height = top - away * np.tan(np.radians(angle))
        axes.plot(sign * away * 1e3, height * 1e3, color=COLOURS[0], linestyle="--", label=label)
    depth = penetration(probe, course, top)[0]
    end = top - depth[round(number / (count - 1) * (len(depth) - 1))]
    corners = np.array([[-PROBE, 0.05], [-PROBE, end], [PROBE, end], [PROBE, 0.05]])
    axes.fill(*(1e3 * corners.T), facecolor="0.6", edgecolor="k", alpha=0.85, zorder=3)
    axes.set(xlim=(-75, 75), ylim=(-3, 50), aspect="equal", xlabel="x [mm]", ylabel="z [mm]")
    axes.set_title(
        f"grains near the middle plane with the probe; rolling friction {friction:g}", loc="left", fontsize=10
    )
    axes.legend(loc="upper right", frameon=False)


def angles(axes, found, frictions):
    """Slopes over rolling friction, and the bound that the rolling law sets."""
    axes.plot(
        [one[0] for one in found], [one[4] for one in found], "o", color=COLOURS[0], label="heaps, one for each seed"
    )
    first = np.mean([one[4] for one in found if one[0] == frictions[0]])
    line = np.linspace(frictions[0], frictions[-1], 50)
    bound = first + np.degrees(np.arctan(line) - np.arctan(frictions[0]))
    axes.plot(line, bound, color="0.3", linestyle="--", label="slope without + arctan of rolling friction")
    axes.set(xlabel="rolling friction", ylabel="slope of the heap [°]", ylim=(0, 40))
    axes.legend(loc="lower right", frameon=False)


def forces(axes, found, frictions, course):
    """Force on the probe over its depth: thin for each seed, thick the mean over 20 ms and the seeds."""
    for friction, colour in zip(frictions, COLOURS, strict=False):
        curves = []
        for _, _, pile, probe, _ in (one for one in found if one[0] == friction):
            depth, force = penetration(probe, course, slope(pile)[2])
            axes.plot(1e3 * depth, 1e3 * force, color=colour, linewidth=0.5, alpha=0.5)
            curves.append((depth[5:-4], np.convolve(force, np.ones(10) / 10.0, "valid")))
        grid = np.linspace(0.0, min(depth.max() for depth, _ in curves), 60)
        mean = np.mean([np.interp(grid, *curve) for curve in curves], axis=0)
        axes.plot(1e3 * grid, 1e3 * mean, color=colour, linewidth=2, label=f"rolling friction {friction:g}")
    axes.set(
        xlabel="depth of the probe below the tip of the fitted cone [mm]", ylabel="force on the probe, upwards [mN]"
    )
    axes.set(xlim=(0, None), yscale="log", ylim=(3, 4e4))
    axes.legend(loc="upper left", frameon=False)
