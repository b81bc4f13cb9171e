"""Exchanges that repeat a step from a saved state until both sides agree."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field
from math import sqrt
from typing import Literal

import numpy as np

from cograin.base import interrupts
from cograin.base.vector import Matrix, Vector, root_of_inverse, vector
from cograin.exchanges.exchange import Exchange, Side, Taker
from cograin.exchanges.tolerance import RELATIVE, Tolerance
from cograin.partners.step import Force, Outcome, Step
from cograin.units.unit import StepDiscarded

#: Trials on both sides of the solution that are nearer than this part of what may be left are as good as one.
CLOSED = 1e-6

#: How many trials in several directions `QuasiNewton` makes that do not halve the residual.
PATIENCE = 20

#: A compliance that is less symmetric is that of no work.
SKEW = 0.1

#: A difference of trials that others span but for a smaller part of it tells more of its error than of the particles.
INDEPENDENT = 0.02

#: By which part of the farthest move in a step `Newton` displaces a direction.
PERTURBATION = 1e-4


@dataclass
class Trial:
    """One evaluation of a step."""

    displacement: Vector  # that the units were given [m, rad]
    force: Vector  # that they found [N, N m]
    residual: Vector  # where the partner would go under it, less the displacement [m, rad]
    size: float  # of the residual, each direction over its weight
    place: Vector  # the displacement as the work that moves the partner measures it: a root of energy
    way: Vector  # likewise the residual


class Measure:
    """How directions compare: displacements in metres and in radians, of light and of heavy parts of the partner.

    A direction weighs what a force of 1 moves it, so that squares of weighed displacements compare as energies do. A
    partner that does not tell its compliance has equal weights, or those that it gives itself.
    """

    def __init__(self, compliance: Matrix | None, directions: int, weights: Vector | None = None) -> None:
        #: Change of displacement per force \\[m/N\\], or ``None``.
        self.compliance = compliance
        sizes = np.zeros(directions) if compliance is None else np.sqrt(np.abs(np.diag(compliance)))
        #: Weights of the directions. What no force moves weighs as the least of the others.
        self.weights = np.where(sizes > 0.0, sizes, sizes[sizes > 0.0].min(initial=np.inf))
        #: Whether the partner weighs them itself: they are values such as velocities, not places that move.
        self.of_values = weights is not None
        if weights is not None:
            self.weights = weights
        if not np.isfinite(self.weights).all():
            self.weights = np.ones(directions)
        #: By which part of itself the compliance is not symmetric.
        self.skew = 0.0
        if compliance is not None:
            scaled = compliance / np.outer(self.weights, self.weights)
            self.skew = float(np.abs(scaled - scaled.T).max() / np.abs(scaled).max()) if scaled.any() else 0.0
        self._root: Matrix | None = None

    def size(self, displacement: Vector) -> float:
        """Largest of the weighed displacements."""
        return float((np.abs(displacement) / self.weights).max())

    def moved(self, force: Vector) -> Vector:
        """How far forces of these sizes move each direction, whatever their signs \\[m, rad\\]."""
        if self.compliance is None:
            return np.zeros(len(self.weights))
        found: Vector = np.abs(self.compliance) @ np.abs(force)
        return found

    def root(self) -> Matrix:
        """R for which \\|R u\\|² is the work that moves the partner by u, but for a factor."""
        if self._root is None:
            known = self.compliance
            self._root = np.diag(1.0 / self.weights) if known is None else root_of_inverse(known)
        return self._root


@dataclass
class Search:
    """The repetitions of one step so far."""

    side: Side
    partner: Taker
    step: Step
    force: Force
    measure: Measure
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
        interrupts.check()
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
        root = self.measure.root()
        size = self.measure.size(residual)
        self.trials.append(Trial(displacement, force, residual, size, root @ displacement, root @ residual))
        return self.last

    def reach(self) -> float:
        """How far the partner goes in this step by the last trial, or by its force alone: the larger, weighed."""
        trial = self.last
        move = np.abs(trial.displacement - self.partner.displacement)
        return self.measure.size(np.maximum(move, self.measure.moved(trial.force)))

    def within(self, target: Vector, patience: int = 3) -> Vector:
        """The displacement to try in place of a target that cannot be right.

        Particles resist, so the residual r falls along every way by at least as much as the displacement u grows. The
        solution is then nearer to the middle of u and u + r than half of r, measured by the partner's work: in one
        direction each trial bounds it on both sides. A target that is farther from one of the trials gives way to the
        middle between the best trial and the nearest one that says the opposite, or to the middle of u and u + r.
        So does every target, but for one in four, where ``patience`` trials did not halve the residual.
        """
        best, place = self.best, self.measure.root() @ target
        bound = 2.0 * float(np.linalg.norm(best.way))
        if self.measure.skew > SKEW or bound == 0.0:
            # No work measures such a partner, or such a residual.
            return target
        far = float(np.linalg.norm(place - best.place)) / bound
        patience = patience if len(target) > 1 else 3
        slow = len(self.trials) > patience and best.size > 0.5 * min(trial.size for trial in self.trials[:-patience])
        if self.gives_way() or len(target) > 1:
            # In several directions a bound on one of them cuts off too much of the others; only what strays is held.
            if slow and len(self.trials) % 4:
                return self.middle()
            return target if far <= 1.0 else best.displacement + (target - best.displacement) / far
        halves = [(trial.place + 0.5 * trial.way, 0.5 * float(np.linalg.norm(trial.way))) for trial in self.trials]
        outside = any(float(np.linalg.norm(place - middle)) > half * (1.0 + 1e-6) for middle, half in halves)
        return self.middle() if outside or slow else target

    def gives_way(self) -> bool:
        """Whether the force of the particles falls as they are pushed, by the last two trials."""
        if len(self.trials) < 2:
            return False
        before, now = self.trials[-2:]
        moved = now.place - before.place
        return float(moved @ (now.way - before.way)) > -(1.0 - 1e-6) * float(moved @ moved)

    def middle(self) -> Vector:
        """Half-way between the two nearest trials that point at each other; without such, of the best residual."""
        pair = self.pair()
        if pair is None:
            return self.best.displacement + 0.5 * self.best.residual
        return 0.5 * (pair[0].displacement + pair[1].displacement)

    def pair(self) -> tuple[Trial, Trial] | None:
        """The two nearest trials whose residuals point at each other: a solution, or a jump, is between them."""
        places = np.array([trial.place for trial in self.trials])
        ways = np.array([trial.way for trial in self.trials])
        between = places[None, :, :] - places[:, None, :]
        there = np.einsum("ijk,ik->ij", between, ways) > 0.0
        back = np.einsum("ijk,jk->ij", between, ways) < 0.0
        distances = np.where(there & back, np.linalg.norm(between, axis=2), np.inf)
        one, other = np.unravel_index(int(np.argmin(distances)), distances.shape)
        return (self.trials[one], self.trials[other]) if np.isfinite(distances[one, other]) else None

    def jumps(self, allowed: Vector) -> bool:
        """Whether two trials that are as good as one disagree: the force of the particles jumps between them."""
        pair = self.pair() if len(self.trials) > 2 else None
        if pair is None:
            return False
        apart = np.abs(pair[0].displacement - pair[1].displacement)
        rounding = 4.0 * np.finfo(float).eps * np.abs(pair[0].displacement)
        if not (apart <= np.maximum(CLOSED * allowed, rounding)).all():
            return False
        # Some mean of the two forces leaves nothing, in any direction: there the jump is the answer.
        change = pair[1].way - pair[0].way
        left = pair[0].way - change * (float(pair[0].way @ change) / float(change @ change))
        return float(np.linalg.norm(left)) <= 1e-3 * float(np.linalg.norm(change))


class Implicit(Exchange):
    """The loop that all repeated exchanges share; they differ in `correct`.

    With the ramp and the mean force, impulse and work of both sides are the same, whatever residual is left: the
    partner takes the force that the units found, and then stands where they stand. With ``force="end"`` this does not
    hold. ``limit`` is the largest number of evaluations in a step; after it the best one is kept, and the record says
    so.
    """

    repeats = True

    def __init__(self, *, tolerance: Tolerance | None = None, force: Force = "mean", limit: int = 30) -> None:
        if not isinstance(tolerance, Tolerance | None):
            raise ValueError(f"tolerance: expected Tolerance(displacement=..), or another limit, found {tolerance!r}")
        self.tolerance = tolerance or Tolerance()
        self.force = force
        self.limit = limit
        # Mean velocity [m/s] and length [s] of the last two steps, newest first.
        self._paces: list[tuple[Vector, float]] = []
        self._reach = 0.0  # farthest that the partner went in a step, weighed
        self._measure: Measure | None = None

    @abstractmethod
    def correct(self, search: Search) -> Vector:
        """The displacement to try next."""

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
        if not self._paces or search.measure.of_values:
            return told
        length = search.step.length
        (pace, newer), (before, older) = self._paces[0], self._paces[-1]
        pace = pace + (pace - before) * ((length + newer) / (newer + older))
        place = search.partner.displacement + pace * length
        closing = self.answer(search, told - place)
        return told if closing is None else place + closing

    def _measured(self, partner: Taker, step: Step) -> Measure:
        """How the directions of this partner compare in a step."""
        try:
            compliance = partner.compliance(step)
        except ValueError:
            compliance = None
        if compliance is None and hasattr(partner, "weights"):
            return Measure(None, len(partner.displacement), partner.weights(step))
        known = self._measure
        if known is None or known.compliance is not compliance or len(known.weights) != len(partner.displacement):
            known = self._measure = Measure(compliance, len(partner.displacement))
        return known

    def evaluate(self, side: Side, partner: Taker, step: Step, last: Vector, expected: Vector) -> Outcome:
        search = Search(side, partner, step, self.force, self._measured(partner, step))
        self.begin(search)
        displacement = self._first(search, expected)
        while True:
            trial = self._try(search, displacement)
            reach = self.reach(search)
            left = self.tolerance.open(trial.residual, trial.force, lambda: partner.compliance(step), reach)
            jumps = bool(left) and search.jumps(self.allowed(reach))
            if not left or jumps or search.evaluations >= self.limit:
                break
            displacement = self.correct(search)
        if left:
            why = "the particles' force jumps, and no displacement has the force between; " if jumps else ""
            left = f"{search.evaluations} evaluations: {why}{left}"
        else:
            self._reach = max(self._reach, search.reach())
        return self._kept(search, left, jumps)

    def reach(self, search: Search) -> Vector:
        """Farthest that each direction went in a step so far, by its weight \\[m, rad\\]; rounding included."""
        farthest = max(self._reach, search.reach()) * search.measure.weights
        relative = self.tolerance.relative or RELATIVE
        rounding = 4.0 * np.finfo(float).eps * np.abs(search.last.displacement)
        return np.maximum(farthest, rounding / relative)

    def allowed(self, reach: Vector) -> Vector:
        """What may be left in each direction \\[m, rad\\], by the limit that says it at once."""
        if self.tolerance.displacement is not None:
            return np.full(len(reach), self.tolerance.displacement)
        return (self.tolerance.relative or RELATIVE) * reach

    def _try(self, search: Search, displacement: Vector) -> Trial:
        """A trial; if a unit discards it, the next is nearer to the best one or to the present displacement."""
        anchor = search.best.displacement if search.trials else search.partner.displacement
        for _ in range(8):
            try:
                return search.evaluate(displacement)
            except StepDiscarded:
                displacement = anchor + 0.25 * (displacement - anchor)
        return search.evaluate(displacement)

    def _kept(self, search: Search, left: str, jumps: bool) -> Outcome:
        """The trial that is kept; the units end in its state."""
        kept = search.last
        if left and search.best is not kept:
            kept = search.best
            search.units(kept.displacement)
        self.accepted(search)
        return Outcome(
            kept.displacement,
            kept.force,
            kept.force,
            float(np.abs(kept.residual).max()),
            search.evaluations,
            not left,
            left,
            search.refusals,
            jumps=jumps,
            spread=kept.size / max(self._reach, search.reach()) if left else 0.0,
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

    def __init__(
        self,
        relaxation: float = 1.0,
        *,
        tolerance: Tolerance | None = None,
        force: Force = "mean",
        limit: int = 60,
    ) -> None:
        super().__init__(relaxation, tolerance=tolerance, force=force, limit=limit)

    def correct(self, search: Search) -> Vector:
        if len(search.trials) > 1:
            before, now = search.trials[-2:]
            change = now.residual - before.residual
            square = float(change @ change)
            if square > 0.0:
                # Exact for a linear answer in one direction, also after a trial that was taken nearer.
                self.relaxation = -float(change @ (now.displacement - before.displacement)) / square
        return search.within(search.last.displacement + self.relaxation * search.last.residual)

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

    def begin(self, search: Search) -> None:
        if len(search.partner.displacement) != 1:
            raise ValueError(
                f"a secant is for one direction, the interface has {len(search.partner.displacement)}; "
                "QuasiNewton and Newton take several"
            )
        if self._slope is None:
            stiff = self._stiffness
            self._slope = -1.0 - (float(search.partner.compliance(search.step)[0, 0]) * stiff if stiff else 0.0)

    def correct(self, search: Search) -> Vector:
        return search.within(search.last.displacement - search.last.residual / self._secant(search))

    def answer(self, search: Search, residual: Vector) -> Vector | None:
        return None if self._slope is None else -residual / self._slope

    def _secant(self, search: Search) -> float:
        """Slope of the residual by the last two trials; if they are too close together, the slope before."""
        if len(search.trials) > 1:
            before, now = search.trials[-2:]
            moved = float(now.displacement[0] - before.displacement[0])
            if abs(moved) > 1e-14 * abs(float(now.displacement[0])):
                self._slope = min(float(now.residual[0] - before.residual[0]) / moved, -1.0)
        assert self._slope is not None
        return self._slope


class QuasiNewton(Implicit):
    """Several directions without derivatives: the trials show the stiffness of the particles.

    With a partner that tells its compliance C, the stiffness K of the particles is estimated, and a correction d closes
    the residual r by (1 + C K) d = r. K begins as one number for all directions, each by its weight, and takes up the
    differences of the trials of the last ``reuse`` steps and of this one (Broyden, Fletcher, Goldfarb and Shanno): it
    stays positive, as particles resist. So light and heavy parts of the partner each get a correction of their own.

    With a partner that does not tell it, the inverse comes from least squares over the same differences (IQN-ILS;
    Degroote, Bathe & Vierendeels 2009). ``relaxation`` is used for the very first correction.
    """

    def __init__(
        self,
        *,
        relaxation: float = 0.5,
        reuse: int = 4,
        tolerance: Tolerance | None = None,
        force: Force = "mean",
        limit: int = 100,
    ) -> None:
        super().__init__(tolerance=tolerance, force=force, limit=limit)
        self.relaxation = relaxation
        self.reuse = reuse
        # Differences of residual, displacement and force of each of the last steps, newest first.
        self._past: list[list[tuple[Vector, Vector, Vector]]] = []

    def correct(self, search: Search) -> Vector:
        now = search.last
        pairs = [self._differences(search), *self._past]
        return search.within(now.displacement + self._closing(search, pairs, now.residual), PATIENCE)

    def answer(self, search: Search, residual: Vector) -> Vector | None:
        return self._closing(search, self._past, residual) if self._past else None

    def _closing(self, search: Search, pairs: list[list[tuple[Vector, Vector, Vector]]], residual: Vector) -> Vector:
        """The change of the displacement that closes a residual, by these differences, newest first."""
        columns = [pair for step in pairs for pair in step]
        if not columns:
            return self.relaxation * residual
        compliance = search.measure.compliance
        if compliance is None:
            return self._by_least_squares(columns, residual, search.measure.weights)
        known = self._stiffness(columns, search.measure.weights)
        return vector(np.linalg.solve(np.eye(len(residual)) + compliance @ known, residual))

    @staticmethod
    def _stiffness(columns: list[tuple[Vector, Vector, Vector]], weights: Vector) -> Matrix:
        """Stiffness of the particles by differences, newest first; those against which nothing resists are left out."""
        resisted = [
            (moved, -force)
            for _, moved, force in columns
            if -float(moved @ force) > 1e-8 * float(np.linalg.norm(moved / weights) * np.linalg.norm(force * weights))
        ]
        if not resisted:
            return np.zeros((len(weights), len(weights)))
        moved, force = resisted[0]
        found: Matrix = np.diag(float(moved @ force) / float(np.sum((moved / weights) ** 2)) / weights**2)
        for moved, force in reversed(resisted):
            before = found @ moved
            found = found - np.outer(before, before) / float(moved @ before)
            found = found + np.outer(force, force) / float(moved @ force)
        return found

    def _by_least_squares(
        self, columns: list[tuple[Vector, Vector, Vector]], residual: Vector, weights: Vector
    ) -> Vector:
        """The same by the differences alone, each direction by its weight."""
        residuals, answers = self._independent([(left / weights, moved) for left, moved, _ in columns])
        shares = np.linalg.lstsq(residuals, -residual / weights, rcond=None)[0]
        along: Vector = answers @ shares
        # What the differences do not span is relaxed.
        rest = residual + weights * (residuals @ shares)
        full = len(shares) >= len(residual)
        return along + (0.0 if full else self.relaxation) * rest

    def accepted(self, search: Search) -> None:
        if self.reuse and len(search.trials) > 1:
            self._past = [self._differences(search), *self._past][: self.reuse]

    @staticmethod
    def _differences(search: Search) -> list[tuple[Vector, Vector, Vector]]:
        """Differences of each trial to the one before it, newest first."""
        pairs = zip(search.trials[1:], search.trials[:-1], strict=True)
        found = [
            (now.residual - one.residual, now.displacement - one.displacement, now.force - one.force)
            for now, one in pairs
        ]
        return found[::-1]

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
            if size > INDEPENDENT:
                directions.append(rest / size)
                kept.append((residual, answer))
        return np.array([pair[0] for pair in kept]).T, np.array([pair[1] for pair in kept]).T


class Newton(Implicit):
    """Newton's method with the derivative of the particles' force and the compliance of the partner.

    ``derivative="unit"`` takes the directional derivatives of the units and refuses units that have none.
    ``"differences"`` moves each direction by ``perturbation`` \\[m, rad\\] and restores the state, which is one more
    evaluation for each direction; if it is not given, by a ten thousandth of the farthest move in a step. A derivative
    of the units is computed again for every correction, unless ``keep`` is set. A kept derivative, as one by
    differences, serves over steps too, until a correction leaves more than a tenth of the residual. ``derivatives``
    counts how often the units were asked for theirs.
    """

    def __init__(
        self,
        derivative: Literal["unit", "differences"] = "unit",
        *,
        keep: bool = False,
        perturbation: float | None = None,
        tolerance: Tolerance | None = None,
        force: Force = "mean",
        limit: int = 100,
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
        # A partner that does not know its compliance says so before anything moves.
        search.partner.compliance(search.step)

    def correct(self, search: Search) -> Vector:
        now = search.last
        slow = len(search.trials) > 1 and now.size > 0.1 * search.trials[-2].size
        # A force that jumps has no derivative: what costs evaluations of its own is not asked for time and again.
        slow = slow and (self.derivative == "unit" or len(search.trials) <= 4)
        if self._known is None or slow or not self.keep:
            self._known = self._change(search, now)
        return search.within(now.displacement + self._closing(search, now.residual, self._known))

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
        for direction, farthest in enumerate(self.reach(search)):
            perturbation = self.perturbation or PERTURBATION * float(farthest)
            moved = now.displacement.copy()
            moved[direction] += perturbation
            columns.append((search.units(moved) - now.force) / perturbation)
        return np.array(columns).T
