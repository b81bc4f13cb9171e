"""A rigid body that moves and turns freely, without limit of its rotation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cograin.base.rotation import (
    after,
    back,
    cross,
    matrix,
    quaternion,
    rotation_vector,
    tangent,
    turned,
)
from cograin.base.vector import Matrix, Vector, closing, vector
from cograin.partners.step import Step
from cograin.units.unit import StepDiscarded

#: What the steps of a body change, beside its motion.
_CHANGING = ("rotation", "work", "load_work", "correction", "_attitudes", "displacement")


@dataclass
class _Motion:
    """Where a step leads."""

    place: Vector  # displacement of the origin [m]
    momentum: Vector  # [kg m/s]
    attitude: Vector  # quaternion
    spin: Vector  # angular momentum about the origin [kg m²/s]
    way: Vector  # rotation vector of the turn in the step [rad]


class RigidBody:
    """A rigid body with six degrees of freedom and one or several boundaries, of one or several units.

    ``mass`` \\[kg\\]; ``inertia`` \\[kg m²\\] about the mass centre at time 0, in global axes: a number, three moments,
    or a matrix. ``centre`` is the mass centre at time 0 \\[m\\], ``at`` the reference point of each boundary (one
    point, or a row for each). Every boundary has six directions of the interface: displacement.x, .y, .z,
    rotation.x, .y, .z.
    ``gravity`` \\[m/s²\\]; ``load(time)`` gives further forces at the mass centre and moments, six numbers in global
    axes. With a ``pivot`` the body only turns about this point. ``velocity`` \\[m/s\\] of the mass centre and
    ``angular_velocity`` \\[rad/s\\] are those at time 0; `place` sets them later.

    A step changes momentum and angular momentum by impulse and angular impulse of forces and moments, and turns the
    body through H times the mean of its angular velocities (in its own axes) at begin and end, at a constant rate in
    global axes, as a boundary of a unit turns. Forces act at the mean of their arms over this turn. So momentum and
    angular momentum are conserved, and the work of forces and moments along displacement and turn is the change of
    energy, to rounding; the method is of second order. Displacements of the interface are counted in turns: what the
    rotations change by in a step is the rotation vector of the turn in this step.

    `position` \\[m\\] and `velocity` \\[m/s\\] are those of the mass centre, `rotation` \\[rad\\] and
    `angular_velocity` \\[rad/s\\] those of the body. The book is ``work + load_work + correction = change of energy``.
    """

    def __init__(
        self,
        mass: float,
        inertia: ArrayLike,
        *,
        at: ArrayLike = (0.0, 0.0, 0.0),
        centre: ArrayLike = (0.0, 0.0, 0.0),
        gravity: ArrayLike = (0.0, 0.0, 0.0),
        load: Callable[[float], ArrayLike] | None = None,
        pivot: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
    ) -> None:
        if not 0.0 < mass < np.inf:
            raise ValueError(f"mass: expected a finite number above 0, found {mass}")
        middle = _three("centre", centre)
        points = np.atleast_2d(np.array(at, dtype=float))
        if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
            raise ValueError(f"at: expected points of three finite numbers, found {at!r}")
        self.mass = float(mass)
        self.free = pivot is None  # whether it moves, beside turning
        origin = middle if pivot is None else _three("pivot", pivot)
        self._centre = middle - origin  # from the origin, at time 0 [m]
        self._arms = points - origin  # likewise
        own = _inertia(inertia)
        apart = self._centre
        self.inertia = own + self.mass * (float(apart @ apart) * np.eye(3) - np.outer(apart, apart))  # about the origin
        self._soft = np.linalg.inv(self.inertia)
        self._weight = self.mass * _three("gravity", gravity)
        self._load = load
        self._now = _Motion(np.zeros(3), np.zeros(3), quaternion(np.zeros(3)), np.zeros(3), np.zeros(3))
        self.rotation = np.zeros(3)
        self.work = 0.0  # of the particles [J]
        self.load_work = 0.0  # of the load [J]
        self.correction = 0.0  # left by displacements that did not agree to rounding [J]
        self._attitudes = [self._now.attitude] * len(points)  # of the boundaries
        self._tried: tuple[Step, Vector, _Motion] | None = None
        self._complied: tuple[Step, Matrix] | None = None
        self.place(velocity=velocity, angular_velocity=angular_velocity)

    # What it is and does

    @property
    def position(self) -> Vector:
        """Displacement of the mass centre since time 0 \\[m\\]."""
        return self._way_of(self._centre, self._now)

    @property
    def angular_velocity(self) -> Vector:
        """In global axes \\[rad/s\\]."""
        return self._spinning(self._now.attitude, self._now.spin)

    @property
    def velocity(self) -> Vector:
        """Of the mass centre \\[m/s\\]."""
        arm = turned(self._now.attitude, self._centre)
        return self._now.momentum / self.mass + np.cross(self.angular_velocity, arm)

    @property
    def momentum(self) -> Vector:
        """Mass times velocity of the mass centre \\[kg m/s\\]."""
        return self.mass * self.velocity

    @property
    def angular_momentum(self) -> Vector:
        """About the mass centre, or about the pivot \\[kg m²/s\\]."""
        return self._now.spin.copy()

    @property
    def energy(self) -> float:
        """Kinetic energy, less the work of gravity since time 0 \\[J\\]."""
        return self._energy(self._now)

    def place(
        self,
        position: ArrayLike | None = None,
        rotation: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
    ) -> None:
        """Sets displacement of the mass centre, rotation vector, and velocities; what is not given stays.

        With a pivot position and velocity follow from the rotation, and are refused.
        """
        if not self.free and (position is not None or velocity is not None):
            raise ValueError("place: a body on a pivot only turns; expected rotation and angular_velocity alone")
        turning, now = self.angular_velocity, self._now
        attitude = now.attitude
        if rotation is not None:
            self.rotation = _three("rotation", rotation)
            attitude = quaternion(self.rotation)
        if angular_velocity is not None:
            turning = _three("angular_velocity", angular_velocity)
        axes = matrix(attitude)
        spin = axes @ (self.inertia @ (axes.T @ turning))
        place = now.place if position is None else _three("position", position)
        momentum = now.momentum if velocity is None else self.mass * _three("velocity", velocity)
        self._now = _Motion(place, momentum, attitude, spin, np.zeros(3))
        self._tried = self._complied = None
        self._attitudes = [attitude] * len(self._arms)
        self.displacement = self._standing()

    # The partner of an exchange

    def turning(self) -> tuple[int, ...]:
        """Begins to count turns from its rotation vector; where the first rotation of each boundary stands."""
        self._attitudes = [self._now.attitude] * len(self._arms)
        self.displacement = self._standing()
        return tuple(range(3, 6 * len(self._arms), 6))

    def predict(self, force: Vector, step: Step) -> Vector:
        """Displacement of the interface at the end of this step under this force; changes nothing."""
        return self._interface(self._moved(force, step))

    def compliance(self, step: Step) -> Matrix:
        """Change of that displacement per change of the force \\[m/N\\], about the motion without it."""
        if self._complied is None or self._complied[0] != step:
            self._complied = (step, self._compliance(self._moved(np.zeros(6 * len(self._arms)), step), step.length))
        return self._complied[1]

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None:
        """Makes the step under this force, and then has this displacement of the interface."""
        before, begin = self._now, self.displacement
        end = self._moved(force, step)
        moved = np.concatenate(
            [np.concatenate([self._way_of(arm, end) - self._way_of(arm, before), end.way]) for arm in self._arms]
        )
        if self._load is not None:
            loads = self._loads(step)
            way = self._way_of(self._centre, end) - self._way_of(self._centre, before)
            self.load_work += float(loads[:3] @ way + loads[3:] @ end.way)
        off = displacement - self._interface(end)
        stood = self._nearer(end, off) if off.any() else end
        self._attitudes = [
            after(quaternion(turn), attitude)
            for turn, attitude in zip((displacement - begin).reshape(-1, 6)[:, 3:], self._attitudes, strict=True)
        ]
        self.work += float(force @ (displacement - begin))
        self.correction += self._energy(stood) - self._energy(end) - float(force @ (displacement - begin - moved))
        self.rotation = rotation_vector(stood.attitude, near=self.rotation)
        self._now, self.displacement = stood, displacement
        self._tried = self._complied = None

    def settings(self) -> dict[str, Any]:
        """What it was made with, and where it stands."""
        return {name: value for name, value in vars(self).items() if name not in ("_tried", "_complied")}

    def memory(self) -> Any:
        """The values that change in a step."""
        return tuple(vars(self._now).values()), {name: vars(self)[name] for name in _CHANGING}

    def recall(self, memory: Any) -> None:
        """Restores what `memory` returned."""
        now, others = memory
        self._now = _Motion(*now)
        vars(self).update(others)
        self._tried = self._complied = None

    # Motion

    def _loads(self, step: Step) -> Vector:
        """Forces and moments of the load in the middle of a step."""
        if self._load is None:
            return np.zeros(6)
        found = vector(self._load(step.middle))
        if found.shape != (6,):
            raise ValueError(f"load: expected three forces and three moments, found {len(found)} numbers")
        return found

    def _spinning(self, attitude: Vector, spin: Vector) -> Vector:
        """Angular velocity in global axes \\[rad/s\\]."""
        return turned(attitude, self._soft @ turned(back(attitude), spin))

    def _way_of(self, arm: Vector, motion: _Motion) -> Vector:
        """Displacement of the point that was at this arm at time 0 \\[m\\]."""
        return motion.place + turned(motion.attitude, arm) - arm

    def _energy(self, motion: _Motion) -> float:
        kinetic = float(motion.momentum @ motion.momentum) / self.mass
        kinetic += float(motion.spin @ self._spinning(motion.attitude, motion.spin))
        return 0.5 * kinetic - float(self._weight @ self._way_of(self._centre, motion))

    def _standing(self) -> Vector:
        """Displacements of the interface, rotations as rotation vectors."""
        turn = rotation_vector(self._now.attitude)
        return np.concatenate([np.concatenate([self._way_of(arm, self._now), turn]) for arm in self._arms])

    def _interface(self, end: _Motion) -> Vector:
        """Displacements of the interface: turns from where the boundaries are."""
        found = []
        counted = self.displacement.reshape(-1, 6)[:, 3:]
        for arm, turns, attitude in zip(self._arms, counted, self._attitudes, strict=True):
            left = rotation_vector(after(end.attitude, back(attitude)))
            found += [self._way_of(arm, end), turns + left]
        return np.concatenate(found)

    def _moved(self, force: Vector, step: Step) -> _Motion:
        """Where a step under these forces and moments leads."""
        if self._tried is not None and self._tried[0] == step and np.array_equal(self._tried[1], force):
            return self._tried[2]
        now, length, loads = self._now, step.length, self._loads(step)
        given = force.reshape(-1, 6)
        central = self._weight + loads[:3]
        momentum = now.momentum + length * (given[:, :3].sum(axis=0) + central) if self.free else now.momentum
        place = now.place + (0.5 * length / self.mass) * (now.momentum + momentum)
        # Sum of the products of arms at the beginning and forces; without a pivot the mass centre has no arm.
        axes = matrix(now.attitude)
        levers = axes @ (self._arms.T @ given[:, :3])
        if not self.free:
            levers = levers + np.outer(axes @ self._centre, central)
        way, spin = self._turn(levers, given[:, 3:].sum(axis=0) + loads[3:], length)
        end = _Motion(place, momentum, after(quaternion(way), now.attitude), spin, way)
        end.attitude = end.attitude / np.sqrt(float(end.attitude @ end.attitude))
        self._tried = (step, vector(force), end)
        return end

    def _turn(self, levers: Matrix, moment: Vector, length: float) -> tuple[Vector, Vector]:
        """The turn of a step and the angular momentum at its end, by Newton's method."""
        now = self._now
        axes = matrix(now.attitude)
        soft = axes @ self._soft  # from the body's axes to those at the beginning
        begin = soft @ (axes.T @ now.spin)
        stiff = (0.5 * length) * (levers - np.trace(levers) * np.eye(3))
        way, last = length * begin, np.inf
        for _ in range(30):
            bent = tangent(way)
            turning = bent @ levers
            torque = np.array([turning[b, c] - turning[c, b] for b, c in ((1, 2), (2, 0), (0, 1))])
            spin = now.spin + length * (moment + torque)
            back_to_body = soft @ matrix(after(quaternion(way), now.attitude)).T
            residual = way - 0.5 * length * (begin + back_to_body @ spin)
            slope = cross(spin) @ bent + stiff
            change = np.linalg.solve(np.eye(3) - 0.5 * length * back_to_body @ slope, residual)
            size, scale = float(np.linalg.norm(change)), float(np.linalg.norm(way))
            if not scale < pi:
                break
            # The last correction is made as long as it still brings the solution nearer.
            if size <= 1e-16 * scale or (size <= 1e-12 * scale and size >= last):
                return way, spin
            way, last = way - change, size
        said = f"rigid body: a step of {length:g} s turns it by half a turn or more"
        raise StepDiscarded(said, said, float("nan"))

    def _compliance(self, end: _Motion, length: float) -> Matrix:
        """Change of the interface's displacement per force, about a motion."""
        axes = matrix(end.attitude)
        soft = matrix(self._now.attitude) @ self._soft @ axes.T
        bent = tangent(end.way)
        slope = np.eye(3) - 0.5 * length * soft @ cross(end.spin) @ bent
        turning = np.linalg.solve(slope, 0.5 * length**2 * soft)  # turn per moment
        moving = (0.5 * length**2 / self.mass) * np.eye(3) if self.free else np.zeros((3, 3))
        arms = [(turned(self._now.attitude, arm), turned(end.attitude, arm)) for arm in self._arms]
        means = [cross(bent @ arm) for arm, _ in arms]
        found = np.zeros((6 * len(arms), 6 * len(arms)))
        for row, (_, arm) in enumerate(arms):
            swing = -cross(arm) @ bent
            for column, lever in enumerate(means):
                block = [[moving + swing @ turning @ lever, swing @ turning], [turning @ lever, turning]]
                found[6 * row : 6 * row + 6, 6 * column : 6 * column + 6] = np.block(block)
        return found

    def _nearer(self, end: _Motion, off: Vector) -> _Motion:
        """Moved and turned by as much as brings the boundaries nearest to where the units stand; same momenta."""
        rows = []
        for arm in self._arms:
            swing = -cross(turned(end.attitude, arm))
            rows.append(np.block([[np.eye(3), swing], [np.zeros((3, 3)), np.eye(3)]]))
        reach = np.concatenate(rows)
        if not self.free:
            reach = reach[:, 3:]
        # Displacements and rotations compare by the length over which the body's mass is spread.
        length = np.sqrt(np.trace(self.inertia) / self.mass)
        weights = np.tile([1.0, 1.0, 1.0, length, length, length], len(self._arms))
        weighed = reach * weights[:, None]
        change = closing(weighed.T @ weighed)(weighed.T @ (weights * off))
        shift, turn = (change[:3], change[3:]) if self.free else (np.zeros(3), change)
        return _Motion(end.place + shift, end.momentum, after(quaternion(turn), end.attitude), end.spin, end.way)


def _three(name: str, values: ArrayLike) -> Vector:
    """A vector of three finite numbers."""
    found = np.array(values, dtype=float)
    if found.shape != (3,) or not np.isfinite(found).all():
        raise ValueError(f"{name}: expected three finite numbers, found {values!r}")
    return found


def _inertia(values: ArrayLike) -> Matrix:
    """A matrix of inertia, refused where no body has it."""
    given = np.array(values, dtype=float)
    whole = given if given.ndim == 2 else np.diag(np.broadcast_to(given, (3,)))
    if (
        whole.shape != (3, 3)
        or not np.isfinite(whole).all()
        or np.abs(whole - whole.T).max() > 1e-9 * np.abs(whole).max()
    ):
        raise ValueError(f"inertia: expected a number, three moments or a symmetric matrix, found {values!r}")
    least, middle, most = np.linalg.eigvalsh(whole)
    if not least > 0.0:
        raise ValueError(f"inertia: expected principal moments above 0, found {least:g}")
    if most > (least + middle) * (1.0 + 1e-9):
        raise ValueError(
            f"inertia: expected no principal moment above the sum of the others, found {least:g}, {middle:g}, {most:g}"
        )
    return 0.5 * (whole + whole.T)
