"""A warm plate: finite elements of its length and thickness, with a heater below and a draught around the lower side."""

from dataclasses import dataclass

import numpy as np
import skfem
from cograin import HeatCapacity
from skfem.helpers import dot, grad


@dataclass(frozen=True)
class Design:
    """What the plate is made of."""

    length: float = 0.08  # along the slope [m]
    width: float = 0.012  # between the side walls [m]
    thickness: float = 1.0e-3  # [m]
    density: float = 2700.0  # [kg/m³]
    specific_heat: float = 900.0  # [J/(kg K)]
    conductivity: float = 200.0  # [W/(m K)]
    draught: float = 30.0  # heat transfer coefficient of the lower side [W/(m² K)]
    ambient: float = 300.0  # [K]
    start: float = 500.0  # temperature at time 0 [K]
    heater: tuple[float, float] = (0.02, 0.06)  # where it is, along the slope [m]


class Plate(HeatCapacity):
    """The plate; its interface is the mean temperature of the upper side, over which the grains' heat is spread evenly."""

    def __init__(self, design, power=lambda time: 0.0, cells=(40, 4)):
        across = np.linspace(-design.thickness, 0.0, cells[1] + 1)
        mesh = skfem.MeshQuad.init_tensor(np.linspace(0.0, design.length, cells[0] + 1), across)
        basis = skfem.Basis(mesh, skfem.ElementQuad2())
        upper, lower = (
            skfem.FacetBasis(mesh, skfem.ElementQuad2(), facets=mesh.facets_satisfying(lambda x, z=z: np.isclose(x[1], z)))
            for z in (0.0, -design.thickness)
        )
        store = design.density * design.specific_heat * design.width
        capacity = skfem.BilinearForm(lambda u, v, _: store * u * v).assemble(basis)
        lead = design.conductivity * design.width
        conductance = skfem.BilinearForm(lambda u, v, _: lead * dot(grad(u), grad(v))).assemble(basis)
        leave = design.draught * design.width
        conductance = conductance + skfem.BilinearForm(lambda u, v, _: leave * u * v).assemble(lower)
        mean = skfem.LinearForm(lambda v, _: v / design.length).assemble(upper)
        begin, end = design.heater
        warm = skfem.LinearForm(lambda v, w: v * ((w.x[0] > begin) & (w.x[0] < end)) / (end - begin)).assemble(lower)
        super().__init__(
            capacity.tocsr(),
            conductance.tocsr(),
            start=design.start,
            ambient=design.ambient,
            at=mean[:, None],
            load=lambda time: warm * power(time),
        )
        self.design, self.mesh = design, mesh
        self.corners = basis.nodal_dofs[0]  # degrees of freedom at the corners of the elements
        self.draught = skfem.LinearForm(lambda v, _: leave * v).assemble(lower)  # of each degree of freedom [W/K]

    def leaving(self):
        """Heat flow into the draught \\[W\\], from the temperatures themselves and not from the book."""
        return float(self.draught @ (self.temperature - self.design.ambient))
