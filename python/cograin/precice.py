"""Units as a participant of preCICE: displacements are read, forces are written.

    import precice
    from cograin import Unit
    from cograin.precice import Surface, participate

    with Unit("bed.fmu") as bed:
        grains = precice.Participant("Grains", "precice-config.xml", 0, 1)
        participate(grains, [Surface(bed, "skin", "Grains-Mesh")])

preCICE 3 and its bindings (``pip install pyprecice``) are not part of this package, and nothing here imports them.
Forces and heat flows are sums over their places: map them with ``constraint="conservative"``, displacements and
temperatures with ``"consistent"``. A `Flow` is the fluid of a unit, by the cells of its own grid: drags and drag
coefficients are sums, too; velocities, pressure gradients, porosities and solid fluxes are fields.
A time window is repeated from saved states as often as an implicit coupling asks for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cograin.base.vector import Matrix, Vector, vector
from cograin.partners.step import Force, Step
from cograin.results import Table
from cograin.units.interface import Interface
from cograin.units.nodes import SCALARS
from cograin.units.unit import State, Unit

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


@dataclass
class Flow:
    """The fluid of a unit as a mesh of preCICE: a vertex for each cell of its grid.

    The unit reads ``velocity`` \\[m/s\\] and ``pressure_gradient`` \\[Pa/m\\]. It writes ``drag`` \\[N\\] and
    ``porosity``, and where names are given ``drag_coefficient`` \\[N s/m\\], ``pressure_force`` \\[N\\] and
    ``solid_flux`` \\[m/s\\].
    They are means of a window, but for velocity and porosity, which are those at its end.
    """

    unit: Unit
    fluid: str
    mesh: str
    velocity: str = "Velocity"
    pressure_gradient: str | None = "Pressure-Gradient"
    drag: str = "Drag"
    porosity: str = "Porosity"
    drag_coefficient: str | None = None
    pressure_force: str | None = None
    solid_flux: str | None = None

    def __post_init__(self) -> None:
        self.cells = self.unit.cells(self.fluid)
        self.vertices: Any = None
        for quantity, _ in self.read:
            if self.unit.variable(self.cells.names(quantity)[0]).causality != "input":
                raise ValueError(f"{self.unit.name}: {self.fluid}: expected a driven {quantity}, found another one")

    @property
    def read(self) -> list[tuple[str, str]]:
        """What it reads: quantities of the cells, and names of data."""
        return _named(velocity=self.velocity, pressure_gradient=self.pressure_gradient)

    @property
    def written(self) -> list[tuple[str, str]]:
        """What it writes."""
        return _named(
            mean_drag=self.drag,
            porosity=self.porosity,
            drag_coefficient=self.drag_coefficient,
            mean_pressure_force=self.pressure_force,
            mean_solid_flux=self.solid_flux,
        )

    def join(self, participant: Any) -> None:
        """Tells preCICE the mesh."""
        _spatial(participant, self.mesh)
        self.vertices = participant.set_mesh_vertices(self.mesh, self.cells.centres)

    def take(self, participant: Any, length: float) -> None:
        """Gives the unit what is to be at the end of a window of this length \\[s\\]."""
        for quantity, name in self.read:
            self.cells[quantity] = participant.read_data(self.mesh, name, self.vertices, length)

    def tell(self, participant: Any) -> None:
        """Writes what the particles did."""
        for quantity, name in self.written:
            participant.write_data(self.mesh, name, self.vertices, self.cells[quantity])


def _named(**names: str | None) -> list[tuple[str, str]]:
    """Quantities whose data have a name."""
    return [(quantity, name) for quantity, name in names.items() if name is not None]


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


def participate(participant: Any, meshes: Sequence[Surface | Flow], *, watch: Sequence[str] = ()) -> Table:
    """Couples the units of these meshes until preCICE ends the run; returns a row for each time window.

    ``participant`` is a ``precice.Participant``. A time window is one communication step of the units, in which they
    choose their own time steps. Of the first unit, ``watch`` names further columns of the table.
    """
    if not meshes:
        raise ValueError("surfaces: expected at least one, found none")
    sides = _Sides(participant, meshes)
    if participant.requires_initial_data():
        sides.write("end")
    participant.initialize()
    columns: dict[str, list[float]] = {name: [] for name in ("time", "evaluations", *watch)}
    evaluations, saved = 0, False
    while participant.is_coupling_ongoing():
        if participant.requires_writing_checkpoint():
            sides.save()
            saved = True
        length = participant.get_max_time_step_size()
        sides.advance(length)
        evaluations += 1
        sides.write(sides.kind)
        participant.advance(length)
        if participant.requires_reading_checkpoint():
            if not saved:
                raise ValueError("preCICE asked for a checkpoint back that it did not ask for before")
            sides.restore()
        elif participant.is_time_window_complete():
            first = meshes[0].unit
            values = [first.time, evaluations, *(first.number(name) for name in watch)]
            for column, value in zip(columns.values(), values, strict=True):
                column.append(float(value))
            evaluations = 0
    participant.finalize()
    return Table({name: np.array(values) for name, values in columns.items()})


class _Sides:
    """All meshes of a participant, and the units behind them."""

    def __init__(self, participant: Any, meshes: Sequence[Surface | Flow]) -> None:
        self.participant = participant
        self.flows = [mesh for mesh in meshes if isinstance(mesh, Flow)]
        surfaces = [mesh for mesh in meshes if isinstance(mesh, Surface)]
        if len({surface.kind for surface in surfaces}) > 1:
            raise ValueError("surfaces: expected forces of one kind, found mean and end")
        self.kind: Force = surfaces[0].kind if surfaces else "mean"
        sides = [_side(participant, surface) for surface in surfaces]
        self.interface = sides[0][0] if sides else None
        for one, _, _ in sides[1:]:
            assert self.interface is not None
            self.interface = self.interface + one
        self.groups = [(group, vertices) for _, several, vertices in sides for group in several]
        ends = np.cumsum([len(group.names) for group, _ in self.groups])
        self.places = [
            slice(int(end) - len(group.names), int(end)) for (group, _), end in zip(self.groups, ends, strict=True)
        ]
        for flow in self.flows:
            flow.join(participant)
        moved = self.interface.units if self.interface else []
        # Units of which no surface is coupled.
        self.others = list({id(flow.unit): flow.unit for flow in self.flows if flow.unit not in moved}.values())
        self.states: list[State | None] = [None] * len(self.others)

    def write(self, kind: Force) -> None:
        """Writes forces of this kind, and what the particles did to the fluid."""
        forces = self.interface.force(kind) if self.interface else np.zeros(0)
        for (group, vertices), place in zip(self.groups, self.places, strict=True):
            self.participant.write_data(group.mesh, group.answer, vertices, group.rows(forces[place]))
        for flow in self.flows:
            flow.tell(self.participant)

    def advance(self, length: float) -> None:
        """Makes a time window of this length \\[s\\] with what preCICE has for its end."""
        for flow in self.flows:
            flow.take(self.participant, length)
        if self.interface:
            begin = self.interface.time
            given = [
                group.values(self.participant.read_data(group.mesh, group.given, vertices, length))
                for group, vertices in self.groups
            ]
            self.interface.advance(np.concatenate(given), Step(begin, begin + length, length), self.kind)
        for unit in self.others:
            unit.step(length)

    def save(self) -> None:
        """Saves the states of all units."""
        if self.interface:
            self.interface.save()
        self.states = [unit.save(state) for unit, state in zip(self.others, self.states, strict=True)]

    def restore(self) -> None:
        """Restores the saved states."""
        if self.interface:
            self.interface.restore()
        for unit, state in zip(self.others, self.states, strict=True):
            assert state is not None
            unit.restore(state)


def _spatial(participant: Any, mesh: str) -> None:
    """Refuses a mesh that is not of space."""
    if participant.get_mesh_dimensions(mesh) != 3:
        raise ValueError(f"{mesh}: expected a mesh of 3 dimensions, found another one")


def _side(participant: Any, surface: Surface) -> tuple[Interface, list[_Group], NDArray[np.int32]]:
    """Tells preCICE the mesh of a surface; its directions and its vertices."""
    _spatial(participant, surface.mesh)
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
