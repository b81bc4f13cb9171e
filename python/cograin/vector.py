"""Types of the numbers that cross an interface."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
