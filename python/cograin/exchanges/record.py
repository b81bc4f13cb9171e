"""The results of a coupled run, step by step."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from cograin.base.vector import Vector
from cograin.results import Table

#: Columns of every record, before displacements, forces and what is watched.
COLUMNS = ("time", "length", "evaluations", "residual", "converged", "refusals", "interface_energy", "exchanged_work")

#: Energy that an exchange makes or loses, over what is exchanged, from which on the record remarks it.
REMARKED = 0.02


@dataclass
class Row:
    """One communication step."""

    time: float  # at its end [s]
    length: float  # [s]
    evaluations: int  # of the units, those of refused attempts included
    residual: float  # between both sides [m, rad]
    converged: bool
    refusals: int  # attempts that a unit discarded or the control rejected
    interface_energy: float  # work on the units + work on the partner: what the exchange made or lost [J]
    exchanged_work: float  # size of the work on the partner [J]
    displacement: Vector  # of the interface, as the units have it [m, rad]
    force: Vector  # of the kind that is exchanged [N, N m]
    watched: tuple[float, ...]
    reason: str = ""  # why it is not converged

    @property
    def values(self) -> list[float]:
        """In the order of the record's names."""
        own: list[float] = [self.time, self.length, self.evaluations, self.residual, int(self.converged), self.refusals]
        return [*own, self.interface_energy, self.exchanged_work, *self.displacement, *self.force, *self.watched]


class Record:
    """The rows of a coupled run, by name: ``record["time"]``, ``record["floor.displacement.z"]``."""

    def __init__(
        self,
        displacements: Sequence[str],
        forces: Sequence[str],
        watched: Sequence[str] = (),
        units: Mapping[str, str] | None = None,
    ) -> None:
        self.names = [*COLUMNS, *displacements, *forces, *watched]
        self._units = units
        self._directions = len(displacements)
        self.rows: list[Row] = []

    def __getitem__(self, name: str) -> Vector:
        try:
            place = self.names.index(name)
        except ValueError:
            raise KeyError(f"{name}; the record has {', '.join(self.names)}") from None
        return np.array([row.values[place] for row in self.rows])

    def __len__(self) -> int:
        return len(self.rows)

    def __repr__(self) -> str:
        last = f" to {self.rows[-1].time:g} s" if self.rows else ""
        return f"<Record of {len(self)} steps{last}: {', '.join(self.names[len(COLUMNS) :][:8])}>"

    def settings(self) -> dict[str, Any]:
        """Its columns."""
        return {"names": self.names}

    def _repr_html_(self) -> str:
        """Its table and summary, as a notebook shows them."""
        return f"{self.table._repr_html_()}<pre>{escape(self.summary)}</pre>"

    def memory(self) -> Any:
        """All rows: their numbers, and why some did not converge."""
        numbers = np.array([row.values for row in self.rows]).reshape(-1, len(self.names))
        return numbers, {place: row.reason for place, row in enumerate(self.rows) if row.reason}

    def recall(self, memory: Any) -> None:
        """Restores these rows."""
        numbers, reasons = memory
        ends = np.cumsum([len(COLUMNS), self._directions, self._directions])
        self.rows = []
        for place, values in enumerate(numbers):
            own, moved, force, watched = np.split(values, ends)
            time, length, evaluations, residual, converged, refusals, energy, work = own.tolist()
            counted = time, length, int(evaluations), residual, bool(converged), int(refusals), energy, work
            self.rows.append(Row(*counted, moved, force, tuple(watched.tolist()), reasons.get(place, "")))

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    @property
    def interface_energy(self) -> float:
        """Energy that the exchange has created (above 0) or lost so far \\[J\\]."""
        return float(sum(row.interface_energy for row in self.rows))

    @property
    def exchanged_work(self) -> float:
        """Sum of the sizes of the work of all steps \\[J\\]."""
        return float(sum(row.exchanged_work for row in self.rows))

    @property
    def unconverged(self) -> list[Row]:
        """Steps that were accepted although both sides did not agree."""
        return [row for row in self.rows if not row.converged]

    @property
    def remark(self) -> str:
        """That the exchange made or lost so much energy that the motion is not to be trusted; else empty."""
        made, exchanged = self.interface_energy, self.exchanged_work
        if abs(made) <= REMARKED * exchanged:
            return ""
        share = abs(made) / exchanged if exchanged else float("inf")
        told = (
            f"{'made' if made > 0.0 else 'lost'} {abs(made):.2e} J, {100.0 * share:.2g} % of what both sides exchanged"
        )
        return f"the exchange {told}: do not trust the motion; take a shorter step, or an exchange that is repeated"

    @property
    def summary(self) -> str:
        """A few lines for the end of a run."""
        if not self.rows:
            return "no step was made"
        evaluations = np.array([row.evaluations for row in self.rows])
        share = self.interface_energy / self.exchanged_work if self.exchanged_work else 0.0
        energy = f"{self.interface_energy:+.2e} J, {share:+.1e} of the {self.exchanged_work:.4g} J exchanged"
        lines = [
            f"{len(self.rows)} steps to {self.rows[-1].time:g} s, {evaluations.mean():.2f} evaluations a step "
            f"(median {np.median(evaluations):g}, at most {evaluations.max()}), "
            f"{sum(row.refusals for row in self.rows)} refused",
            f"interface energy {energy}",
        ]
        if self.unconverged:
            worst = max(self.unconverged, key=lambda row: row.residual)
            lines.append(f"{len(self.unconverged)} steps did not converge; worst at {worst.time:g} s: {worst.reason}")
        return "\n".join([*lines, self.remark] if self.remark else lines)

    @property
    def table(self) -> Table:
        """The columns by name with their units, and as tables of pandas and xarray: ``record.table.to_pandas()``."""
        return Table({name: self[name] for name in self.names}, self._units)

    def save(self, path: str | Path) -> None:
        """Writes a CSV file, a row for each step."""
        with Path(path).open("w", newline="") as text:
            writer = csv.writer(text)
            writer.writerow(self.names)
            writer.writerows(row.values for row in self.rows)
