"""Units as a participant of preCICE: displacements are read, forces are written.

    import precice
    from cograin import Unit
    from cograin.precice import Surface, participate

    with Unit("bed.fmu") as bed:
        grains = precice.Participant("Grains", "precice-config.xml", 0, 1)
        participate(grains, [Surface(bed, "skin", "Grains-Mesh")])

preCICE 3 and its bindings (``pip install pyprecice``) are not part of this package, and nothing here imports them.
Forces are sums over their places: map them with ``constraint="conservative"``, displacements with ``"consistent"``.
A time window is repeated from saved states as often as an implicit coupling asks for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cograin.interface import Interface
from cograin.results import Table
from cograin.step import Force, Step
from cograin.unit import Unit
from cograin.vector import Matrix, Vector


@dataclass
class Surface:
    """A boundary of a unit as a mesh of preCICE.

    A boundary with ``nodes = "driven"`` has a vertex for each node, and its triangles; any other one is a single vertex
    at the place ``at`` \\[m\\], of which the driven axes are moved. ``displacement`` and ``force`` are names of data;
    where they are given, a boundary reads its rotation vector \\[rad\\] as ``rotation`` and writes the ``moment`` that
    does the same work along it \\[N m\\]. ``kind`` is the force that is written: mean of a window, or that at its end.
    """

    unit: Unit
    boundary: str
    mesh: str
    displacement: str = "Displacement"
    force: str = "Force"
    rotation: str | None = None
    moment: str | None = None
    at: ArrayLike = (0.0, 0.0, 0.0)
    kind: Force = "mean"

    def __post_init__(self) -> None:
        if (self.rotation is None) != (self.moment is None):
            raise ValueError(f"{self.boundary}: expected names of both rotation and moment, found one of them")


class _Group:
    """Data of preCICE that are one quantity of a surface: displacements or rotations."""

    def __init__(self, surface: Surface, quantity: str, given: str, answer: str) -> None:
        self.mesh, self.given, self.answer = surface.mesh, given, answer
        self.where = f"{surface.unit.name}: {surface.boundary}.{quantity}"
        inputs = set(surface.unit.names("input"))
        node = f"{surface.boundary}.node[1].{quantity}.x"
        if node in inputs:
            self.names: tuple[str, ...] = surface.unit.nodes(surface.boundary).names(quantity)
            self.axes = [0, 1, 2]
        else:
            driven = [f"{surface.boundary}.{quantity}.{axis}" for axis in "xyz"]
            self.names = tuple(name for name in driven if name in inputs)
            self.axes = [axis for axis in range(3) if driven[axis] in inputs]
        if not self.names:
            raise ValueError(f"{self.where}: expected a driven boundary, found no such input")

    def values(self, read: Matrix) -> Vector:
        """What is given to the unit, from rows of three; refuses a motion along an axis that is not driven."""
        rest = np.delete(read, self.axes, axis=1)
        if np.abs(rest).max(initial=0.0) > 1e-9 * np.abs(read).max(initial=0.0):
            axis = "xyz"[next(axis for axis in range(3) if axis not in self.axes and read[:, axis].any())]
            raise ValueError(
                f"{self.where}.{axis}: expected a driven axis or no motion, found {read[:, 'xyz'.index(axis)].max():g}"
            )
        return read[:, self.axes].ravel()

    def rows(self, forces: Vector) -> Matrix:
        """Rows of three, from the forces in the driven directions."""
        found = np.zeros((len(forces) // len(self.axes), 3))
        found[:, self.axes] = forces.reshape(-1, len(self.axes))
        return found


def participate(participant: Any, surfaces: Sequence[Surface], *, watch: Sequence[str] = ()) -> Table:
    """Couples the units of these surfaces until preCICE ends the run; returns a row for each time window.

    ``participant`` is a ``precice.Participant``. A time window is one communication step of the units, in which they
    choose their own time steps. Of the first unit, ``watch`` names further columns of the table.
    """
    if not surfaces:
        raise ValueError("surfaces: expected at least one, found none")
    if len({surface.kind for surface in surfaces}) > 1:
        raise ValueError("surfaces: expected forces of one kind, found mean and end")
    sides, kind = [_side(participant, surface) for surface in surfaces], surfaces[0].kind
    interface = sides[0][0]
    for one, _, _ in sides[1:]:
        interface = interface + one
    groups = [(group, vertices) for _, several, vertices in sides for group in several]
    ends = np.cumsum([len(group.names) for group, _ in groups])
    places = [slice(int(end) - len(group.names), int(end)) for (group, _), end in zip(groups, ends, strict=True)]

    def write() -> None:
        forces = interface.force(kind)
        for (group, vertices), place in zip(groups, places, strict=True):
            participant.write_data(group.mesh, group.answer, vertices, group.rows(forces[place]))

    def read(length: float) -> Vector:
        given = [
            group.values(participant.read_data(group.mesh, group.given, vertices, length).reshape(-1, 3))
            for group, vertices in groups
        ]
        return np.concatenate(given)

    if participant.requires_initial_data():
        forces = interface.force("end")
        for (group, vertices), place in zip(groups, places, strict=True):
            participant.write_data(group.mesh, group.answer, vertices, group.rows(forces[place]))
    participant.initialize()
    columns: dict[str, list[float]] = {name: [] for name in ("time", "evaluations", *watch)}
    evaluations, saved = 0, False
    while participant.is_coupling_ongoing():
        if participant.requires_writing_checkpoint():
            interface.save()
            saved = True
        length = participant.get_max_time_step_size()
        begin = interface.time
        interface.advance(read(length), Step(begin, begin + length, length), kind)
        evaluations += 1
        write()
        participant.advance(length)
        if participant.requires_reading_checkpoint():
            if not saved:
                raise ValueError("preCICE asked for a checkpoint back that it did not ask for before")
            interface.restore()
        elif participant.is_time_window_complete():
            values = [interface.time, evaluations, *(surfaces[0].unit.number(name) for name in watch)]
            for column, value in zip(columns.values(), values, strict=True):
                column.append(float(value))
            evaluations = 0
    participant.finalize()
    return Table({name: np.array(values) for name, values in columns.items()})


def _side(participant: Any, surface: Surface) -> tuple[Interface, list[_Group], NDArray[np.int32]]:
    """Tells preCICE the mesh of a surface; its directions and its vertices."""
    if participant.get_mesh_dimensions(surface.mesh) != 3:
        raise ValueError(f"{surface.mesh}: expected a mesh of 3 dimensions, found another one")
    groups = [_Group(surface, "displacement", surface.displacement, surface.force)]
    if surface.rotation is not None and surface.moment is not None:
        groups.append(_Group(surface, "rotation", surface.rotation, surface.moment))
    if ".node[" in groups[0].names[0]:
        nodes = surface.unit.nodes(surface.boundary)
        vertices = participant.set_mesh_vertices(surface.mesh, nodes.places)
        if participant.requires_mesh_connectivity_for(surface.mesh):
            participant.set_mesh_triangles(surface.mesh, np.asarray(vertices)[nodes.triangles])
    else:
        vertices = participant.set_mesh_vertices(surface.mesh, np.array(surface.at, dtype=float).reshape(1, 3))
    names = [name for group in groups for name in group.names]
    return Interface(surface.unit, names), groups, vertices
