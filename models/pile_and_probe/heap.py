"""Slope and density of a heap, and what a probe meets in it, from the files of a run."""

import csv

import meshio
import numpy as np

GRAVITY, DENSITY = 9.81, 2500.0  # [m/s²], of a grain [kg/m³], as in scene.toml
PLATE, RIM = 0.045, 0.004  # radius of the plate and height of its rim [m]
PROBE, TIP = 0.006, 0.04  # radius of the probe and height of its end at the start [m]


def history(folder):
    """The columns of a history by their names."""
    rows = list(csv.reader((folder / "history.csv").open()))
    return dict(zip(rows[0], np.array(rows[1:], dtype=float).T, strict=True))


def frame(folder, number=-1):
    """Places [m] and radii [m] of the grains in a frame."""
    found = meshio.read(sorted(folder.glob("particles_*.vtu"))[number])
    return found.points, found.point_data["radius"].ravel()


def surface(points, radii, sectors=8, width=4e-3):
    """Tops of the highest grains in each ring and sector: distances from the axis and heights [m]."""
    away, turn = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])
    sector = np.floor((turn + np.pi) / (2.0 * np.pi) * sectors).astype(int) % sectors
    tops = []
    for low in np.arange(0.01, 0.038, width):
        for number in range(sectors):
            inside = np.flatnonzero((away >= low) & (away < low + width) & (sector == number) & (points[:, 2] > 0.0))
            if inside.size:
                best = inside[(points[inside, 2] + radii[inside]).argmax()]
                tops.append((away[best], points[best, 2] + radii[best]))
    return np.array(tops)


def slope(folder, number=-1):
    """Angle of the surface [°], its standard deviation [°], and the height of the cone on the axis [m]."""
    tops = surface(*frame(folder, number))
    (fall, top), covariance = np.polyfit(*tops.T, 1, cov=True)
    angle = np.degrees(np.arctan(-fall))
    return angle, np.degrees(np.sqrt(covariance[0, 0])) * np.cos(np.radians(angle)) ** 2, top


def slope_by_mass(rows):
    """The angle of a cone of the heap's mass over the filled rim, with the density of its core [°]."""
    bulk = DENSITY * (1.0 - rows["core.porosity"][-1])
    cone = rows["heap.mass"][-1] / bulk - np.pi * PLATE**2 * RIM
    return np.degrees(np.arctan(3.0 * cone / (np.pi * PLATE**3)))


def penetration(folder, course, top):
    """Depth of the probe's end below the top of the heap [m], and the force that pushes it up [N], both over time."""
    rows = history(folder)
    times, ways = np.array(list(csv.reader(course.open()))[1:], dtype=float).T
    return top - TIP - np.interp(rows["time"], times, ways), rows["probe.mean_force.z"]
