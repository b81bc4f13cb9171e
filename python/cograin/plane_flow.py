"""A slow flow in a plane by finite elements, as a partner of the fluid of a unit: needs ``cograin[elements]``."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from scipy.sparse import bmat, csc_matrix
from scipy.sparse.linalg import splu

from cograin.base.extras import needed
from cograin.base.vector import Matrix, Vector, vector
from cograin.fluid import FluidInterface, Response
from cograin.partners.step import Step

#: Sides of the box: across the first axis, then across the second one.
SIDES = ("low", "high")
#: Superficial velocity along the axes \\[m/s\\]; none of a component that is free, as along a smooth wall.
Given = tuple[float | None, float | None]
#: That of a side: all along it, or by stretches from one place to another \\[m\\].
Through = Given | Mapping[tuple[float, float], Given]
#: Pressure beside that of the fluid at rest \\[Pa\\]: a number, or a function of time.
Excess = float | Callable[[float], float]


class PlaneFlow:
    """An incompressible fluid in a layer of cells, one deep, as a partner of a `FluidInterface` with two axes.

    The superficial velocity U = ε u and the pressure p of elements of Taylor and Hood (quadratic and linear, one on
    each cell) meet

        ρ ∂U/∂t = −ε ∇p + µ ∇²U + ε ρ g + drag/V        ∇·(U + solid flux) = 0

    (Darcy, Brinkman), with drag as a mass term: a straight line in u by the particles' own coefficients. Inertia along
    the way (ρ u·∇u) is left out, so the flow is slow beside what the particles resist.

    ``velocity`` gives U \\[m/s\\] of sides of the box by their names, as ``{"x_low": (0.01, 0.0), "z_low": (0, 0)}``:
    zeros are a wall, ``(0, None)`` is a smooth one across x. A side may have it on stretches alone, whole cells:
    ``{"x_low": {(0.01, 0.03): (0, 0)}}`` is a wall from z = 0.01 to 0.03 m. What is not named is open, at the pressure
    of the fluid at rest and ``pressure`` \\[Pa\\] beside, as ``{"x_low": 200.0}`` or a function of time. ρ, µ and g are
    those of the unit; p contains that of the fluid at rest.
    """

    def __init__(
        self,
        side: FluidInterface,
        *,
        velocity: Mapping[str, Through],
        pressure: Mapping[str, Excess] | None = None,
    ) -> None:
        if len(side.axes) != 2:
            raise ValueError(f"a plane has two axes, found an interface of {side.axes!r}")
        names = [f"{axis}_{end}" for axis in side.axes for end in SIDES]
        self.open = dict(pressure or {})
        for what, given in (("velocity", velocity), ("pressure", self.open)):
            for name in given:
                if name not in names:
                    raise ValueError(f"{what}: expected sides among {', '.join(names)}, found {name}")
        self.density, self.viscosity, self.rest = side.density, side.viscosity, side.rest
        self.sides = {name: _stretches(velocity[name]) for name in velocity}
        self._side = side
        self._elements = _Elements(side, self.sides, self.rest)
        for name in self.open:
            if not self._elements.is_open(name):
                raise ValueError(f"pressure: expected a side that is open, found {name}, all of which has a velocity")
        self.displacement: Vector = vector(side.displacement)
        self._response = side.response(side.force("mean"))
        flux = self._response.velocity * self._response.porosity[:, None]
        self._state: Vector = self._elements.started(flux)

    @property
    def cells(self) -> tuple[int, int]:
        """How many cells there are along the axes."""
        return self._elements.counts

    @property
    def flux(self) -> Matrix:
        """Superficial velocity in the cells \\[m/s\\]."""
        return self._elements.of_cells(self._state)[0]

    @property
    def velocity(self) -> Matrix:
        """Velocity between the particles in the cells \\[m/s\\]."""
        found: Matrix = self.flux / self._response.porosity[:, None]
        return found

    @property
    def pressure(self) -> tuple[Matrix, Vector]:
        """Corners of the cells \\[m\\] and the pressure there \\[Pa\\]."""
        return self._elements.corners, self._state[self._elements.flows :]

    def predict(self, force: Vector, step: Step) -> Vector:
        """Velocities at the end and pressure gradients under this response of the particles; changes nothing."""
        response = self._side.response(force)
        flux, gradient = self._elements.of_cells(self._solved(response, step))
        return np.concatenate([(flux / response.porosity[:, None]).ravel(), gradient.ravel()])

    def _solved(self, response: Response, step: Step) -> Vector:
        """Superficial velocities and pressures at the end of a step."""
        volume, porosity = self._elements.volume, response.porosity
        resisted = 0.5 * response.coefficient / (volume * porosity)
        still = response.drag_at(0.0 * response.velocity) / volume
        # Spread evenly it is held by a pressure and moves nothing; so the sum is what the particles felt.
        even = response.pressure_left(volume).mean(axis=0) / volume
        weight = porosity[:, None] * self.rest
        inertia = self.density / step.length
        return self._elements.solved(
            (inertia + resisted, self.viscosity, porosity),
            still + even + weight,
            response.solid_flux,
            inertia,
            self._state,
            {name: _at(excess, step.middle) for name, excess in self.open.items()},
        )

    def compliance(self, step: Step) -> Matrix:
        """Not told: what the particles do in return is no elastic answer."""
        raise ValueError("PlaneFlow: has no compliance; take QuasiNewton")

    def weights(self, step: Step) -> Vector:
        """How velocities \\[m/s\\] and pressure gradients \\[Pa/m\\] compare: these by what they do to the fluid."""
        half = len(self.displacement) // 2
        return np.concatenate([np.ones(half), np.full(half, self.density / step.length)])

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None:
        """Makes the step under this response, and then stands where the particles stand."""
        self._response = self._side.response(force)
        self._state = self._solved(self._response, step)
        self.displacement = displacement

    def settings(self) -> dict[str, Any]:
        """What it was made with."""
        return {name: getattr(self, name) for name in ("density", "viscosity", "rest", "sides", "open", "cells")}

    def memory(self) -> Any:
        """What its steps change."""
        return self.displacement, self._state, list(vars(self._response).values())

    def recall(self, memory: Any) -> None:
        """Restores what `memory` returned."""
        self.displacement, self._state, response = memory
        self._response = Response(*response)


#: Velocities on stretches of a side.
Stretches = dict[tuple[float, float], Given]


def _stretches(through: Through) -> Stretches:
    """Stretches of a side with their velocities."""
    if not isinstance(through, Mapping):
        through = {(-np.inf, np.inf): through}
    return {(float(begin), float(end)): velocity for (begin, end), velocity in through.items()}


def _at(excess: Excess, time: float) -> float:
    """A pressure at this time \\[Pa\\]."""
    return excess(time) if callable(excess) else excess


class _Elements:
    """Quadrilaterals of Taylor and Hood on the cells of a grid, with its boundary conditions."""

    def __init__(self, side: FluidInterface, given: Mapping[str, Stretches], rest: Vector) -> None:
        fem = needed("skfem", "elements")
        helpers = needed("skfem.helpers", "elements")
        places = ["xyz".index(axis) for axis in side.axes]
        centres = side.cells.centres[:, places]
        self.volume = float(side.cells.volumes[0])
        lines = [_faces(np.unique(np.round(centres[:, axis], 12))) for axis in range(2)]
        self.counts = (len(lines[0]) - 1, len(lines[1]) - 1)
        if self.counts[0] * self.counts[1] != len(centres) or not np.allclose(side.cells.volumes, self.volume):
            raise ValueError(f"plane: expected one layer of equal cells along {side.axes}, found {side.cells!r}")
        mesh = fem.MeshQuad.init_tensor(*lines)
        self._flow = fem.Basis(mesh, fem.ElementVector(fem.ElementQuad2()), intorder=4)
        self._pressure = self._flow.with_element(fem.ElementQuad1())
        self._cells = self._flow.with_element(fem.ElementQuad0())
        self.flows = self._flow.N
        # From cells of the mesh to those of the unit.
        middles = mesh.p[:, mesh.t].mean(axis=1).T
        apart = np.abs(centres[:, None] - middles[None]).sum(axis=2)
        self._of = apart.argmin(axis=1)
        self._to = np.argsort(self._of)
        self._areas = np.array([np.prod([np.ptp(line) for line in mesh.p[:, cell]]) for cell in mesh.t.T])
        self.corners = mesh.p.T
        self._assemble(fem, helpers)
        self._bound(fem, mesh, side.axes, given, rest)

    def _assemble(self, fem: Any, helpers: Any) -> None:
        """The matrices that do not change, and forms of those that do."""
        dot, grad, ddot = helpers.dot, helpers.grad, helpers.ddot
        self._viscous = fem.BilinearForm(lambda u, v, w: ddot(grad(u), grad(v))).assemble(self._flow)
        self._mass = fem.BilinearForm(lambda u, v, w: w.cell * dot(u, v))
        self._gradient = fem.BilinearForm(lambda p, v, w: w.cell * dot(grad(p), v))
        # ∫ ∇q·U, of which the continuity is made.
        self._flux = fem.BilinearForm(lambda u, q, w: dot(u, grad(q))).assemble(self._flow, self._pressure)
        self._push = fem.LinearForm(lambda v, w: w.first * v[0] + w.second * v[1])
        self._source = fem.LinearForm(lambda q, w: w.first * grad(q)[0] + w.second * grad(q)[1])
        means = [fem.BilinearForm(lambda u, r, w, axis=axis: u[axis] * r) for axis in range(2)]
        slopes = [fem.BilinearForm(lambda p, r, w, axis=axis: grad(p)[axis] * r) for axis in range(2)]
        self._means = [form.assemble(self._flow, self._cells) for form in means]
        self._slopes = [form.assemble(self._pressure, self._cells) for form in slopes]
        self._own = self._cells.element_dofs[0]

    def _bound(self, fem: Any, mesh: Any, axes: str, given: Mapping[str, Stretches], rest: Vector) -> None:
        """What is known: velocities of walls and inlets, pressures of open sides, what flows through the sides."""
        self._known = np.zeros(self._flow.N + self._pressure.N, dtype=bool)
        self._values = np.zeros(len(self._known))
        self._through = np.zeros(self._pressure.N)
        self._open: dict[str, Any] = {}
        at_rest = rest @ self._pressure.doflocs
        for axis, end in itertools.product(range(2), SIDES):
            place = mesh.p[axis].min() if end == "low" else mesh.p[axis].max()
            facets = mesh.facets_satisfying(lambda x, axis=axis, place=place: np.isclose(x[axis], place))
            middles = mesh.p[1 - axis][mesh.facets[:, facets]].mean(axis=0)
            left = np.ones(len(facets), dtype=bool)
            for (begin, finish), velocity in given.get(f"{axes[axis]}_{end}", {}).items():
                within = (middles > begin) & (middles < finish)
                left &= ~within
                self._let_through(fem, mesh, facets[within], velocity, axis, 1.0 if end == "high" else -1.0)
            if left.any():
                dofs = self.flows + self._pressure.get_dofs(facets[left]).all()
                self._open[f"{axes[axis]}_{end}"] = dofs
                self._known[dofs] = True
                self._values[dofs] = at_rest[dofs - self.flows]
        if not self._open:
            raise ValueError("velocity: expected a side that is open, found none: the pressure would be unknown")

    def _let_through(self, fem: Any, mesh: Any, facets: Any, velocity: Any, axis: int, outwards: float) -> None:
        """Velocities on these facets, and what flows through them."""
        if not len(facets):
            raise ValueError("velocity: expected stretches of a cell and more, found one without")
        if velocity[axis] is None:
            raise ValueError(f"velocity: expected a number across a side, found {velocity}")
        for number, component in enumerate(velocity):
            if component is not None:
                dofs = self._flow.get_dofs(facets).all(f"u^{number + 1}")
                self._known[dofs] = True
                self._values[dofs] = component
        boundary = fem.FacetBasis(mesh, fem.ElementQuad1(), facets=facets)
        leaving = velocity[axis] * outwards
        self._through += fem.LinearForm(lambda q, w: leaving * q).assemble(boundary)

    def is_open(self, name: str) -> bool:
        """Whether a part of a side has a pressure."""
        return name in self._open

    def _field(self, values: Vector) -> Any:
        """Numbers of the unit's cells as a field."""
        own = np.zeros(len(values))
        own[self._own] = values[self._to]
        return self._cells.interpolate(own)

    def started(self, flux: Matrix) -> Vector:
        """Velocities and pressures at the start: these in the cells, and the fluid at rest."""
        found = self._values.copy()
        inertia = np.ones(len(flux))
        mass = self._mass.assemble(self._flow, cell=self._field(inertia))
        right = self._push.assemble(self._flow, first=self._field(flux[:, 0]), second=self._field(flux[:, 1]))
        found[: self.flows] = splu(csc_matrix(mass)).solve(right)
        return found

    def solved(
        self,
        coefficients: tuple[Vector, float, Vector],
        push: Matrix,
        solid: Matrix,
        inertia: float,
        before: Vector,
        excess: Mapping[str, float],
    ) -> Vector:
        """Velocities and pressures of a step; coefficients are those of U, of its Laplacian and of the gradient."""
        resisted, viscosity, porosity = coefficients
        mass = self._mass.assemble(self._flow, cell=self._field(resisted)) + viscosity * self._viscous
        gradient = self._gradient.assemble(self._pressure, self._flow, cell=self._field(porosity))
        kept = self._mass.assemble(self._flow, cell=self._field(np.full(len(push), inertia))) @ before[: self.flows]
        right = kept + self._push.assemble(self._flow, first=self._field(push[:, 0]), second=self._field(push[:, 1]))
        source = self._source.assemble(self._pressure, first=self._field(solid[:, 0]), second=self._field(solid[:, 1]))
        matrix = csc_matrix(bmat([[mass, gradient], [self._flux, None]]))
        free = ~self._known
        found = self._values.copy()
        for name, pressure in excess.items():
            found[self._open[name]] = self._values[self._open[name]] + pressure
        rest = np.concatenate([right, self._through - source]) - matrix @ found
        found[free] = splu(matrix[free][:, free]).solve(rest[free])
        return found

    def of_cells(self, state: Vector) -> tuple[Matrix, Matrix]:
        """Means of the superficial velocity \\[m/s\\] and of the pressure gradient \\[Pa/m\\] over the unit's cells."""
        flow, pressure = np.split(state, [self.flows])
        flux = np.array([(mean @ flow)[self._own] / self._areas for mean in self._means]).T
        gradient = np.array([(slope @ pressure)[self._own] / self._areas for slope in self._slopes]).T
        return flux[self._of], gradient[self._of]


def _faces(centres: Vector) -> Vector:
    """Places of the faces between and around cells with these centres."""
    if len(centres) < 2:
        raise ValueError("plane: expected two cells at least along each axis, found one")
    half = 0.5 * float(centres[1] - centres[0])
    return np.concatenate([centres - half, centres[-1:] + half])
