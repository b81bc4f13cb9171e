"""Studies: a table of values becomes runs on all cores, or on a cluster, and their results become one table.

A row of the table has a value for each of some keys. `SceneRun` runs a scene with these values as ``--set`` takes
them; `UnitRun` steps a unit with them as its parameters and inputs; any other function of a row serves, too, if
processes can be given it (defined in a module, no lambda). What it returns, a mapping of names to numbers, is the
result.

    from cograin.study import SceneRun, Study
    rows = [{"pair.glass.glass.friction": mu} for mu in (0.1, 0.3, 0.5)]
    table = Study(rows, SceneRun("heap.toml"), "study").run()

Or ``python -m cograin.study TABLE.csv SCENE -o DIR``. Each result is on the disk when it is known: a study that is
broken off continues where it was, and a run that fails is a row with its message.

A kept result counts as long as what made it is the same by content: the row, the scene or unit with every file that
it names, options, the program, the function. What has changed is computed anew, and told; earlier results stay on the
disk. Of a function of one's own code and values count, not the files that it reads: a class with ``__call__(row)`` and
``identity(row)`` tells those.
"""

from __future__ import annotations

import argparse
import csv
import json
import logging
import os
import re
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import Any

from cograin.base.extras import needed
from cograin.base.identity import Identity, differing, identity, of_file, of_program, of_scene, of_words
from cograin.base.program import Program, ProgramError
from cograin.results import ResultError, Run
from cograin.results.errors import reason
from cograin.results.table import html

#: A number or a text of a table.
Value = float | int | bool | str
Row = dict[str, Value]
#: What is done with a row.
Work = Callable[[Row], Mapping[str, Value]]

#: How often a run is tried whose process dies.
TRIES = 3

#: What makes a result and stands outside of Python, by the last part of its name.
OUTSIDE = re.compile(r"(^|\.)(scene|unit|program|file [^\n]*)$")

_log = logging.getLogger("cograin")


class StudyError(Exception):
    """A table or a folder that a study cannot work with, and why."""


class Changed(StudyError):
    """What makes the results has changed while a study ran, or is another one where a run was made."""


def grid(**values: Sequence[Value]) -> list[Row]:
    """Every combination of these values: ``grid(**{"run.seed": [1, 2], "pair.a.a.friction": [0.1, 0.2]})``.

    >>> len(grid(**{"run.seed": [1, 2], "pair.a.a.friction": [0.1, 0.2, 0.3]}))
    6
    """
    return [dict(zip(values, row, strict=True)) for row in product(*values.values())]


def read_rows(path: str | Path) -> list[Row]:
    """Reads a table of values: CSV with the keys in its heading."""
    path = Path(path)
    try:
        with path.open(newline="", encoding="utf-8-sig") as text:
            lines = [line for line in csv.reader(text, strict=True) if line]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise StudyError(f"{path}: expected a table of values (CSV): {reason(error)}") from None
    if not lines:
        raise StudyError(f"{path}: expected a heading with keys, found no line")
    keys = [key.strip() for key in lines[0]]
    for number, line in enumerate(lines[1:], 2):
        if len(line) != len(keys):
            raise StudyError(f"{path}, row {number}: expected {len(keys)} values, found {len(line)}")
    return checked([dict(zip(keys, map(_value, line), strict=True)) for line in lines[1:]], keys, str(path))


def _value(word: str) -> Value:
    """The number that a word is, or the word."""
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            continue
    return word.strip()


def checked(rows: Any, keys: Sequence[str] | None = None, name: str = "table") -> list[Row]:
    """The rows of a table: a list of mappings, a mapping of columns, or a table of pandas."""
    if hasattr(rows, "to_dict"):
        rows = rows.to_dict("records")
    elif isinstance(rows, Mapping):
        for key, values in rows.items():
            single = isinstance(values, str | bytes | Mapping) or getattr(values, "ndim", 1) == 0
            if single or not hasattr(values, "__len__"):
                raise StudyError(f"{name}, {key}: expected a column of values, found {values!r}")
        columns = {key: list(values) for key, values in rows.items()}
        lengths = sorted({len(values) for values in columns.values()})
        if len(lengths) > 1:
            raise StudyError(f"{name}: expected columns of one length, found {' and '.join(map(str, lengths))}")
        rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    elif isinstance(rows, str | bytes) or not isinstance(rows, Iterable):
        raise StudyError(f"{name}: expected rows or columns of values, found {rows!r}")
    found: list[Row] = []
    for number, row in enumerate(rows, 1):
        if not isinstance(row, Mapping):
            raise StudyError(f"{name}, row {number}: expected values by their keys, found {row!r}")
        values = {str(key): _plain(value, f"{name}, row {number}, {key}") for key, value in row.items()}
        if found and values.keys() != found[0].keys():
            raise StudyError(
                f"{name}, row {number}: expected the keys {', '.join(found[0])}, found {', '.join(values)}"
            )
        found.append(values)
    keys = list(found[0]) if keys is None and found else list(keys or [])
    for key in keys:
        if not key or any(letter in key for letter in "=\n\r\0") or not _encodes(key):
            raise StudyError(f"{name}: expected a key such as run.seed in the heading, found {key!r}")
        if keys.count(key) > 1:
            raise StudyError(f"{name}: expected each key once, found {key} twice")
    if not found:
        raise StudyError(f"{name}: expected at least one row, found none")
    return found


