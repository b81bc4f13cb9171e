"""An elastic beam on two supports with a rigid plate on its middle, solved with dynamic finite elements.

Cubic Hermite elements (Euler and Bernoulli) from scikit-fem, Rayleigh damping, Newmark's average acceleration in time.
Deflections are counted from the shape that the beam has under its own weight; z points up.
"""

from dataclasses import dataclass

import numpy as np
import skfem
from scipy.linalg import lu_factor, lu_solve
from skfem.helpers import dd


@dataclass(frozen=True)
class Design:
    """What the beam and its plate are made of."""

    span: float = 0.4  # between the supports [m]
    width: float = 0.07  # of the cross-section [m]
    height: float = 0.009  # of the cross-section [m]
    youngs_modulus: float = 70e9  # [Pa]
    density: float = 2700.0  # [kg/m³]
    plate_mass: float = 0.5  # [kg]
    damping_time: float = 4e-3  # damping matrix over stiffness matrix [s]
    elements: int = 20

    @property
    def compliance(self):
        """Deflection of the middle per unit force on it, after Euler and Bernoulli [m/N]."""
        second_moment = self.width * self.height**3 / 12.0
        return self.span**3 / (48.0 * self.youngs_modulus * second_moment)


class Beam:
    """The beam in motion. All vectors hold the free degrees of freedom: deflections and slopes of the nodes."""

    def __init__(self, design):
        mesh = skfem.MeshLine(np.linspace(0.0, design.span, design.elements + 1))
        basis = skfem.Basis(mesh, skfem.ElementLineHermite())
        area = design.width * design.height
        bending = design.youngs_modulus * area * design.height**2 / 12.0
        stiffness = skfem.BilinearForm(lambda u, v, _: bending * dd(u)[0, 0] * dd(v)[0, 0]).assemble(basis).toarray()
        mass = skfem.BilinearForm(lambda u, v, _: design.density * area * u * v).assemble(basis).toarray()

        middle = basis.nodal_dofs[0, design.elements // 2]
        mass[middle, middle] += design.plate_mass
        free = basis.complement_dofs(basis.nodal_dofs[0, [0, -1]])
        self.stiffness = stiffness[np.ix_(free, free)]
        self.mass = mass[np.ix_(free, free)]
        self.damping = design.damping_time * self.stiffness
        self.middle = int(np.searchsorted(free, middle))
        # Where the deflections of the inner nodes stand, from left to right.
        self.deflections = np.searchsorted(free, basis.nodal_dofs[0, 1:-1])
        self.shape = np.zeros(len(free))
        self.velocity = np.zeros(len(free))
        self.interval = None
        self.damping_loss = 0.0

    @property
    def deflection(self):
        """Height of the middle over where it hangs under the beam's own weight [m]."""
        return self.shape[self.middle]

    @property
    def energy(self):
        """Kinetic and elastic energy of beam and plate [J]."""
        return 0.5 * (self.velocity @ self.mass @ self.velocity + self.shape @ self.stiffness @ self.shape)

    def prepare(self, interval):
        """Factorises the equations for steps of this length [s]."""
        half = 0.5 * interval
        self.interval = interval
        self.factors = lu_factor(self.mass + half * self.damping + half * half * self.stiffness)
        unit_force = np.zeros(len(self.shape))
        unit_force[self.middle] = 1.0
        # Mean velocity of a step per unit force on the middle.
        self.response = half * lu_solve(self.factors, unit_force)

    @property
    def step_compliance(self):
        """How far a unit force during one step moves the middle by the end of it [m/N]."""
        return self.interval * self.response[self.middle]

    def mean_velocity(self, force):
        """Mean velocity of the next step under a constant force on the middle [N].

        The average acceleration method is the implicit midpoint rule: the middle of the step obeys
        M (v̄ − v₀) 2/H = f − C v̄ − K (x₀ + v̄ H/2).
        """
        half = 0.5 * self.interval
        unforced = self.mass @ self.velocity - half * (self.stiffness @ self.shape)
        return lu_solve(self.factors, unforced) + force * self.response

    def predict(self, force):
        """Deflection of the middle at the end of the next step under this force [m]."""
        return self.deflection + self.interval * self.mean_velocity(force)[self.middle]

    def advance(self, force):
        """Takes the step; the loss in the damping and the change of the energy add up to the work of the force."""
        mean = self.mean_velocity(force)
        self.shape = self.shape + self.interval * mean
        self.velocity = 2.0 * mean - self.velocity
        self.damping_loss += self.interval * (mean @ self.damping @ mean)
