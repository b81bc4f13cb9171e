"""The exchange of higher order: quadratic motion in the step, mean and slope of the force."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, cast

import numpy as np

from cograin.base.vector import Matrix, Vector
from cograin.exchanges.exchange import Exchange, Side, Taker
from cograin.exchanges.implicit import Implicit, QuasiNewton
from cograin.partners.step import Force, Outcome, Step


class QuadraticSide(Side, Protocol):
    """A side of particles that moves along a parabola and tells the slope of its force."""

    def advance_quadratically(self, displacement: Vector, acceleration: Vector, step: Step) -> tuple[Vector, Vector]:
        """Moves the interface there at this acceleration; returns mean \\[N\\] and slope \\[N/s\\] of the force."""


class QuadraticPartner(Taker, Protocol):
    """A partner that moves along a parabola under a force that is linear in time."""

    def predict_quadratically(self, force: Vector, slope: Vector, step: Step) -> tuple[Vector, Vector]:
        """Displacement at the end \\[m\\] and acceleration \\[m/s²\\] of the interface; changes nothing."""

    def quadratic_compliance(self, step: Step) -> Matrix:
        """Change of displacements and accelerations per change of mean and slope of the force."""

    def advance_quadratically(self, force: tuple[Vector, Vector], motion: tuple[Vector, Vector], step: Step) -> None:
        """Makes the step under this mean and slope; stands where the units stand, and books their motion."""


class Quadratic(Exchange):
    """Fourth order: quadratic motion in the step, mean and slope of the force.

    The boundary goes through the step at the constant acceleration that the partner has in it, and the partner takes
    the mean and the slope of the force.

    The unit's scene needs ``input = "quadratic"`` at the boundary, and the partner mass or damping (every `Structure`
    that is not static). For each direction of the interface two numbers are agreed on, by a repeated exchange of its
    own: ``exchange``, a `QuasiNewton` if none is given. Its tolerance counts displacements at the end of the step and
    the bulges of the parabolas, both in metres. Impulse and work of both sides are the same to rounding, as those of a
    ramp and the mean force are.
    """

    force: Force = "mean"
    repeats = True

    def __init__(self, exchange: Implicit | None = None) -> None:
        self.exchange = exchange or QuasiNewton()
        self._slope: Vector | None = None  # of the last step [N/s]
        self._agreed: tuple[Vector, Vector] | None = None

    def evaluate(self, side: Side, partner: Taker, step: Step, last: Vector, expected: Vector) -> Outcome:
        if not hasattr(side, "advance_quadratically"):
            raise ValueError(f"{type(side).__name__}: quadratic motion needs a side with advance_quadratically")
        if not hasattr(partner, "predict_quadratically"):
            raise ValueError(f"{type(partner).__name__}: quadratic motion needs a partner with predict_quadratically")
        slope = np.zeros(len(last)) if self._slope is None else self._slope
        doubled = _DoubledSide(cast(QuadraticSide, side)), _DoubledPartner(cast(QuadraticPartner, partner))
        joined = [np.concatenate([force, 0.5 * step.length * slope]) for force in (last, expected)]
        found = self.exchange.evaluate(*doubled, step, *joined)
        motion, load = _split(found.displacement), _split(found.force)
        self._agreed = (motion[1] * (8.0 / step.length**2), load[1] * (2.0 / step.length))
        return Outcome(
            motion[0],
            load[0],
            load[0],
            found.residual,
            found.evaluations,
            found.converged,
            found.reason,
            found.refusals,
            found.jumps,
            found.spread,
            4.0 / 3.0 * float(load[1] @ motion[1]),
        )

    def bend(self, partner: Taker, step: Step, force: Vector) -> float:
        raise ValueError("StepControl(error=...): expected an exchange whose boundary moves straight, found Quadratic")

    def memory(self) -> Any:
        return super().memory(), self.exchange.memory()

    def recall(self, memory: Any) -> None:
        own, agreeing = memory
        super().recall(own)
        self.exchange.recall(agreeing)

    def commit(self, partner: Taker, step: Step, outcome: Outcome) -> None:
        assert self._agreed is not None
        acceleration, slope = self._agreed
        bulge = acceleration * (step.length**2 / 8.0)
        self.exchange.note(np.concatenate([outcome.displacement - partner.displacement, bulge]), step.length)
        cast(QuadraticPartner, partner).advance_quadratically(
            (outcome.force, slope), (outcome.displacement, acceleration), step
        )
        self._slope = slope


class _DoubledSide:
    """A side with twice as many directions.

    In go displacements and bulges of the parabolas [m], out come the mean force and half of its change in the step [N].
    """

    has_derivatives = False

    def __init__(self, side: QuadraticSide) -> None:
        self._side = side
        self.save: Callable[[], None] = side.save
        self.restore: Callable[[], None] = side.restore
        self.can_restore, self.keeps_itself = side.can_restore, side.keeps_itself
        self.displacement = np.concatenate([side.displacement, np.zeros(len(side.displacement))])

    @property
    def names(self) -> list[str]:
        """Names of its directions."""
        names = self._side.names
        return [*names, *(f"{name}.bulge" for name in names)]

    @property
    def time(self) -> float:
        """Its present time \\[s\\]."""
        return self._side.time

    @property
    def work(self) -> float | None:
        """Work of the interface on the particles since the start \\[J\\]."""
        return self._side.work

    def force(self, kind: Force) -> Vector:
        """Not asked for by repeated exchanges."""
        raise NotImplementedError

    def derivative(self, kind: Force) -> Matrix:
        """None: `has_derivatives` says so."""
        raise NotImplementedError

    def advance(self, displacement: Vector, step: Step, kind: Force) -> Vector:
        """One step of the units."""
        end, bulge = _split(displacement)
        mean, slope = self._side.advance_quadratically(end, bulge * (8.0 / step.length**2), step)
        return np.concatenate([mean, 0.5 * step.length * slope])


class _DoubledPartner:
    """A partner with twice as many directions, in the same terms."""

    def __init__(self, partner: QuadraticPartner) -> None:
        self._partner = partner

    @property
    def displacement(self) -> Vector:
        """At the beginning of the step, and no bulge."""
        here = self._partner.displacement
        return np.concatenate([here, np.zeros(len(here))])

    def predict(self, force: Vector, step: Step) -> Vector:
        """Displacement at the end and bulge \\[m\\]."""
        mean, change = _split(force)
        end, acceleration = self._partner.predict_quadratically(mean, change * (2.0 / step.length), step)
        return np.concatenate([end, acceleration * (step.length**2 / 8.0)])

    def compliance(self, step: Step) -> Matrix:
        """Change of both per change of the force \\[m/N\\]."""
        found = self._partner.quadratic_compliance(step).copy()
        size = len(found) // 2
        found[size:] *= step.length**2 / 8.0
        found[:, size:] *= 2.0 / step.length
        return found

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None:
        """Not asked for: `Quadratic` makes the step."""
        raise NotImplementedError


def _split(both: Vector) -> tuple[Vector, Vector]:
    """First and second half."""
    size = len(both) // 2
    return both[:size], both[size:]
