"""How both sides of an interface agree on one communication step: what every exchange offers, and the explicit ones."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Protocol

from cograin.step import Force, Outcome, Step
from cograin.vector import Matrix, Vector


class Side(Protocol):
    """What an exchange needs of the side of the particles; `Interface` is one, another program may be another."""

    displacement: Vector  # where it stands [m, rad]

    @property
    def names(self) -> list[str]:
        """Names of its directions."""

    @property
    def time(self) -> float:
        """Where it stands in time \\[s\\]."""

    @property
    def work(self) -> float | None:
        """Work of the interface on the particles since the start \\[J\\]; none where the side keeps no account."""

    @property
    def can_restore(self) -> bool:
        """Whether it can go back to a saved state."""

    @property
    def keeps_itself(self) -> bool:
        """Whether a step that it discards leaves it as it was, without help."""

    @property
    def has_derivatives(self) -> bool:
        """Whether `derivative` can be asked for."""

    def force(self, kind: Force) -> Vector:
        """Force of the particles on the interface \\[N, N m\\]."""

    def advance(self, displacement: Vector, step: Step, kind: Force) -> Vector:
        """Moves the interface there during this step; gives the force of this kind \\[N, N m\\]."""

    def save(self) -> None:
        """Remembers the present state."""

    def restore(self) -> None:
        """Goes back to the remembered state."""

    def derivative(self, displacement: Vector, kind: Force) -> Matrix:
        """Change of the force per change of displacement in the next step \\[N/m\\]."""


class Taker(Protocol):
    """What an exchange needs of a partner: `cograin.partner.Partner`."""

    @property
    def displacement(self) -> Vector: ...

    def predict(self, force: Vector, step: Step) -> Vector: ...

    def compliance(self, step: Step) -> Matrix: ...

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None: ...


class Exchange(ABC):
    """One way to agree. `evaluate` steps the units and leaves the partner alone; `commit` lets the partner follow.

    Where `evaluate` raises, the partner is as it was. ``force`` is the kind that is exchanged. An exchange remembers
    slopes from step to step and belongs to one run.
    """

    force: Force = "mean"
    #: Whether steps are repeated from saved states.
    repeats = False

    @abstractmethod
    def evaluate(self, side: Side, partner: Taker, step: Step, last: Vector, expected: Vector) -> Outcome:
        """Takes the units through a step; ``last`` is the force of the last step, ``expected`` its continuation."""

    def commit(self, partner: Taker, step: Step, outcome: Outcome) -> None:
        """The partner takes the step."""
        partner.advance(outcome.partner_force, outcome.displacement, step)


class GaussSeidel(Exchange):
    """One after the other: the partner takes the force of the last step, the units go where it went.

    One evaluation a step, first order. An error of the force comes back multiplied by stiffness of the particles over
    the step × compliance of the partner over the step, and grows above 1. With the force of the end the delay is half
    a step less than with the mean.
    """

    def __init__(self, force: Force = "end") -> None:
        self.force = force

    def evaluate(self, side: Side, partner: Taker, step: Step, last: Vector, expected: Vector) -> Outcome:
        displacement = partner.predict(last, step)
        found = side.advance(displacement, step, self.force)
        residual = float(abs(partner_difference(partner, found - last, step)).max())
        return Outcome(displacement, found, last, residual)


class Jacobi(Exchange):
    """Both at once, with what the other had at the begin: the units lag a step behind the partner.

    Both sides can run at the same time; nothing else speaks for it. It loses or makes energy in proportion to the step.
    """

    def __init__(self, force: Force = "end") -> None:
        self.force = force

    def evaluate(self, side: Side, partner: Taker, step: Step, last: Vector, expected: Vector) -> Outcome:
        begin = partner.displacement
        found = side.advance(begin, step, self.force)
        moved = partner.predict(last, step) - begin
        return Outcome(begin, found, last, float(abs(moved).max()))

    def commit(self, partner: Taker, step: Step, outcome: Outcome) -> None:
        partner.advance(outcome.partner_force, partner.predict(outcome.partner_force, step), step)


class Verlet(Exchange):
    """Velocity Verlet across the interface: half a kick by the force of now, drift, the force of then, half a kick.

    Second order with one evaluation a step; it is what one program would do that held both sides. Stable while the
    step is below the stability limit of partner and particles together; the partner needs a mass at every degree of
    freedom. The work of both sides differs by the change of the force within a step.
    """

    force: Force = "end"

    def evaluate(self, side: Side, partner: Taker, step: Step, last: Vector, expected: Vector) -> Outcome:
        if not (hasattr(partner, "drift") and hasattr(partner, "kick")):
            raise ValueError(f"{type(partner).__name__}: velocity Verlet needs a partner with drift and kick")
        displacement = partner.drift(last, step)
        found = side.advance(displacement, step, "end")
        self._begin = last
        return Outcome(displacement, found, 0.5 * (last + found), 0.0)

    def commit(self, partner: Taker, step: Step, outcome: Outcome) -> None:
        partner.kick(self._begin, outcome.force, step)  # type: ignore[attr-defined]


def partner_difference(partner: Taker, force: Vector, step: Step) -> Vector:
    """How much further a change of the force takes the partner; not known is said as not a number."""
    try:
        return partner.compliance(step) @ force
    except ValueError:
        return force * float("nan")
