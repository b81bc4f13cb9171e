"""An elastic plate on four supported edges: finite elements as a partner of the grains, and the closed solution.

Kirchhoff's plate by the elements of Bogner, Fox and Schmit (bicubic, with continuous slopes) from scikit-fem; the time
stepping is that of `cograin.Structure`. Deflections are counted from the shape under the plate's own weight; z points up.
"""

from dataclasses import dataclass

import numpy as np
import skfem
from cograin import Mapping, Structure
from skfem.helpers import dd, ddot, eye, trace


@dataclass(frozen=True)
class Design:
    """What the plate is made of."""

    span: float = 0.12  # of each edge [m]
    thickness: float = 2.0e-3  # [m]
    youngs_modulus: float = 3.0e9  # [Pa]
    poissons_ratio: float = 0.35
    density: float = 1190.0  # [kg/m³]
    damping_time: float = 2e-3  # damping matrix over stiffness matrix [s]

    @property
    def rigidity(self):
        """Bending stiffness of a unit of width [N m]."""
        return self.youngs_modulus * self.thickness**3 / (12.0 * (1.0 - self.poissons_ratio**2))

    @property
    def mass(self):
        """Mass of the plate [kg]."""
        return self.density * self.thickness * self.span**2


class Plate(Structure):
    """The plate in motion; the directions of its interface are the deflections of its inner nodes.

    `load(time)` [N] acts there as well.
    """

    def __init__(self, design, cells, load=None):
        grid = np.linspace(0.0, design.span, cells + 1)
        mesh = skfem.MeshQuad.init_tensor(grid, grid)
        basis = skfem.Basis(mesh, skfem.ElementQuadBFS())
        ratio = design.poissons_ratio

        def moment(curvature):
            return design.rigidity * ((1.0 - ratio) * curvature + ratio * eye(trace(curvature), 2))

        stiffness = skfem.BilinearForm(lambda u, v, _: ddot(moment(dd(u)), dd(v))).assemble(basis)
        surface = design.density * design.thickness
        mass = skfem.BilinearForm(lambda u, v, _: surface * u * v).assemble(basis)
        deflection, slope_x, slope_y, _twist = basis.nodal_dofs
        x, y = mesh.p
        on_x, on_y = (np.isclose(part * (design.span - part), 0.0) for part in (x, y))
        # Along a support nothing bends: the deflection and its slope along the edge are 0.
        fixed = np.concatenate([deflection[on_x | on_y], slope_y[on_x], slope_x[on_y]])
        self.inside = np.flatnonzero(~(on_x | on_y))
        self.nodes = deflection
        super().__init__(
            mass.tocsr(),
            stiffness.tocsr(),
            design.damping_time * stiffness.tocsr(),
            at=deflection[self.inside],
            fixed=np.unique(fixed),
            load=None if load is None else self._spread(load),
        )
        self.design, self.cells = design, cells
        self.places = np.column_stack([x, y, 0.0 * x])
        a, b, c, d = mesh.t
        self.triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
        self.middle = int(np.argmin(np.hypot(x - 0.5 * design.span, y - 0.5 * design.span)))

    def _spread(self, load):
        """A load on the inner nodes as one on all degrees of freedom."""

        def everywhere(time):
            forces = np.zeros(4 * len(self.nodes))
            forces[self.nodes[self.inside]] = load(time)
            return forces

        return everywhere

    def through(self, skin):
        """Deflections of the nodes of a skin (rows) from those of the inner nodes of the plate (columns)."""
        return Mapping(self.places, self.triangles, skin).matrix[2::3, 2::3][:, self.inside].tocsr()

    @property
    def deflections(self):
        """Deflections of all nodes [m]."""
        return self.field[self.nodes]


def navier(design, places, forces, terms=199):
    """Deflection of the middle of the plate at rest under forces at places (n, 2), by Navier's double series [m]."""
    numbers = np.pi * np.arange(1, terms + 1) / design.span
    along, across = (np.sin(np.multiply.outer(numbers, places[:, axis])) for axis in (0, 1))
    loads = 4.0 / design.span**2 * (along * forces) @ across.T
    return _middle(design, numbers, loads)


def navier_evenly(design, force, terms=199):
    """The same under a force that is spread out evenly over the plate [m]."""
    numbers = np.pi * np.arange(1, terms + 1) / design.span
    mean = (1.0 - np.cos(numbers * design.span)) / (numbers * design.span)
    return _middle(design, numbers, 4.0 * force / design.span**2 * np.outer(mean, mean))


def _middle(design, numbers, loads):
    """Deflection of the middle under the waves of a pressure [m]."""
    seen = np.sin(0.5 * numbers * design.span)
    return float(seen @ (loads / (design.rigidity * np.add.outer(numbers**2, numbers**2) ** 2)) @ seen)
