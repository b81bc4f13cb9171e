"""Cells of a grid of a unit, as arrays: a row for each cell in the order of the unit."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cograin.base.vector import Matrix, Vector

if TYPE_CHECKING:
    from cograin.units.unit import Unit


class Cells:
    """The cells of ``[grid.<name>]``: ``unit.cells("bed")``.

    ``centres`` (cells, 3) \\[m\\] and ``volumes`` \\[m³\\] are those of the cells, along x first, then y, then z.
    ``cells["velocity"]`` is the present field: an array (cells,) of a number, (cells, components) of a vector or a
    tensor. Inputs are set likewise.
    """

    def __init__(self, unit: Unit, grid: str) -> None:
        self.unit = unit
        self.grid = grid
        rows = _table(unit, grid)
        self.centres: Matrix = rows[:, 1:4]
        self.volumes: Vector = rows[:, 4]
        self._names: dict[str, tuple[str, ...]] = {}
        self._components: dict[str, list[str]] = {}
        first = f"{grid}.cell[1]."
        for name in unit.variables:
            if name.startswith(first):
                quantity, _, component = name.removeprefix(first).partition(".")
                self._components.setdefault(quantity, []).append(component)

    def __len__(self) -> int:
        return len(self.centres)

    def __repr__(self) -> str:
        return f"<{len(self)} cells of {self.grid}: {', '.join(self.quantities)}>"

    @property
    def quantities(self) -> tuple[str, ...]:
        """What the unit has of each cell."""
        return tuple(self._components)

    def components(self, quantity: str) -> tuple[str, ...]:
        """Names of the components of a quantity, in the order of the columns; one empty name of a number."""
        try:
            return tuple(self._components[quantity])
        except KeyError:
            raise KeyError(f"expected one of {', '.join(self.quantities)}, found {quantity}") from None

    def names(self, quantity: str) -> tuple[str, ...]:
        """Names of the variables of a quantity, cell after cell."""
        ends = [f"{quantity}.{own}".removesuffix(".") for own in self.components(quantity)]
        if quantity not in self._names:
            numbers = range(1, len(self) + 1)
            self._names[quantity] = tuple(f"{self.grid}.cell[{number}].{end}" for number in numbers for end in ends)
        return self._names[quantity]

    def __getitem__(self, quantity: str) -> NDArray[Any]:
        names, components = self.names(quantity), self.components(quantity)
        if self.unit.variable(names[0]).type == "Real":
            values: NDArray[Any] = self.unit.get(names)
        else:
            values = np.array([self.unit[name] for name in names])
        return values if components == ("",) else values.reshape(-1, len(components))

    def __setitem__(self, quantity: str, values: ArrayLike) -> None:
        names, components = self.names(quantity), self.components(quantity)
        given = np.asarray(values, dtype=float)
        shape = (len(self),) if components == ("",) else (len(self), len(components))
        if given.shape != shape:
            raise ValueError(f"{quantity}: expected an array of {shape}, a row for each cell, found {given.shape}")
        self.unit.set(names, given.ravel())


def _table(unit: Unit, grid: str) -> Matrix:
    """Numbers of the table of the cells in the resources of a unit."""
    from cograin.units.unit import UnitError

    path = unit.folder / "resources" / f"{grid}.cells.csv"
    if not path.is_file():
        known = sorted(path.name.removesuffix(".cells.csv") for path in path.parent.glob("*.cells.csv"))
        hint = f"; it has {', '.join(known)}" if known else "; it has none"
        raise UnitError(f"{unit.name}: expected a grid of the unit, found {grid}{hint}")
    with path.open(newline="") as text:
        return np.array(list(csv.reader(text))[1:], dtype=float)
