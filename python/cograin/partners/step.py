"""A communication step and its outcome."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cograin.base.vector import Vector

#: Which force of a step is exchanged: its mean (impulse over length) or that at its end.
Force = Literal["mean", "end"]


@dataclass(frozen=True)
class Step:
    """One communication step. Begin and end are exact multiples of the shortest length in use, not sums."""

    begin: float  # [s]
    end: float  # [s]
    length: float  # [s]

    @property
    def middle(self) -> float:
        """Time half-way \\[s\\]."""
        return self.begin + 0.5 * self.length


@dataclass
class Outcome:
    """The outcome of one communication step, before the partner makes it."""

    displacement: Vector  # of the interface at the end, as the units have it [m or rad]
    force: Vector  # of the particles on the interface, of the exchange's kind [N or N m]
    partner_force: Vector  # what the partner takes in the mean of the step [N or N m]
    residual: float  # largest difference between the displacement that the partner would have and that of the units
    evaluations: int = 1  # of the units
    converged: bool = True
    reason: str = ""  # why it is not converged
    refusals: int = 0  # trials that a unit discarded
    jumps: bool = False  # whether the force jumps, so that no displacement makes both sides agree
    spread: float = 0.0  # of a step that is not converged: the residual over the farthest move in a step
    further_work: float = 0.0  # on the partner, beside that of its mean force along the displacement [J]
