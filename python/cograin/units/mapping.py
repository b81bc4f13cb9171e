"""From one mesh of a surface to another one that does not match it: displacements there, forces back."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cograin.base.vector import Matrix, Vector


class Mapping:
    """Displacements of the nodes of one mesh as those of the points of another; forces there as forces of the nodes.

    Each point has its nearest place on the triangles of the mesh (*nearest projection*) and takes the displacement
    there, between the corners by the shares of areas: u = H U. Forces go back by the transpose, F = Hᵀ f. So both
    sides do the same work, F·U = f·u, whatever they are, and the sum of forces stays. A point that is away from its
    projection takes only the displacement of the latter: a translation is exact, a rotation θ errs by θ × distance,
    the moment by distance × force.

    With ``turning=True`` a point also turns with its triangle about its projection. Then small rigid motions and
    moments are exact at any distance: the way from the middle of a plate to its upper side.

    ``nodes`` (n, 3) \\[m\\] and ``triangles`` (m, 3) are those of the one mesh, ``points`` (k, 3) \\[m\\] of the other.
    `matrix` is H as a sparse matrix of scipy, (3 k, 3 n), over x, y, z of the first point, then of the second one: the
    ``through`` of an `Interface`.
    """

    def __init__(self, nodes: ArrayLike, triangles: ArrayLike, points: ArrayLike, *, turning: bool = False) -> None:
        import scipy.sparse

        corners, faces, targets = _checked(nodes, triangles, points)
        found = _nearest(corners, faces, targets)
        rows = np.repeat(np.arange(len(targets)), 3)
        shape = (len(targets), len(corners))
        #: What each point has of each node, (k, n), a sparse matrix of scipy: the ``through`` of temperatures.
        self.shares: Any = scipy.sparse.csr_matrix(
            (found.shares.ravel(), (rows, faces[found.triangle].ravel())), shape=shape
        )
        matrix = scipy.sparse.kron(self.shares, scipy.sparse.identity(3))
        projections = self.shares @ corners
        #: How far each point is from its projection \\[m\\].
        self.distance: Vector = np.linalg.norm(targets - projections, axis=1)
        #: The triangle of each point.
        self.triangle = found.triangle
        if turning:
            matrix = matrix + _turned(corners, faces[found.triangle], targets - projections)
        self.matrix: Any = matrix.tocsr()
        self._back: Any = self.matrix.T.tocsr()

    def displacement(self, of_nodes: ArrayLike) -> Matrix:
        """Displacements of the points (k, 3) from those of the nodes (n, 3)."""
        return _through(self.matrix, of_nodes, "displacements of the nodes")

    def force(self, of_points: ArrayLike) -> Matrix:
        """Forces on the nodes (n, 3) from those on the points (k, 3)."""
        return _through(self._back, of_points, "forces on the points")

    def temperature(self, of_nodes: ArrayLike) -> Vector:
        """Temperatures of the points (k,) from those of the nodes (n,)."""
        return _shared(self.shares, of_nodes, "temperatures of the nodes")

    def heat_flow(self, of_points: ArrayLike) -> Vector:
        """Heat flows into the nodes (n,) from those into the points (k,); their sum stays."""
        return _shared(self.shares.T, of_points, "heat flows into the points")


class _Found:
    """The triangle that is nearest to each point, and the shares of its corners in the projection."""

    def __init__(self, triangle: NDArray[np.int64], shares: Matrix) -> None:
        self.triangle = triangle
        self.shares = shares


def _through(matrix: Any, values: ArrayLike, what: str) -> Matrix:
    """The product of a matrix with rows of three."""
    rows = np.asarray(values, dtype=float)
    right = (matrix.shape[1] // 3, 3)
    if rows.shape != right:
        raise ValueError(f"{what}: expected an array of {right}, found {rows.shape}")
    found: Matrix = (matrix @ rows.ravel()).reshape(-1, 3)
    return found


def _shared(matrix: Any, values: ArrayLike, what: str) -> Vector:
    """The product of a matrix with numbers."""
    numbers = np.asarray(values, dtype=float)
    if numbers.shape != (matrix.shape[1],):
        raise ValueError(f"{what}: expected an array of ({matrix.shape[1]},), found {numbers.shape}")
    found: Vector = matrix @ numbers
    return found


def _checked(nodes: ArrayLike, triangles: ArrayLike, points: ArrayLike) -> tuple[Matrix, NDArray[np.int64], Matrix]:
    """The arrays of a mapping, refused where they cannot be."""
    corners, targets = np.asarray(nodes, dtype=float), np.asarray(points, dtype=float)
    faces = np.asarray(triangles, dtype=np.int64)
    for name, rows in (("nodes", corners), ("triangles", faces), ("points", targets)):
        if rows.ndim != 2 or rows.shape[1] != 3 or len(rows) == 0:
            raise ValueError(f"{name}: expected rows of three, found an array of {rows.shape}")
        if not np.all(np.isfinite(rows)):
            raise ValueError(f"{name}: expected finite numbers, found others")
    if faces.min() < 0 or faces.max() >= len(corners):
        raise ValueError(
            f"triangles: expected nodes from 0 to {len(corners) - 1}, found {faces.min()} to {faces.max()}"
        )
    a, b, c = (corners[faces[:, corner]] for corner in range(3))
    flat = np.linalg.norm(np.cross(b - a, c - a), axis=1) == 0.0
    if flat.any():
        raise ValueError(f"triangles: row {int(np.argmax(flat))} has no area")
    return corners, faces, targets


def _nearest(corners: Matrix, faces: NDArray[np.int64], points: Matrix) -> _Found:
    """The nearest triangle of each point. What may be nearer than the nearest corner is looked at, nothing else."""
    from scipy.spatial import cKDTree

    middles = corners[faces].mean(axis=1)
    size = float(np.linalg.norm(corners[faces] - middles[:, None], axis=2).max())
    used = np.unique(faces)
    nearest_corner, _ = cKDTree(corners[used]).query(points)
    candidates = cKDTree(middles).query_ball_point(points, nearest_corner + size * (1.0 + 1e-9), return_sorted=True)
    chosen, shares = np.empty(len(points), dtype=np.int64), np.empty((len(points), 3))
    for number, near in enumerate(candidates):
        weights = _shares(corners[faces[near]], points[number])
        projections = np.einsum("ij,ijk->ik", weights, corners[faces[near]])
        best = int(np.argmin(np.linalg.norm(projections - points[number], axis=1)))
        chosen[number], shares[number] = near[best], weights[best]
    return _Found(chosen, shares)


def _shares(triangles: Matrix, point: Vector) -> Matrix:
    """Shares of the corners of triangles (m, 3, 3) in the place of each that is nearest to a point."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = np.cross(b - a, c - a)
    square = np.einsum("ij,ij->i", normal, normal)

    def area(one: Matrix, other: Matrix) -> Vector:
        part: Vector = np.einsum("ij,ij->i", np.cross(one - point, other - point), normal) / square
        return part

    inside = np.stack([area(b, c), area(c, a), area(a, b)], axis=1)
    inside /= inside.sum(axis=1, keepdims=True)
    found, least = inside, np.where((inside >= 0.0).all(axis=1), 0.0, np.inf)
    outside = np.isinf(least)
    for first, second in ((0, 1), (1, 2), (2, 0)):
        begin, way = triangles[:, first], triangles[:, second] - triangles[:, first]
        share = np.clip(np.einsum("ij,ij->i", point - begin, way) / np.einsum("ij,ij->i", way, way), 0.0, 1.0)
        away = np.linalg.norm(begin + share[:, None] * way - point, axis=1)
        nearer = outside & (away < least)
        edge = np.zeros_like(found)
        edge[:, first], edge[:, second] = 1.0 - share, share
        found = np.where(nearer[:, None], edge, found)
        least = np.where(nearer, away, least)
    return found


