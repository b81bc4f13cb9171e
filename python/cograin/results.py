"""What a run leaves, as arrays: `Run` reads the folder of ``cograin run``, `read_frame` one frame.

>>> from cograin.results import unit_of
>>> unit_of("lid.mean_force.z"), unit_of("energy.lost.sliding"), unit_of("contacts.count")
('N', 'J', '1')
"""

from __future__ import annotations

import base64
import csv
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from cograin.extras import needed
from cograin.vector import Matrix, Vector

#: Units of the columns of a history or a record, by the first word of their names.
FIRST = {
    "time": "s",
    "time_step": "s",
    "length": "s",
    "residual": "m",
    "energy": "J",
    "interface_energy": "J",
    "exchanged_work": "J",
}
#: By the last of these words behind the name of a boundary, a region and so on.
UNITS = {
    "displacement": "m",
    "position": "m",
    "overlap": "m",
    "velocity": "m/s",
    "rotation": "rad",
    "angular_velocity": "rad/s",
    "force": "N",
    "mean_force": "N",
    "target_force": "N",
    "applied_force": "N",
    "servo_error": "N",
    "normal_force": "N",
    "force_slope": "N/s",
    "moment": "N.m",
    "mean_moment": "N.m",
    "applied_moment": "N.m",
    "torque": "N.m",
    "work": "J",
    "elastic_energy": "J",
    "dissipated_energy": "J",
    "mass": "kg",
    "mass_flow": "kg/s",
    "stress": "Pa",
    "mean_stress": "Pa",
    "conjugate_stress": "Pa",
    "target_stress": "Pa",
    "volume": "m3",
    "density": "kg/m3",
    "granular_temperature": "m2/s2",
    "temperature": "K",
    "heat_flow": "W",
    "mean_heat_flow": "W",
    "applied_heat": "W",
    "heat": "J",
    "stiffness": "N/m",
}
#: Those of the periodic cell, where its words mean something else.
CELL = {"stiffness": "Pa", "servo_error": "Pa"}


def unit_of(name: str) -> str:
    """The unit of a variable of a unit or a column of a history by its name; ``1`` for counts and ratios.

    Names of derived outputs and ``<insertion>.rate`` tell none: `Table.unit_of` knows those of a run or a record.
    """
    first, *words = name.split(".")
    units = {**UNITS, **CELL} if first == "cell" else UNITS
    return next((units[word] for word in reversed(words) if word in units), FIRST.get(first, "1"))


class ResultError(Exception):
    """A file that cannot be read, and why."""


