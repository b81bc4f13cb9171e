"""The master: steps units and partner through time, shortens steps if necessary, and keeps the record."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any, Literal

import numpy as np

from cograin.base import interrupts
from cograin.base.identity import differing, digest, identity
from cograin.base.vector import Vector, vector
from cograin.exchanges import checkpoint as checkpoints
from cograin.exchanges.exchange import Exchange, Side
from cograin.exchanges.progress import Progress
from cograin.exchanges.record import COLUMNS, Record, Row
from cograin.partners.partner import Partner
from cograin.partners.step import Outcome, Step
from cograin.units.interface import TEMPERATURE
from cograin.units.unit import StepDiscarded, Unit

_log = logging.getLogger("cograin")

#: What is recorded beside the columns of every record: names of a unit's variables, or names with what gives a value.
Watch = Sequence[str] | Mapping[str, Callable[[], float]]


#: Attributes of a `Coupling` that its steps change.
_CHANGING = ("_place", "_level", "_lengths", "_jumped", "_force", "_before", "_stood", "_worked")

#: Which part of the bend that is allowed a step may have by the force that is expected.
FORESEEN = 0.75

#: A step whose sides differ by more than this part of the farthest move in a step is never kept unasked.
KEPT = 0.1

#: How many differences a refusal tells.
MOST = 6


@dataclass(frozen=True)
class StepControl:
    """When a communication step is repeated with half the length, and when the length grows again.

    A step that a unit discards is always halved. ``energy`` is the largest interface energy residual that a step may
    have \\[J\\]: the difference between the force and the one with which the exchange began, times the displacement. An
    explicit exchange creates or loses this energy in the step; a repeated exchange removes it.
    ``error`` is how far the path of the partner may bend away in a step from the straight way that the units are moved
    \\[m, rad\\]. It chooses the length, of which the given one is the longest; the error of a run is in proportion.
    ``unconverged`` says what happens to a step whose sides do not agree: ``"shorten"``, ``"accept"`` it and note it, or
    ``"stop"``. ``halvings`` is how often a length is halved.

    ``"shorten"`` ends where a shorter step does not help: the length is halved as often as it may be, or the force of
    the particles jumps, and the partner has no mass or damping and moves as far in a shorter step, or the step before
    ended at a jump, too. The best trial is then kept and noted if the force jumps, or if its sides differ by less than
    a tenth of the farthest move in a step; otherwise the run ends.

    Lengths are the given one over powers of two and stay on its grid: every multiple of the given length is met.
    """

    energy: float | None = None
    error: float | None = None
    unconverged: Literal["shorten", "accept", "stop"] = "shorten"
    halvings: int = 6

    def __post_init__(self) -> None:
        if self.unconverged not in ("shorten", "accept", "stop"):
            raise ValueError(f"unconverged: expected 'shorten', 'accept' or 'stop', found {self.unconverged!r}")
        for name in ("energy", "error"):
            value = getattr(self, name)
            if value is not None and not value > 0.0:
                raise ValueError(f"{name}: expected a number above 0, found {value}")
        if not (isinstance(self.halvings, int) and self.halvings >= 0):
            raise ValueError(f"halvings: expected a whole number from 0 on, found {self.halvings}")

    def objection(self, outcome: Outcome, defect: float, bend: float, last: bool) -> str:
        """Why a step is not accepted; empty if it is accepted. ``last``: a shorter one is not to be had or no help."""
        if not outcome.converged and self.unconverged != "accept":
            kept = last and self.unconverged == "shorten" and (outcome.jumps or outcome.spread < KEPT)
            return "" if kept else outcome.reason
        # The shortest step is accepted as it is, and the record says so.
        if self.energy is not None and abs(defect) > self.energy and not last:
            return f"the interface energy residual is {defect:.1e} J, {self.energy:g} J are allowed"
        if self.error is not None and bend > self.error and not last:
            return f"the partner's path bends by {bend:.1e} m, {self.error:g} m is allowed"
        return ""

    def may_grow(self, defect: float) -> bool:
        """Whether the next step may be twice as long: a residual grows at least with the square of the length."""
        return self.energy is None or abs(defect) < 0.125 * self.energy


class CouplingStopped(Exception):
    """The coupled run cannot go on. ``record`` holds the steps that were made."""

    def __init__(self, message: str, record: Record) -> None:
        super().__init__(message)
        self.record = record


class Coupling:
    """Units and partner, coupled by an exchange with this communication step \\[s\\].

    ``for row in coupling.steps(end)`` goes step by step, `run` to the end. ``record`` has every step.

    Whatever ends a step early (an exception, Ctrl-C), both sides and the exchange are then where the step began, and
    the run can go on from there with the same bits. An explicit exchange saves no states: Ctrl-C acts between its
    steps, and after an exception of the partner, whose units are ahead, the run is not continued.
    """

    def __init__(
        self,
        interface: Side,
        partner: Partner,
        exchange: Exchange,
        step: float,
        *,
        control: StepControl | None = None,
        watch: Watch = (),
        parallel: bool = False,
    ) -> None:
        if not 0.0 < step < float("inf"):
            raise ValueError(f"step: expected a finite number above 0, found {step}")
        if not isinstance(exchange, Exchange):
            raise ValueError(f"exchange: expected an exchange, such as Secant(), found {exchange!r}")
        exchange.fresh()
        if parallel and not hasattr(interface, "parallel"):
            raise ValueError(f"parallel: expected an Interface, found {type(interface).__name__}")
        if parallel or hasattr(interface, "parallel"):
            interface.parallel = parallel  # type: ignore[attr-defined]
        self.interface = interface
        self.partner = partner
        self.exchange = exchange
        self.step = step
        self.control = control or StepControl()
        answers = getattr(interface, "answers", None) or [_force_name(one, exchange.force) for one in interface.names]
        columns = [*interface.names, *answers]
        # What is a column anyway is not watched a second time.
        watched, self._read_watched, units = self._reading(_without(watch, columns))
        self._watched = dict(watch) if isinstance(watch, Mapping) else {}
        _different([*COLUMNS, *columns, *watched])
        count = len(interface.names)
        self.record = Record(columns[:count], columns[count:], watched, units)
        self._start = interface.time
        self._place = 0.0  # in steps since the start, exact
        self._level = 0  # how often the step is halved now
        self._lengths = (step, step)  # of the last two steps [s]
        self._jumped = False  # whether the last step was kept at a jump of the force
        self._broken = ""
        if len(interface.names) == len(partner.displacement):
            for place in partner.turning() if hasattr(partner, "turning") else ():
                _turning(interface, place)
        self._together()
        controlled = self.control.energy is not None or self.control.error is not None
        can_save = exchange.repeats or controlled or not interface.keeps_itself
        if can_save and not interface.can_restore:
            without = ", ".join(unit.name for unit in getattr(interface, "units", []) if not unit.can_restore)
            raise ValueError(
                f"{type(exchange).__name__}: needs units that save and restore their states"
                + (f"; {without} cannot (canGetAndSetFMUstate)" if without else "")
            )
        self._saves = can_save
        self._identity: dict[str, Any] | None = None  # what a checkpoint has to be of
        self._force = interface.force(exchange.force)
        self._before = self._force
        self._stood = vector(interface.displacement)  # where the books saw the interface last
        self._worked = interface.work or 0.0

    @property
    def time(self) -> float:
        """Present time of the run \\[s\\]."""
        return self._start + self.step * self._place

    def run(
        self,
        end: float,
        *,
        progress: bool | None = None,
        checkpoint: str | Path | None = None,
        every: float = 60.0,
    ) -> Record:
        """Continues to a time; ``progress`` shows or hides a line of progress (default: on a terminal only).

        ``checkpoint`` is a file with which the run survives: written after ``every`` seconds of the clock and where
        anything ends the run early, deleted at the end. If it is there at the start, the run goes on from it, with the
        same bits as one that was not broken off.
        """
        file = None if checkpoint is None else Path(checkpoint)
        if file is not None:
            self._identify(file)
            if file.exists():
                self._resume(file)
        shown = Progress(self.time, end, shown=progress)
        written, begun = monotonic(), len(self.record)
        try:
            for row in self.steps(end):
                shown.step(row.time, row.evaluations)
                if file is not None and monotonic() - written >= every:
                    self._keep(file)
                    written = monotonic()
        except BaseException:
            if file is not None and not self._broken and len(self.record) > begun:
                self._keep(file)
            raise
        if file is not None:
            file.unlink(missing_ok=True)
        if self.record.remark:
            _log.warning("%s: %s", type(self.exchange).__name__, self.record.remark)
        return self.record

    @property
    def _units(self) -> list[Unit]:
        """Units of both sides."""
        return [*getattr(self.interface, "units", []), *getattr(self.partner, "units", [])]

    @property
    def _sides(self) -> list[Any]:
        """What has a memory, beside the units."""
        return [self.interface, self.partner, self.exchange]

    def _identify(self, file: Path) -> None:
        """Notes what tells this run from others, before its first step; refuses what cannot be written down."""
        if self._identity is not None:
            return
        if self.record.rows:
            raise ValueError(f"{file}: expected a run from its first step on, found one at {self.time:g} s")
        for one in (self.interface, *getattr(self.partner, "partners", [self.partner])):
            if not (hasattr(one, "memory") and hasattr(one, "recall")):
                raise ValueError(f"{file}: {type(one).__name__} has no memory() and recall(), which a checkpoint needs")
        made = identity(self.settings(), "run")
        # Outputs, not saved states: those differ by the number of threads, which changes no bit.
        outputs = {f"outputs of {unit.name}": digest(unit.outputs().tobytes()) for unit in self._units}
        answer = None
        if not getattr(self.partner, "units", []):
            step = self._next()
            answer = []
            with suppress(ValueError, StepDiscarded):
                answer.append(self.partner.predict(0.0 * self._force, step))
                answer.append(self.partner.compliance(step))
        self._identity = {**made, **outputs, "first force": self._force, "answer of the partner": answer}

    def settings(self) -> dict[str, Any]:
        """What makes a run what it is; the end and the number of threads are not among it."""
        return {
            "step": self.step,
            "begin": self._start,
            "columns": self.record.names,
            "watch": self._watched,
            "control": self.control,
            "exchange": self.exchange,
            "partner": self.partner,
            "interface": self.interface,
            "units": {unit.name: unit for unit in self._units},
        }

    def _keep(self, file: Path) -> None:
        """Writes where the run stands."""
        with interrupts.held():
            states = []
            for unit in self._units:
                state = unit.save()
                states.append((unit.serialise(state), unit.time))
                unit.free(state)
            memories = [each.memory() for each in self._sides]
            own = {name: vars(self)[name] for name in _CHANGING}
            checkpoints.write(file, (self._identity, states, memories, own, self.record.memory()))

    def _resume(self, file: Path) -> None:
        """Stands where the run stood that left this file."""
        found = checkpoints.read(file)
        try:
            made, states, memories, own, rows = found
            other = _other(self._identity or {}, dict(made))
        except (ValueError, TypeError, KeyError):
            raise ValueError(f"{file}: expected a checkpoint of a coupled run, found another file") from None
        if other:
            more = f" and {len(other) - MOST} more" if len(other) > MOST else ""
            said = f"expected a checkpoint of this run, found one of another: {', '.join(other[:MOST])}{more} differ"
            raise ValueError(f"{file}: {said}; delete the file to begin anew")
        for unit, (data, time) in zip(self._units, states, strict=True):
            state = unit.deserialise(data, time)
            unit.restore(state)
            unit.free(state)
        for each, memory in zip(self._sides, memories, strict=True):
            each.recall(memory)
        vars(self).update(own)
        self.record.recall(rows)

    def steps(self, end: float) -> Iterator[Row]:
        """The rows until a time, which is a multiple of the step, one after the other."""
        count = (end - self._start) / self.step
        if not abs(count) < 2.0**53 or abs(count - round(count)) > 1e-6:
            found = f"{count:.10g} up to {end:g} s"
            raise ValueError(f"end: expected a whole number of steps of {self.step:g} s, found {found}")
        if round(count) < self._place:
            raise ValueError(f"end: expected a time from {self.time:g} s on, found {end:g} s")
        while self._place < round(count):
            yield self.advance()

    def advance(self) -> Row:
        """Makes one step, of the length that the control permits."""
        if self._broken:
            raise CouplingStopped(self._broken, self.record)
        with interrupts.held():
            return self._advance()

    def _advance(self) -> Row:
        """One step; if it is left early, both sides go back to its beginning."""
        own, exchange = dict(vars(self)), self.exchange.memory()
        partner = self.partner.memory() if hasattr(self.partner, "memory") else None
        begun, began = len(self.record), self.interface.time
        if self._saves:
            self.interface.save()
        try:
            step, outcome, defect, evaluations, refusals = self._agreed()
            self._jumped = outcome.jumps
            row = self._commit(step, outcome, evaluations, refusals)
            self._place += 0.5**self._level
            aligned = (self._place * 2.0 ** (self._level - 1)).is_integer()
            if self._level > 0 and aligned and self.control.may_grow(defect):
                self._level -= 1
            return row
        except BaseException as error:
            if not self._saves and self.interface.time != began:
                said = str(error) or type(error).__name__
                self._broken = (
                    f"t = {self.interface.time:g} s: the units have made the step, the partner has not: {said}"
                )
                raise
            vars(self).update(own)
            del self.record.rows[begun:]
            self.exchange.recall(exchange)
            self._take_back(partner)
            raise

    def _take_back(self, partner: Any) -> None:
        """Takes both sides back to the beginning of the step."""
        if self._saves:
            self.interface.restore()
        if hasattr(self.partner, "recall"):
            self.partner.recall(partner)

    def _agreed(self) -> tuple[Step, Outcome, float, int, int]:
        """A step that is accepted, its interface energy residual, and how many evaluations and refusals it took."""
        refusals = evaluations = 0
        begun = False
        self._foresee()
        while True:
            step = self._next()
            if self._saves and begun:
                self.interface.restore()
            begun = True
            outcome, defect, objection = self._attempt(step)
            evaluations += outcome.evaluations if outcome else 0
            if outcome is not None and not objection:
                return step, outcome, defect, evaluations, refusals + outcome.refusals
            refusals += 1
            self._shorten(step, outcome, objection)

    def _next(self) -> Step:
        """The step to try."""
        part = 0.5**self._level
        return Step(self.time, self._start + self.step * (self._place + part), self.step * part)

    def _attempt(self, step: Step) -> tuple[Outcome | None, float, str]:
        """The outcome of the units, its interface energy residual, and why it is not accepted."""
        begin = self.interface.displacement
        # What makes one evaluation does not look ahead.
        expected = self._expected(step.length) if self.exchange.repeats else self._force
        try:
            outcome = self.exchange.evaluate(self.interface, self.partner, step, self._force, expected)
        except StepDiscarded as refusal:
            return None, 0.0, str(refusal)
        bend = 0.0 if self.control.error is None else self._bend(step, outcome.partner_force)
        start = expected if self.exchange.repeats else outcome.partner_force
        defect = float((outcome.force - start) @ self._way(begin, outcome.displacement, step.length))
        last = self._level >= self.control.halvings or (outcome.jumps and (self._jumped or not self._softens(step)))
        return outcome, defect, self.control.objection(outcome, defect, bend, last)

    def _foresee(self) -> None:
        """Halves the step until its bend is small enough, by the force that is expected."""
        if self.control.error is None:
            return
        while self._level < self.control.halvings:
            step = self._next()
            if self._bend(step, self._expected(step.length)) <= FORESEEN * self.control.error:
                return
            self._level += 1

    def _bend(self, step: Step, force: Vector) -> float:
        """How far the partner leaves the way of the units; without limit where it cannot make the step."""
        try:
            return self.exchange.bend(self.partner, step, force)
        except StepDiscarded:
            return float("inf")

    def _softens(self, step: Step) -> bool:
        """Whether a force moves the partner by less in a shorter step."""
        half = Step(step.begin, step.middle, 0.5 * step.length)
        try:
            long, short = (np.abs(self.partner.compliance(one)).max() for one in (step, half))
        except ValueError:
            return True
        return bool(short < 0.75 * long)

    def _expected(self, length: float) -> Vector:
        """The force of the next step, extrapolated from the last two."""
        older, newer = self._lengths
        share = (length + newer) / (newer + older) if self.exchange.force == "mean" else length / newer
        return self._force + share * (self._force - self._before)

    def _shorten(self, step: Step, outcome: Outcome | None, objection: str) -> None:
        """Halves the step, or ends the run with the reason."""
        stop = outcome is not None and not outcome.converged and self.control.unconverged == "stop"
        fixed = [unit.name for unit in getattr(self.interface, "units", []) if not unit.has_variable_steps]
        if stop or fixed or self._level >= self.control.halvings:
            shortest = f", the shortest allowed ({self.step:g} s halved {self.control.halvings} times)"
            if fixed:
                shortest = f"; {', '.join(fixed)} takes no other (canHandleVariableCommunicationStepSize)"
            said = f"t = {step.begin:g} s, step of {step.length:g} s{'' if stop else shortest}: {objection}"
            raise CouplingStopped(said, self.record)
        self._level += 1

    def _commit(self, step: Step, outcome: Outcome, evaluations: int, refusals: int) -> Row:
        """The partner follows, and the row is written."""
        before = self.partner.displacement
        self.exchange.commit(self.partner, step, outcome)
        way = self._way(before, self.partner.displacement, step.length)
        on_partner = float(outcome.partner_force @ way) + outcome.further_work
        on_units = self._work_on_units(step.length)
        self._before, self._force = self._force, outcome.force
        self._lengths = (self._lengths[1], step.length)
        row = Row(
            step.end,
            step.length,
            evaluations,
            outcome.residual,
            outcome.converged,
            refusals,
            on_units + on_partner,
            abs(on_partner),
            *self._told(outcome),
            tuple(self._read_watched()),
            outcome.reason,
        )
        self.record.rows.append(row)
        return row

    def _way(self, begin: Vector, end: Vector, length: float) -> Vector:
        """What makes energy of a force: the way between two displacements; of a heat flow: the time."""
        if hasattr(self.interface, "way"):
            own: Vector = self.interface.way(begin, end, length)
            return own
        warm = [name.endswith(f".{TEMPERATURE}") for name in self.interface.names]
        return np.where(warm, length, end - begin)

    def _work_on_units(self, length: float) -> float:
        """Work on the particles in the last step, by the account of the units or by the mean force \\[J\\]."""
        stood, self._stood = self._stood, self.interface.displacement
        total = self.interface.work
        if total is None:
            return -float(self.interface.force("mean") @ self._way(stood, self._stood, length))
        before, self._worked = self._worked, total
        return total - before

    def _told(self, outcome: Outcome) -> tuple[Vector, Vector]:
        """Displacement and force as the units call them."""
        told = getattr(self.interface, "told", None)
        if told is None:
            return outcome.displacement, outcome.force
        shown: tuple[Vector, Vector] = told(outcome.displacement, outcome.force, self.exchange.force)
        return shown

    def _together(self) -> None:
        """Refuses sides that cannot stand at one place."""
        here, there = vector(self.interface.displacement), vector(self.partner.displacement)
        count = len(self.interface.names)
        if count != len(there):
            raise ValueError(f"the interface has {count} directions, the partner {len(there)}")
        for place, unit in enumerate(self._units):
            if any(unit is other for other in self._units[:place]):
                raise ValueError(f"{unit.name}: expected another unit as the partner, found the same on both sides")
            if abs(unit.time - self._start) > 1e-6 * self.step:
                raise ValueError(
                    f"{unit.name}: expected to stand at {self._start:g} s, as the others do, found {unit.time:g} s"
                )
        # What was computed in two ways differs by rounding.
        if np.abs(here - there).max() > 1e-9 * max(np.abs(here).max(), np.abs(there).max()):
            raise ValueError(
                f"the interface stands at {here}, the partner at {there}; "
                "give the unit its inputs at the start, or place the partner"
            )

    def _reading(self, watch: Watch) -> tuple[list[str], Callable[[], Iterable[float]], dict[str, str]]:
        """The watched names, a function that returns all their values, and the units that they are known to have."""
        if isinstance(watch, Mapping):
            functions = list(watch.values())
            return list(watch), lambda: (read() for read in functions), {}
        units = {unit.name: unit for unit in getattr(self.interface, "units", [])}
        found: list[tuple[Unit, str]] = []
        watched = list(dict.fromkeys(watch))
        for name in watched:
            first, _, rest = name.partition(".")
            several = len(units) > 1 and first in units
            found.append((units[first], rest) if several else (next(iter(units.values())), name))
        described = [unit.variable(variable) for unit, variable in found]
        kinds = {one.type for one in described}
        measured = {name: one.unit for name, one in zip(watched, described, strict=True) if one.unit}
        if kinds == {"Real"} and len({id(unit) for unit, _ in found}) == 1:
            # One call for all of them: on a small scene each call costs as much as several time steps.
            unit, names = found[0][0], tuple(variable for _, variable in found)
            return watched, lambda: unit.get(names).tolist(), measured
        return watched, lambda: (unit.number(variable) for unit, variable in found), measured


def couple(
    interface: Side,
    partner: Partner,
    exchange: Exchange,
    *,
    step: float,
    end: float,
    control: StepControl | None = None,
    watch: Watch = (),
    progress: bool | None = None,
    checkpoint: str | Path | None = None,
    every: float = 60.0,
    parallel: bool = False,
) -> Record:
    """Couples units and partner from their present state to a time \\[s\\]; returns the record.

    With a ``checkpoint`` a run that was broken off goes on from this file (`Coupling.run`). ``parallel`` steps several
    units at the same time, each in a thread of its own.
    """
    coupling = Coupling(interface, partner, exchange, step, control=control, watch=watch, parallel=parallel)
    return coupling.run(end, progress=progress, checkpoint=checkpoint, every=every)


def _force_name(name: str, kind: str) -> str:
    """Column of the force that belongs to a displacement."""
    for given, answer in (("displacement", "force"), ("rotation", "moment")):
        if f".{given}." in name:
            return name.replace(f".{given}.", f".{'mean_' if kind == 'mean' else ''}{answer}.")
    stem, _, last = name.rpartition(".")
    if stem and last == TEMPERATURE:
        return f"{stem}.{'mean_' if kind == 'mean' else ''}heat_flow"
    return f"{name}.{kind}_force"


def _without(watch: Watch, columns: Sequence[str]) -> Watch:
    """What is watched, without names that are columns of the record; functions are kept."""
    if isinstance(watch, Mapping):
        return watch
    names = (watch,) if isinstance(watch, str) else watch
    return [name for name in names if name not in columns]


def _different(names: Sequence[str]) -> None:
    """Refuses columns of one name."""
    twice = [name for place, name in enumerate(names) if name in names[:place]]
    if twice:
        raise ValueError(f"record: expected different names of its columns, found {twice[0]} twice")


def _turning(interface: Side, place: int) -> None:
    """Tells the interface that the partner counts the turns of this direction and the next two."""
    turn = getattr(interface, "turn", None)
    if turn is None:
        raise ValueError(f"{type(interface).__name__}: expected a side that turns, for a partner that turns")
    turn(place)


def _other(mine: Mapping[str, Any], found: Mapping[str, Any]) -> list[str]:
    """What tells a run from that of a checkpoint, in words: settings exactly, what was computed to rounding."""
    computed = ("first force", "answer of the partner")
    settings = ({name: value for name, value in each.items() if name not in computed} for each in (mine, found))
    other = [name.removeprefix("run.").removeprefix("units.") for name in differing(*settings)]
    return other + [name for name in computed if not _same(mine[name], found[name])]


def _same(mine: Any, found: Any) -> bool:
    """Whether a part of a run is that of a checkpoint: numbers to rounding, everything else exactly."""
    if isinstance(mine, list | tuple):
        return (
            isinstance(found, list | tuple)
            and len(mine) == len(found)
            and all(_same(one, other) for one, other in zip(mine, found, strict=True))
        )
    if isinstance(mine, np.ndarray):
        if not isinstance(found, np.ndarray) or mine.shape != found.shape:
            return False
        return bool(np.abs(mine - found).max(initial=0.0) <= 1e-9 * np.abs(mine).max(initial=0.0))
    return bool(mine == found)
