"""Frames of a run of the wheel, and the picture."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import meshio
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle, Polygon
from mesh import outline

INTERVAL = 5e-2  # between frames [s]
START = np.array([0.035, 0.0515])  # of the axle, x and z [m]


def frame(folder, time):
    """Places [m], radii [m] and velocities [m/s] of the grains at a time [s]."""
    found = meshio.read(Path(folder) / f"particles_{round(time / INTERVAL):06d}.vtu")
    return found.points, found.point_data["radius"].ravel(), found.point_data["velocity"]


def bed(axes, history, folder, time):
    """Bed and wheel from the side."""
    points, radii, velocity = frame(folder, time)
    order = np.argsort(points[:, 1])[::-1]
    grains = PatchCollection(
        [Circle(1e3 * points[k, [0, 2]], 1e3 * radii[k]) for k in order], cmap="viridis", edgecolor="k", linewidth=0.2
    )
    grains.set_array(np.linalg.norm(velocity[order], axis=1))
    grains.set_clim(0.0, 0.1)
    axes.add_collection(grains)
    row = np.searchsorted(history["time"], time - 1e-9)
    moved = [history[f"wheel.displacement.{axis}"][row] for axis in "xz"]
    angle = history["wheel.rotation.y"][row]
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    corners = np.array(outline()) @ turn.T + START + moved
    axes.add_patch(Polygon(1e3 * corners, facecolor="0.6", edgecolor="k", alpha=0.85))
    axes.set(xlim=(0, 130), ylim=(0, 76), aspect="equal", xlabel="x [mm]", ylabel="z [mm]")
    return grains


def draw(path, found, weight):
    """Writes bed and wheel at the largest pull, and pull and sinkage over slip."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.5, 4.2), layout="constrained", width_ratios=[1.3, 1.0])
    slip, _, pull, _, history, folder = max(found, key=lambda one: one[2])
    time = 0.8
    grains = bed(left, history, folder, time)
    left.set_title(f"slip {slip:.2f}, t = {time:.2f} s: pull {pull:.2f} N", loc="left")
    figure.colorbar(grains, ax=left, label="speed [m/s]", shrink=0.8)
    slips = [one[0] for one in found]
    right.plot(slips, [one[2] / weight for one in found], "o-", color="#1b6ca8", label="pull over weight")
    right.plot(
        slips, [one[3] / weight / 0.021 for one in found], "s-", color="0.5", label="torque over weight and radius"
    )
    right.axhline(0.0, color="0.8", linewidth=0.8)
    right.set(xlabel="slip", ylabel="over the weight")
    sink = right.twinx()
    sink.plot(slips, [1e3 * one[1] for one in found], "^--", color="#b5482a")
    sink.set_ylabel("sinkage [mm]", color="#b5482a")
    right.legend(loc="upper left", frameon=False, fontsize="small")
    figure.savefig(path, dpi=110)
    plt.close(figure)