def _plain(value: Any, where: str) -> Value:
    """A number or text of Python, of what numpy and pandas have."""
    if hasattr(value, "item") and getattr(value, "ndim", 0) == 0:
        value = value.item()
    if isinstance(value, str):
        if not value.strip() or "\0" in value or not _encodes(value):
            raise StudyError(f"{where}: expected a value, found {value!r}")
        return value
    if isinstance(value, bool | int):
        return value
    if isinstance(value, float) and value == value and abs(value) != float("inf"):
        return value
    raise StudyError(f"{where}: expected a finite number or a text, found {value!r}")


def _encodes(text: str) -> bool:
    """Whether a text can be written: not every text of Python is one of Unicode."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _written(value: Value) -> str:
    """A value as a scene has it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return value if isinstance(value, str) else repr(value)


def last_row(run: Run) -> dict[str, Value]:
    """The outputs at the end of a run."""
    return {name: float(values[-1]) for name, values in run.history.items() if len(values)}


@dataclass
class SceneRun:
    """Runs a scene in a folder of its own. ``read`` makes the result of a `Run`; by default the outputs at its end.

    ``options`` are further words for ``cograin run``. Without ``keep`` the files of a run are deleted once it was read.
    """

    scene: str | Path
    read: Callable[[Run], Mapping[str, Value]] = last_row
    program: str | Path | None = None
    options: Sequence[str] = ()
    keep: bool = False

    @property
    def _command(self) -> Program:
        return Program() if self.program is None else Program(self.program)

    def identity(self, row: Row) -> Identity:
        """What makes its result: scene and files, options, program, ``read``."""
        folders = [Path(self.scene).parent, Path()]
        return {
            **of_scene(self.scene),
            **of_words([*map(str, self.options), *_texts(row)], folders),
            "options": str(list(map(str, self.options))),
            "program": of_program(self._command.command),
            **identity(self.read, "read"),
            "keep": self.keep,
        }

    def __call__(self, row: Row) -> Mapping[str, Value]:
        """Runs it with the values of a row."""
        import shutil
        import tempfile

        # Progress would stand in the message of a run that fails.
        quiet = [] if {"-q", "--quiet"} & set(map(str, self.options)) else ["--quiet"]
        settings = [word for key, value in row.items() for word in ("--set", f"{key}={_written(value)}")]
        folder = Path(tempfile.mkdtemp(prefix="cograin-study-"))
        try:
            self._command("run", self.scene, *settings, "--threads", "1", "-o", folder / "run", *quiet, *self.options)
            found = dict(self.read(Run(folder / "run")))
            return {**found, "folder": str(folder / "run")} if self.keep else found
        finally:
            if not self.keep:
                shutil.rmtree(folder, ignore_errors=True)


@dataclass
class UnitRun:
    """Steps a unit with the values of a row as its parameters and inputs; the result is its outputs at the end."""

    unit: str | Path
    step: float  # communication step [s]
    end: float  # [s]
    outputs: Sequence[str] | None = None

    def identity(self, row: Row) -> Identity:
        """What makes its result: the unit, the steps, the outputs."""
        steps = {"unit": of_file(self.unit), "step": self.step, "end": self.end}
        return {**steps, "outputs": str(None if self.outputs is None else list(self.outputs))}

    def __call__(self, row: Row) -> Mapping[str, Value]:
        """Steps it with the values of a row."""
        from cograin.units.unit import Unit

        with Unit(self.unit, parameters={"run.threads": 1}) as plain:
            parameters = set(plain.names("parameter"))
            inputs = {key: value for key, value in row.items() if key not in parameters}
            given = {key: value for key, value in row.items() if key in parameters}
            plain.reset(parameters={"run.threads": 1, **given}, inputs=inputs)
            for _ in range(round(self.end / self.step)):
                for key, value in inputs.items():
                    plain[key] = value
                plain.step(self.step)
            return {name: plain[name] for name in self.outputs or plain.names("output") if ".node[" not in name}


