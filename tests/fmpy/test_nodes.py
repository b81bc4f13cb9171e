"""A unit with a mesh whose nodes the master moves: arrays in a documented order, forces that balance, states."""

import fmpy
import numpy as np
import pytest
from cograin import Interface, Mapping, Step, StepDiscarded, Unit, UnitError
from fmpy.validation import validate_fmu

SIDE, PITCH = 7, 0.004  # nodes along an edge and their distance [m]

SCENE = """
gravity = [0.0, 0.0, -9.81]
[run]
step = 1.0e-5
threads = 2
[material.glass]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.3
friction = 0.4
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.bed]
material = "glass"

[particles.bed.lattice]
kind = "simple_cubic"
radius = 0.002
spacing = 0.00395
origin = [-0.0067, -0.0061, 0.00196]
counts = [4, 4, 2]

[boundary.skin]
material = "glass"
mesh = { file = "skin.obj" }
nodes = "driven"
[boundary.lid]
plane = { point = [0.0, 0.0, 0.0115], normal = [0.0, 0.0, -1.0] }
material = "glass"
motion = { driven = ["z"] }
"""


@pytest.fixture(scope="module")
def path(cograin, tmp_path_factory):
    """The unit."""
    folder = tmp_path_factory.mktemp("skin")
    grid = PITCH * (np.arange(SIDE) - 0.5 * (SIDE - 1))
    lines = [f"v {x:.17g} {y:.17g} 0.0" for x in grid for y in grid]
    for i in range(SIDE - 1):
        for j in range(SIDE - 1):
            a, b = i * SIDE + j + 1, (i + 1) * SIDE + j + 1
            lines += [f"f {a} {b} {b + 1}", f"f {a} {b + 1} {a + 1}"]
    (folder / "skin.obj").write_text("\n".join(lines) + "\n")
    (folder / "scene.toml").write_text(SCENE)
    cograin("export", folder / "scene.toml", "-o", folder / "skin.fmu", "--overwrite")
    return folder / "skin.fmu"


def wave(nodes, time):
    """Displacements of the nodes at a time [m]."""
    x, y, _ = nodes.places.T
    lift = 1e-4 * np.sin(300.0 * time) * np.cos(200.0 * x) + 5e-5 * time / 1e-2 * y / 0.01
    return np.stack([1e-3 * x * np.sin(100.0 * time), 0.0 * y, lift], axis=1)


def course(unit, first, last):
    """What the nodes give over some steps."""
    nodes, rows = unit.nodes("skin"), []
    for count in range(first, last):
        nodes.displacement = wave(nodes, 2e-4 * (count + 1))
        unit.step(2e-4)
        rows.append(np.concatenate([nodes.force, nodes.mean_force, nodes.displacement]).tolist())
    return rows


def test_the_description_is_valid_and_the_order_of_the_variables_is_that_of_the_table(path):
    description = fmpy.read_model_description(str(path), validate=True)
    assert not validate_fmu(str(path))
    with Unit(path) as unit:
        nodes = unit.nodes("skin")
        assert len(nodes) == SIDE * SIDE and nodes.triangles.shape == (2 * (SIDE - 1) ** 2, 3)
        assert np.allclose(nodes.places[1] - nodes.places[0], [PITCH, 0.0, 0.0])  # as the faces name them first
        references = [unit.variable(name).valueReference for name in nodes.names("displacement")]
        assert references == list(range(references[0], references[0] + 3 * len(nodes)))
        lines = (unit.folder / "resources" / "skin.nodes.csv").read_text().splitlines()
        assert lines[0] == "node,x,y,z" and lines[1] == "1,-0.012,-0.012,0.0"
        with pytest.raises(UnitError, match=r"lid has no nodes that can be moved; skin has nodes"):
            unit.nodes("lid")
        with pytest.raises(ValueError, match=r"displacement: expected an array of \(49, 3\), a row for each node, found \(3,\)"):
            nodes.displacement = np.zeros(3)
    unknown = {it.variable.name: it.dependencies for it in description.initialUnknowns}
    assert unknown["skin.node[49].force.z"] is None


