"""A partner that takes heat: capacities joined by conductances, of first order in time."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cograin.base.vector import Vector, vector
from cograin.partners.step import Step
from cograin.partners.structure import Load, Structure


class HeatCapacity(Structure):
    """C dT/dt + K (T − ambient) = heat flow of the particles + ``load``, in the temperatures T \\[K\\].

    ``capacity`` \\[J/K\\] and ``conductance`` \\[W/K\\] are numbers, diagonals, or matrices, as finite elements give
    them; ``at`` says which temperatures the interface has, as in a `Structure`. ``ambient`` \\[K\\] is where the
    conductance leads, ``start`` \\[K\\] the temperature at time 0. ``load(time)`` are other heat flows \\[W\\].
    Without any capacity (0) the conductance holds it: T = ambient + K⁻¹ heat flow at the end of a step.

    It is coupled by ``Interface(unit, "floor.temperature")``: temperatures in, mean heat flows of the particles into
    the boundary out. A step is that of a `Structure` without mass: the midpoint rule, of second order. What one side
    gives, the other one takes and keeps, to rounding: where both temperatures differ, at most by the tolerance of the
    exchange, each side keeps its own. Steps that are long against C/K let temperatures swing about their course.
    The book is ``heat + load_heat = stored + lost``.
    """

    def __init__(
        self,
        capacity: ArrayLike | Any,
        conductance: ArrayLike | Any = 0.0,
        *,
        start: ArrayLike = 0.0,
        ambient: float = 0.0,
        at: ArrayLike | None = None,
        load: Load | None = None,
        substeps: int = 1,
    ) -> None:
        self._base = 0.0
        super().__init__(0.0, conductance, capacity, at=at, load=self._flows, substeps=substeps)
        if not self.static and not (self.damping.diagonal() > 0.0).all():
            raise ValueError("capacity: expected numbers above 0, or 0 everywhere, found others")
        self.ambient = float(ambient)
        self._given = load
        self._leading = vector(self.stiffness @ np.ones(len(self.free)))  # to the ambient [W/K]
        self.place(start)

    def place(self, position: ArrayLike | None = None, velocity: ArrayLike | None = None) -> None:
        """Sets the temperatures \\[K\\]; the book begins anew. They have no velocity."""
        if velocity is not None:
            raise ValueError("HeatCapacity: expected temperatures, found velocities; heat has none")
        if position is not None:
            # Steps are made in differences to this one, so that small heats do not drown in 300 K [K].
            self._base = float(np.mean(vector(position)))
            super().place(vector(position) - self._base)
        self.displacement = self._at_interface(self.position)
        self._first = self.position.copy()
        self.heat = 0.0  # of the particles [J]
        self.load_heat = 0.0  # of the load [J]

    def _at_interface(self, position: Vector) -> Vector:
        """Temperatures of the interface at these differences \\[K\\]."""
        found: Vector = self.at.T @ position + self._base * self.at.sum(axis=0)
        return found

    @property
    def temperature(self) -> Vector:
        """Present temperatures \\[K\\]."""
        return self.position + self._base

    @property
    def field(self) -> Vector:
        """The same."""
        return self.temperature

    @property
    def stored(self) -> float:
        """Heat that it holds more than at the start \\[J\\]."""
        return float((self.damping @ (self.position - self._first)).sum())

    @property
    def lost(self) -> float:
        """Heat that went to the ambient, by the book \\[J\\]."""
        return self.heat + self.load_heat - self.stored

    def advance(self, force: Vector, displacement: Vector, step: Step) -> None:
        """Makes the step under this mean heat flow, and then has this temperature of the interface."""
        super().advance(force, displacement, step)
        self.heat += step.length * float((self.at @ force).sum())
        if self._given is not None:
            for middle, length in self._parts(step):
                self.load_heat += length * float(
                    np.sum(np.broadcast_to(vector(self._given(middle)), self.position.shape))
                )

    def drift(self, force: Vector, step: Step) -> Vector:
        """None: heat has no inertia."""
        raise ValueError("HeatCapacity: velocity Verlet needs a mass; heat has none")

    def _stand(self, displacement: Vector, force: Vector, step: Step) -> None:
        """The interface is where the units are. Its own temperatures stay: heat would come from nowhere."""
        self.displacement = displacement

    def memory(self) -> Any:
        return {**super().memory(), "heat": self.heat, "load_heat": self.load_heat}

    def _flows(self, time: float) -> Vector:
        """Heat flows of load and ambient \\[W\\], as far as they are not in the differences."""
        own = 0.0 if self._given is None else vector(self._given(time))
        return vector(self._leading * (self.ambient - self._base) + own)