class Table(Mapping[str, Vector]):
    """Columns of numbers by name, each with its unit: ``table["lid.force.z"]``, ``table.unit_of("lid.force.z")``."""

    def __init__(self, columns: Mapping[str, Any], units: Mapping[str, str] | None = None) -> None:
        self._columns = {name: np.asarray(values, dtype=float) for name, values in columns.items()}
        self._units = dict(units or {})

    def __getitem__(self, name: str) -> Vector:
        try:
            return self._columns[name]
        except KeyError:
            from difflib import get_close_matches

            near = get_close_matches(name, self._columns, n=1)
            hint = f"; the nearest is {near[0]}" if near else ""
            raise KeyError(f"expected a column of the table, found {name}{hint}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        names = [name if self.unit_of(name) == "1" else f"{name} [{self.unit_of(name)}]" for name in self]
        return f"<Table of {self.rows} rows: {_listed(names)}>"

    def _repr_html_(self) -> str:
        """The first and the last rows, as a notebook shows them."""
        shown = list(range(self.rows)) if self.rows <= 10 else [*range(5), *range(self.rows - 5, self.rows)]
        heads = [f"{name} [{self.unit_of(name)}]" if self.unit_of(name) != "1" else name for name in self]
        rows = [[f"{values[place]:.6g}" for values in self.values()] for place in shown]
        return _html(heads, rows, f"{self.rows} rows, {len(self)} columns")

    def unit_of(self, name: str) -> str:
        """The unit of a column: what the run or the record says, else what the name tells."""
        return self._units.get(name) or unit_of(name)

    @property
    def rows(self) -> int:
        """Number of its rows."""
        return len(next(iter(self._columns.values()), ()))

    def to_pandas(self) -> Any:
        """The table as a ``pandas.DataFrame`` over ``time``; ``frame.attrs["units"]`` has the units."""
        frame = needed("pandas", "tables").DataFrame(self._columns)
        frame.attrs["units"] = {name: self.unit_of(name) for name in self}
        return frame.set_index("time") if "time" in self else frame

    def to_xarray(self) -> Any:
        """The table as an ``xarray.Dataset`` over ``time``; each variable has its unit in ``attrs["units"]``."""
        xarray = needed("xarray", "tables")
        time = "time" if "time" in self else "row"
        variables = {
            name: (time, values, {"units": self.unit_of(name)}) for name, values in self.items() if name != time
        }
        at = self._columns.get("time", np.arange(self.rows, dtype=float))
        return xarray.Dataset(variables, coords={time: (time, at, {"units": self.unit_of(time)})})


def _html(heads: list[str], rows: list[list[str]], told: str) -> str:
    """A table of a page, and a line below it."""
    head = "".join(f"<th>{escape(name)}</th>" for name in heads)
    body = "".join("<tr>" + "".join(f"<td>{escape(word)}</td>" for word in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table><p>{escape(told)}</p>"


def _listed(names: list[str], most: int = 8) -> str:
    """Names in a row, the first of them where there are many."""
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def reason(error: Exception) -> str:
    """Why a file could not be read, without its name."""
    return (error.strerror or str(error)) if isinstance(error, OSError) else str(error)


def read_table(path: str | Path, units: Mapping[str, str] | None = None) -> Table:
    """Reads a CSV file of numbers: a history, or the record of a coupled run. Names tell units, ``units`` others."""
    path = Path(path)
    try:
        with path.open(newline="", encoding="utf-8") as text:
            lines = list(csv.reader(text))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ResultError(f"{path}: expected a table of numbers (CSV): {reason(error)}") from None
    if not lines or len(set(lines[0])) != len(lines[0]):
        raise ResultError(f"{path}: expected a heading with a name for each column, found {lines[:1]}")
    names, rows = lines[0], lines[1:]
    for number, row in enumerate(rows, 2):
        if len(row) != len(names):
            raise ResultError(f"{path}, line {number}: expected {len(names)} numbers, found {len(row)}")
    try:
        numbers = [[float(word) if word else np.nan for word in row] for row in rows]
    except ValueError as error:
        raise ResultError(f"{path}: expected numbers: {error}") from None
    values = np.array(numbers, dtype=float).reshape(len(rows), len(names))
    return Table({name: values[:, place] for place, name in enumerate(names)}, units)


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
        names = _listed([*self.fields, *self.cell_fields], most=20)
        return f"<Cloud of {len(self)} points, {len(self.cells)} cells: {names}>"


_TYPES = {"Float64": "f8", "Int64": "i8", "UInt64": "u8", "UInt8": "u1", "Float32": "f4", "Int32": "i4"}


def _array(element: ElementTree.Element) -> NDArray[Any]:
    """The numbers of a DataArray: their count in bytes, then they themselves, in base 64."""
    text = (element.text or "").strip()
    data = base64.b64decode(text) if text else b""
    values = np.frombuffer(data[8:], dtype="<" + _TYPES[element.get("type", "Float64")]).copy()
    components = int(element.get("NumberOfComponents", "1"))
    return values.reshape(-1, components) if components > 1 else values


def read_frame(path: str | Path) -> Cloud:
    """Reads a ``.vtu`` file as ``cograin`` writes them."""
    path = Path(path)
    try:
        piece = ElementTree.parse(path).find("./UnstructuredGrid/Piece")
        if piece is None:
            raise ResultError(f"{path}: expected an unstructured grid, found another file")
        found: dict[str, dict[str, NDArray[Any]]] = {
            group.tag: {array.get("Name", ""): _array(array) for array in group.iter("DataArray")} for group in piece
        }
    except (OSError, ElementTree.ParseError, ValueError, KeyError) as error:
        raise ResultError(f"{path}: expected a frame of cograin: {reason(error)}") from None
    points = next(iter(found.get("Points", {}).values()), np.empty((0, 3))).reshape(-1, 3)
    structure = found.get("Cells", {})
    corners = structure.get("connectivity", np.empty(0, dtype=int)).astype(np.int64)
    ends = structure.get("offsets", np.empty(0, dtype=int)).astype(np.int64)
    cells = [] if not len(points) else np.split(corners, ends[:-1])
    return Cloud(points, found.get("PointData", {}), list(cells), found.get("CellData", {}))


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
        return f"<Image of {' x '.join(map(str, self.counts))} cells: {_listed(list(self.fields), most=20)}>"

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
        fields = {name: _array(array) for name, array in arrays.items()}
    except (OSError, ElementTree.ParseError, ValueError, KeyError) as error:
        raise ResultError(f"{path}: expected a frame of cograin: {reason(error)}") from None
    counts = (ends[1] - ends[0], ends[3] - ends[2], ends[5] - ends[4])
    several = {name: range(values.shape[1]) for name, values in fields.items() if values.ndim > 1}
    names = {
        name: tuple(arrays[name].get(f"ComponentName{place}", "") for place in places)
        for name, places in several.items()
    }
    return Image(lower, edges, counts, fields, names)


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


class Run:
    """The results of ``cograin run`` in a folder: `history`, `summary`, `breakage`, `frames`."""

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        if not (self.folder / "history.csv").is_file():
            raise ResultError(f"{self.folder}: expected the results of a run, found no history.csv")

    def __repr__(self) -> str:
        return f"<Run in {self.folder}: .history, .summary, .frames, .breakage>"

    def _repr_html_(self) -> str:
        """Its history, as a notebook shows it."""
        return f"<p>{escape(repr(self))}</p>{self.history._repr_html_()}"

    @property
    def history(self) -> Table:
        """`history.csv`, with the units that `summary.json` has once the run has ended."""
        try:
            units = self.summary.get("units")
        except ResultError:
            units = None
        return read_table(self.folder / "history.csv", units)

    @property
    def summary(self) -> dict[str, Any]:
        """`summary.json`."""
        path = self.folder / "summary.json"
        try:
            read: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise ResultError(f"{path}: {reason(error)}") from None
        return read

    @property
    def breakage(self) -> list[dict[str, str]]:
        """`breakage.csv`: a row for each bond that broke; none without bonds."""
        path = self.folder / "breakage.csv"
        if not path.is_file():
            return []
        with path.open(newline="", encoding="utf-8") as text:
            return list(csv.DictReader(text))

    @property
    def frames(self) -> list[Frame]:
        """The frames, in their order; they are read when they are asked for."""
        path = self.folder / "particles.pvd"
        if not path.is_file():
            return []
        text = path.read_text(encoding="utf-8")
        found = re.findall(r'timestep="([^"]+)"[^>]*file="particles_(\d+)\.vtu"', text)
        return [Frame(self.folder, int(number), float(time)) for time, number in found]