@dataclass
class Result:
    """What became of a row."""

    row: Row
    values: dict[str, Value] = field(default_factory=dict)
    error: str = ""  # why there are no values
    seconds: float = 0.0  # that it took
    made: Identity = field(default_factory=dict)  # what made it

    @property
    def failed(self) -> bool:
        """Whether there are no values."""
        return bool(self.error)


def _made(work: Work, row: Row) -> Identity:
    """What makes the result of a row."""
    own = getattr(work, "identity", None)
    return own(row) if callable(own) else identity(work, "work")


def _texts(row: Row) -> list[str]:
    """The values of a row that are texts."""
    return [value for value in row.values() if isinstance(value, str)]


def _unchanged(work: Work, row: Row, made: Identity) -> None:
    """Refuses files, programs and code that are not those with which the study began."""
    now = _made(work, row)
    # Other values of Python may rightly differ between processes, such as those that a script has made meanwhile.
    names = [name for name in {**made, **now} if name == "work" or OUTSIDE.search(name)]
    there, here = ({name: each.get(name) for name in names} for each in (made, now))
    if other := differing(there, here):
        raise Changed(f"study: expected what it began with, found another: {', '.join(other)}; run it again")


def _attempt(work: Work, row: Row, made: Identity) -> tuple[dict[str, Value], str, float]:
    """Values, or the reason why there are none, and the time that it took; what a process does."""
    _unchanged(work, row, made)
    values, error, seconds = _tried(work, row)
    _unchanged(work, row, made)
    return values, error, seconds


def _tried(work: Work, row: Row) -> tuple[dict[str, Value], str, float]:
    """Values, or the reason why there are none, and the time that it took."""
    began = time.monotonic()
    try:
        values = {str(key): _plain(value, str(key)) for key, value in work(row).items()}
        return values, "", time.monotonic() - began
    except (ProgramError, ResultError, StudyError) as error:
        return {}, str(error), time.monotonic() - began
    except Exception as error:  # a run that fails is a row of the table, whatever failed
        return {}, f"{type(error).__name__}: {error}", time.monotonic() - began


