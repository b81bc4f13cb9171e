"""An elastic beam on two supports with a rigid plate on its middle: finite elements as a partner of the grains.

Cubic Hermite elements (Euler and Bernoulli) from scikit-fem, damping in proportion to the stiffness; the time stepping is
that of `cograin.Structure`. Deflections are counted from the shape that the beam has under its own weight; z points up.
"""

from dataclasses import dataclass

import numpy as np
import skfem
from cograin import Structure
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


class Beam(Structure):
    """The beam in motion; the interface is its middle, where another force may act: `force(time)` [N]."""

    def __init__(self, design, force=lambda time: 0.0):
        mesh = skfem.MeshLine(np.linspace(0.0, design.span, design.elements + 1))
        basis = skfem.Basis(mesh, skfem.ElementLineHermite())
        area = design.width * design.height
        bending = design.youngs_modulus * area * design.height**2 / 12.0
        stiffness = skfem.BilinearForm(lambda u, v, _: bending * dd(u)[0, 0] * dd(v)[0, 0]).assemble(basis)
        mass = skfem.BilinearForm(lambda u, v, _: design.density * area * u * v).assemble(basis).tolil()

        middle = basis.nodal_dofs[0, design.elements // 2]
        mass[middle, middle] += design.plate_mass
        at_middle = np.eye(basis.N)[middle]
        super().__init__(
            mass.tocsr(),
            stiffness,
            design.damping_time * stiffness,
            at=middle,
            fixed=basis.nodal_dofs[0, [0, -1]],
            load=lambda time: force(time) * at_middle,
        )
        self.nodes = basis.nodal_dofs[0]  # where the deflections stand, from left to right

    @property
    def deflection(self):
        """Height of the middle over where it hangs under the beam's own weight [m]."""
        return self.displacement[0]

    @property
    def static_compliance(self):
        """Deflection of the middle per unit force at rest [m/N]."""
        return self.at[:, 0] @ np.linalg.solve(self.stiffness.toarray(), self.at[:, 0])
