"""A step of a linear structure along a parabola, under a force that is linear in time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import bmat
from scipy.sparse.linalg import splu

from cograin.base.vector import Matrix, Vector, solver
from cograin.partners.step import Step

if TYPE_CHECKING:
    from cograin.partners.structure import Structure


class QuadraticStep:
    """The continuous Galerkin method of degree 2 in time, for steps of one length \\[s\\].

    Positions and velocities are quadratic in the step; the equations of motion hold in their mean and in their first
    moment about the middle of the step. Only the mean f̄ and the slope s of the forces enter, the two numbers that a
    unit with ``input = "quadratic"`` gives. With the mean velocity V and the acceleration A of the positions:

        (C + K H/2) V + (M − K H²/12) A = f̄ − K x₀
        (M − K H²/12) V − (M H/2 + C H²/12) A = M v₀ − s H²/12

    and x₁ = x₀ + V H, v₁ = v₀ + A H. The method is of fourth order at the ends of the steps, and keeps energy but for
    the dashpots: the work of the forces is (f̄·V + s·A H²/12) H.
    """

    def __init__(self, structure: Structure, length: float) -> None:
        if structure.static:
            raise ValueError("quadratic motion needs a partner with mass or damping; this one is static")
        if structure.substeps != 1:
            raise ValueError(f"quadratic motion: expected 1 substep of the partner, found {structure.substeps}")
        self._structure = structure
        self._length = length
        mass, stiffness, damping = structure.mass, structure.stiffness, structure.damping
        across = mass - (length**2 / 12.0) * stiffness
        blocks = [
            [damping + (0.5 * length) * stiffness, across],
            [across, -(0.5 * length) * mass - (length**2 / 12.0) * damping],
        ]
        self._solve = _solver(blocks, sparse=not isinstance(mass, np.ndarray))
        self._response: Matrix | None = None

    def motion(self, mean: Vector, slope: Vector, position: Vector, velocity: Vector) -> tuple[Vector, Vector]:
        """Mean velocity \\[m/s\\] and acceleration \\[m/s²\\] under forces of this mean \\[N\\] and slope \\[N/s\\]."""
        structure = self._structure
        first = mean - structure.stiffness @ position
        second = structure.mass @ velocity - (self._length**2 / 12.0) * slope
        found = self._solve(np.concatenate([first, second]))
        return found[: len(position)], found[len(position) :]

    def loads(self, step: Step) -> tuple[Vector, Vector]:
        """Mean \\[N\\] and slope \\[N/s\\] of the structure's load in a step, from its values at two Gauss points."""
        apart = step.length / np.sqrt(12.0)
        early, late = (self._structure.loads(step.middle + side * apart) for side in (-1.0, 1.0))
        return 0.5 * (early + late), (late - early) / (2.0 * apart)

    def response(self) -> Matrix:
        """Change of the interface's motion (rows) with the forces on it (columns).

        Rows: displacements \\[m\\], then accelerations \\[m/s²\\]. Columns: mean forces \\[N\\], then slopes \\[N/s\\].
        """
        if self._response is None:
            at = self._structure.at
            nothing, columns = np.zeros(len(at)), []
            for part in (0, 1):
                for direction in at.T:
                    mean, slope = (direction, nothing) if part == 0 else (nothing, direction)
                    velocity, acceleration = self.motion(mean, slope, nothing, nothing)
                    columns.append(np.concatenate([at.T @ (self._length * velocity), at.T @ acceleration]))
            self._response = np.array(columns).T
        return self._response


def _solver(blocks: Any, *, sparse: bool) -> Any:
    """Solves with a matrix of four blocks."""
    singular = "quadratic motion: the structure has nothing that holds it, its matrix is singular"
    if sparse:
        try:
            return splu(bmat(blocks).tocsc()).solve
        except RuntimeError:
            raise ValueError(singular) from None
    solve = solver(np.block(blocks))
    if solve is None:
        raise ValueError(singular)
    return solve