class Study:
    """A table of values, what is done with each row, and a folder in which the results are kept."""

    def __init__(self, table: Any, work: Work, folder: str | Path) -> None:
        self.rows = read_rows(table) if isinstance(table, str | Path) else checked(table)
        self.work = work
        self.folder = Path(folder)
        self.kept = self.folder / "results.jsonl"
        self.results: dict[str, Result] = {}
        self._whole = 0  # length of the whole lines of the file
        self.table = self.folder / "results.csv"
        if self.table.exists() and not self.kept.is_file():
            raise StudyError(f"{self.table}: expected a folder without it, or one of a study; take another folder")
        self._read()

    def _read(self) -> None:
        """Takes over what an earlier study with this folder found. A last line that was cut off does not count."""
        self._made = {_key(row): _made(self.work, row) for row in self.rows}
        self.results, self._whole = {}, 0
        other: dict[str, Identity] = {}  # what made earlier results of these rows
        if self.kept.is_file():
            for result in self._lines():
                key = _key(result.row)
                if key in self._made and not differing(self._made[key], result.made):
                    self.results[key] = result
                elif key in self._made:
                    other[key] = result.made
        left = [key for key in other if key not in self.results]
        if left:
            differs = ", ".join(differing(self._made[left[0]], other[left[0]])[:5])
            _log.warning("%s: %d results were made otherwise and are computed anew: %s", self.kept, len(left), differs)

    def _lines(self) -> Iterator[Result]:
        """The results in the file, whatever made them."""
        lines = self.kept.read_bytes().splitlines(keepends=True)
        for number, line in enumerate(lines, 1):
            try:
                read = json.loads(line)
                known = dict(read["row"]), dict(read["values"]), str(read["error"]), float(read["seconds"])
                result = Result(*known, dict(read.get("made", {})))
            except (ValueError, KeyError, TypeError):
                if number < len(lines) or line.endswith(b"\n"):
                    raise StudyError(
                        f"{self.kept}, line {number}: expected a result of a study, found another text"
                    ) from None
                continue
            if line.endswith(b"\n"):
                self._whole += len(line)
                yield result

    def _keep(self, result: Result) -> None:
        """Writes a result down, behind the last whole line."""
        result.made = self._made[_key(result.row)]
        self.results[_key(result.row)] = result
        data = (json.dumps(vars(result)) + "\n").encode()
        self.kept.touch()
        with self.kept.open("r+b") as file:
            file.truncate(self._whole)
            file.seek(self._whole)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        self._whole += len(data)

    def run(
        self, *, workers: int | None = None, client: Any = None, retry: bool = False, shown: bool | None = None
    ) -> list[Result]:
        """Runs what is not done yet, and writes ``results.csv``; returns the results in the order of the table.

        ``workers`` processes work on this machine, by default one for each core; a ``client`` of ``dask.distributed``
        sends the runs to its cluster instead. ``retry`` does those that failed once more.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        if any(differing(self._made[_key(row)], _made(self.work, row)) for row in self.rows):
            self._read()
        left = list({_key(row): row for row in self.rows if self._is_open(row, retry)}.values())
        progress = _Progress(len(self.rows), len(self.rows) - len(left), shown)
        if client is not None:
            done = _on_cluster(client, self.work, left, self._made)
        else:
            done = _on_cores(self.work, left, self._made, workers or os.cpu_count() or 1)
        for result in done:
            self._keep(result)
            progress.add(result)
        self.save(self.table)
        return [self.results[_key(row)] for row in self.rows]

    def _is_open(self, row: Row, retry: bool) -> bool:
        """Whether a row is still to be done."""
        found = self.results.get(_key(row))
        return found is None or (retry and found.failed)

    @property
    def columns(self) -> dict[str, list[Any]]:
        """Values, results, error and seconds of every row that is done, by columns."""
        done = [self.results[_key(row)] for row in self.rows if _key(row) in self.results]
        columns: dict[str, list[Any]] = {}
        own = ("error", "seconds")
        for key in self.rows[0]:
            columns[_free(key, "row", own)] = [result.row[key] for result in done]
        # An output may have the name of a key, or of a column of the study itself.
        for name in dict.fromkeys(name for result in done for name in result.values):
            columns[_free(name, "result", [*columns, *own])] = [result.values.get(name) for result in done]
        columns["error"] = [result.error for result in done]
        columns["seconds"] = [result.seconds for result in done]
        return columns

    def __repr__(self) -> str:
        done = sum(_key(row) in self.results for row in self.rows)
        return f"<Study of {len(self.rows)} rows in {self.folder}, {done} done>"

    def _repr_html_(self) -> str:
        """The first and the last rows that are done, as a notebook shows them."""
        columns = self.columns
        return html(list(columns), list(zip(*columns.values(), strict=True)), repr(self))

    def to_pandas(self) -> Any:
        """The table as a ``pandas.DataFrame``."""
        return needed("pandas", "study").DataFrame(self.columns)

    def save(self, path: str | Path) -> None:
        """Writes the table, whole or not at all: Parquet if the name ends so (by pandas and pyarrow), else CSV."""
        path = Path(path)
        part = path.with_name(f".{path.name}.part")
        if path.suffix == ".parquet":
            needed("pyarrow", "study")
            self.to_pandas().to_parquet(part)
        else:
            columns = self.columns
            with part.open("w", newline="", encoding="utf-8") as text:
                writer = csv.writer(text)
                writer.writerow(columns)
                rows = zip(*columns.values(), strict=True)
                writer.writerows(["" if value is None else value for value in row] for row in rows)
        part.replace(path)


def _free(name: str, prefix: str, taken: Iterable[str]) -> str:
    """The name of a column, with a prefix where another column has it."""
    while name in taken:
        name = f"{prefix}.{name}"
    return name


def _key(row: Row) -> str:
    """What tells rows apart."""
    return json.dumps(row, sort_keys=True)


def _end_when_told() -> None:
    """Lets SIGTERM end this process, as its pool expects. A notebook or a cluster may have left another handler."""
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _on_cores(work: Work, rows: list[Row], made: Mapping[str, Identity], workers: int) -> Iterator[Result]:
    """Results of rows, as they come, of processes on this machine. One that dies takes its own run with it alone."""
    tries = dict.fromkeys(map(_key, rows), 0)
    ahead = list(reversed(rows))
    while ahead:
        running: dict[Future[Any], Row] = {}
        with ProcessPoolExecutor(min(workers, len(ahead)), initializer=_end_when_told) as pool:
            try:
                while ahead or running:
                    # No more than work at once: what dies with a process is what was running.
                    while ahead and len(running) < workers:
                        row = ahead.pop()
                        try:
                            running[pool.submit(_attempt, work, row, made[_key(row)])] = row
                        except BrokenProcessPool:
                            ahead.append(row)
                            raise
                    for future in wait(running, return_when=FIRST_COMPLETED).done:
                        values, error, seconds = future.result()
                        yield Result(running.pop(future), values, error, seconds)
            except BrokenProcessPool:
                for row in running.values():
                    tries[_key(row)] += 1
                    if tries[_key(row)] < TRIES:
                        ahead.append(row)
                    else:
                        yield Result(row, error=f"the process that ran it died, {TRIES} times")
                # One by one, the run that kills its process is found and spares the others.
                workers = 1


def _on_cluster(client: Any, work: Work, rows: list[Row], made: Mapping[str, Identity]) -> Iterator[Result]:
    """Results of rows, as they come, of the workers of a cluster; what a lost worker ran is run elsewhere."""
    from dask.distributed import as_completed

    sending: dict[str, Any] = {"pure": False, "retries": TRIES - 1}
    futures = {client.submit(_attempt, work, row, made[_key(row)], **sending): row for row in rows}
    for future in as_completed(list(futures)):
        try:
            values, error, seconds = future.result()
        except Changed:
            raise
        except Exception as failure:  # the cluster gave it up
            values, error, seconds = {}, f"{type(failure).__name__}: {failure}", 0.0
        yield Result(futures[future], values, error, seconds)


class _Progress:
    """A line on the terminal: what is done, what failed, what is left."""

    def __init__(self, count: int, done: int, shown: bool | None) -> None:
        self._count, self._done, self._first, self._failed = count, done, done, 0
        self._shown = sys.stderr.isatty() if shown is None else shown
        self._began = time.monotonic()

    def add(self, result: Result) -> None:
        """Another row is done."""
        self._done += 1
        self._failed += result.failed
        if not self._shown:
            return
        each = (time.monotonic() - self._began) / (self._done - self._first)
        left = round(each * (self._count - self._done))
        clock = f"{left // 3600}:{left // 60 % 60:02}:{left % 60:02}"
        end = "\n" if self._done == self._count else ""
        text = f"\r{self._done} of {self._count} runs, {self._failed} failed, {clock} left   "
        print(text, end=end, file=sys.stderr, flush=True)


def main(words: Iterable[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m cograin.study", description="Runs a scene for each row of a table."
    )
    parser.add_argument(
        "table", type=Path, metavar="TABLE", help="CSV: keys of the scene in the heading, values in the rows"
    )
    parser.add_argument("scene", type=Path, metavar="SCENE", help="the scene")
    parser.add_argument(
        "-o", "--output", type=Path, required=True, help="folder of the results; continues what is there"
    )
    parser.add_argument("--workers", type=int, help="processes at once (default: one for each core)")
    parser.add_argument("--dask", metavar="ADDRESS", help="send the runs to the cluster with this scheduler")
    parser.add_argument("--program", help="the cograin command")
    parser.add_argument("--retry", action="store_true", help="do those that failed once more")
    options = parser.parse_args(None if words is None else list(words))
    if options.workers is not None and options.workers < 1:
        parser.error(f"--workers: expected 1 or more, found {options.workers}")
    try:
        work = SceneRun(options.scene.resolve(), program=options.program)
        study = Study(options.table, work, options.output)
        client = None
        if options.dask:
            from dask.distributed import Client

            client = Client(options.dask)
        results = study.run(workers=options.workers, client=client, retry=options.retry)
    except ModuleNotFoundError as error:
        print(f"{error.name}: not found; install cograin[study]", file=sys.stderr)
        return 1
    except (StudyError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("broken off; the same command goes on", file=sys.stderr)
        return 1
    failed = [result for result in results if result.failed]
    print(f"{len(results)} runs, {len(failed)} failed: {options.output / 'results.csv'}")
    for result in failed[:3]:
        print(f"  {result.row}: {result.error}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    # The functions that processes are given must be those of the module, not of this script.
    from cograin.study import main as of_module

    sys.exit(of_module())
