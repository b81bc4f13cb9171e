"""The interface of units with a partner: driven displacements in, forces out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from cograin.base import interrupts
from cograin.base.rotation import after, quaternion, rotation_vector, secant, tangent, turn
from cograin.base.vector import Matrix, Vector, vector
from cograin.partners.step import Force, Step
from cograin.units.unit import State, StepDiscarded, Unit

# What the particles give back for what they are given, by design.
_ANSWERS = {
    "displacement": ("force", "mean_force"),
    "rotation": ("moment", "mean_moment"),
}

#: The last word of a direction that is a temperature, with a heat flow in place of a force.
TEMPERATURE = "temperature"

#: What `_answer` counts.
_KINDS: tuple[Force, Force] = ("end", "mean")


class _Turn:
    """Rotations of one boundary about two or three axes, which do not add up.

    What the directions mean is chosen by the partner. As *rotation vector* (of a structure) they are what the unit is
    given; the moment is the one that does the same work along the vector as the moments about the axes along the turn.
    As *turns* (of a rigid body) their changes are the rotation vectors of the turns in each step, and moments are those
    of the unit.
    """

    def __init__(
        self,
        places: list[int],
        axes: list[int],
        names: dict[Force, tuple[str, ...]],
        others: tuple[str, ...],
    ) -> None:
        self.places = places  # of its directions among those of the part
        self.axes = axes  # of these directions
        self.names = names  # of the moments about x, y, z
        self.others = others  # names of driven rotations of the boundary that are no directions
        self.moments = slice(0, 0)  # their places in what is read
        self.turns = False
        self.given: Vector = np.zeros(3)  # rotation vector [rad]
        self.before = np.zeros(3)  # that of the step before
        self.counted = np.zeros(3)  # the directions as the partner has them

    def memory(self) -> tuple[Vector, Vector, Vector]:
        """The values that change in a step."""
        return self.given, self.before, self.counted

    def begin(self, given: Vector, others: Vector) -> None:
        """Stands at this rotation vector: its directions, and the other driven rotations."""
        self.given[self.axes] = given
        self.given[self.beside] = others
        self.before, self.counted = self.given, self.given

    @property
    def beside(self) -> list[int]:
        """Axes of the other driven rotations."""
        return ["xyz".index(name[-1]) for name in self.others]

    def move(self, displacement: Vector, others: Vector) -> Vector:
        """The directions as the unit is given them, where the other driven rotations are given these."""
        if not self.turns:
            moved = self.given.copy()
            moved[self.axes] = displacement
            moved[self.beside] = others
        else:
            now = after(quaternion(displacement - self.counted), quaternion(self.given))
            moved = rotation_vector(now, near=self.given)
        self.before, self.given = self.given, moved
        self.counted = displacement if self.turns else moved
        return moved[self.axes]

    def rows(self, kind: Force) -> Matrix:
        """What the moments about x, y, z come to in the directions."""
        if self.turns:
            return np.eye(3)
        change = secant(self.before, self.given) if kind == "mean" else tangent(self.given)
        found: Matrix = change.T[self.axes]
        return found

    def columns(self) -> Matrix:
        """Change of what the unit is given, by change of the directions."""
        if not self.turns:
            return np.eye(len(self.axes))
        found: Matrix = np.linalg.inv(tangent(self.given)) @ tangent(turn(self.before, self.given))
        return found


class _Part:
    """The directions of one unit."""

    def __init__(
        self, unit: Unit, displacements: tuple[str, ...], ends: tuple[str, ...], means: tuple[str, ...], through: Any
    ):
        self.unit = unit
        self.through = through
        self.displacements = displacements
        self.forces: dict[Force, tuple[str, ...]] = {"end": ends, "mean": means}
        for name in (*displacements, *ends, *means):
            unit.variable(name)
        for name in displacements:
            if unit.variable(name).causality not in ("input", "parameter"):
                raise ValueError(f"{unit.name}: {name} is an {unit.variable(name).causality}; an input is needed")
        boundaries = dict.fromkeys(name.split(".")[0] for name in displacements)
        works = tuple(f"{boundary}.work" for boundary in boundaries)
        warm = [name.endswith(f".{TEMPERATURE}") for name in displacements]
        #: Whether they are temperatures.
        self.warm = any(warm)
        if through is not None and self.warm and not all(warm):
            raise ValueError("through: expected displacements or temperatures, found both")
        self.works = works if not self.warm and all(name in unit.variables for name in works) else ()
        self.slopes: tuple[str, ...] = ()  # names of the slopes of the forces, once they are asked for
        self.state: State | None = None
        self.begin = unit.get(displacements)
        if through is not None and self.warm:
            off = np.abs(through @ np.full(through.shape[1], self.begin[0]) - self.begin).max()
            if not off <= 1e-9 * np.abs(self.begin).max():
                raise ValueError(
                    "through: expected a unit of one temperature at the start, and rows that have the sum 1; "
                    f"one temperature of the partner is {off:.3g} K off"
                )
        #: How many directions of the partner it has.
        self.size = len(displacements) if through is None else through.shape[1]
        self.turns = list(_turns_of(unit, displacements, ends, means))
        # Everything that is read for the forces: the forces, then all moments of each turn.
        self.read = dict(self.forces)
        for one in self.turns:
            one.moments = slice(len(self.read["end"]), len(self.read["end"]) + 3)
            for kind, names in one.names.items():
                for name in names:
                    unit.variable(name)
                self.read[kind] = (*self.read[kind], *names)
            one.begin(self.begin[one.places], unit.get(one.others))
        self._turns_saved = [one.memory() for one in self.turns]

    def names(self) -> tuple[str, ...]:
        """Names of its directions."""
        if self.through is None:
            return self.displacements
        boundary, last = self.displacements[0].split(".")[0], f".{TEMPERATURE}" if self.warm else ""
        return tuple(f"{boundary}.mapped[{number}]{last}" for number in range(1, self.size + 1))

    @property
    def displacement(self) -> Vector:
        """Present displacements; those of a mapping are counted from where the unit begins, temperatures are not."""
        if self.through is None:
            return self.unit.get(self.displacements)
        return np.full(self.size, self.begin[0]) if self.warm else np.zeros(self.size)

    def move(self, displacement: Vector) -> None:
        """Gives the unit where it is to be."""
        if self.through is None:
            given = displacement
        else:
            mapped = self.through @ displacement
            given = mapped if self.warm else self.begin + mapped
        if self.warm:
            self._possible(given)
        if self.turns:
            given = given.copy()
            for one in self.turns:
                given[one.places] = one.move(given[one.places], self.unit.get(one.others))
        self.unit.set(self.displacements, given)

    def _possible(self, given: Vector) -> None:
        """Refuses what no partner reaches but a trial, or an exchange that swings: an exchange then tries less."""
        for name, value in zip(self.displacements, given, strict=True):
            if value < 0.0 and name.endswith(f".{TEMPERATURE}"):
                said = f"{name}: expected 0 K or above, found {value:g} K"
                raise StepDiscarded(f"{self.unit.name}: {said}", said, self.unit.time)

    def bend(self, acceleration: Vector, displacement: Vector, length: float) -> None:
        """Gives the unit where it is to be at the end of a step of this length \\[s\\], and its acceleration in it."""
        turning = [name for name in self.displacements if ".displacement." not in name]
        if turning:
            raise ValueError(f"quadratic motion: expected displacements, found {turning[0]}")
        self.move(displacement)
        given = acceleration if self.through is None else self.through @ acceleration
        # The step ends at value + (rate + ½ acceleration · length) · length: at the value, to the last bit.
        self.unit.set_rates(self.displacements, -0.5 * given * length)
        self.unit.set_rates(self.displacements, given, order=2)

    def mean_and_slope(self) -> tuple[Vector, Vector]:
        """Means \\[N\\] and slopes \\[N/s\\] of the forces over the last step."""
        if not self.slopes:
            self.slopes = tuple(name.replace(".displacement.", ".force_slope.") for name in self.displacements)
        found = self.unit.get((*self.forces["mean"], *self.slopes))
        mean, slope = found[: len(self.slopes)], found[len(self.slopes) :]
        return (mean, slope) if self.through is None else (self.through.T @ mean, self.through.T @ slope)

    def force(self, kind: Force) -> Vector:
        """Forces of the particles \\[N, N m\\]."""
        found = self._reduced(self.unit.get(self.read[kind]), kind) if self.turns else self.unit.get(self.read[kind])
        return found if self.through is None else vector(self.through.T @ found)

    def _reduced(self, read: Any, kind: Force) -> Any:
        """Forces in the directions, from all that is read; of a matrix, each column."""
        found = read[: len(self.displacements)].copy()
        for one in self.turns:
            found[one.places] = one.rows(kind) @ read[one.moments]
        return found

    def derivative(self, other: _Part, kind: Force) -> Matrix:
        """Change of its forces per change of the directions of a part of the same unit."""
        found = self._reduced(self.unit.derivative(self.read[kind], other.displacements), kind)
        for one in other.turns:
            found[:, one.places] = found[:, one.places] @ one.columns()
        found = found if self.through is None else self.through.T @ found
        whole: Matrix = found if other.through is None else found @ other.through
        return whole

    def told(self, displacement: Vector, force: Vector, kind: Force) -> tuple[Vector, Vector]:
        """Displacement and force as the unit calls them."""
        if not self.turns or self.through is not None:
            return displacement, force
        shown, moments = displacement.copy(), force.copy()
        for one in self.turns:
            shown[one.places] = one.given[one.axes]
            # Moments about the axes from those along the vector; about turns they are the same.
            if not one.turns:
                moments[one.places] = self.unit.get(one.names[kind])[one.axes]
        return shown, moments

    def save(self) -> None:
        """Keeps what changes beside the unit."""
        self._turns_saved = [one.memory() for one in self.turns]

    def restore(self) -> None:
        """Restores the saved state."""
        for one, saved in zip(self.turns, self._turns_saved, strict=True):
            one.given, one.before, one.counted = saved


def _turns_of(
    unit: Unit, displacements: tuple[str, ...], ends: tuple[str, ...], means: tuple[str, ...]
) -> Iterator[_Turn]:
    """The boundaries that turn about several axes, where forces have the names that follow from those of the inputs."""
    found: dict[str, list[tuple[int, int]]] = {}
    for place, name in enumerate(displacements):
        stem, _, axis = name.rpartition(".")
        usual = stem.endswith(".rotation") and axis in ("x", "y", "z")
        if usual and (ends[place], means[place]) == (_answer(name, 0), _answer(name, 1)):
            found.setdefault(stem, []).append((place, "xyz".index(axis)))
    for stem, several in found.items():
        coupled = [f"{stem}.{'xyz'[axis]}" for _, axis in several]
        driven = [f"{stem}.{axis}" for axis in "xyz" if f"{stem}.{axis}" in unit.variables]
        others = tuple(name for name in driven if name not in coupled and unit.variable(name).causality == "input")
        if len(several) + len(others) > 1:
            names: dict[Force, tuple[str, ...]] = {
                kind: tuple(_answer(f"{stem}.{axis}", number) for axis in "xyz") for number, kind in enumerate(_KINDS)
            }
            yield _Turn([place for place, _ in several], [axis for _, axis in several], names, others)


class Interface:
    """Driven directions of the boundaries of one unit, and the forces that belong to them.

    ``Interface(bed, "floor.displacement.z")`` couples one direction; give a list for several. The forces follow from
    the names: ``floor.force.z`` at the end of a step, ``floor.mean_force.z`` as its mean; a unit of another tool that
    calls them otherwise names them with ``forces`` and ``mean_forces``. Interfaces of several units are added:
    ``Interface(left, "wall.displacement.x") + Interface(right, "wall.displacement.x")``.

    ``through`` is a matrix with a row for each of the displacements and a column for each direction of the partner: the
    unit moves by it, and forces go back by its transpose. The partner's displacements are counted from where the unit
    stands. With the `matrix` of a `Mapping` they are those of the nodes of the partner's own mesh. Temperatures are not
    counted from the start: all are the same there, and `shares` of a `Mapping` is the matrix for them.

    ``Interface(bed, "floor.temperature")`` couples a temperature \\[K\\]; what responds is the heat flow of the
    particles into the boundary \\[W\\], ``floor.heat_flow`` and ``floor.mean_heat_flow``.

    ``substeps`` is how many communication steps of the units make one of the coupling; the boundary moves at constant
    velocity through all of them.
    """

    def __init__(
        self,
        unit: Unit,
        displacements: str | Sequence[str],
        *,
        forces: str | Sequence[str] | None = None,
        mean_forces: str | Sequence[str] | None = None,
        through: Any = None,
        substeps: int = 1,
    ) -> None:
        inputs = _several(displacements)
        if not inputs:
            raise ValueError("interface: expected names of displacements, found none")
        ends = _several(forces) if forces is not None else tuple(_answer(name, 0) for name in inputs)
        if mean_forces is not None:
            means = _several(mean_forces)
        else:
            means = ends if forces is not None else tuple(_answer(name, 1) for name in inputs)
        if not len(inputs) == len(ends) == len(means):
            raise ValueError(f"{len(inputs)} displacements, {len(ends)} forces and {len(means)} mean forces: one each")
        if substeps < 1:
            raise ValueError(f"substeps: expected at least 1, found {substeps}")
        if through is not None and through.shape[0] != len(inputs):
            found = through.shape[0]
            raise ValueError(f"through: expected a row for each of {len(inputs)} displacements, found {found}")
        self._parts = [_Part(unit, inputs, ends, means, through)]
        self.substeps = substeps
        self._refresh()

    def __add__(self, other: Interface) -> Interface:
        """The directions of both, in this order."""
        if self.substeps != other.substeps:
            raise ValueError(f"substeps: expected the same in all units, found {self.substeps} and {other.substeps}")
        both = Interface.__new__(Interface)
        both._parts = [*self._parts, *other._parts]
        both.substeps = self.substeps
        both._refresh()
        return both

    def _refresh(self) -> None:
        """Reads the present displacements of the units."""
        inputs = [(id(part.unit), name) for part in self._parts for name in part.displacements]
        for place, (_, name) in enumerate(inputs):
            if inputs[place] in inputs[:place]:
                raise ValueError(f"interface: expected each displacement once, found {name} twice")
        turning: dict[tuple[int, str], _Part] = {}
        for part in self._parts:
            for name in part.displacements:
                stem = name.rpartition(".")[0]
                if stem.endswith(".rotation") and turning.setdefault((id(part.unit), stem), part) is not part:
                    raise ValueError(
                        f"interface: expected all of {stem} in one Interface, found it in two: they do not add"
                    )
        self.displacement = np.concatenate([part.displacement for part in self._parts])
        self._saved = self.displacement
        #: Whether the units make their steps at the same time, each in a thread of its own.
        self.parallel = False
        self._threads: ThreadPoolExecutor | None = None
        #: Every unit, once.
        self.units = list({id(part.unit): part.unit for part in self._parts}.values())
        names = [unit.name for unit in self.units]
        for place, name in enumerate(names):
            if name in names[:place]:
                raise ValueError(
                    f"interface: expected units of different names, found {name} twice; "
                    "Unit(path, name=...) gives one of its own"
                )
        # Names of the works of each unit; two parts may speak of one boundary. Nothing where one keeps no account.
        works = [[name for part in self._parts if part.unit is unit for name in part.works] for unit in self.units]
        whole = all(part.works for part in self._parts)
        self._accounts = [(unit, tuple(dict.fromkeys(names))) for unit, names in zip(self.units, works, strict=True)]
        self._accounts = self._accounts if whole else []

    @property
    def names(self) -> list[str]:
        """Names of the displacements; after the name of the unit if there are several units."""
        several = len(self.units) > 1
        return [f"{part.unit.name}.{name}" if several else name for part in self._parts for name in part.names()]

    @property
    def time(self) -> float:
        """Present time of the units \\[s\\]."""
        return self.units[0].time

    @property
    def keeps_itself(self) -> bool:
        """Whether all units return to the beginning of a step that one discards by themselves."""
        return self.substeps == 1 and len(self.units) == 1

    @property
    def can_restore(self) -> bool:
        """Whether every unit can restore a saved state."""
        return all(unit.can_restore for unit in self.units)

    @property
    def has_derivatives(self) -> bool:
        """Whether every unit gives directional derivatives."""
        return self.substeps == 1 and all(unit.has_derivatives for unit in self.units)

    def turn(self, place: int) -> None:
        """Counts this direction and the next two, the rotations of one boundary, as turns; from its rotation vector."""
        first = 0
        for part in self._parts:
            for one in part.turns:
                if part.through is None and [first + each for each in one.places] == [place, place + 1, place + 2]:
                    if one.axes != [0, 1, 2]:
                        break
                    one.turns = True
                    principal = rotation_vector(quaternion(one.given))
                    one.counted = principal
                    self.displacement = self.displacement.copy()
                    self.displacement[place : place + 3] = principal
                    return
            first += part.size
        names = ", ".join(self.names[place : place + 3])
        raise ValueError(f"a rigid body turns: expected rotation.x, .y and .z of a boundary here, found {names}")

    def told(self, displacement: Vector, force: Vector, kind: Force) -> tuple[Vector, Vector]:
        """Displacement and force of the last step as the units call them."""
        if not any(part.turns for part in self._parts):
            return displacement, force
        first, found = 0, []
        for part in self._parts:
            places = slice(first, first + part.size)
            found.append(part.told(displacement[places], force[places], kind))
            first += part.size
        return _joined(found)

    def force(self, kind: Force) -> Vector:
        """Force of the particles on the interface: mean of the last step or at its end \\[N, N m\\]."""
        found = [part.force(kind) for part in self._parts]
        return found[0] if len(found) == 1 else np.concatenate(found)

    @property
    def work(self) -> float | None:
        """Work on the particles since the start, by the account of the units \\[J\\]; ``None`` without one."""
        if not self._accounts:
            return None
        return sum(float(sum(unit.get(names))) for unit, names in self._accounts)

    def advance(self, displacement: Vector, step: Step, kind: Force) -> Vector:
        """Moves the interface to this displacement during the step; returns the force of this kind \\[N, N m\\]."""
        if self.substeps == 1:
            self._move(displacement, step.length, step.end)
            self.displacement = displacement
            return self.force(kind)
        begin, impulse = self.displacement, np.zeros(len(displacement))
        length = step.length / self.substeps
        for count in range(1, self.substeps + 1):
            last = count == self.substeps
            place = displacement if last else begin + (displacement - begin) * (count / self.substeps)
            self._move(place, length, step.end if last else step.begin + count * length)
            if kind == "mean":
                impulse += self.force("mean")
        self.displacement = displacement
        return impulse / self.substeps if kind == "mean" else self.force("end")

    def advance_quadratically(self, displacement: Vector, acceleration: Vector, step: Step) -> tuple[Vector, Vector]:
        """Moves the interface to this displacement at this constant acceleration \\[m/s²\\] during the step.

        Returns mean \\[N\\] and slope \\[N/s\\] of the force. Needs ``input = "quadratic"`` in the scenes of the units.
        """
        if self.substeps != 1:
            raise ValueError(f"quadratic motion: expected 1 substep of the units, found {self.substeps}")
        first = 0
        for part in self._parts:
            part.bend(acceleration[first : first + part.size], displacement[first : first + part.size], step.length)
            first += part.size
        self._step(step.length, step.end)
        self.displacement = displacement
        found = [part.mean_and_slope() for part in self._parts]
        return found[0] if len(found) == 1 else _joined(found)

    def _move(self, displacement: Vector, length: float, end: float) -> None:
        """One step of every unit."""
        first = 0
        for part in self._parts:
            part.move(displacement[first : first + part.size])
            first += part.size
        self._step(length, end)

    def _step(self, length: float, end: float) -> None:
        """One step of every unit; in parallel where that was asked for."""
        if not self.parallel or len(self.units) == 1:
            for unit in self.units:
                unit.step(length, until=end)
            return
        if self._threads is None:
            self._threads = ThreadPoolExecutor(len(self.units) - 1, thread_name_prefix="cograin")
        first, *others = self.units
        running = [self._threads.submit(unit.step, length, until=end) for unit in others]
        try:
            first.step(length, until=end)
        finally:
            # No unit is left in the middle of a step.
            failed = [failure for each in running if (failure := each.exception()) is not None]
        if failed:
            interrupts.check()
            raise failed[0]

    def save(self) -> None:
        """Saves the state of every unit, in place of the one saved before."""
        for part in {id(part.unit): part for part in self._parts}.values():
            part.state = part.unit.save(part.state)
        for part in self._parts:
            part.save()
        self._saved = self.displacement

    def restore(self) -> None:
        """Restores the saved states."""
        for part in {id(part.unit): part for part in self._parts}.values():
            if part.state is not None:
                part.unit.restore(part.state)
        for part in self._parts:
            part.restore()
        self.displacement = self._saved

    def settings(self) -> dict[str, Any]:
        """Which variables of which units it joins, and where it stands."""
        parts = [[part.unit.name, part.displacements, part.forces, part.through] for part in self._parts]
        return {"parts": parts, "substeps": self.substeps, "displacement": self.displacement}

    def memory(self) -> Any:
        """The values that change in a step, without the units."""
        return self.displacement, [[one.memory() for one in part.turns] for part in self._parts]

    def recall(self, memory: Any) -> None:
        """Restores what `memory` returned."""
        self.displacement, turns = memory
        for part, several in zip(self._parts, turns, strict=True):
            for one, kept in zip(part.turns, several, strict=True):
                one.given, one.before, one.counted = kept

    def derivative(self, kind: Force) -> Matrix:
        """Change of the force per change of displacement at the end of the last step, by the units \\[N/m\\]."""
        ends = np.cumsum([part.size for part in self._parts])
        places = [slice(end - part.size, end) for part, end in zip(self._parts, ends, strict=True)]
        blocks = np.zeros((ends[-1], ends[-1]))
        for one, rows in zip(self._parts, places, strict=True):
            for other, columns in zip(self._parts, places, strict=True):
                if one.unit is other.unit:
                    blocks[rows, columns] = one.derivative(other, kind)
        return blocks


def _joined(pairs: Sequence[tuple[Vector, Vector]]) -> tuple[Vector, Vector]:
    """Pairs of vectors of several units as one pair."""
    first, second = zip(*pairs, strict=True)
    return np.concatenate(first), np.concatenate(second)


def _several(names: str | Sequence[str]) -> tuple[str, ...]:
    """One name or many, as a tuple."""
    return (names,) if isinstance(names, str) else tuple(names)


def _answer(name: str, kind: int) -> str:
    """Name of the force (0) or mean force (1) that belongs to a displacement; of the heat flow to a temperature."""
    parts = name.split(".")
    if len(parts) > 1 and parts[-1] == TEMPERATURE:
        return ".".join([*parts[:-1], ("heat_flow", "mean_heat_flow")[kind]])
    if len(parts) < 3 or parts[-2] not in _ANSWERS:
        expected = "<boundary>.displacement.<axis>, <boundary>.rotation.<axis> or <boundary>.temperature"
        advice = "name forces and mean_forces where a unit calls them otherwise"
        raise ValueError(f"expected {expected}, found {name}; {advice}")
    return ".".join([*parts[:-2], _ANSWERS[parts[-2]][kind], parts[-1]])


def stiffness(interface: Interface, length: float, displacement: float | None = None) -> Vector:
    """Change of the mean force with which each direction resists a ramp of one step, from the present state \\[N/m\\].

    By the derivatives of the units, or by moving each direction separately by ``displacement`` \\[m, rad\\], where one
    is given. The state is restored afterwards.
    """
    if not interface.can_restore:
        raise ValueError("stiffness: needs units that save and restore their states")
    if displacement is None and not interface.has_derivatives:
        raise ValueError(
            "stiffness: the units give no derivatives; expected a displacement to move them by, found none"
        )
    begin = interface.time
    step = Step(begin, begin + length, length)
    interface.save()
    try:
        place = vector(interface.displacement)
        at_rest = interface.advance(place, step, "mean")
        if displacement is None:
            return vector(-np.diag(interface.derivative("mean")))
        found = np.empty(len(place))
        for direction in range(len(place)):
            interface.restore()
            moved = place.copy()
            moved[direction] += displacement
            found[direction] = (at_rest - interface.advance(moved, step, "mean"))[direction] / displacement
        return found
    finally:
        interface.restore()
