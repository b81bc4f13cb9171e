"""A block in plane strain at large deformation; its stress comes from one cell of grains for each integration point.

F = Q U with U upper triangular: U deforms the edges of a cell as `[cell]` writes them, Q turns them. So a cell is asked
for the strains of U, and its stress is turned by Q: what a material point feels does not depend on how it is turned.
"""

import numpy as np
from scipy.sparse.linalg import spsolve
from skfem import Basis, BilinearForm, ElementQuad2, ElementVector, FacetBasis, LinearForm, MeshQuad
from skfem.helpers import ddot, dot, grad


def triangular(gradient):
    """Q and the strains (xx, zz, xz) of U, of deformation gradients of shape (2, 2, ...)."""
    length = np.hypot(gradient[0, 0], gradient[1, 0])
    c, s = gradient[0, 0] / length, gradient[1, 0] / length
    turn = np.array([[c, -s], [s, c]])
    upper = np.einsum("ki...,kj...->ij...", turn, gradient)
    strains = np.array([np.log(upper[0, 0]), np.log(upper[1, 1]), upper[0, 1] / upper[1, 1]])
    return turn, strains


def cofactor(gradient):
    """det F times the transposed inverse of F."""
    return np.array([[gradient[1, 1], -gradient[1, 0]], [-gradient[0, 1], gradient[0, 0]]])


def piola(gradient, turn, stress):
    """First Piola-Kirchhoff stress of a cell's stress (xx, zz, xz)."""
    own = np.array([[stress[0], stress[2]], [stress[2], stress[1]]])
    return np.einsum("ik...,kl...,jl...,jm...->im...", turn, own, turn, cofactor(gradient))


def stiffness(gradient, stress, tangent):
    """dP/dF of shape (2, 2, 2, 2, ...), where stress and its tangent are those at the cell's strains."""
    result = np.empty((2, 2, *gradient.shape))
    by = 1e-7
    _, strains = triangular(gradient)
    for row, column in np.ndindex(2, 2):
        sides = []
        for sign in (1, -1):
            moved = gradient.copy()
            moved[row, column] += sign * by
            turn, there = triangular(moved)
            sides.append(piola(moved, turn, stress + np.einsum("ab...,b...->a...", tangent, there - strains)))
        result[:, :, row, column] = (sides[0] - sides[1]) / (2 * by)
    return result


@LinearForm
def inner(v, w):
    return ddot(w.stress, grad(v))


@BilinearForm
def change(u, v, w):
    return np.einsum("ijkl...,kl...,ij...->...", w.stiffness, grad(u), grad(v))


def normal(gradient, w):
    """The normal of a deformed side times its stretch: what a pressure acts along, wherever the side goes."""
    return np.einsum("ij...,j...->i...", cofactor(gradient), w.n)


@LinearForm
def membrane(v, w):
    gradient = grad(w.displacement) + np.eye(2)[:, :, None, None]
    return -w.pressure * dot(normal(gradient, w), v)


@BilinearForm
def membrane_change(u, v, w):
    return -w.pressure * dot(normal(grad(u), w), v)


class Block:
    """A block of width and height [m] between a rough floor and a rough lid, with `pressure` [Pa] on its sides."""

    def __init__(self, width, height, counts, pressure, *, rough=True):
        mesh = MeshQuad.init_tensor(np.linspace(0, width, counts[0] + 1), np.linspace(0, height, counts[1] + 1))
        self.mesh = mesh.with_boundaries({"sides": lambda x: np.isclose(x[0] * (width - x[0]), 0)})
        self.basis = Basis(self.mesh, ElementVector(ElementQuad2()), intorder=3)
        self.sides = FacetBasis(self.mesh, self.basis.elem, facets=self.mesh.boundaries["sides"], intorder=3)
        self.width, self.height, self.pressure = width, height, pressure
        x, z = self.basis.doflocs
        component = np.empty(self.basis.N, int)
        for index in range(2):
            component[self.basis.split_indices()[index]] = index
        self.lid = np.flatnonzero(np.isclose(z, height) & (component == 1))
        floor = np.isclose(z, 0) & (component == 1)
        still = (np.isclose(z, 0) | np.isclose(z, height)) & (component == 0)
        if not rough:
            still &= np.isclose(z, 0) & np.isclose(x, 0)
        self.fixed = np.flatnonzero(floor | still)
        self.free = np.setdiff1d(np.arange(self.basis.N), np.concatenate([self.fixed, self.lid]))

    @property
    def points(self):
        """Number of integration points."""
        return int(np.prod(self.basis.dx.shape))

    def gradients(self, displacement):
        """Deformation gradients, shape (2, 2, elements, points)."""
        return self.basis.interpolate(displacement).grad + np.eye(2)[:, :, None, None]

    def strains(self, displacement):
        """Strains of the cells, shape (points, 3)."""
        return triangular(self.gradients(displacement))[1].reshape(3, -1).T

    def forces(self, displacement, stresses):
        """Forces on the nodes that are out of balance [N/m]; those at held nodes are what holds them."""
        gradient = self.gradients(displacement)
        turn, _ = triangular(gradient)
        inside = inner.assemble(self.basis, stress=piola(gradient, turn, self._shaped(stresses)))
        outside = membrane.assemble(
            self.sides, displacement=self.sides.interpolate(displacement), pressure=self.pressure
        )
        return inside - outside

    def rest(self, forces):
        """What is out of balance at free nodes, over what the lid presses with."""
        return np.linalg.norm(forces[self.free]) / np.linalg.norm(forces[self.lid])

    def matrix(self, displacement, stresses, tangents):
        """How forces change with displacements [N/m²]."""
        gradient = self.gradients(displacement)
        tangent = np.moveaxis(tangents, 0, -1).reshape(3, 3, *self.basis.dx.shape)
        matrix = change.assemble(self.basis, stiffness=stiffness(gradient, self._shaped(stresses), tangent))
        return matrix - membrane_change.assemble(self.sides, pressure=self.pressure)

    def solve(self, displacement, stresses, tangents, forces):
        """The change of displacement that balances the forces, with held nodes as they are."""
        step = np.zeros(self.basis.N)
        matrix = self.matrix(displacement, stresses, tangents)
        step[self.free] = spsolve(matrix[self.free][:, self.free].tocsc(), -forces[self.free])
        return step

    def _shaped(self, stresses):
        return stresses.T.reshape(3, *self.basis.dx.shape)
