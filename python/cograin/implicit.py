"""Exchanges that repeat a step from a saved state until both sides agree."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field
from math import sqrt
from typing import Literal

import numpy as np

from cograin.exchange import Exchange, Side, Taker
from cograin.step import Force, Outcome, Step
from cograin.tolerance import Tolerance
from cograin.unit import StepDiscarded
from cograin.vector import Matrix, Vector, vector


@dataclass
class Trial:
    """One evaluation of a step."""

    displacement: Vector  # that the units were given [m, rad]
    force: Vector  # that they found [N, N m]
    residual: Vector  # where the partner would go under it, less the displacement [m, rad]

    @property
    def size(self) -> float:
        """Largest component of the residual \\[m, rad\\]."""
        return float(np.abs(self.residual).max())


@dataclass
class Search:
    """The repetitions of one step so far."""

    side: Side
    partner: Taker
    step: Step
    force: Force
    trials: list[Trial] = field(default_factory=list)
    evaluations: int = 0
    refusals: int = 0

    @property
    def last(self) -> Trial:
        """The newest one."""
        return self.trials[-1]

    @property
    def best(self) -> Trial:
        """The one with the smallest residual."""
        return min(self.trials, key=lambda trial: trial.size)

    def units(self, displacement: Vector) -> Vector:
        """Force that the units find at this displacement, from the saved state \\[N, N m\\]."""
        if self.evaluations or self.refusals:
            self.side.restore()
        try:
            force = self.side.advance(displacement, self.step, self.force)
        except StepDiscarded:
            self.refusals += 1
            raise
        self.evaluations += 1
        return force

    def evaluate(self, displacement: Vector) -> Trial:
        """One more trial."""
        force = self.units(displacement)
        residual = self.partner.predict(force, self.step) - displacement
        self.trials.append(Trial(displacement, force, residual))
        return self.last


class Implicit(Exchange):
    """The loop that all repeated exchanges share; they differ in `correct`.

    With the ramp and the mean force, impulse and work of both sides are the same, whatever residual is left: the
    partner takes the force that the units found, and then stands where they stand. With ``force="end"`` this does not
    hold. ``limit`` is the largest number of evaluations in a step; after it the best one is kept, and the record says
    so.
    """

    repeats = True

    def __init__(self, *, tolerance: Tolerance | None = None, force: Force = "mean", limit: int = 30) -> None:
        self.tolerance = tolerance or Tolerance()
        self.force = force
        self.limit = limit
        self._paces: list[
            tuple[Vector, float]
        ] = []  # mean velocity [m/s] and length [s] of the last two steps, newest first

    @abstractmethod
    def correct(self, search: Search) -> Vector | None:
        """The displacement to try next; ``None`` if no better one exists, with the reason in `why`."""

    def begin(self, search: Search) -> None:
        """Called before the first trial of a step."""

    def accepted(self, search: Search) -> None:
        """Called after the last trial of a step."""

    def answer(self, search: Search, residual: Vector) -> Vector | None:
        """The change of the displacement that closes a residual, by what earlier steps showed of the particles.

        ``None`` before they showed anything.
        """
        return None

    def commit(self, partner: Taker, step: Step, outcome: Outcome) -> None:
        self.note(outcome.displacement - partner.displacement, step.length)
        super().commit(partner, step, outcome)

    def note(self, move: Vector, length: float) -> None:
        """Takes note of how far the interface went in a step that is kept."""
        self._paces = [(move / length, length), *self._paces][:2]

    def _first(self, search: Search, expected: Vector) -> Vector:
        """The first trial: force and motion are both taken to go on as they did.

        Under that force the partner makes another motion; the known answer of the particles closes the difference.
        """
        told = search.partner.predict(expected, search.step)
        if not self._paces:
            return told
        length = search.step.length
        (pace, newer), (before, older) = self._paces[0], self._paces[-1]
        pace = pace + (pace - before) * ((length + newer) / (newer + older))
        place = search.partner.displacement + pace * length
        closing = self.answer(search, told - place)
        return told if closing is None else place + closing

    #: Why `correct` gave up.
    why = ""

    def evaluate(self, side: Side, partner: Taker, step: Step, last: Vector, expected: Vector) -> Outcome:
        search = Search(side, partner, step, self.force)
        self.begin(search)
        displacement: Vector | None = self._first(search, expected)
        left = ""
        while displacement is not None:
            trial = self._try(search, displacement)
            left = self.tolerance.open(trial.residual, trial.force, lambda: partner.compliance(step))
            if not left:
                break
            if search.evaluations >= self.limit:
                left = f"{self.limit} evaluations: {left}"
                break
            displacement = self.correct(search)
        if displacement is None:
            left = f"{self.why}: {left}"
        return self._kept(search, left)

    def _try(self, search: Search, displacement: Vector) -> Trial:
        """A trial; if a unit discards it, the next is nearer to the best one or to the present displacement."""
        anchor = search.best.displacement if search.trials else search.partner.displacement
        for _ in range(8):
            try:
                return search.evaluate(displacement)
            except StepDiscarded:
                displacement = anchor + 0.25 * (displacement - anchor)
        return search.evaluate(displacement)

    def _kept(self, search: Search, left: str) -> Outcome:
        """The trial that is kept; the units end in its state."""
        kept = search.last
        if left and search.best is not kept:
            kept = search.best
            search.units(kept.displacement)
        self.accepted(search)
        if left and "evaluations" not in left and not self.why:
            left = f"{search.evaluations} evaluations: {left}"
        return Outcome(
            kept.displacement,
            kept.force,
            kept.force,
            kept.size,
            search.evaluations,
            not left,
            left,
            search.refusals,
        )


class FixedPoint(Implicit):
    """Repeats the step with the displacement that the partner predicted, or a part of the change (``relaxation``).

    Converges only while the gain (stiffness of the particles × compliance of the partner over the step) is below 1, or
    below 2/relaxation − 1; each repetition multiplies the residual by 1 − relaxation · (1 + gain).
    """

    def __init__(
        self,
        relaxation: float = 1.0,
        *,
        tolerance: Tolerance | None = None,
        force: Force = "mean",
        limit: int = 30,
    ) -> None:
        super().__init__(tolerance=tolerance, force=force, limit=limit)
        self.relaxation = relaxation

    def correct(self, search: Search) -> Vector:
        return search.last.displacement + self.relaxation * search.last.residual


class Aitken(FixedPoint):
    """Fixed point with a relaxation from the last two residuals; a step begins with the relaxation of the step before.

    One factor for all directions: in one direction it is the secant, in several it is slower than `QuasiNewton`.
    """

    def correct(self, search: Search) -> Vector:
        if len(search.trials) > 1:
            before, now = search.trials[-2:]
            change = now.residual - before.residual
            square = float(change @ change)
            if square > 0.0:
                # Exact for a linear answer in one direction, also after a trial that was taken nearer.
                self.relaxation = -float(change @ (now.displacement - before.displacement)) / square
        return search.last.displacement + self.relaxation * search.last.residual

    def answer(self, search: Search, residual: Vector) -> Vector:
        return self.relaxation * residual


class Secant(Implicit):
    """One direction: secant of the last two trials, kept in a bracket; a step begins with the slope of the last one.

    The residual falls as the displacement grows, by at least as much, as long as the particles resist. So the first
    trial already brackets the solution, and no stiff bed or light partner can make the iteration diverge. If the force
    of the particles jumps (a contact that closes or does not close within the step), there may be no solution: the
    bracket closes on the jump, the better side is kept, and the record gives the residual.

    ``stiffness`` is a guess for the particles over the first step \\[N/m\\].
    """

    def __init__(
        self,
        *,
        stiffness: float = 0.0,
        tolerance: Tolerance | None = None,
        force: Force = "mean",
        limit: int = 60,
    ) -> None:
        super().__init__(tolerance=tolerance, force=force, limit=limit)
        self._slope: float | None = None  # of the residual over the displacement; at most −1 for what resists
        self._stiffness = stiffness
        self._low: Trial | None = None
        self._high: Trial | None = None
        self._widths: list[float] = []

    def begin(self, search: Search) -> None:
        if len(search.partner.displacement) != 1:
            raise ValueError(
                f"a secant is for one direction, the interface has {len(search.partner.displacement)}; "
                "QuasiNewton and Newton take several"
            )
        if self._slope is None:
            stiff = self._stiffness
            self._slope = -1.0 - (float(search.partner.compliance(search.step)[0, 0]) * stiff if stiff else 0.0)
        self._low = self._high = None
        self._widths = []
        self.why = ""

    def correct(self, search: Search) -> Vector | None:
        now = search.last
        self._narrow(now)
        slope = self._secant(search)
        place, residual = float(now.displacement[0]), float(now.residual[0])
        target = place - residual / slope
        if self._low is None or self._high is None:
            # Not bracketed from both sides yet: the solution is no farther than the residual for what resists.
            return np.array([target])
        low, high = float(self._low.displacement[0]), float(self._high.displacement[0])
        middle = 0.5 * (low + high)
        # Much narrower than what is asked for, and still apart: the answer is not continuous here.
        closed = max(1e-3 * (self.tolerance.displacement or 0.0), 4.0 * np.finfo(float).eps * abs(middle))
        if abs(high - low) <= closed:
            self.why = f"the particles' force jumps at a displacement of {middle:.9g} m, which has no force between"
            return None
        self._widths.append(abs(high - low))
        slow = len(self._widths) > 2 and self._widths[-1] > 0.5 * self._widths[-3]
        if slow or not low < target < high:
            target = middle
        return np.array([target])

    def answer(self, search: Search, residual: Vector) -> Vector | None:
        return None if self._slope is None else -residual / self._slope

    def _narrow(self, trial: Trial) -> None:
        """Keeps the nearest trials on both sides of the solution."""
        place = trial.displacement[0]
        if trial.residual[0] > 0.0:
            if self._low is None or place > self._low.displacement[0]:
                self._low = trial
        elif self._high is None or place < self._high.displacement[0]:
            self._high = trial
        if self._low and self._high and self._low.displacement[0] > self._high.displacement[0]:
            # The particles give way here: what was found last counts.
            if trial is self._low:
                self._high = None
            else:
                self._low = None

    def _secant(self, search: Search) -> float:
        """Slope of the residual by the last two trials; if they are too close together, the slope before."""
        if len(search.trials) > 1:
            before, now = search.trials[-2:]
            moved = float(now.displacement[0] - before.displacement[0])
            scale = 1e-14 * max(abs(float(now.displacement[0])), 1e-6)
            if abs(moved) > scale:
                self._slope = min(float(now.residual[0] - before.residual[0]) / moved, -1.0)
        assert self._slope is not None
        return self._slope


class QuasiNewton(Implicit):
    """Several directions without derivatives: interface quasi-Newton with an inverse from least squares (IQN-ILS).

    The response of the partner is assumed to be linear in the differences of the trials of this step and of the last
    ``reuse`` steps (Degroote, Bathe & Vierendeels 2009). ``relaxation`` is used for the very first correction.
    """

    def __init__(
        self,
        *,
        relaxation: float = 0.5,
        reuse: int = 4,
        tolerance: Tolerance | None = None,
        force: Force = "mean",
        limit: int = 60,
    ) -> None:
        super().__init__(tolerance=tolerance, force=force, limit=limit)
        self.relaxation = relaxation
        self.reuse = reuse
        self._past: list[list[tuple[Vector, Vector]]] = []  # differences of residual and displacement, newest first

    def correct(self, search: Search) -> Vector:
        now = search.last
        columns = self._differences(search) + [pair for step in self._past for pair in step]
        return now.displacement + self._closing(columns, now.residual)

    def answer(self, search: Search, residual: Vector) -> Vector | None:
        columns = [pair for step in self._past for pair in step]
        return self._closing(columns, residual) if columns else None

    def _closing(self, columns: list[tuple[Vector, Vector]], residual: Vector) -> Vector:
        """The change of the displacement that closes a residual, by these differences."""
        if not columns:
            return self.relaxation * residual
        residuals, answers = self._independent(columns)
        weights = np.linalg.lstsq(residuals, -residual, rcond=None)[0]
        along: Vector = answers @ weights
        # What the differences do not span is relaxed.
        rest = residual + residuals @ weights
        full = len(weights) >= len(residual)
        return along + (0.0 if full else self.relaxation) * rest

    def accepted(self, search: Search) -> None:
        if self.reuse and len(search.trials) > 1:
            self._past = [self._differences(search), *self._past][: self.reuse]

    @staticmethod
    def _differences(search: Search) -> list[tuple[Vector, Vector]]:
        """Differences of the last trial to the ones before it, newest first."""
        now = search.last
        earlier = reversed(search.trials[:-1])
        return [(now.residual - one.residual, now.displacement - one.displacement) for one in earlier]

    @staticmethod
    def _independent(columns: list[tuple[Vector, Vector]]) -> tuple[Matrix, Matrix]:
        """Linearly independent columns, newest first, at most as many as there are directions."""
        kept: list[tuple[Vector, Vector]] = []
        directions: list[Vector] = []
        for residual, answer in columns:
            length = sqrt(residual @ residual)
            if length == 0.0 or len(kept) == len(residual):
                continue
            rest = residual / length
            for direction in directions:
                rest = rest - (rest @ direction) * direction
            size = sqrt(rest @ rest)
            if size > 1e-6:
                directions.append(rest / size)
                kept.append((residual, answer))
        return np.array([pair[0] for pair in kept]).T, np.array([pair[1] for pair in kept]).T


class Newton(Implicit):
    """Newton's method with the derivative of the particles' force and the compliance of the partner.

    ``derivative="unit"`` takes the directional derivatives of the units and refuses units that have none.
    ``"differences"`` moves each direction by ``perturbation`` \\[m, rad\\] and restores the state, which is one more
    evaluation for each direction. A derivative of the units is computed again for every correction, unless ``keep`` is
    set. A kept derivative, as one by differences, serves over steps too, until a correction leaves more than a tenth of
    the residual. ``derivatives`` counts how often the units were asked for theirs.
    """

    def __init__(
        self,
        derivative: Literal["unit", "differences"] = "unit",
        *,
        keep: bool = False,
        perturbation: float = 1e-8,
        tolerance: Tolerance | None = None,
        force: Force = "mean",
        limit: int = 30,
    ) -> None:
        super().__init__(tolerance=tolerance, force=force, limit=limit)
        if derivative not in ("unit", "differences"):
            raise ValueError(f"derivative: expected 'unit' or 'differences', found {derivative!r}")
        self.derivative = derivative
        self.keep = keep or derivative == "differences"
        self.perturbation = perturbation
        self.derivatives = 0
        self._known: Matrix | None = None

    def begin(self, search: Search) -> None:
        if self.derivative == "unit" and not search.side.has_derivatives:
            raise ValueError(
                "the units give no directional derivatives; Newton('differences') takes them from restored states, at "
                "one evaluation more for each direction"
            )

    def correct(self, search: Search) -> Vector:
        now = search.last
        slow = len(search.trials) > 1 and now.size > 0.1 * search.trials[-2].size
        if self._known is None or slow or not self.keep:
            self._known = self._change(search, now)
        return now.displacement + self._closing(search, now.residual, self._known)

    def answer(self, search: Search, residual: Vector) -> Vector | None:
        return None if self._known is None else self._closing(search, residual, self._known)

    @staticmethod
    def _closing(search: Search, residual: Vector, known: Matrix) -> Vector:
        """The change of the displacement that closes a residual, with this change of the force per displacement."""
        matrix = np.eye(len(residual)) - search.partner.compliance(search.step) @ known
        return vector(np.linalg.solve(matrix, residual))

    def _change(self, search: Search, now: Trial) -> Matrix:
        """Change of the force per change of displacement about the last trial \\[N/m\\]."""
        if self.derivative == "differences":
            return self._by_differences(search, now)
        self.derivatives += 1
        return search.side.derivative(self.force)

    def _by_differences(self, search: Search, now: Trial) -> Matrix:
        """Change of the force per change of displacement about a trial \\[N/m\\]."""
        columns = []
        for direction in range(len(now.displacement)):
            moved = now.displacement.copy()
            moved[direction] += self.perturbation
            columns.append((search.units(moved) - now.force) / self.perturbation)
        return np.array(columns).T
