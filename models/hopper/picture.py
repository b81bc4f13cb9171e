"""A run that repeats the course of the gate, for its frames, and the picture."""

import csv

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import meshio
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle

GATE, BIN, HOPPER, BOUND, STEEL = "#b5482a", "#1b6ca8", "#8a6d2f", "#333333", "0.25"
FRAME = 5e-2  # between frames, as in scene.toml [s]


def replay(program, scene, folder, rows, options):
    """Runs the scene by itself with the course of the gate; gives the folder of its frames."""
    path = folder / "gate.csv"
    with path.open("w", newline="") as text:
        csv.writer(text).writerows([["time", "gate.displacement.x"], *rows[:, :2].tolist()])
    words = ["--set", f"run.end={options.end}", "--set", f"output.history_interval={options.interval}"]
    program("run", scene, "--overwrite", "--inputs", path, "-o", folder / "run", *words)
    return folder / "run"


def draw(path, folder, rows, names, options, bounds):
    """Writes a cut through hopper and bin while grains fall, and the course of masses and gate."""
    figure, axes = plt.subplot_mosaic(
        [["cut", "bin"], ["cut", "gate"]],
        figsize=(11.5, 6.4),
        width_ratios=[1.2, 1.9],
        height_ratios=[2.2, 1.0],
        layout="constrained",
    )
    column = {name: rows[:, place] for place, name in enumerate(names)}
    cut(axes["cut"], folder, column)
    masses(axes["bin"], column, options, bounds)
    axes["gate"].fill_between(column["time"], 1e3 * column["gate"], color=GATE, alpha=0.8, linewidth=0)
    axes["gate"].set(xlabel="time [s]", ylabel="gate [mm]\n(0: shut, 50: open)", xlim=(0.0, options.end))
    axes["bin"].tick_params(labelbottom=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def cut(axes, folder, column):
    """Grains near the middle plane, at a frame in which the gate is open."""
    times = np.arange(0.0, column["time"][-1] + 1e-9, FRAME)
    opened = np.interp(times, column["time"], column["gate"])
    later = np.flatnonzero((opened > 0.049) & (times > 0.5 * times[-1]))
    number = int(later[0]) if later.size else len(times) - 1
    frame = meshio.read(folder / f"particles_{number:06d}.vtu")
    points, radii = frame.points, frame.point_data["radius"].ravel()
    speed = np.linalg.norm(frame.point_data["velocity"], axis=1)
    near = np.flatnonzero(np.abs(points[:, 1]) < 4e-3)
    near = near[np.argsort(-points[near, 1])]
    shown = PatchCollection(
        [Circle(1e3 * points[k, [0, 2]], 1e3 * radii[k]) for k in near], cmap="viridis", edgecolor="k", linewidth=0.2
    )
    shown.set_array(speed[near])
    shown.set_clim(0.0, 1.0)
    axes.add_collection(shown)
    for profile in ([[13, 100], [25, 112], [25, 240]], [[10, -30], [20, -30], [20, 20], [90, 55], [90, 85]]):
        line = np.array(profile)
        for side in (-1, 1):
            axes.plot(side * line[:, 0], line[:, 1], color=STEEL, linewidth=1.5)
    place = 1e3 * opened[number]
    axes.plot([place - 32, place + 32], [94, 94], color=GATE, linewidth=2.5)
    axes.set(xlim=(-98, 98), ylim=(-62, 245), aspect="equal", xlabel="x [mm]", ylabel="z [mm]")
    axes.set_title(f"t = {times[number]:.2f} s", loc="left")
    axes.figure.colorbar(shown, ax=axes, label="speed [m/s]", shrink=0.5)


def masses(axes, column, options, bounds):
    """Mass in the bin with thresholds and bounds, and the mass in the hopper."""
    axes.plot(column["time"], 1e3 * column["bin_filling.mass"], color=BIN, label="in the bin")
    for level, label in ((options.high, "thresholds of the controller"), (options.low, None)):
        axes.axhline(1e3 * level, color=BOUND, linestyle="--", linewidth=1, label=label)
    if bounds:
        for (low, high), label in zip(bounds, ("where the reference puts its turning points", None), strict=True):
            axes.axhspan(1e3 * low, 1e3 * high, color=BIN, alpha=0.15, linewidth=0, label=label)
    axes.set_ylabel("mass in the bin [g]", color=BIN)
    axes.set_ylim(0.0, None)
    axes.set_xlim(0.0, options.end)
    other = axes.twinx()
    other.plot(column["time"], 1e3 * column["hopper_filling.mass"], color=HOPPER, linewidth=1)
    other.set_ylabel("mass in the hopper [g]", color=HOPPER)
    other.set_ylim(0.0, None)
    axes.legend(loc="lower right", frameon=False, fontsize="small")
