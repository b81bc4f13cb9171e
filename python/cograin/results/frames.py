"""Frames: what a run or a unit wrote at one time, as arrays."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from cograin.base.vector import Matrix
from cograin.results.arrays import array_of
from cograin.results.errors import ResultError, reason
from cograin.results.images import Image, read_image
from cograin.results.table import listed


@dataclass(repr=False)
class Cloud:
    """The points, lines or facets of one file of a frame."""

    points: NDArray[np.float64]  # a row each: x, y, z [m]
    fields: dict[str, NDArray[Any]]  # values at the points
    cells: list[NDArray[np.int64]] = field(default_factory=list)  # points of each line or facet
    cell_fields: dict[str, NDArray[Any]] = field(default_factory=dict)  # values of lines or facets

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name in self.fields:
            return self.fields[name]
        if name in self.cell_fields:
            return self.cell_fields[name]
        raise KeyError(f"expected one of {', '.join([*self.fields, *self.cell_fields])}, found {name}")

    def __repr__(self) -> str:
        names = listed([*self.fields, *self.cell_fields], most=20)
        return f"<Cloud of {len(self)} points, {len(self.cells)} cells: {names}>"


def read_frame(path: str | Path) -> Cloud:
    """Reads a ``.vtu`` file as ``cograin`` writes them."""
    path = Path(path)
    try:
        piece = ElementTree.parse(path).find("./UnstructuredGrid/Piece")
        if piece is None:
            raise ResultError(f"{path}: expected an unstructured grid, found another file")
        found: dict[str, dict[str, NDArray[Any]]] = {
            group.tag: {array.get("Name", ""): array_of(array) for array in group.iter("DataArray")} for group in piece
        }
    except (OSError, ElementTree.ParseError, ValueError, KeyError) as error:
        raise ResultError(f"{path}: expected a frame of cograin: {reason(error)}") from None
    points = next(iter(found.get("Points", {}).values()), np.empty((0, 3))).reshape(-1, 3)
    structure = found.get("Cells", {})
    corners = structure.get("connectivity", np.empty(0, dtype=int)).astype(np.int64)
    ends = structure.get("offsets", np.empty(0, dtype=int)).astype(np.int64)
    cells = [] if not len(points) else np.split(corners, ends[:-1])
    return Cloud(points, found.get("PointData", {}), list(cells), found.get("CellData", {}))


@dataclass
class Frame:
    """What a run wrote at one time. A kind of file that is not there is `None`."""

    folder: Path
    number: int
    time: float  # [s]

    def _read(self, kind: str) -> Cloud | None:
        path = self.folder / f"{kind}_{self.number:06}.vtu"
        return read_frame(path) if path.is_file() else None

    @property
    def particles(self) -> Cloud:
        """The particles, in the order of their ids."""
        return read_frame(self.folder / f"particles_{self.number:06}.vtu")

    @property
    def contacts(self) -> Cloud | None:
        """The contacts, a point each."""
        return self._read("contacts")

    @property
    def bonds(self) -> Cloud | None:
        """The living bonds, a line each."""
        return self._read("bonds")

    @property
    def boundaries(self) -> Cloud | None:
        """The surfaces, facet by facet."""
        return self._read("boundaries")

    def names(self, field: str) -> dict[int, str]:
        """Names of the numbers of a field: sets, materials, boundaries (``group``), which the end of a run tells."""
        return dict(enumerate(names_in(self.folder).get("boundary" if field == "group" else field, ())))

    @property
    def clumps(self) -> Cloud | None:
        """The clumps, a point each: mass centre, orientation, motion."""
        return self._read("clumps")

    @property
    def cell(self) -> Cloud | None:
        """The edges of the periodic cell, a line each."""
        return self._read("cell")

    def grid(self, name: str) -> Image:
        """The fields of ``[grid.<name>]``."""
        return read_image(self.folder / f"grid_{name}_{self.number:06}.vti")

    @property
    def grids(self) -> list[str]:
        """Names of the grids of the run."""
        return sorted(path.stem.removeprefix("grid_") for path in self.folder.glob("grid_*.pvd"))

    @property
    def edges(self) -> Matrix | None:
        """The three edges of the periodic cell, a row each \\[m\\]; 0 where nothing repeats."""
        cell = self.cell
        return None if cell is None or len(cell) < 6 else cell.points[1:6:2] - cell.points[0:6:2]


def names_in(folder: Path) -> dict[str, list[str]]:
    """Names of sets, materials and boundaries, of a run that has ended; none elsewhere."""
    try:
        told: dict[str, list[str]] = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["names"]
    except (OSError, ValueError, KeyError):
        return {}
    return told


def frames_in(folder: str | Path) -> list[Frame]:
    """The frames in a folder, as a run or a unit (``run.frames``) leaves them, in their order; none without any."""
    path = Path(folder) / "particles.pvd"
    if not path.is_file():
        return []
    text = path.read_text(encoding="utf-8")
    found = re.findall(r'timestep="([^"]+)"[^>]*file="particles_(\d+)\.vtu"', text)
    return [Frame(Path(folder), int(number), float(time)) for time, number in found]
