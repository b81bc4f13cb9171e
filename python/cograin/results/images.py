"""Frames of grids, as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from cograin.base.vector import Matrix, Vector
from cograin.results.arrays import array_of
from cograin.results.errors import ResultError, reason
from cograin.results.table import listed


@dataclass(repr=False)
class Image:
    """The fields of a grid at one time: numbers of its cells, along x first, then y, then z."""

    lower: Vector  # corner of the box [m]
    edges: Vector  # of a cell [m]
    counts: tuple[int, int, int]  # cells along each axis
    fields: dict[str, NDArray[Any]]  # (cells,) or (cells, components)
    components: dict[str, tuple[str, ...]]  # names of those, where there are several

    def __len__(self) -> int:
        return int(np.prod(self.counts))

    def __getitem__(self, name: str) -> NDArray[Any]:
        try:
            return self.fields[name]
        except KeyError:
            raise KeyError(f"expected one of {', '.join(self.fields)}, found {name}") from None

    def __repr__(self) -> str:
        return f"<Image of {' x '.join(map(str, self.counts))} cells: {listed(list(self.fields), most=20)}>"

    @property
    def centres(self) -> Matrix:
        """Centres of the cells, a row each \\[m\\]."""
        k, j, i = np.unravel_index(np.arange(len(self)), self.counts[::-1])
        return self.lower + (np.stack([i, j, k], axis=1) + 0.5) * self.edges

    def box(self, name: str) -> NDArray[Any]:
        """A field as an array [x, y, z] or [x, y, z, component]."""
        values = self[name]
        return values.reshape(*self.counts[::-1], *values.shape[1:]).swapaxes(0, 2)


def read_image(path: str | Path) -> Image:
    """Reads a ``.vti`` file as ``cograin`` writes them."""
    path = Path(path)
    try:
        image = ElementTree.parse(path).find("./ImageData")
        data = None if image is None else image.find("./Piece/CellData")
        if image is None or data is None:
            raise ResultError(f"{path}: expected image data with values of cells, found another file")
        lower, edges = (np.array(image.attrib[key].split(), dtype=float) for key in ("Origin", "Spacing"))
        ends = [int(word) for word in image.attrib["WholeExtent"].split()]
        arrays = {array.get("Name", ""): array for array in data.iter("DataArray")}
        fields = {name: array_of(array) for name, array in arrays.items()}
    except (OSError, ElementTree.ParseError, ValueError, KeyError) as error:
        raise ResultError(f"{path}: expected a frame of cograin: {reason(error)}") from None
    counts = (ends[1] - ends[0], ends[3] - ends[2], ends[5] - ends[4])
    several = {name: range(values.shape[1]) for name, values in fields.items() if values.ndim > 1}
    names = {
        name: tuple(arrays[name].get(f"ComponentName{place}", "") for place in places)
        for name, places in several.items()
    }
    return Image(lower, edges, counts, fields, names)
