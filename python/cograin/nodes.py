"""Nodes of a mesh of a unit, as arrays: a row for each node in the order of the unit, a column for each of x, y, z."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cograin.vector import Matrix

if TYPE_CHECKING:
    from cograin.unit import Unit


class Nodes:
    """The nodes of a boundary whose mesh has ``nodes = "driven"``: ``unit.nodes("sheet")``.

    ``places`` are the nodes at time 0 \\[m\\], ``triangles`` the nodes of each face, counted from 0. `displacement`
    \\[m\\] is set before a communication step and reached at its end; `force` and `mean_force` \\[N\\] are the parts of
    the nodes in the force of the particles on the boundary. All are arrays (nodes, 3).
    """

    def __init__(self, unit: Unit, boundary: str) -> None:
        self.unit = unit
        self.boundary = boundary
        rows = _table(unit, f"{boundary}.nodes.csv")
        self.places: Matrix = rows[:, 1:]
        self.triangles: NDArray[np.int64] = _table(unit, f"{boundary}.triangles.csv").astype(np.int64) - 1

    def __len__(self) -> int:
        return len(self.places)

    def names(self, quantity: str) -> tuple[str, ...]:
        """Names of the variables of a quantity, node after node: those of `displacement` couple an `Interface`."""
        numbers = range(1, len(self) + 1)
        return tuple(f"{self.boundary}.node[{number}].{quantity}.{axis}" for number in numbers for axis in "xyz")

    @property
    def displacement(self) -> Matrix:
        """Displacements given last \\[m\\]."""
        return self._get("displacement")

    @displacement.setter
    def displacement(self, values: ArrayLike) -> None:
        given = np.asarray(values, dtype=float)
        if given.shape != self.places.shape:
            raise ValueError(
                f"displacement: expected an array of {self.places.shape}, a row for each node, found {given.shape}"
            )
        self.unit.set(self.names("displacement"), given.ravel())

    @property
    def force(self) -> Matrix:
        """Forces of the particles at the present time \\[N\\]."""
        return self._get("force")

    @property
    def mean_force(self) -> Matrix:
        """Mean forces of the particles over the last communication step \\[N\\]."""
        return self._get("mean_force")

    def _get(self, quantity: str) -> Matrix:
        """Values of a quantity."""
        return self.unit.get(self.names(quantity)).reshape(-1, 3)


def _table(unit: Unit, name: str) -> Matrix:
    """Numbers of a table in the resources of a unit."""
    from cograin.unit import UnitError

    path = unit.folder / "resources" / name
    if not path.is_file():
        known = sorted(path.name.removesuffix(".nodes.csv") for path in path.parent.glob("*.nodes.csv"))
        hint = f"; {', '.join(known)} has nodes" if known else "; none of its boundaries has"
        raise UnitError(f"{unit.name}: {name.split('.')[0]} has no nodes that can be moved{hint}")
    with path.open(newline="") as text:
        return np.array(list(csv.reader(text))[1:], dtype=float)
