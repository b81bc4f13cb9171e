"""The fluid around the particles of a unit, cell by cell, and a column of it as a partner."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cograin.base.vector import Matrix, Vector, vector
from cograin.partners.step import Force, Step
from cograin.units.cells import Cells
from cograin.units.unit import State

if TYPE_CHECKING:
    from cograin.units.unit import Unit


#: Porosity that a fluid has at least: overlaps of particles count twice, and drag laws see no smaller one.
LEAST = 0.2


@dataclass(frozen=True)
class Response:
    """What the particles of a step do to the fluid in each cell, as straight lines in what the fluid does to them.

    Arrays are (cells, axes), or (cells,) where a cell has one number. ``velocity`` and ``pressure_gradient`` are those
    at which the particles made the step.
    """

    velocity: Matrix  # of the fluid at the end [m/s]
    pressure_gradient: Matrix  # [Pa/m]
    drag: Matrix  # mean of the particles on the fluid [N]
    pressure_force: Matrix  # likewise, by the pressure gradient [N]
    solid_flux: Matrix  # superficial velocity of the particles at the end [m/s]
    porosity: Vector  # at the end
    coefficient: Vector  # mean of drag over slip [N s/m]

    def drag_at(self, velocity: Matrix) -> Matrix:
        """Mean drag if the fluid had this velocity at the end, which it reaches on a ramp \\[N\\]."""
        found: Matrix = self.drag - 0.5 * self.coefficient[:, None] * (velocity - self.velocity)
        return found

    def pressure_left(self, volume: float) -> Matrix:
        """What the particles felt of the pressure beside (1 − ε) V ∇p in cells of this volume \\[m³\\] \\[N\\]."""
        solid = (1.0 - self.porosity) * volume
        found: Matrix = self.pressure_force - solid[:, None] * self.pressure_gradient
        return found


class FluidInterface:
    """The fluid of a unit, cell by cell, as a side of `couple`: velocities and pressure gradients in, drag out.

    The scene has ``[fluid.<name>]`` with a ``grid``, ``velocity = "driven"`` and ``pressure = "total"``. ``axes`` are
    those along which the partner moves the fluid: a `Column`, or a `cograin.plane_flow.PlaneFlow`. The exchange is
    `QuasiNewton`. ``density`` \\[kg/m³\\], ``viscosity`` \\[Pa s\\] and ``rest`` are those of the unit: this is the
    pressure gradient ρ g of the fluid at rest, along the axes \\[Pa/m\\].
    """

    keeps_itself = True
    has_derivatives = False
    work = None  # beside that of drag along the velocity, which is the same on both sides

    def __init__(self, unit: Unit, fluid: str, axes: str = "z") -> None:
        if not axes or len(set(axes)) < len(axes) or not set(axes) <= set("xyz"):
            raise ValueError(f"axes: expected some of x, y and z, found {axes!r}")
        self.units = [unit]
        self.cells: Cells = _solved(unit, fluid)
        self.axes = axes
        self.density, self.viscosity = (unit.number(f"fluid.{fluid}.{name}") for name in ("density", "viscosity"))
        described = [float(unit.variables[name].start) for name in self._names("pressure_gradient")[: len(axes)]]
        heavier = self.density / float(unit.variables[f"fluid.{fluid}.density"].start)
        self.rest: Vector = vector(described) * heavier
        self._given = tuple(name for quantity in ("velocity", "pressure_gradient") for name in self._names(quantity))
        answers = ("mean_drag", "mean_pressure_force", "mean_solid_flux")
        along = tuple(name for quantity in answers for name in self._names(quantity))
        self._read = (*along, *self.cells.names("porosity"), *self.cells.names("drag_coefficient"))
        self.displacement: Vector = unit.get(self._given)
        self._saved = self.displacement
        self._state: State | None = None

    def _names(self, quantity: str) -> tuple[str, ...]:
        """Names of the variables of a vector along the axes, cell after cell."""
        return tuple(name for name in self.cells.names(quantity) if name[-1] in self.axes)

    @property
    def names(self) -> list[str]:
        """Velocities of all cells, then pressure gradients."""
        return list(self._given)

    @property
    def answers(self) -> list[str]:
        """What the record shows of the particles: drags, forces of the pressure, porosities, coefficients."""
        return list(self._read)

    @property
    def time(self) -> float:
        """Present time of the unit \\[s\\]."""
        return self.units[0].time

    @property
    def can_restore(self) -> bool:
        """Whether the unit can restore a saved state."""
        return self.units[0].can_restore

    @property
    def _size(self) -> int:
        """How many numbers a vector of all cells has."""
        return len(self.cells) * len(self.axes)

    def response(self, force: Vector) -> Response:
        """What `force` gives, by its parts."""
        fields, rest = np.split(force, [5 * self._size])
        porosity, coefficient = rest.reshape(2, -1)
        velocity, gradient, drag, pressure, flux = fields.reshape(5, len(self.cells), len(self.axes))
        return Response(velocity, gradient, drag, pressure, flux, np.maximum(porosity, LEAST), coefficient)

    def force(self, kind: Force) -> Vector:
        """What the particles did in the last step, behind the velocities and gradients under which they did it."""
        return np.concatenate([self.displacement, self.units[0].get(self._read)])

    def told(self, displacement: Vector, force: Vector, kind: Force) -> tuple[Vector, Vector]:
        """Displacement and force as the unit calls them."""
        return displacement, force[len(displacement) :]

    def way(self, before: Vector, displacement: Vector, length: float) -> Vector:
        """Along which `force` does work: that of drag, along the mean velocity."""
        mean = 0.5 * length * (before + displacement)[: self._size]
        return np.concatenate([np.zeros(len(displacement)), mean, np.zeros(len(self._read) - len(mean))])

    def advance(self, displacement: Vector, step: Step, kind: Force) -> Vector:
        """Makes a step with these velocities at the end, and these pressure gradients; returns `force`."""
        self.units[0].set(self._given, displacement)
        self.units[0].step(step.length, until=step.end)
        self.displacement = displacement
        return self.force(kind)

    def save(self) -> None:
        """Saves the present state."""
        self._state = self.units[0].save(self._state)
        self._saved = self.displacement

    def restore(self) -> None:
        """Restores the saved state."""
        if self._state is not None:
            self.units[0].restore(self._state)
        self.displacement = self._saved

    def derivative(self, kind: Force) -> Matrix:
        """Not known."""
        raise ValueError(f"{self.units[0].name}: gives no derivatives of a fluid; take QuasiNewton")

    def settings(self) -> dict[str, Any]:
        """Which variables it joins, and where it stands."""
        return {"unit": self.units[0].name, "given": self._given, "displacement": self.displacement}

    def memory(self) -> Any:
        """The values that change in a step, without the unit."""
        return self.displacement

    def recall(self, memory: Any) -> None:
        """Restores what `memory` returned."""
        self.displacement = memory


def _solved(unit: Unit, fluid: str) -> Cells:
    """The cells of a fluid whose flow a partner solves; refuses others."""
    cells = unit.cells(fluid)
    if "velocity" not in cells.quantities:
        raise ValueError(f'{unit.name}: [fluid.{fluid}]: expected velocity = "driven", found another one')
    # Scenes are TOML 1.1, which Python's reader of TOML does not know. A scene has one fluid.
    scene = (unit.folder / "resources" / "scene.toml").read_text(encoding="utf-8")
    dynamic = re.search(r"""^[^#\n]*\bpressure["']?\s*=\s*["']dynamic["']""", scene, re.MULTILINE)
    if dynamic or "pressure_gradient" not in cells.quantities:
        found = '"dynamic"' if dynamic else "none"
        raise ValueError(f'{unit.name}: [fluid.{fluid}]: expected pressure = "total", found {found}')
    return cells


#: Velocity of what flows in \\[m/s\\], superficial: a number, or a function of time.
Inflow = float | Callable[[float], float]


class Column:
    """An incompressible fluid in a column of cells, one above the other, as a partner of a `FluidInterface`.

    Continuity gives the velocity u: ε u + the solid flux is ``inflow`` \\[m/s\\] in every cell, the superficial
    velocity of what flows in below (0: a closed bottom). Momentum gives the pressure gradient,

        ρ [∂(ε u)/∂t + ∂(ε u u)/∂z] = −ε ∂p/∂z + drag/V + ε ρ g,

    with drag as a straight line in u by the particles' own coefficient. What they felt of the pressure beside
    (1 − ε) V ∂p/∂z, in sum over the column, is spread evenly. ρ and g are those of the unit; p contains that of the
    fluid at rest.

    A step is implicit. What the fluid keeps is exact whatever is left between both sides: the volume by what the
    particles take up, the momentum by the forces that they found.
    """

    def __init__(self, side: FluidInterface, *, inflow: Inflow = 0.0) -> None:
        if len(side.axes) != 1:
            raise ValueError(f"a column has one axis, found an interface of {side.axes}")
        self.density, self.rest, self.inflow = side.density, float(side.rest[0]), inflow
        self._side = side
        self.height, self.volume = _stacked(side)
        response = side.response(side.force("mean"))
        self.displacement: Vector = vector(side.displacement)
        #: Porosity of the cells.
        self.porosity: Vector = response.porosity
        #: Velocity of the fluid between the particles \\[m/s\\].
        self.velocity: Vector = response.velocity[:, 0]
        #: Pressure gradient of the last step \\[Pa/m\\].
        self.pressure_gradient: Vector = response.pressure_gradient[:, 0]

    @property
    def momentum(self) -> float:
        """Momentum of the fluid along the column \\[N s\\]."""
        return float(self.density * self.volume * (self.porosity @ self.velocity))

    @property
    def pressure_drop(self) -> float:
        """Pressure at the bottom less that at the top, mean of the last step \\[Pa\\]."""
        return float(-self.height * self.pressure_gradient.sum())

    def predict(self, force: Vector, step: Step) -> Vector:
        """Velocities at the end and pressure gradients under this response of the particles; changes nothing."""
        response = self._side.response(force)
        velocity = self._velocity(response, step)
        drag = response.drag_at(velocity[:, None])[:, 0]
        even = response.pressure_left(self.volume).mean()
        left = self._left(response, velocity, step) + drag + even
        return np.concatenate([velocity, left / (self.volume * response.porosity)])

    def _through(self, time: float) -> float:
        """What flows in \\[m/s\\]."""
        return self.inflow(time) if callable(self.inflow) else self.inflow

    def _velocity(self, response: Response, step: Step) -> Vector:
        """Velocities at the end, by continuity \\[m/s\\]."""
        mean = 0.5 * (response.porosity + self.porosity)
        found: Vector = (self._through(step.middle) - response.solid_flux[:, 0]) / mean
        return found

    def _left(self, response: Response, velocity: Vector, step: Step) -> Vector:
        """What the fluid's own acceleration leaves of its weight \\[N\\]."""
        flux, through = response.porosity * velocity, self._through(step.middle)
        faces = np.concatenate([[through], 0.5 * (flux[1:] + flux[:-1]), [through]])
        ends = np.concatenate([velocity[:1], velocity, velocity[-1:]])
        conveyed = np.diff(faces * np.where(faces > 0.0, ends[:-1], ends[1:])) / self.height
        kept = (flux - self.porosity * self.velocity) / step.length
        mean = 0.5 * (response.porosity + self.porosity)
        found: Vector = self.volume * (mean * self.rest - self.density * (kept + conveyed))
        return found

    def compliance(self, step: Step) -> Matrix:
        """Not told: what the particles do in return is no elastic answer."""
        raise ValueError("Column: has no compliance; take QuasiNewton")

    def weights(self, step: Step) -> Vector:
        """How velocities \\[m/s\\] and pressure gradients \\[Pa/m\\] compare: these by what they do to the fluid."""
        cells = len(self.velocity)
        return np.concatenate([np.ones(cells), np.full(cells, self.density / step.length)])

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None:
        """Makes the step with the forces that the particles found, and then stands where they stand."""
        response = self._side.response(force)
        velocity = self._velocity(response, step)
        left = self._left(response, velocity, step) + response.drag[:, 0]
        # What is spread evenly makes the sum of −V ∇p + pressure force, as the particles found it, that of −ε V ∇p.
        full = (1.0 - response.porosity) / response.porosity
        even = (response.pressure_force.sum() - full @ left) / (len(left) + full.sum())
        self.pressure_gradient = (left + even) / (self.volume * response.porosity)
        self.velocity, self.porosity = velocity, response.porosity
        self.displacement = displacement

    def settings(self) -> dict[str, Any]:
        """What it was made with."""
        return {name: getattr(self, name) for name in ("density", "rest", "inflow", "height", "volume")}

    def memory(self) -> Any:
        """What its steps change."""
        return self.displacement, self.porosity, self.velocity, self.pressure_gradient

    def recall(self, memory: Any) -> None:
        """Restores what `memory` returned."""
        self.displacement, self.porosity, self.velocity, self.pressure_gradient = memory


def _stacked(side: FluidInterface) -> tuple[float, float]:
    """Height and volume of the cells of a column; refuses others."""
    centres, axis = side.cells.centres, "xyz".index(side.axes)
    across = np.delete(centres, axis, axis=1)
    ways = np.diff(centres[:, axis])
    if len(centres) < 2 or np.ptp(across, axis=0).any() or not np.allclose(ways, ways[0], rtol=1e-9):
        raise ValueError(f"column: expected cells one above the other along {side.axes}, found {side.cells!r}")
    return float(ways[0]), float(side.cells.volumes[0])
