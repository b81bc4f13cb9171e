"""Where a specimen broke: from the frames and the events of its replay."""

import csv
from dataclasses import dataclass

import meshio
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import LinearSegmentedColormap

CAUSES = {
    "tension": "#b5482a",
    "bending": "#e0a030",
    "shear": "#1b6ca8",
    "torsion": "#6aa9d8",
    "compression": "#5d3a7a",
    "distance": "#777777",
}
DAMAGE = LinearSegmentedColormap.from_list("damage", ["#ece3d0", "#d9a441", "#b5482a", "#4a1414"])


@dataclass
class Cracks:
    """Broken bonds."""

    time: np.ndarray  # [s]
    first: np.ndarray  # rows of the particles
    second: np.ndarray
    cause: np.ndarray
    energy: np.ndarray  # [J]


@dataclass
class Frame:
    """The particles at a time, by ascending number."""

    time: float
    position: np.ndarray
    radius: np.ndarray
    damage: np.ndarray
    number: np.ndarray


def frames(folder):
    """All frames of a run; each is read when it is asked for."""
    lines = (folder / "particles.pvd").read_text().split("<DataSet ")[1:]
    for line in lines:
        attributes = dict(part.split("=", 1) for part in line.split("/>")[0].split())
        mesh = meshio.read(folder / attributes["file"].strip('"'))
        data = {name: np.asarray(values).reshape(-1) for name, values in mesh.point_data.items() if values.ndim == 1}
        time = float(attributes["timestep"].strip('"'))
        yield Frame(time, mesh.points, data["radius"], data["damage"], data["id"])


def cracks(folder, number):
    """The events of a run, with rows in place of the particles' numbers."""
    rows = list(csv.DictReader((folder / "breakage.csv").open()))
    ids = {name: np.searchsorted(number, [int(row[name]) for row in rows]) for name in ("id1", "id2")}
    time, energy = (np.array([float(row[name]) for row in rows]) for name in ("time", "energy"))
    return Cracks(time, ids["id1"], ids["id2"], np.array([row["cause"] for row in rows]), energy)


def cut(axes, frame, axis, at=0.0, across=(0, 2)):
    """The spheres that a plane normal to an axis cuts, coloured by damage; drawn as they are cut."""
    radius = np.sqrt(np.maximum(frame.radius**2 - (frame.position[:, axis] - at) ** 2, 0.0))
    seen = radius > 0.0
    spheres = EllipseCollection(
        2e3 * radius[seen],
        2e3 * radius[seen],
        np.zeros(seen.sum()),
        units="xy",
        offsets=1e3 * frame.position[seen][:, across],
        transOffset=axes.transData,
        array=frame.damage[seen],
        cmap=DAMAGE,
        clim=(0.0, 1.0),
        edgecolor="#3a2c1a",
        linewidth=0.25,
    )
    axes.add_collection(spheres)
    axes.set_aspect("equal")
    return spheres


def broken_bonds(axes, start, events, chosen, across=(0, 2)):
    """Every chosen broken bond as a crack: a stroke through its middle, across its axis, where it was at the start."""
    ends = start.position[events.first[chosen]], start.position[events.second[chosen]]
    middle = 0.5 * (ends[0] + ends[1])[:, across]
    way = (ends[1] - ends[0])[:, across]
    size = np.minimum(start.radius[events.first[chosen]], start.radius[events.second[chosen]])
    length = np.linalg.norm(way, axis=1, keepdims=True)
    # What the projection leaves of the disc that parted: a long stroke where it is seen from its edge.
    stroke = size[:, None] * np.column_stack([-way[:, 1], way[:, 0]]) / np.maximum(length, 1e-12)
    causes = events.cause[chosen]
    for cause, colour in CAUSES.items():
        of = causes == cause
        if of.any():
            strokes = np.stack([middle[of] - stroke[of], middle[of] + stroke[of]], axis=1) * 1e3
            label = f"{cause} ({of.sum()})"
            axes.add_collection(LineCollection(strokes, colors=colour, linewidths=0.8, alpha=0.8, label=label))
    axes.set_aspect("equal")