def test_forces_moments_and_work_of_the_nodes_are_those_of_the_boundary(path):
    with Unit(path) as unit:
        nodes = unit.nodes("skin")
        names = [f"skin.{kind}.{axis}" for kind in ("force", "moment") for axis in "xyz"]
        work, turnover = 0.0, 0.0
        for count in range(40):
            before = nodes.displacement
            nodes.displacement = wave(nodes, 2e-4 * (count + 1))
            unit.step(2e-4)
            parts = nodes.mean_force * (nodes.displacement - before)
            work, turnover = work - parts.sum(), turnover + np.abs(parts).sum()
            force, places = nodes.force, nodes.places + nodes.displacement
            found = np.concatenate([force.sum(axis=0), np.cross(places, force).sum(axis=0)])
            scale = np.abs(force).sum() * np.repeat([1.0, 0.02], 3)
            assert (np.abs(found - unit.get(names)) <= 1e-12 * scale).all()
        assert turnover > 1e-8 and abs(unit["skin.work"] - work) < 1e-12 * turnover


def test_states_with_nodes_are_restored_and_read_elsewhere_bit_for_bit(path):
    with Unit(path) as unit, Unit(path, name="other") as other:
        course(unit, 0, 3)
        state = unit.save()
        first = course(unit, 3, 10)
        assert np.abs(first).max() > 1e-3
        unit.restore(state)
        assert course(unit, 3, 10) == first
        other.restore(other.deserialise(unit.serialise(state), state.time))
        assert course(other, 3, 10) == first


def test_start_values_are_taken_without_motion(path):
    with Unit(path, inputs={"skin.node[25].displacement.z": 1e-4}) as unit:
        nodes = unit.nodes("skin")
        assert nodes.displacement[24].tolist() == [0.0, 0.0, 1e-4]
        assert unit["skin.work"] == 0.0 and np.abs(nodes.force).max() > 0.0


def test_a_step_that_leaves_a_face_without_area_is_discarded_in_words(path):
    with Unit(path) as unit, Unit(path, name="other") as other:
        nodes, expected = unit.nodes("skin"), course(other, 0, 4)
        assert course(unit, 0, 2) == expected[:2]
        nodes.displacement = nodes.places * [-1.0, 0.0, 0.0]
        with pytest.raises(StepDiscarded, match="boundary skin: expected .* found face 1 without one"):
            unit.step(2e-4)
        assert course(unit, 2, 4) == expected[2:]


def test_a_mapping_from_another_mesh_keeps_work_and_force(path):
    corners = np.array([[x, y, 0.0] for x in (-0.013, 0.0, 0.013) for y in (-0.013, 0.001, 0.013)])
    triangles = [[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2], [3, 6, 7], [3, 7, 4], [4, 7, 8], [4, 8, 5]]
    with Unit(path) as unit:
        nodes = unit.nodes("skin")
        mapping = Mapping(corners, triangles, nodes.places)
        moved, work, turnover = np.zeros((9, 3)), 0.0, 0.0
        rng = np.random.default_rng(3)
        for _ in range(10):
            before, moved = moved, 3e-5 * rng.normal(size=(9, 3))
            nodes.displacement = mapping.displacement(moved)
            unit.step(2e-4)
            force = mapping.force(nodes.mean_force)
            assert force.sum(axis=0) == pytest.approx(nodes.mean_force.sum(axis=0), abs=1e-12)
            work -= (force * (moved - before)).sum()
            turnover += np.abs(force * (moved - before)).sum()
        assert abs(unit["skin.work"] - work) < 1e-11 * turnover


def test_an_interface_takes_the_nodes_by_their_names(path):
    with Unit(path) as unit:
        nodes = unit.nodes("skin")
        interface = Interface(unit, nodes.names("displacement"))
        assert len(interface.displacement) == 3 * len(nodes)
        assert interface.force("end").tolist() == nodes.force.ravel().tolist()
        corners = np.array([[-0.02, -0.02, 0.0], [0.02, -0.02, 0.0], [0.02, 0.02, 0.0], [-0.02, 0.02, 0.0]])
        mapping = Mapping(corners, [[0, 1, 2], [0, 2, 3]], nodes.places)
        mapped = Interface(unit, nodes.names("displacement"), through=mapping.matrix)
        moved = 1e-5 * np.arange(12.0)
        force = mapped.advance(moved, Step(0.0, 2e-4, 2e-4), "mean")
        assert nodes.displacement == pytest.approx(mapping.displacement(moved.reshape(-1, 3)))
        assert force == pytest.approx(mapping.force(nodes.mean_force).ravel())
        assert mapped.names[:2] == ["skin.mapped[1]", "skin.mapped[2]"] and len(mapped.names) == 12
        with pytest.raises(ValueError, match="through: expected a row for each of 1 displacements, found 147"):
            Interface(unit, "skin.node[1].displacement.x", through=mapping.matrix)
