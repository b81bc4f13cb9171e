"""The command line of the pictures: all that a run or a record allows, or what is named."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cograin.plot.sections import section
from cograin.plot.space import VIEWS, animation, cracks, force_chains, packing
from cograin.plot.tables import energy, history
from cograin.results import ResultError, Run, Table, read_table

#: Formats of pictures.
FORMATS = ("png", "svg", "pdf")


class _Folder:
    """The folder of the pictures, made with the first of them."""

    def __init__(self, path: Path, format: str) -> None:
        self.path, self.format = path, format
        self.made: list[Path] = []

    def file(self, name: str) -> Path:
        """The path of a file that is about to be written."""
        self.path.mkdir(parents=True, exist_ok=True)
        self.made.append(self.path / name)
        return self.made[-1]

    def keep(self, name: str, make: Any) -> None:
        """Draws a picture, where there is anything of its kind."""
        try:
            drawn = make()
        except ResultError:
            return
        drawn.savefig(self.file(f"{name}.{self.format}"), dpi=150)


def draw(
    source: str | Path,
    output: str | Path | None = None,
    *,
    by: str = "velocity",
    view: str = "y",
    columns: Sequence[str] | None = None,
    over: str = "time",
    time: float | None = None,
    at: float | None = None,
    names: Mapping[int, str] | None = None,
    format: str = "png",
) -> list[Path]:
    """Draws all that a run or a record allows, into a folder; returns the files.

    With ``columns`` only these, over time or ``over`` another column. ``time`` \\[s\\] chooses the nearest frame, and
    then no film is made; ``at``, ``names`` as in `packing`.
    """
    source = Path(source)
    run = Run(source) if source.is_dir() else None
    table = run.history if run else read_table(source)
    if format not in FORMATS:
        raise ResultError(f"format: expected one of {', '.join(FORMATS)}, found {format}")
    default = source / "pictures" if run else source.with_suffix("")
    folder = _Folder(Path(output) if output else default, format)
    if columns is not None or over != "time":
        return [_columns(table, columns, over, folder)]
    folder.keep("history", lambda: history(table))
    folder.keep("energy", lambda: energy(table))
    if run:
        if frames := run.frames:
            frame = frames[-1] if time is None else run.frame_at(time)
            several = {"set", "material"} & {
                name for name, values in frame.particles.fields.items() if len(np.unique(values)) > 1
            }
            for field in dict.fromkeys([by, "force", *sorted(several, reverse=True)[:1]]):
                drawn = packing(frame, field, view, at=at, names=names)
                drawn.savefig(folder.file(f"packing_{field}.{format}"), dpi=150)
            folder.keep("force_chains", lambda: force_chains(frame, view))
            for grid in frame.grids:
                for name in frame.grid(grid).fields:
                    if name != "count_by_set":
                        folder.keep(f"{grid}_{name}", lambda grid=grid, name=name: section(frame, grid, name, view))
        folder.keep("cracks", lambda: cracks(run, view))
        if len(frames) > 1 and time is None:
            animation(run, folder.file("animation.gif"), by, view, at=at, names=names)
    if not folder.made:
        raise ResultError(f"{source}: expected something that changes over time, found nothing to draw")
    return folder.made


def _columns(table: Table, columns: Sequence[str] | None, over: str, folder: _Folder) -> Path:
    """Draws the columns that are named."""
    drawn = history(table, columns, over)
    path = folder.file(f"history.{folder.format}" if over == "time" else f"over_{over}.{folder.format}")
    drawn.savefig(path, dpi=150)
    return path


def numbered(words: Sequence[str] | None) -> dict[int, str]:
    """Names in the order of their numbers."""
    return dict(enumerate(words or ()))


def main(words: Iterable[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m cograin.plot", description="Draws a run, or the record of a coupled run."
    )
    parser.add_argument("source", type=Path, metavar="OUT", help="folder of cograin run, or CSV file of a record")
    parser.add_argument("-o", "--output", type=Path, help="folder of the pictures; by default OUT/pictures")
    parser.add_argument("--columns", nargs="+", metavar="NAME", help="draw these columns alone")
    parser.add_argument("--over", default="time", metavar="NAME", help="column that they are drawn over (time)")
    parser.add_argument("--time", type=float, help="draw the frame that is nearest to this time [s] (the last)")
    parser.add_argument("--by", default="velocity", help="what colours the particles (velocity)")
    parser.add_argument("--names", nargs="+", metavar="NAME", help="names of sets or materials, in their order")
    parser.add_argument("--view", default="y", choices=sorted(VIEWS), help="axis along which they are seen (y)")
    parser.add_argument("--slice", type=float, metavar="PLACE", help="cut at this place of that axis [m], with walls")
    parser.add_argument("--format", default="png", choices=FORMATS, help="format of the pictures (png)")
    given = vars(parser.parse_args(None if words is None else list(words)))
    given["at"], given["names"] = given.pop("slice"), numbered(given["names"])
    try:
        for path in draw(given.pop("source"), given.pop("output"), **given):
            print(path)
    except ModuleNotFoundError as error:
        print(error, file=sys.stderr)
        return 1
    except (ResultError, KeyError, OSError) as error:
        print(error.args[0] if isinstance(error, KeyError) else error, file=sys.stderr)
        return 2
    return 0
