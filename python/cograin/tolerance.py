"""When both sides of an interface agree, in words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite

import numpy as np

from cograin.vector import Matrix, Vector


@dataclass(frozen=True)
class Tolerance:
    """How much may be left between both sides when a repeated step is accepted. All limits that are given must hold.

    ``displacement``: largest difference between the displacement of the partner under the force that the units found,
    and the displacement of the units \\[m, rad\\]. ``force``: the force that would close this difference, by the
    partner's compliance \\[N, N m\\]. ``energy``: the work of the units' force along it \\[J\\].
    """

    displacement: float | None = 1e-9
    force: float | None = None
    energy: float | None = None

    def __post_init__(self) -> None:
        given = [value for value in (self.displacement, self.force, self.energy) if value is not None]
        if not given or not all(value > 0.0 for value in given):
            raise ValueError("a tolerance of displacement, force or energy above 0 is needed")

    def open(self, residual: Vector, force: Vector, compliance: Callable[[], Matrix]) -> str:
        """Which limit does not hold yet, in words; empty if all hold. `compliance` is called only if it is needed."""
        said = []
        left = float(np.abs(residual).max())
        if not isfinite(left):
            return "the residual is not finite"
        if self.displacement is not None and left > self.displacement:
            said.append(f"displacements differ by {left:.1e} m, {self.displacement:g} m is allowed")
        if self.force is not None:
            closing = float(np.abs(np.linalg.solve(compliance(), residual)).max())
            if closing > self.force:
                said.append(f"forces differ by {closing:.1e} N, {self.force:g} N is allowed")
        if self.energy is not None:
            between = abs(float(force @ residual))
            if between > self.energy:
                said.append(f"{between:.1e} J are between both sides, {self.energy:g} J are allowed")
        return "; ".join(said)
