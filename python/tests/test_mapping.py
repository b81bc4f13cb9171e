"""A mapping between two meshes of one surface: rigid motion, sums of forces and moments, work."""

import numpy as np
import pytest

from cograin import Mapping


def sheet(cells, lift, seed, half=0.5):
    """Nodes and triangles of a square mesh on a curved surface, corners inside shifted at random."""
    rng = np.random.default_rng(seed)
    grid = np.linspace(-half, half, cells + 1)
    x, y = (part.copy() for part in np.meshgrid(grid, grid, indexing="ij"))
    inside = (slice(1, -1), slice(1, -1))
    for part in (x, y):
        part[inside] += 0.25 / cells * rng.uniform(-1, 1, part[inside].shape)
    nodes = np.stack([x, y, lift * (x**2 - 0.5 * y)], axis=2).reshape(-1, 3)
    number = np.arange((cells + 1) ** 2).reshape(cells + 1, -1)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    triangles = np.concatenate([np.stack(part, axis=2).reshape(-1, 3) for part in ((a, b, c), (a, c, d))])
    return nodes, triangles


def rigid(places, turn=(0.2, -0.3, 0.1)):
    """A small rigid motion of these places."""
    return np.array([0.3, -0.1, 0.2]) + np.cross(turn, places)


@pytest.mark.parametrize("turning", [False, True])
@pytest.mark.parametrize("cells", [3, 17])
def test_on_one_plane_rigid_motion_force_and_moment_are_exact(cells, turning):
    nodes, triangles = sheet(7, 0.0, 1)
    points, _ = sheet(cells, 0.0, 2)
    mapping = Mapping(nodes, triangles, points, turning=turning)
    assert mapping.distance.max() < 1e-15
    assert np.abs(mapping.displacement(rigid(nodes)) - rigid(points)).max() < 1e-14
    forces = np.random.default_rng(3).normal(size=points.shape)
    found = mapping.force(forces)
    assert np.abs(found.sum(axis=0) - forces.sum(axis=0)).max() < 1e-12
    moments = np.cross(nodes, found).sum(axis=0) - np.cross(points, forces).sum(axis=0)
    assert np.abs(moments).max() < 1e-12


def test_between_curved_meshes_only_the_moment_errs_by_no_more_than_the_distance_and_turning_mends_it():
    nodes, triangles = sheet(6, 0.4, 1)
    points, _ = sheet(13, 0.4, 2)
    forces = np.random.default_rng(3).normal(size=points.shape)
    for turning in (False, True):
        mapping = Mapping(nodes, triangles, points, turning=turning)
        assert 1e-4 < mapping.distance.max() < 0.01
        found = mapping.force(forces)
        assert np.abs(found.sum(axis=0) - forces.sum(axis=0)).max() < 1e-12
        error = np.cross(nodes, found).sum(axis=0) - np.cross(points, forces).sum(axis=0)
        bound = (mapping.distance * np.linalg.norm(forces, axis=1)).sum()
        off = np.abs(mapping.displacement(rigid(nodes)) - rigid(points)).max()
        shifted = np.ones((len(nodes), 3))
        assert np.abs(mapping.displacement(shifted) - 1.0).max() < 1e-14
        if turning:
            assert np.linalg.norm(error) < 1e-12 and off < 1e-14
        else:
            assert 1e-6 < np.linalg.norm(error) < bound and 1e-6 < off < 0.4 * mapping.distance.max()


def test_both_sides_do_the_same_work_whatever_the_forces_and_displacements():
    rng = np.random.default_rng(5)
    nodes, triangles = sheet(6, 0.4, 1)
    points, _ = sheet(13, 0.5, 2, half=0.55)
    for turning in (False, True):
        mapping = Mapping(nodes, triangles, points, turning=turning)
        forces, moved = rng.normal(size=points.shape), rng.normal(size=nodes.shape)
        one, other = (mapping.force(forces) * moved).sum(), (forces * mapping.displacement(moved)).sum()
        assert abs(one - other) < 1e-12 * np.abs(forces).sum()


def test_every_point_finds_the_nearest_place_of_all_triangles():
    rng = np.random.default_rng(8)
    nodes, triangles = sheet(5, 0.8, 1)
    points = rng.uniform(-1.0, 1.0, (60, 3))
    mapping = Mapping(nodes, triangles, points)
    # Many places on every triangle: none is nearer.
    shares = rng.dirichlet((0.7, 0.7, 0.7), 400)
    places = np.einsum("sc,tci->tsi", shares, nodes[triangles]).reshape(-1, 3)
    sampled = np.linalg.norm(points[:, None] - places[None], axis=2).min(axis=1)
    assert (mapping.distance <= sampled + 1e-12).all()
    assert (sampled - mapping.distance).max() < 0.05


def test_an_edge_and_a_corner_are_the_nearest_places_outside():
    mapping = Mapping([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [[0.25, -1, 0], [-1, -1, 2], [2, 2, 0]])
    assert mapping.matrix.toarray()[::3, ::3] == pytest.approx(np.array([[0.75, 0.25, 0], [1, 0, 0], [0, 0.5, 0.5]]))
    assert mapping.distance == pytest.approx([1.0, np.sqrt(6.0), np.sqrt(4.5)])


def test_what_is_no_mesh_is_refused_in_words():
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    with pytest.raises(ValueError, match=r"triangles: expected nodes from 0 to 2, found 0 to 3"):
        Mapping(square, [[0, 1, 3]], square)
    with pytest.raises(ValueError, match="triangles: row 0 has no area"):
        Mapping([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]], square)
    with pytest.raises(ValueError, match=r"points: expected rows of three, found an array of \(3,\)"):
        Mapping(square, [[0, 1, 2]], [0, 0, 0])
    with pytest.raises(ValueError, match="nodes: expected finite numbers"):
        Mapping([[0, 0, np.nan], [1, 0, 0], [1, 1, 0]], [[0, 1, 2]], square)
    with pytest.raises(ValueError, match=r"forces on the points: expected an array of \(3, 3\), found \(2, 3\)"):
        Mapping(square, [[0, 1, 2]], square).force(np.zeros((2, 3)))
