"""Linear structures: mass–spring–dashpots, modal models, finite elements. Average acceleration or velocity Verlet."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse.linalg import splu

from cograin.base.vector import Matrix, Vector, closing, is_sparse, solver, vector
from cograin.partners.quadratic_step import QuadraticStep
from cograin.partners.step import Step

#: What the steps of a structure change.
_CHANGING = ("position", "velocity", "displacement", "work", "load_work", "loss", "correction", "_apart")

#: What is computed again where it is missing.
_COMPUTED = (
    "_solvers",
    "_responses",
    "_closings",
    "_unforced",
    "_kicked",
    "_mass_solver",
    "_kick_solvers",
    "_quadratic_steps",
)

#: External forces on the degrees of freedom at a time [s] [N].
Load = Callable[[float], ArrayLike]


class Structure:
    """M ẍ + C ẋ + K x = forces of the particles + ``load``, in the degrees of freedom x.

    ``mass``, ``stiffness`` and ``damping`` are numbers, diagonals, or matrices, dense or sparse, as scikit-fem
    assembles them. ``at`` says which degrees of freedom the interface moves (all of them if it is not given), or
    is a matrix with a column for each direction of the interface: the displacement there is atᵀ x, and a force f
    there acts as at f. ``fixed`` are degrees of freedom that stay 0. ``load(time)`` are the other forces on all
    degrees of freedom.

    The time stepping is Newmark's average acceleration, which is the midpoint rule: the step obeys
    M (v̄ − v₀) 2/H = f − C v̄ − K (x₀ + v̄ H/2) with the mean velocity v̄. Force and velocity count with their means,
    the very pair that a unit exchanges, so that energy is kept but for the dashpots. A structure that has neither mass
    nor damping is static: x = K⁻¹ f at the end of the step. ``substeps`` of equal length make a communication step,
    all under its one force.

    After a step the interface stands where the unit stands. The displacement that is left, at most the tolerance of the
    exchange, moves the structure along its own response to the force of the interface; its momentum does not change.
    """

    def __init__(
        self,
        mass: ArrayLike | Any,
        stiffness: ArrayLike | Any,
        damping: ArrayLike | Any = 0.0,
        *,
        at: ArrayLike | None = None,
        fixed: ArrayLike | None = None,
        load: Load | None = None,
        substeps: int = 1,
    ) -> None:
        size = max(_size(mass), _size(stiffness), _size(damping))
        self.degrees_of_freedom = size
        keep = np.setdiff1d(np.arange(size), np.asarray([] if fixed is None else fixed, dtype=int))
        self.free = keep  # places of the free degrees of freedom among all
        sparse = any(is_sparse(matrix) for matrix in (mass, stiffness, damping))
        self.mass, self.stiffness, self.damping = (
            _matrix(each, size, keep, sparse) for each in (mass, stiffness, damping)
        )
        for name in ("mass", "stiffness", "damping"):
            matrix = getattr(self, name)
            if not np.isfinite(matrix.data if sparse else matrix).all():
                raise ValueError(f"{name}: expected finite numbers, found others")
        lightest = self.mass.diagonal().min(initial=0.0)
        if lightest < 0.0:
            raise ValueError(f"mass: expected numbers from 0 on, found {lightest:g}")
        self.at = _directions(at, size)[keep]
        self._sparse = sparse
        self._load = load
        if substeps < 1:
            raise ValueError(f"substeps: expected at least 1, found {substeps}")
        self.substeps = substeps
        self._damped = _any(self.damping)
        self.static = not _any(self.mass) and not self._damped
        self.position = np.zeros(len(keep))  # of the free degrees of freedom [m]
        self.velocity = np.zeros(len(keep))  # [m/s]
        self.displacement = self._at_interface(self.position)  # of the interface [m, rad]
        self.work = 0.0  # of the particles [J]
        self.load_work = 0.0  # of the load [J]
        self.loss = 0.0  # in the dashpots, and in the jumps of a static structure [J]
        self.correction = 0.0  # left by displacements that did not agree to rounding [J]
        # Where the units stand, less the interface of these positions, if one is not to be had with the other [m].
        self._apart: Vector | None = None
        self._solvers: dict[float, Any] = {}
        self._responses: dict[float, tuple[Matrix, Matrix]] = {}
        self._closings: dict[float, Callable[[Vector], Vector]] = {}
        self._unforced: tuple[Step, Vector] | None = None
        self._kicked: tuple[Step, Vector, Vector] | None = None  # step, force and what they come to
        self._mass_solver: Any = None
        self._kick_solvers: dict[float, Any] = {}
        self._quadratic_steps: dict[float, QuadraticStep] = {}

    # What it is and does

    @property
    def energy(self) -> float:
        """Kinetic and elastic energy \\[J\\]."""
        kinetic = self.velocity @ (self.mass @ self.velocity)
        return 0.5 * float(kinetic + self.position @ (self.stiffness @ self.position))

    @property
    def field(self) -> Vector:
        """Displacements of all degrees of freedom, fixed ones too \\[m, rad\\]."""
        everywhere = np.zeros(self.degrees_of_freedom)
        everywhere[self.free] = self.position
        return everywhere

    def _at_interface(self, position: Vector) -> Vector:
        """Displacement of the interface at these positions \\[m, rad\\]."""
        found: Vector = self.at.T @ position
        return found

    def place(self, position: ArrayLike | None = None, velocity: ArrayLike | None = None) -> None:
        """Sets the positions \\[m\\] and velocities \\[m/s\\] of the free degrees of freedom."""
        if position is not None:
            self.position = np.broadcast_to(vector(position), self.position.shape).copy()
        if velocity is not None:
            self.velocity = np.broadcast_to(vector(velocity), self.velocity.shape).copy()
        self.displacement = self._at_interface(self.position)
        self._unforced = self._apart = None

    # The partner of an exchange

    def predict(self, force: Vector, step: Step) -> Vector:
        """Displacement of the interface at the end of this step under this force; changes nothing."""
        return self._at_interface(self._end_unforced(step)) + self._response(step.length)[1] @ force

    def compliance(self, step: Step) -> Matrix:
        """Change of that displacement per change of the force \\[m/N\\]."""
        return self._response(step.length)[1]

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None:
        """Makes the step under this force, and then has this displacement of the interface."""
        begin = self.displacement
        if self.substeps == 1:
            # What was predicted is what happens: no second solution of the equations.
            end = self._end_unforced(step) + self._response(step.length)[0] @ force
            self._take(end, step.middle, step.length)
        else:
            applied = self.at @ force
            for middle, length in self._parts(step):
                forces = applied if self._load is None else applied + self.loads(middle)
                mean = self._mean_velocity(self.position, self.velocity, forces, length)
                self._take(self.position + length * mean, middle, length)
        self._unforced = None
        self._stand(displacement, force, step)
        self.work += float(force @ (displacement - begin))

    def settings(self) -> dict[str, Any]:
        """What it was made with, and where it stands."""
        return {name: value for name, value in vars(self).items() if name not in _COMPUTED}

    def memory(self) -> Any:
        """The values that change in a step."""
        return {name: vars(self)[name] for name in _CHANGING}

    def recall(self, memory: Any) -> None:
        """Restores what `memory` returned."""
        vars(self).update(memory)
        self._unforced = self._kicked = None

    def _take(self, end: Vector, middle: float, length: float) -> None:
        """Moves to these positions in a substep, and books the energy for it."""
        moved = end - self.position
        if self.static:
            self.loss += 0.5 * float(moved @ (self.stiffness @ moved))
        else:
            mean = moved / length
            self.velocity = 2.0 * mean - self.velocity
            if self._damped:
                self.loss += length * float(mean @ (self.damping @ mean))
        if self._load is not None:
            self.load_work += float(self.loads(middle) @ moved)
        self.position = end

    def _stand(self, displacement: Vector, force: Vector, step: Step) -> None:
        """Moves the interface to the displacement of the units; books the energy that this creates or takes."""
        off = displacement - self._at_interface(self.position)
        self.displacement = displacement
        if self._apart is not None:
            self.correction += float(force @ self._apart)
            self._apart = None
        if not off.any():
            return
        reached, compliance = self._response(step.length)
        if step.length not in self._closings:
            self._closings[step.length] = closing(compliance)
        before = self.energy
        # Where two directions are one degree of freedom, units that differ are met in between.
        self.position = self.position + reached @ self._closings[step.length](off)
        self.correction += self.energy - before - float(force @ off)
        left = displacement - self._at_interface(self.position)
        if np.abs(left).max() > 1e-6 * np.abs(off).max():
            self._apart = left

    # Along a parabola

    def predict_quadratically(self, force: Vector, slope: Vector, step: Step) -> tuple[Vector, Vector]:
        """Displacement at the end \\[m\\] and acceleration \\[m/s²\\] under this mean and slope; changes nothing."""
        velocity, acceleration = self._quadratic_motion(force, slope, step)
        return self._at_interface(self.position + step.length * velocity), self._at_interface(acceleration)

    def quadratic_compliance(self, step: Step) -> Matrix:
        """Change of both per change of mean and slope of the force."""
        return self._quadratic_step(step.length).response()

    def advance_quadratically(self, force: tuple[Vector, Vector], motion: tuple[Vector, Vector], step: Step) -> None:
        """Makes the step under this mean and slope of the force, and then stands where the units stand.

        ``motion`` is theirs: displacement at the end and acceleration.
        """
        (mean, slope), (displacement, acceleration), begin = force, motion, self.displacement
        velocity, own = self._quadratic_motion(mean, slope, step)
        moment = step.length**3 / 12.0  # work per slope and acceleration [s³]
        self.position = self.position + step.length * velocity
        self.velocity = self.velocity + step.length * own
        if self._damped:
            self.loss += step.length * float(velocity @ (self.damping @ velocity)) + moment * float(
                own @ (self.damping @ own)
            )
        if self._load is not None:
            load, change = self._quadratic_step(step.length).loads(step)
            self.load_work += step.length * float(load @ velocity) + moment * float(change @ own)
        self.correction += moment * float(slope @ (self._at_interface(own) - acceleration))
        self._unforced = None
        self._stand(displacement, mean, step)
        self.work += float(mean @ (displacement - begin)) + moment * float(slope @ acceleration)

    def _quadratic_motion(self, force: Vector, slope: Vector, step: Step) -> tuple[Vector, Vector]:
        """Mean velocity and acceleration of the free degrees of freedom."""
        stepping = self._quadratic_step(step.length)
        mean, change = self.at @ force, self.at @ slope
        if self._load is not None:
            load, its_change = stepping.loads(step)
            mean, change = mean + load, change + its_change
        return stepping.motion(mean, change, self.position, self.velocity)

    def _quadratic_step(self, length: float) -> QuadraticStep:
        """What steps of this length \\[s\\] need."""
        if length not in self._quadratic_steps:
            self._quadratic_steps[length] = QuadraticStep(self, length)
        return self._quadratic_steps[length]

    # Velocity Verlet

    def drift(self, force: Vector, step: Step) -> Vector:
        """Displacement at the end, after half a kick of the force at the beginning; changes nothing."""
        return self._at_interface(self.position + step.length * self._half_kicked(force, step))

    def kick(self, begin: Vector, end: Vector, step: Step) -> None:
        """Makes the step with the forces at its beginning and its end."""
        half, before = self._half_kicked(begin, step), self.displacement
        self._kicked = None
        self.position = self.position + step.length * half
        self.displacement = self._at_interface(self.position)
        self._unforced = None
        if not self._damped:
            self.velocity = half + 0.5 * step.length * self._acceleration(self.position, half, end, step.end)
        else:
            # The dashpots take the velocity at the end, as the first half takes that at the beginning: second order.
            forces = self.at @ end - self.stiffness @ self.position + self.loads(step.end)
            self.velocity = self._damped_solver(step.length)(self.mass @ half + 0.5 * step.length * forces)
            self.loss += step.length * float(half @ (self.damping @ half))
        if self._load is not None:
            loads = 0.5 * (self.loads(step.begin) + self.loads(step.end))
            self.load_work += step.length * float(loads @ half)
        self.work += 0.5 * float((begin + end) @ (self.displacement - before))

    def _damped_solver(self, length: float) -> Any:
        """Solves for the velocity at the end of a step of this length \\[s\\]."""
        if length not in self._kick_solvers:
            singular = "velocity Verlet needs a mass at every degree of freedom"
            self._kick_solvers[length] = self._factorised(self.mass + 0.5 * length * self.damping, singular)
        return self._kick_solvers[length]

    def _half_kicked(self, force: Vector, step: Step) -> Vector:
        """Velocity in the middle of the step, which drift and kick both ask for \\[m/s\\]."""
        if self._kicked is None or self._kicked[0] is not step or self._kicked[1] is not force:
            kick = self._acceleration(self.position, self.velocity, force, step.begin)
            self._kicked = (step, force, self.velocity + 0.5 * step.length * kick)
        return self._kicked[2]

    def _acceleration(self, position: Vector, velocity: Vector, force: Vector, time: float) -> Vector:
        if self._mass_solver is None:
            self._mass_solver = self._factorised(self.mass, "velocity Verlet needs a mass at every degree of freedom")
        forces = self.at @ force - self.stiffness @ position
        if self._damped:
            forces = forces - self.damping @ velocity
        if self._load is not None:
            forces = forces + self.loads(time)
        found: Vector = self._mass_solver(forces)
        return found

    # The midpoint rule

    def _parts(self, step: Step) -> list[tuple[float, float]]:
        """Middle and length of each substep \\[s\\]."""
        length = step.length / self.substeps
        return [(step.begin + (count + 0.5) * length, length) for count in range(self.substeps)]

    def loads(self, time: float) -> Vector:
        """External forces on the free degrees of freedom \\[N\\]."""
        if self._load is None:
            return np.zeros(len(self.free))
        return vector(np.broadcast_to(vector(self._load(time)), (self.degrees_of_freedom,))[self.free])

    def _mean_velocity(self, position: Vector, velocity: Vector, forces: Vector, length: float) -> Vector:
        """Mean velocity of a substep under these forces \\[m/s\\]."""
        half = 0.5 * length
        if length not in self._solvers:
            matrix = self.stiffness if self.static else self.mass + half * self.damping + half * half * self.stiffness
            self._solvers[length] = self._factorised(matrix, "the structure has nothing that holds it")
        solve = self._solvers[length]
        found: Vector
        if self.static:
            found = (solve(forces) - position) / length
        else:
            found = solve(self.mass @ velocity + half * (forces - self.stiffness @ position))
        return found

    def _end_unforced(self, step: Step) -> Vector:
        """Positions at the end of the step without a force of the particles \\[m\\]."""
        if self._unforced is None or self._unforced[0] != step:
            position, velocity = self.position, self.velocity
            for middle, length in self._parts(step):
                mean = self._mean_velocity(position, velocity, self.loads(middle), length)
                position, velocity = position + length * mean, 2.0 * mean - velocity
            self._unforced = (step, position)
        return self._unforced[1]

    def _response(self, length: float) -> tuple[Matrix, Matrix]:
        """Positions at the end per unit force on the interface: all, and those of the interface \\[m/N\\]."""
        if length not in self._responses:
            columns = []
            for direction in self.at.T:
                position = velocity = np.zeros(len(self.free))
                for _, part in self._parts(Step(0.0, length, length)):
                    mean = self._mean_velocity(position, velocity, direction, part)
                    position, velocity = position + part * mean, 2.0 * mean - velocity
                columns.append(position)
            reached = np.array(columns).T
            self._responses[length] = (reached, self.at.T @ reached)
        return self._responses[length]

    def _factorised(self, matrix: Any, otherwise: str) -> Any:
        """Solves with a matrix; `otherwise` is the message if it is singular."""
        if self._sparse:
            try:
                return splu(matrix.tocsc()).solve
            except RuntimeError:
                raise ValueError(f"{otherwise}: the matrix is singular") from None
        if len(matrix) == 1:
            if matrix[0, 0] == 0.0:
                raise ValueError(f"{otherwise}: the matrix is singular")
            return lambda forces: forces / matrix[0, 0]
        try:
            cholesky = cho_factor(matrix)
            return lambda forces: cho_solve(cholesky, forces)
        except np.linalg.LinAlgError:
            pass
        solve = solver(matrix)
        if solve is None:
            raise ValueError(f"{otherwise}: the matrix is singular")
        return solve


class Oscillator(Structure):
    """A mass on a spring and a dashpot; the mass may be 0. Load and displacement are in its one direction."""

    def __init__(
        self,
        mass: float,
        stiffness: float,
        damping: float = 0.0,
        *,
        load: Load | None = None,
        substeps: int = 1,
    ) -> None:
        super().__init__(mass, stiffness, damping, load=load, substeps=substeps)


class Modal(Structure):
    """A modal model: modes of these frequencies \\[Hz\\], each with its damping ratio, mass \\[kg\\] and shape.

    ``shapes`` has a row for each mode and a column for each direction of the interface: how far a unit of the mode
    moves it.
    """

    def __init__(
        self,
        frequencies: ArrayLike,
        shapes: ArrayLike,
        *,
        masses: ArrayLike = 1.0,
        damping_ratios: ArrayLike = 0.0,
        substeps: int = 1,
    ) -> None:
        angular = 2.0 * np.pi * vector(frequencies)
        mass = np.broadcast_to(vector(masses), angular.shape)
        ratio = np.broadcast_to(vector(damping_ratios), angular.shape)
        at = np.asarray(shapes, dtype=float).reshape(len(angular), -1)
        super().__init__(mass, mass * angular**2, 2.0 * ratio * mass * angular, at=at, substeps=substeps)


def _size(matrix: Any) -> int:
    """Number of degrees of freedom of a matrix, a diagonal or a number."""
    return int(matrix.shape[0]) if is_sparse(matrix) else (1 if np.ndim(matrix) == 0 else len(np.asarray(matrix)))


def _matrix(matrix: Any, size: int, keep: Any, sparse: bool) -> Any:
    """The matrix of the free degrees of freedom."""
    import scipy.sparse

    if not is_sparse(matrix):
        dense = np.array(matrix, dtype=float)
        matrix = dense if dense.ndim == 2 else np.diag(np.broadcast_to(dense, (size,)))
    if matrix.shape != (size, size):
        raise ValueError(f"a matrix of {matrix.shape[0]} × {matrix.shape[1]} beside {size} degrees of freedom")
    if sparse:
        return scipy.sparse.csc_matrix(matrix)[keep][:, keep].tocsc()
    return matrix[np.ix_(keep, keep)]


def _directions(at: ArrayLike | None, size: int) -> Matrix:
    """A column for each direction of the interface."""
    if at is None:
        return np.eye(size)
    found = np.asarray(at)
    if found.ndim == 2:
        return found.astype(float)
    columns = np.atleast_1d(found).astype(int)
    return np.eye(size)[:, columns]


def _any(matrix: Any) -> bool:
    """Whether a matrix has an entry other than 0."""
    return bool(matrix.count_nonzero() if is_sparse(matrix) else np.any(matrix))
