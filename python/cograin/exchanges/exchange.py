"""How both sides of an interface agree on one communication step: what every exchange offers, and the explicit ones."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, Protocol

from cograin.base.vector import Matrix, Vector
from cograin.partners.step import Force, Outcome, Step


class Side(Protocol):
    """What an exchange needs of the side of the particles. `Interface` provides it; another program may do so, too."""

    displacement: Vector  # where it stands [m, rad]

    @property
    def names(self) -> list[str]:
        """Names of its directions."""

    @property
    def time(self) -> float:
        """Its present time \\[s\\]."""

    @property
    def work(self) -> float | None:
        """Work of the interface on the particles since the start \\[J\\]; ``None`` if the side does not know it."""

    @property
    def can_restore(self) -> bool:
        """Whether it can restore a saved state."""

    @property
    def keeps_itself(self) -> bool:
        """Whether it returns to the beginning of a step that it discards by itself."""

    @property
    def has_derivatives(self) -> bool:
        """Whether it has `derivative`."""

    def force(self, kind: Force) -> Vector:
        """Force of the particles on the interface \\[N, N m\\]."""

    def advance(self, displacement: Vector, step: Step, kind: Force) -> Vector:
        """Moves the interface to this displacement during the step; returns the force of this kind \\[N, N m\\]."""

    def save(self) -> None:
        """Saves the present state."""

    def restore(self) -> None:
        """Restores the saved state."""

    def derivative(self, kind: Force) -> Matrix:
        """Change of the force per change of displacement in the next step \\[N/m\\]."""


class Taker(Protocol):
    """What an exchange needs of a partner: `cograin.partners.partner.Partner`."""

    @property
    def displacement(self) -> Vector: ...

    def predict(self, force: Vector, step: Step) -> Vector: ...

    def compliance(self, step: Step) -> Matrix: ...

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None: ...


class Exchange(ABC):
    """One way to agree. `evaluate` steps the units and does not change the partner; `commit` then steps the partner.

    If `evaluate` raises, the partner is unchanged. ``force`` is the kind of force that is exchanged. An exchange stores
    slopes from step to step, so each run at the same time needs an instance of its own.
    """

    force: Force = "mean"
    #: Whether steps are repeated from saved states.
    repeats = False

    def bend(self, partner: Taker, step: Step, force: Vector) -> float:
        """How far the partner's path under this force leaves the way of the boundary in a step \\[m, rad\\].

        The boundary moves at constant velocity; halfway, the partner is elsewhere.
        """
        half = Step(step.begin, step.middle, 0.5 * step.length)
        straight = 0.5 * (partner.displacement + partner.predict(force, step))
        return float(abs(partner.predict(force, half) - straight).max())

    @abstractmethod
    def evaluate(self, side: Side, partner: Taker, step: Step, last: Vector, expected: Vector) -> Outcome:
        """Takes the units through a step; ``last`` is the force of the last step, ``expected`` its continuation."""

    def commit(self, partner: Taker, step: Step, outcome: Outcome) -> None:
        """The partner takes the step."""
        partner.advance(outcome.partner_force, outcome.displacement, step)

    #: What a run does not change, and what is computed again where it is missing.
    _fixed = ("_made", "tolerance", "exchange", "_measure")

    def memory(self) -> Any:
        """What the exchange learned in earlier steps."""
        changing = {name: value for name, value in vars(self).items() if name not in self._fixed}
        return {name: list(value) if isinstance(value, list) else value for name, value in changing.items()}

    def recall(self, memory: Any) -> None:
        """Restores what `memory` returned, and forgets what came after."""
        vars(self).update(memory)

    def settings(self) -> dict[str, Any]:
        """What it was made with, before its first step."""
        return {name: value for name, value in vars(self).items() if name not in ("_made", "_measure")}

    def fresh(self) -> None:
        """Begins a run, with what it was made with: nothing of an earlier run changes a bit."""
        first = vars(self).get("_made")
        if first is None:
            vars(self)["_made"] = self.memory()
        else:
            self.recall(first)


class GaussSeidel(Exchange):
    """The two sides take turns: the partner takes the force of the last step, then the units follow its displacement.

    One evaluation for each step, first order. An error of the force returns multiplied by the gain: stiffness of the
    particles × compliance of the partner, both over the step. It grows if the gain is above 1. With the force at the
    end of the step the delay is half a step less than with the mean.
    """

    def __init__(self, force: Force = "end") -> None:
        self.force = force

    def evaluate(self, side: Side, partner: Taker, step: Step, last: Vector, expected: Vector) -> Outcome:
        displacement = partner.predict(last, step)
        found = side.advance(displacement, step, self.force)
        residual = float(abs(partner_difference(partner, found - last, step)).max())
        return Outcome(displacement, found, last, residual)


class Jacobi(Exchange):
    """Both sides step at once, with the values of the other at the beginning: the units lag a step behind the partner.

    Its only advantage is that both sides can run at the same time. It creates or loses energy in proportion to the
    step.
    """

    def __init__(self, force: Force = "end") -> None:
        self.force = force

    def evaluate(self, side: Side, partner: Taker, step: Step, last: Vector, expected: Vector) -> Outcome:
        begin = partner.displacement
        moved = partner.predict(last, step) - begin
        found = side.advance(begin, step, self.force)
        return Outcome(begin, found, last, float(abs(moved).max()))

    def commit(self, partner: Taker, step: Step, outcome: Outcome) -> None:
        partner.advance(outcome.partner_force, partner.predict(outcome.partner_force, step), step)


class Verlet(Exchange):
    """Velocity Verlet across the interface: half a kick by the present force, drift, the new force, half a kick.

    Second order with one evaluation for each step, as if one program computed both sides. Stable while the
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
    """Change of the partner's displacement by a change of the force; NaN if the partner cannot tell."""
    try:
        return partner.compliance(step) @ force
    except ValueError:
        return force * float("nan")
