"""Types of the numbers that cross an interface."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import get_lapack_funcs, lu_factor

#: One number for each direction of an interface, or for each degree of freedom.
Vector = NDArray[np.float64]
#: Rows and columns of them.
Matrix = NDArray[np.float64]


def vector(values: ArrayLike) -> Vector:
    """A vector of its own; a number becomes one of length 1."""
    return np.atleast_1d(np.array(values, dtype=np.float64))


def is_sparse(matrix: Any) -> bool:
    """Whether this is a sparse matrix of scipy."""
    return hasattr(matrix, "tocsc")


def solver(matrix: Matrix) -> Callable[[Vector], Vector] | None:
    """Solves with a dense matrix, factorised once; ``None`` if it is singular.

    LAPACK is asked directly: what scipy looks at before takes ten times as long as a small matrix itself.
    """
    factors, pivots = lu_factor(matrix)
    if not np.all(np.abs(np.diag(factors)) > 0.0):
        return None
    (substitute,) = get_lapack_funcs(("getrs",), (factors,))

    def solve(forces: Vector) -> Vector:
        found: Vector = substitute(factors, pivots, forces)[0]
        return found

    return solve
