"""The master: steps units and partner through time, shortens steps if necessary, and keeps the record."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from cograin.exchange import Exchange, Side
from cograin.partner import Partner
from cograin.progress import Progress
from cograin.record import Record, Row
from cograin.step import Outcome, Step
from cograin.unit import StepDiscarded, Unit
from cograin.vector import Vector, vector

#: What is recorded beside the columns of every record: names of a unit's variables, or names with what gives a value.
Watch = Sequence[str] | Mapping[str, Callable[[], float]]


@dataclass(frozen=True)
class StepControl:
    """When a communication step is repeated with half the length, and when the length grows again.

    A step that a unit discards is always halved. ``energy`` is the largest interface energy residual that a step may
    have \\[J\\]: the difference between the force and the one with which the exchange began, times the displacement. An
    explicit exchange creates or loses this energy in the step; a repeated exchange removes it.
    ``unconverged`` says what happens to a step whose sides do not agree. ``halvings`` is how often a length is halved.

    Lengths are the given one over powers of two and stay on its grid: every multiple of the given length is met.
    """

    energy: float | None = None
    unconverged: Literal["shorten", "accept", "stop"] = "shorten"
    halvings: int = 6

    def objection(self, outcome: Outcome, defect: float, level: int) -> str:
        """Why a step is not accepted; empty if it is accepted."""
        if not outcome.converged and self.unconverged != "accept":
            return outcome.reason
        # The shortest step is accepted as it is, and the record says so.
        if self.energy is not None and abs(defect) > self.energy and level < self.halvings:
            return f"the interface energy residual is {defect:.1e} J, {self.energy:g} J are allowed"
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
    ) -> None:
        if not step > 0.0:
            raise ValueError(f"step: expected a step above 0, found {step}")
        self.interface = interface
        self.partner = partner
        self.exchange = exchange
        self.step = step
        self.control = control or StepControl()
        watched, self._read_watched = self._reading(watch)
        names = interface.names
        forces = [_force_name(name, exchange.force) for name in names]
        self.record = Record(names, forces, watched)
        self._start = interface.time
        self._place = 0.0  # in steps since the start, exact
        self._level = 0  # how often the step is halved now
        self._force = interface.force(exchange.force)
        self._before = self._force
        self._lengths = (step, step)  # of the last two steps [s]
        self._stood = vector(interface.displacement)  # where the books saw the interface last
        self._worked = interface.work or 0.0
        self._together()
        can_save = exchange.repeats or self.control.energy is not None or not interface.keeps_itself
        if can_save and not interface.can_restore:
            raise ValueError(f"{type(exchange).__name__}: needs units that save and restore their states")
        self._saves = can_save

    @property
    def time(self) -> float:
        """Present time of the run \\[s\\]."""
        return self._start + self.step * self._place

    def run(self, end: float, *, progress: bool | None = None) -> Record:
        """Continues to a time; ``progress`` shows or hides a line of progress (default: on a terminal only)."""
        shown = Progress(self.time, end, shown=progress)
        for row in self.steps(end):
            shown.step(row.time, row.evaluations)
        return self.record

    def steps(self, end: float) -> Iterator[Row]:
        """The rows until a time, which is a multiple of the step, one after the other."""
        count = (end - self._start) / self.step
        if abs(count - round(count)) > 1e-6:
            found = f"{count:.10g} up to {end:g} s"
            raise ValueError(f"end: expected a whole number of steps of {self.step:g} s, found {found}")
        while self._place < round(count):
            yield self.advance()

    def advance(self) -> Row:
        """Makes one step, of the length that the control permits."""
        refusals = evaluations = 0
        while True:
            step = self._next()
            if self._saves:
                self.interface.save()
            outcome, defect, objection = self._attempt(step)
            evaluations += outcome.evaluations if outcome else 0
            if outcome is not None and not objection:
                break
            refusals += 1
            if self._saves:
                self.interface.restore()
            self._shorten(step, outcome, objection)
        refusals += outcome.refusals
        row = self._commit(step, outcome, evaluations, refusals)
        self._place += 0.5**self._level
        aligned = (self._place * 2.0 ** (self._level - 1)).is_integer()
        if self._level > 0 and aligned and self.control.may_grow(defect):
            self._level -= 1
        return row

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
        start = expected if self.exchange.repeats else outcome.partner_force
        defect = float((outcome.force - start) @ (outcome.displacement - begin))
        return outcome, defect, self.control.objection(outcome, defect, self._level)

    def _expected(self, length: float) -> Vector:
        """The force of the next step, extrapolated from the last two."""
        older, newer = self._lengths
        share = (length + newer) / (newer + older) if self.exchange.force == "mean" else length / newer
        return self._force + share * (self._force - self._before)

    def _shorten(self, step: Step, outcome: Outcome | None, objection: str) -> None:
        """Halves the step, or ends the run with the reason."""
        stop = outcome is not None and not outcome.converged and self.control.unconverged == "stop"
        if stop or self._level >= self.control.halvings:
            shortest = f", the shortest allowed ({self.step:g} s halved {self.control.halvings} times)"
            said = f"t = {step.begin:g} s, step of {step.length:g} s{'' if stop else shortest}: {objection}"
            raise CouplingStopped(said, self.record)
        self._level += 1

    def _commit(self, step: Step, outcome: Outcome, evaluations: int, refusals: int) -> Row:
        """The partner follows, and the row is written."""
        before = self.partner.displacement
        self.exchange.commit(self.partner, step, outcome)
        on_partner = float(outcome.partner_force @ (self.partner.displacement - before)) + outcome.further_work
        on_units = self._work_on_units()
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
            outcome.displacement,
            outcome.force,
            tuple(self._read_watched()),
            outcome.reason,
        )
        self.record.rows.append(row)
        return row

    def _work_on_units(self) -> float:
        """Work on the particles in the last step, by the account of the units or by the mean force \\[J\\]."""
        stood, self._stood = self._stood, self.interface.displacement
        total = self.interface.work
        if total is None:
            return -float(self.interface.force("mean") @ (self._stood - stood))
        before, self._worked = self._worked, total
        return total - before

    def _together(self) -> None:
        """Refuses sides whose displacements differ."""
        apart = np.abs(self.interface.displacement - self.partner.displacement)
        if apart.shape != self._force.shape or len(self.interface.names) != len(self.partner.displacement):
            there = len(self.partner.displacement)
            raise ValueError(f"the interface has {len(self.interface.names)} directions, the partner {there}")
        if apart.max() > 1e-9:
            raise ValueError(
                f"the interface stands at {self.interface.displacement}, the partner at {self.partner.displacement}; "
                "give the unit its inputs at the start, or place the partner"
            )

    def _reading(self, watch: Watch) -> tuple[list[str], Callable[[], Iterable[float]]]:
        """The watched names, and a function that returns all their values."""
        if isinstance(watch, Mapping):
            functions = list(watch.values())
            return list(watch), lambda: (read() for read in functions)
        units = {unit.name: unit for unit in getattr(self.interface, "units", [])}
        found: list[tuple[Unit, str]] = []
        watched = list(dict.fromkeys(watch))
        for name in watched:
            first, _, rest = name.partition(".")
            several = len(units) > 1 and first in units
            found.append((units[first], rest) if several else (next(iter(units.values())), name))
        kinds = {unit.variable(variable).type for unit, variable in found}
        if kinds == {"Real"} and len({id(unit) for unit, _ in found}) == 1:
            # One call for all of them: on a small scene each call costs as much as several time steps.
            unit, names = found[0][0], tuple(variable for _, variable in found)
            return watched, lambda: unit.get(names).tolist()
        return watched, lambda: (unit.number(variable) for unit, variable in found)


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
) -> Record:
    """Couples units and partner from their present state to a time \\[s\\]; returns the record."""
    return Coupling(interface, partner, exchange, step, control=control, watch=watch).run(end, progress=progress)


def _force_name(name: str, kind: str) -> str:
    """Column of the force that belongs to a displacement."""
    for given, answer in (("displacement", "force"), ("rotation", "moment")):
        if f".{given}." in name:
            return name.replace(f".{given}.", f".{'mean_' if kind == 'mean' else ''}{answer}.")
    return f"{name}.{kind}_force"
