"""Tables: columns of numbers by name, each with its unit."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from cograin.base.extras import needed
from cograin.base.vector import Vector
from cograin.results.errors import ResultError, reason
from cograin.results.units import unit_of


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
        return f"<Table of {self.rows} rows: {listed(names)}>"

    def _repr_html_(self) -> str:
        """The first and the last rows, as a notebook shows them."""
        heads = [f"{name} [{self.unit_of(name)}]" if self.unit_of(name) != "1" else name for name in self]
        return html(heads, list(zip(*self.values(), strict=True)), f"{self.rows} rows, {len(self)} columns")

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


def html(heads: list[str], rows: list[tuple[Any, ...]], told: str) -> str:
    """A table of a page, its first and last rows where there are many, and a line below it."""
    shown = rows if len(rows) <= 10 else [*rows[:5], *rows[-5:]]
    written = [[f"{word:.6g}" if isinstance(word, float) else str(word) for word in row] for row in shown]
    head = "".join(f"<th>{escape(name)}</th>" for name in heads)
    body = "".join("<tr>" + "".join(f"<td>{escape(word)}</td>" for word in row) + "</tr>" for row in written)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table><p>{escape(told)}</p>"


def listed(names: list[str], most: int = 8) -> str:
    """Names in a row, the first of them where there are many."""
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


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


#: Last words of columns that count from the start of a run.
COUNTED = (
    "work",
    "heat",
    "heat_residual",
    "dissipated",
    "residual",
    "physical_residual",
    "broken",
    "removed",
    "count",
    "clumps",
    "wear",
)


def _counts(name: str, columns: Mapping[str, Vector]) -> bool:
    """Whether a column counts from the start of a run."""
    stem, _, last = name.rpartition(".")
    if last == "mass":  # of particles that came or went, not of those in a region
        return f"{stem}.count" in columns
    return name != "contacts.count" and (last in COUNTED or name.startswith("energy.lost."))


def _is_next(before: Vector, after: Vector) -> bool:
    """Whether a history begins with the row that follows another one: nearer than a row that is left out would be."""
    intervals = np.concatenate([np.diff(before), np.diff(after)])
    if not len(before) or not len(after) or not len(intervals):
        return False
    return bool(0.0 < after[0] - before[-1] < 1.5 * intervals.max())


def joined(*tables: Table) -> Table:
    """The histories of a run and of those that went on from it in other folders, one after the other.

    A later one counts from where it begins; of those before it, rows until then are kept. Works, heats, losses and
    counts, which begin anew with ``cograin run --from``, are carried on. ``cograin run --resume FILE`` begins nothing
    anew; its history begins with the next row. Columns are those that all have.
    """
    if not tables:
        raise ResultError("joined: expected histories, found none")
    names = [name for name in tables[0] if all(name in table for table in tables)]
    if "time" not in names:
        raise ResultError("joined: expected histories with a column time, found none")
    found = {name: tables[0][name] for name in names}
    for table in tables[1:]:
        begin = float(table["time"][0]) if table.rows else np.nan
        here = np.flatnonzero(found["time"] == begin)
        if _is_next(found["time"], table["time"]):
            found = {name: np.concatenate([found[name], table[name]]) for name in names}
            continue
        if not len(here):
            raise ResultError(
                f"joined: expected a history that begins at a time of the one before, up to {found['time'][-1]:g} s, "
                f"or with the row after it, found {begin:g} s"
            )
        place = int(here[-1])
        for name in names:
            more = table[name]
            if _counts(name, found):
                more = more + (found[name][place] - more[0])
            found[name] = np.concatenate([found[name][:place], more])
    return Table(found, {name: tables[0].unit_of(name) for name in names})