def _turned(corners: Matrix, triangles: NDArray[np.int64], arms: Matrix) -> Any:
    """What the rotation of its triangle adds to the displacement of each point, an arm (k, 3) from its projection."""
    import scipy.sparse

    places = corners[triangles]
    a, b, c = places[:, 0], places[:, 1], places[:, 2]
    cross = np.cross(b - a, c - a)
    area = np.linalg.norm(cross, axis=1)
    normal = cross / area[:, None]
    middle = places.mean(axis=1)
    squares = ((places - middle[:, None]) ** 2).sum(axis=(1, 2))
    points = len(arms)
    matrix = scipy.sparse.csr_matrix((3 * points, 3 * len(corners)))
    rows = (3 * np.arange(points)[:, None, None] + np.arange(3)[None, :, None]).repeat(3, axis=2)
    for corner, opposite in enumerate((c - b, a - c, b - a)):
        # About axes in the plane by motion along the normal, about the normal by motion in the plane.
        tilt = np.einsum("ki,kj->kij", opposite / area[:, None], normal)
        radius = np.cross(normal, places[:, corner] - middle) / squares[:, None]
        spin = tilt + np.einsum("ki,kj->kij", normal, radius)
        # ω × arm, column by column.
        moved = np.cross(spin, arms[:, :, None], axis=1)
        columns = (3 * triangles[:, corner][:, None, None] + np.arange(3)[None, None, :]).repeat(3, axis=1)
        matrix = matrix + scipy.sparse.csr_matrix((moved.ravel(), (rows.ravel(), columns.ravel())), shape=matrix.shape)
    return matrix
