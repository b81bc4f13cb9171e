"""What colours particles: a field of a frame as one number for each, with ends of the colours that can be compared."""

from __future__ import annotations

from typing import Any

import numpy as np

from cograin.base.vector import Vector
from cograin.results import Cloud, Frame, ResultError

#: Units of the fields of particles.
FIELDS = {
    "velocity": "m/s",
    "angular_velocity": "rad/s",
    "force": "N",
    "torque": "N.m",
    "mass": "kg",
    "radius": "m",
    "temperature": "K",
}
#: Units of the fields of facets.
FACET_FIELDS = {
    "force": "N",
    "traction": "Pa",
    "normal_pressure": "Pa",
    "wear": "m3",
    "wear_depth": "m",
    "impact_energy_normal": "J",
    "impact_energy_tangential": "J",
}
#: Fields that are those of the whole clump on each of its spheres, as they are those of a particle; their names there.
OF_CLUMPS = {"force": "force", "torque": "moment"}
#: Part of its radius that a grain at rest may have moved since the start, at its present speed.
STILL = 0.01
#: Kinds of particles: fields of whole numbers, of which each has a colour of its own.
MOST_KINDS = 20


def colouring(particles: Cloud, by: str) -> str:
    """The field that is meant; a scene of one set does not number it."""
    chosen = "material" if by == "set" and "set" not in particles.fields else by
    if chosen not in particles.fields:
        raise ResultError(f"by: expected one of {', '.join(particles.fields)}, found {by}")
    return chosen


def are_kinds(particles: Cloud, by: str) -> bool:
    """Whether a field numbers kinds."""
    values = particles[by]
    return values.dtype.kind in "iu" and by not in ("id", "clump") and len(np.unique(values)) <= MOST_KINDS


def values(frame: Frame, particles: Cloud, by: str) -> Vector:
    """One number for each particle: lengths of vectors. Forces on a clump are those of the whole."""
    found = particles[by]
    if by in OF_CLUMPS and "clump" in particles.fields and (clumps := frame.clumps) is not None and len(clumps):
        inside, place_of = particles["clump"] >= 0, {int(n): place for place, n in enumerate(clumps["clump"])}
        places = [place_of[int(number)] for number in particles["clump"][inside]]
        found = found.copy()
        found[inside] = clumps[OF_CLUMPS[by]][places]
    return magnitude(found)


def magnitude(found: Any) -> Vector:
    """Lengths of vectors; numbers as they are."""
    lengths: Vector = np.linalg.norm(found, axis=1) if found.ndim == 2 else found.astype(float)
    return lengths


def scale(found: Any) -> tuple[float, float]:
    """The values of the two ends of the colours: one grain in a hundred may be beyond, so that one does not dim all."""
    return float(found.min()), float(np.percentile(found, 99.0))


def ends(particles: Cloud, by: str, found: Any, time: float) -> tuple[float, float]:
    """The same, but no finer than rest: what rounding leaves of a speed or a force has one colour."""
    low, high = scale(found)
    return low, max(high, still(particles, time).get(by, high))


def still(particles: Cloud, time: float) -> dict[str, float]:
    """Speed \\[m/s\\] and force \\[N\\] below which particles are at rest, as a picture shows them."""
    if time <= 0.0:
        return {}
    radius = float(np.median(particles["radius"]))
    found = {"velocity": STILL * radius / time, "angular_velocity": STILL / time}
    if "mass" in particles.fields:
        found["force"] = STILL * radius * float(np.median(particles["mass"])) / time**2
        found["torque"] = radius * found["force"]
    return found


def contact_lines(frame: Frame, particles: Cloud, contacts: Cloud) -> tuple[Any, Any]:
    """Where the lines of contacts begin and end: at the centres; at a boundary where they touch."""
    place_of = {int(number): place for place, number in enumerate(particles["id"])}
    places = [np.array([place_of.get(int(number), -1) for number in contacts[name]]) for name in ("id1", "id2")]
    second = np.where((places[1] >= 0)[:, None], particles.points[places[1]], contacts.points)
    return particles.points[places[0]], second


def joined(first: Any, second: Any, found: Any, edges: Any) -> tuple[Any, Any]:
    """Lines between points, with their values. Through a face of a cell there are two: from each point to the image."""
    lines = np.stack([first, second], axis=1)
    if edges is None:
        return lines, found
    apart = second - first
    way = apart - np.round(apart @ np.linalg.pinv(edges)) @ edges
    through = np.abs(way - apart).max(axis=1) > 1e-6 * np.abs(edges).max()
    lines[:, 1] = first + way
    back = np.stack([second - way, second], axis=1)[through]
    return np.concatenate([lines, back]), np.concatenate([found, found[through]])
