"""When both sides of an interface agree, in words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite

import numpy as np

from cograin.base.vector import Matrix, Vector, closing

#: What may be left of the farthest move, where nothing else is said.
RELATIVE = 1e-6


@dataclass(frozen=True)
class Tolerance:
    """How much may be left between both sides when a repeated step is accepted. All limits that are given must hold.

    ``displacement``: largest difference between the displacement of the partner under the force that the units found,
    and the displacement of the units \\[m, rad\\]. ``force``: the force that would close this difference, by the
    partner's compliance \\[N, N m\\]. ``energy``: the work of the units' force along it \\[J\\]. ``relative``: the
    difference of displacement over the farthest that the partner went in a step so far, or that the force of the
    particles alone moves it in one; 1e-6 where no limit is given. It holds for scenes of every size.
    """

    displacement: float | None = None
    force: float | None = None
    energy: float | None = None
    relative: float | None = None

    def __post_init__(self) -> None:
        given = [value for value in (self.displacement, self.force, self.energy, self.relative) if value is not None]
        if not all(isfinite(value) and value > 0.0 for value in given):
            raise ValueError(f"tolerance: expected numbers above 0, found {', '.join(f'{value:g}' for value in given)}")
        if not given:
            object.__setattr__(self, "relative", RELATIVE)

    def open(
        self, residual: Vector, force: Vector, compliance: Callable[[], Matrix], reach: Vector | None = None
    ) -> str:
        """Which limit does not hold yet, in words; empty if all hold. `compliance` is called only if it is needed.

        ``reach`` is what ``relative`` is a part of, in each direction \\[m, rad\\].
        """
        said = []
        left = float(np.abs(residual).max())
        if not isfinite(left):
            return "the residual is not finite"
        if self.displacement is not None and left > self.displacement:
            said.append(f"displacements differ by {left:.1e} m, {self.displacement:g} m is allowed")
        if self.relative is not None and reach is not None:
            over = np.abs(residual) - self.relative * reach
            worst = int(np.argmax(over))
            if over[worst] > 0.0:
                most = self.relative * float(reach[worst])
                said.append(f"displacements differ by {abs(float(residual[worst])):.1e} m, {most:.1e} m is allowed")
        if self.force is not None:
            most = float(np.abs(closing(compliance())(residual)).max())
            if most > self.force:
                said.append(f"forces differ by {most:.1e} N, {self.force:g} N is allowed")
        if self.energy is not None:
            between = abs(float(force @ residual))
            if between > self.energy:
                said.append(f"{between:.1e} J are between both sides, {self.energy:g} J are allowed")
        return "; ".join(said)
