"""The other side of an interface: what a partner provides, and partners that are not structures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np

from cograin.base.vector import Matrix, Vector, vector
from cograin.partners.step import Step
from cograin.units.unit import State, Unit


class Partner(Protocol):
    """The other side of an interface: takes the force of the particles and determines the displacement.

    Where the directions are no places but values, such as velocities and pressure gradients, ``weights(step)`` says in
    place of a compliance how they compare.

    For a checkpoint it also has ``memory()``, which gives what its steps change, and ``recall(memory)``. A checkpoint
    is that of a partner with the same attributes; ``settings()`` gives others in their place, by their names.
    """

    @property
    def displacement(self) -> Vector:
        """Present displacement of the interface \\[m, rad\\]."""

    def predict(self, force: Vector, step: Step) -> Vector:
        """Displacement of the interface at the end of this step under this force \\[N, N m\\]; changes nothing."""

    def compliance(self, step: Step) -> Matrix:
        """Change of that displacement per change of the force \\[m/N\\]."""

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None:
        """Makes the step under this force, and then stands where the units stand: at this displacement."""


@runtime_checkable
class KickedPartner(Partner, Protocol):
    """A partner that velocity Verlet can step: half a kick, drift, half a kick."""

    def drift(self, force: Vector, step: Step) -> Vector:
        """Displacement at the end, after half a kick of the force at the beginning; changes nothing."""

    def kick(self, begin: Vector, end: Vector, step: Step) -> None:
        """Makes the step with the forces at its beginning and its end."""


class UnitPartner:
    """Another unit, of any tool, whose inputs are forces and whose outputs are displacements.

    It has to restore states unless the exchange is explicit. Its compliance is needed by Newton's exchange and by a
    tolerance of the force alone: ``compliance="differences"`` measures it from two predictions a direction, once for
    each length of the step; the unit is then assumed to be linear. ``perturbation`` is the force for it \\[N, N m\\],
    the largest one so far if none is given.
    """

    def __init__(
        self,
        unit: Unit,
        *,
        force: str | Sequence[str],
        displacement: str | Sequence[str],
        compliance: Literal["differences"] | None = None,
        perturbation: float | None = None,
    ) -> None:
        self.unit = unit
        self.forces = (force,) if isinstance(force, str) else tuple(force)
        self.displacements = (displacement,) if isinstance(displacement, str) else tuple(displacement)
        if len(self.forces) != len(self.displacements):
            raise ValueError(f"{len(self.forces)} forces and {len(self.displacements)} displacements: one each")
        self._by_differences = compliance == "differences"
        self._perturbation = perturbation  # [N]
        self._largest = 0.0  # force so far [N, N m]
        self._compliances: dict[float, Matrix] = {}
        self._here = unit.get(self.displacements)
        self._saved: State | None = None
        self._tried: tuple[Step, Vector, Vector] | None = None

    @property
    def displacement(self) -> Vector:
        """Present displacement of the interface \\[m, rad\\]."""
        return self._here

    def predict(self, force: Vector, step: Step) -> Vector:
        """Makes the step on trial; the state of the unit is restored before the next trial."""
        if self._tried is not None:
            tried, taken, found = self._tried
            if tried == step and np.array_equal(taken, force):
                return found
            if self._saved is None:
                raise ValueError(f"{self.unit.name}: cannot restore states, which a repeated step needs")
            self.unit.restore(self._saved)
        elif self.unit.can_restore:
            self._saved = self.unit.save(self._saved)
        self.unit.set(self.forces, force)
        self._largest = max(self._largest, float(np.abs(force).max()))
        self.unit.step(step.length, until=step.end)
        found = self.unit.get(self.displacements)
        self._tried = (step, vector(force), found)
        return found

    def compliance(self, step: Step) -> Matrix:
        """Change of the displacement per change of the force, by differences of the unit itself \\[m/N\\]."""
        if not self._by_differences:
            raise ValueError(f"{self.unit.name}: its compliance is not known; compliance='differences' measures it")
        if step.length not in self._compliances:
            size = len(self.forces)
            force = self._perturbation or self._largest or 1.0
            none = self.predict(np.zeros(size), step)
            columns = [self.predict(row, step) - none for row in force * np.eye(size)]
            self._compliances[step.length] = np.array(columns).T / force
        return self._compliances[step.length]

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None:
        """Keeps the trial with this force; the unit is then at the displacement, to the tolerance."""
        self._here = self.predict(force, step)
        self._tried = None

    @property
    def units(self) -> list[Unit]:
        """The unit."""
        return [self.unit]

    def settings(self) -> dict[str, Any]:
        """What it was made with, and where it stands, beside the unit itself."""
        return {name: value for name, value in vars(self).items() if name not in ("unit", "_saved", "_tried")}

    def memory(self) -> Any:
        """Where the partner is, and what it learned of the unit."""
        return self._here, self.unit.time, self._largest, dict(self._compliances)

    def recall(self, memory: Any) -> None:
        """Restores what `memory` returned, at the beginning of a step."""
        self._here, time, self._largest, self._compliances = memory
        if (self._tried is not None or self.unit.time != time) and self._saved is not None:
            self.unit.restore(self._saved)
        self._tried = None


class Partners:
    """Several partners: the first has the first directions of the interface, and so on."""

    def __init__(self, *partners: Partner) -> None:
        if not partners:
            raise ValueError("partners: expected one at least, found none")
        self.partners = partners
        ends = np.cumsum([len(partner.displacement) for partner in partners])
        self._places = [
            slice(int(end) - len(one.displacement), int(end)) for one, end in zip(partners, ends, strict=True)
        ]

    def _each(self) -> Any:
        return zip(self.partners, self._places, strict=True)

    @property
    def displacement(self) -> Vector:
        """Present displacement of the interface \\[m, rad\\]."""
        return np.concatenate([partner.displacement for partner in self.partners])

    def predict(self, force: Vector, step: Step) -> Vector:
        """The displacements of all."""
        return np.concatenate([partner.predict(force[place], step) for partner, place in self._each()])

    def compliance(self, step: Step) -> Matrix:
        """A matrix with a block for each \\[m/N\\]."""
        size = self._places[-1].stop
        found = np.zeros((size, size))
        for partner, place in self._each():
            found[place, place] = partner.compliance(step)
        return found

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None:
        """Makes the step with all."""
        for partner, place in self._each():
            partner.advance(force[place], displacement[place], step)

    def drift(self, force: Vector, step: Step) -> Vector:
        """Displacement at the end, after half a kick of the force at the beginning; changes nothing."""
        return np.concatenate([_kicked(partner).drift(force[place], step) for partner, place in self._each()])

    def kick(self, begin: Vector, end: Vector, step: Step) -> None:
        """Makes the step with the forces at its beginning and its end."""
        for partner, place in self._each():
            _kicked(partner).kick(begin[place], end[place], step)

    def predict_quadratically(self, force: Vector, slope: Vector, step: Step) -> tuple[Vector, Vector]:
        """Displacements at the end \\[m\\] and accelerations \\[m/s²\\] of all; changes nothing."""
        each = [_quadratic(one).predict_quadratically(force[place], slope[place], step) for one, place in self._each()]
        ends, accelerations = zip(*each, strict=True)
        return np.concatenate(ends), np.concatenate(accelerations)

    def quadratic_compliance(self, step: Step) -> Matrix:
        """Change of displacements and accelerations per change of mean and slope of the force, a block for each."""
        size = self._places[-1].stop
        found = np.zeros((2, size, 2, size))
        for partner, place in self._each():
            own = len(partner.displacement)
            block = _quadratic(partner).quadratic_compliance(step)
            found[:, place, :, place] = block.reshape(2, own, 2, own)
        return found.reshape(2 * size, 2 * size)

    def advance_quadratically(self, force: tuple[Vector, Vector], motion: tuple[Vector, Vector], step: Step) -> None:
        """Makes the step with all, under mean and slope of the force, along these displacements and accelerations."""
        for partner, place in self._each():
            own = (force[0][place], force[1][place]), (motion[0][place], motion[1][place])
            _quadratic(partner).advance_quadratically(*own, step)

    @property
    def units(self) -> list[Unit]:
        """Those of all."""
        return [unit for one in self.partners for unit in getattr(one, "units", [])]

    def turning(self) -> tuple[int, ...]:
        """Where the directions begin that count turns."""
        turning = [(one, place.start) for one, place in self._each() if hasattr(one, "turning")]
        return tuple(first + each for one, first in turning for each in one.turning())

    def settings(self) -> dict[str, Any]:
        """The partners."""
        return {"partners": self.partners}

    def memory(self) -> Any:
        """The memories of those that have one."""
        return [one.memory() if hasattr(one, "memory") else None for one in self.partners]

    def recall(self, memory: Any) -> None:
        """Restores what `memory` returned."""
        for one, kept in zip(self.partners, memory, strict=True):
            if hasattr(one, "recall"):
                one.recall(kept)


def _kicked(partner: Partner) -> KickedPartner:
    """A partner that velocity Verlet can step; others are refused."""
    if not isinstance(partner, KickedPartner):
        raise ValueError(f"{type(partner).__name__}: velocity Verlet needs a partner with drift and kick")
    return partner


def _quadratic(partner: Any) -> Any:
    """A partner that moves along a parabola; others are refused."""
    if not hasattr(partner, "predict_quadratically"):
        raise ValueError(f"{type(partner).__name__}: quadratic motion needs a partner with predict_quadratically")
    return partner
