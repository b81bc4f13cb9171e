"""Nodes of a mesh of a unit, as arrays: a row for each node in the order of the unit, a column for each of x, y, z.

Temperatures and heat flows have a number for each node.
"""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cograin.base.vector import Matrix, Vector

if TYPE_CHECKING:
    from cograin.units.unit import Unit


#: Quantities of which a node has one number.
SCALARS = ("temperature", "heat_flow", "mean_heat_flow", "heat")


class Nodes:
    """The nodes of a boundary whose mesh has ``nodes = "driven"``: ``unit.nodes("sheet")``.

    ``places`` are the nodes at time 0 \\[m\\], ``triangles`` the nodes of each face, counted from 0. `displacement`
    \\[m\\] is set before a communication step and reached at its end; `force` and `mean_force` \\[N\\] are the parts of
    the nodes in the force of the particles on the boundary. All are arrays (nodes, 3). `temperature` \\[K\\] is set
    likewise where the boundary has driven ones; `heat_flow` and `mean_heat_flow` \\[W\\] are the heat flows of the
    particles into the nodes. They are arrays (nodes,).
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
        """Names of the variables of a quantity, node after node. Inputs among them couple an `Interface`."""
        lasts = [quantity] if quantity in SCALARS else [f"{quantity}.{axis}" for axis in "xyz"]
        return tuple(f"{self.boundary}.node[{number}].{last}" for number in range(1, len(self) + 1) for last in lasts)

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

    @property
    def temperature(self) -> Vector:
        """Temperatures given last \\[K\\]."""
        return self.unit.get(self.names("temperature"))

    @temperature.setter
    def temperature(self, values: ArrayLike) -> None:
        given = np.asarray(values, dtype=float)
        if given.shape not in ((), (len(self),)):
            raise ValueError(f"temperature: expected a number, or an array of ({len(self)},), found {given.shape}")
        self.unit.set(self.names("temperature"), np.broadcast_to(given, (len(self),)))

    @property
    def heat_flow(self) -> Vector:
        """Heat flows of the particles into the nodes at the present time \\[W\\]."""
        return self.unit.get(self.names("heat_flow"))

    @property
    def mean_heat_flow(self) -> Vector:
        """Mean heat flows of the particles into the nodes over the last communication step \\[W\\]."""
        return self.unit.get(self.names("mean_heat_flow"))

    @property
    def heat(self) -> Vector:
        """Heat of the particles into the nodes since the start \\[J\\]."""
        return self.unit.get(self.names("heat"))

    def _get(self, quantity: str) -> Matrix:
        """Values of a quantity."""
        return self.unit.get(self.names(quantity)).reshape(-1, 3)


def _table(unit: Unit, name: str) -> Matrix:
    """Numbers of a table in the resources of a unit."""
    from cograin.units.unit import UnitError

    path = unit.folder / "resources" / name
    if not path.is_file():
        known = sorted(path.name.removesuffix(".nodes.csv") for path in path.parent.glob("*.nodes.csv"))
        hint = f"; {', '.join(known)} has nodes" if known else "; none of its boundaries has"
        raise UnitError(f"{unit.name}: {name.split('.')[0]} has no nodes that can be moved{hint}")
    with path.open(newline="") as text:
        return np.array(list(csv.reader(text))[1:], dtype=float)
