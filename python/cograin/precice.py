"""Units as a participant of preCICE: displacements are read, forces are written.

    import precice
    from cograin import Unit
    from cograin.precice import Surface, participate

    with Unit("bed.fmu") as bed:
        grains = precice.Participant("Grains", "precice-config.xml", 0, 1)
        participate(grains, [Surface(bed, "skin", "Grains-Mesh")])

preCICE 3 and its bindings (``pip install pyprecice``) are not part of this package, and nothing here imports them.
Forces and heat flows are sums over their places: map them with ``constraint="conservative"``, displacements and
temperatures with ``"consistent"``.
A time window is repeated from saved states as often as an implicit coupling asks for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cograin.interface import Interface
from cograin.nodes import SCALARS
from cograin.results import Table
from cograin.step import Force, Step
from cograin.unit import Unit
from cograin.vector import Matrix, Vector, vector

#: What a surface reads, and what it writes for it.
QUANTITIES = {"displacement": "force", "rotation": "moment", "temperature": "heat"}


@dataclass
class Surface:
    """A boundary of a unit as a mesh of preCICE.

    A boundary with ``nodes = "driven"`` has a vertex for each node, and its triangles; any other one is a single vertex
    at the place ``at`` \\[m\\], of which the driven axes are moved. ``displacement`` and ``force`` are names of data.
    Where names are given, a boundary reads its rotation vector \\[rad\\] as ``rotation`` and writes the ``moment`` that
    does the same work along it \\[N m\\]; it reads its ``temperature`` \\[K\\] and writes as ``heat`` the heat flow of
    the particles into it \\[W\\], scalars. With a temperature, ``displacement=None`` and ``force=None`` leave a
    boundary where it stands. ``kind`` is the force that is written: mean of a window, or that at its end.
    """

    unit: Unit
    boundary: str
    mesh: str
    displacement: str | None = "Displacement"
    force: str | None = "Force"
    rotation: str | None = None
    moment: str | None = None
    temperature: str | None = None
    heat: str | None = None
    at: ArrayLike = (0.0, 0.0, 0.0)
    kind: Force = "mean"

    def __post_init__(self) -> None:
        for given, answer in QUANTITIES.items():
            if (getattr(self, given) is None) != (getattr(self, answer) is None):
                raise ValueError(f"{self.boundary}: expected names of both {given} and {answer}, found one of them")
        if not self.named():
            raise ValueError(f"{self.boundary}: expected names of data, found none")

    def named(self) -> list[tuple[str, str, str]]:
        """Its quantities, with the names of the data that are read and written."""
        pairs = [(given, getattr(self, given), getattr(self, answer)) for given, answer in QUANTITIES.items()]
        return [pair for pair in pairs if pair[1] is not None]


class _Group:
    """Data of preCICE that are one quantity of a surface: displacements, rotations or temperatures."""

    def __init__(self, surface: Surface, quantity: str, given: str, answer: str) -> None:
        self.mesh, self.given, self.answer = surface.mesh, given, answer
        self.where = f"{surface.unit.name}: {surface.boundary}.{quantity}"
        inputs = set(surface.unit.names("input"))
        self.scalar = quantity in SCALARS
        lasts = [quantity] if self.scalar else [f"{quantity}.{axis}" for axis in "xyz"]
        self.by_node = f"{surface.boundary}.node[1].{lasts[0]}" in inputs
        if self.by_node:
            self.names: tuple[str, ...] = surface.unit.nodes(surface.boundary).names(quantity)
            self.axes = list(range(len(lasts)))
        else:
            driven = [f"{surface.boundary}.{last}" for last in lasts]
            self.names = tuple(name for name in driven if name in inputs)
            self.axes = [axis for axis, name in enumerate(driven) if name in inputs]
        if not self.names:
            advice = ""
            if quantity == "displacement" and surface.temperature is not None:
                advice = "; displacement=None and force=None leave it where it stands"
            raise ValueError(f"{self.where}: expected a driven boundary, found no such input{advice}")

    def values(self, read: Any) -> Vector:
        """What is given to the unit, from rows of three; refuses a motion along an axis that is not driven."""
        if self.scalar:
            return vector(read).ravel()
        read = np.asarray(read, dtype=float).reshape(-1, 3)
        rest = np.delete(read, self.axes, axis=1)
        if np.abs(rest).max(initial=0.0) > 1e-9 * np.abs(read).max(initial=0.0):
            axis = "xyz"[next(axis for axis in range(3) if axis not in self.axes and read[:, axis].any())]
            raise ValueError(
                f"{self.where}.{axis}: expected a driven axis or no motion, found {read[:, 'xyz'.index(axis)].max():g}"
            )
        return vector(read[:, self.axes].ravel())

    def rows(self, forces: Vector) -> Vector | Matrix:
        """Rows of three, from the forces in the driven directions; heat flows as they are."""
        if self.scalar:
            return forces
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
            group.values(participant.read_data(group.mesh, group.given, vertices, length)) for group, vertices in groups
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
    groups = [_Group(surface, *named) for named in surface.named()]
    if len({group.by_node for group in groups}) > 1:
        told = ", ".join(f"{group.where} {'of nodes' if group.by_node else 'of the whole'}" for group in groups)
        raise ValueError(f"expected data of nodes or of the whole boundary, found {told}")
    if groups[0].by_node:
        nodes = surface.unit.nodes(surface.boundary)
        vertices = participant.set_mesh_vertices(surface.mesh, nodes.places)
        if participant.requires_mesh_connectivity_for(surface.mesh):
            participant.set_mesh_triangles(surface.mesh, np.asarray(vertices)[nodes.triangles])
    else:
        vertices = participant.set_mesh_vertices(surface.mesh, np.array(surface.at, dtype=float).reshape(1, 3))
    names = [name for group in groups for name in group.names]
    return Interface(surface.unit, names), groups, vertices
