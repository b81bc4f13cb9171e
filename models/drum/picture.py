"""The slope of the grains from the frames of a run, and the picture."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import meshio
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle

RADIUS = 0.04  # of the drum [m]
INTERVAL = 2e-2  # between frames [s]


def frames(folder):
    """Times [s], places [m], velocities [m/s] and radii [m] of all frames."""
    for path in sorted(folder.glob("particles_*.vtu")):
        frame = meshio.read(path)
        number = int(path.stem.split("_")[1])
        yield number * INTERVAL, frame.points, frame.point_data["velocity"], frame.point_data["radius"].ravel()


def surface(points, radii):
    """Tops of the grains that lie highest, one for each 4 mm along the middle half of the drum [m]."""
    across, top = points[:, 1], points[:, 2] + radii
    edges = np.arange(-0.5 * RADIUS, 0.5 * RADIUS + 1e-9, 4e-3)
    tops = []
    for low, high in zip(edges, edges[1:], strict=False):
        inside = np.flatnonzero((across >= low) & (across < high))
        if inside.size:
            best = inside[top[inside].argmax()]
            tops.append((across[best], top[best]))
    return np.array(tops)


def slopes(folder, start):
    """Angle of the surface, and of the line from the axis to the centre of mass against the vertical, frame by frame [°]."""
    angles, centres = [], []
    for time, points, _, radii in frames(folder):
        if time >= start:
            tops = surface(points, radii)
            angles.append(np.degrees(np.arctan(abs(np.polyfit(*tops.T, 1)[0]))))
            centre = np.average(points, axis=0, weights=radii**3)
            centres.append(np.degrees(np.arctan2(abs(centre[1]), -centre[2])))
    return np.array(angles), np.array(centres)


def draw(path, folder, rows, names):
    """Writes the grains as they flow, and speed and torques over time."""
    *_, (time, points, velocity, radii) = frames(folder)
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.0, 4.6), layout="constrained", width_ratios=[1.0, 1.25])
    order = np.argsort(points[:, 0])[::-1]
    grains = [Circle(1e3 * points[k, 1:], 1e3 * radii[k]) for k in order]
    shown = PatchCollection(grains, cmap="viridis", edgecolor="k", linewidth=0.2)
    shown.set_array(np.linalg.norm(velocity[order], axis=1))
    left.add_collection(shown)
    left.add_patch(Circle((0.0, 0.0), 1e3 * RADIUS, fill=False, linewidth=2.0))
    tops = surface(points, radii)
    fit = np.polyfit(*tops.T, 1)
    ends = np.array([-0.7 * RADIUS, 0.7 * RADIUS])
    left.plot(1e3 * ends, 1e3 * np.polyval(fit, ends), color="#b5482a", linestyle="--")
    angle = np.degrees(np.arctan(abs(fit[0])))
    left.set(xlim=(-43, 43), ylim=(-43, 43), aspect="equal", xlabel="y [mm]", ylabel="z [mm]")
    left.set_title(f"t = {time:.2f} s: the surface lies at {angle:.0f}°", loc="left")
    figure.colorbar(shown, ax=left, label="speed [m/s]", shrink=0.85)
    column = {name: rows[:, place] for place, name in enumerate(names)}
    right.plot(column["time"], 1e3 * column["torque"], color="#1b6ca8", label="torque of the motor")
    moment = np.convolve(-column["drum.mean_moment.x"], np.ones(20) / 20.0, "valid")
    right.plot(
        column["time"][10:-9],
        1e3 * moment,
        color="0.6",
        linewidth=1,
        label="moment of the grains, reversed, mean of 20 ms",
    )
    right.set(xlabel="time [s]", ylabel="[mN m]")
    speed = right.twinx()
    speed.plot(column["time"], column["drum.angular_velocity.x"], color="#b5482a", linewidth=1)
    speed.set_ylabel("speed of the drum [rad/s]", color="#b5482a")
    right.legend(loc="lower right", frameon=False, fontsize="small")
    figure.savefig(path, dpi=110)
    plt.close(figure)
