"""The folder of ``cograin run``."""

from __future__ import annotations

import csv
import json
from html import escape
from pathlib import Path
from typing import Any

from cograin.results.errors import ResultError, reason
from cograin.results.frames import Frame, frames_in
from cograin.results.table import Table, read_table


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
        return frames_in(self.folder)

    def frame_at(self, time: float) -> Frame:
        """The frame that is nearest to a time \\[s\\]."""
        frames = self.frames
        if not frames:
            raise ResultError(f"{self.folder}: expected frames; [output] frame_interval writes them")
        return min(frames, key=lambda frame: abs(frame.time - time))
