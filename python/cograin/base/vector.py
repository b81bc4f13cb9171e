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

#: A matrix whose entries are scaled to a diagonal of 1 counts as singular in directions that it stretches by less.
SINGULAR = 1e-12


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


def root_of_inverse(matrix: Matrix) -> Matrix:
    """R, for which RᵀR is the inverse of a symmetric matrix without negative eigenvalues.

    Directions in which the matrix is singular are left out: R then has fewer rows than the matrix.
    """
    sizes = np.sqrt(np.abs(np.diag(matrix)))
    sizes = np.where(sizes > 0.0, sizes, 1.0)
    squares, shapes = np.linalg.eigh(0.5 * (matrix + matrix.T) / np.outer(sizes, sizes))
    kept = squares > SINGULAR * max(float(squares[-1]), 0.0)
    found: Matrix = (shapes[:, kept] / np.sqrt(squares[kept])).T / sizes
    return found


def closing(matrix: Matrix) -> Callable[[Vector], Vector]:
    """Solves with a matrix; where that is singular, for the part of the right side that can be reached."""
    sizes = np.sqrt(np.abs(np.diag(matrix)))
    sizes = np.where(sizes > 0.0, sizes, 1.0)
    scaled = matrix / np.outer(sizes, sizes)
    if len(matrix) == 1 and matrix[0, 0] != 0.0:
        return lambda right: vector(right / matrix[0, 0])
    stretches = np.linalg.svd(scaled, compute_uv=False)
    if stretches[-1] > SINGULAR * stretches[0]:
        return lambda right: vector(np.linalg.solve(matrix, right))
    inverse = np.linalg.pinv(scaled, rcond=SINGULAR) / np.outer(sizes, sizes)
    return lambda right: vector(inverse @ right)
