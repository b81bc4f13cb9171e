"""Groups of particles that move and turn axis by axis, as units in fmpy."""

import math

import pytest

SCENE = """
gravity = [0.0, 0.0, -9.81]
[run]
step = 1.0e-4
[material.steel]
density = 7800.0
[particles.pair]
material = "steel"
list = [
    {{ position = [-0.1, 0.0, 0.0], radius = 0.05 }},
    {{ position = [0.1, 0.0, 0.0], radius = 0.05 }},
]
[boundary.bell]
particles = {{ set = "pair" }}
motion = {motion}
"""


@pytest.fixture
def bell(cograin, slave, tmp_path):
    """A unit of two spheres as a group with this motion."""

    def package(motion):
        scene = tmp_path / "bell.toml"
        scene.write_text(SCENE.format(motion=motion))
        cograin("export", scene, "-o", tmp_path / "bell.fmu", "--overwrite")
        return slave(tmp_path / "bell.fmu")

    return package


def test_free_axes_are_outputs_and_driven_ones_inputs(bell):
    subject = bell('{ driven = ["z"], free = ["x", "rotation.y"] }')
    assert subject.inputs == ["bell.displacement.z"]
    units = {name: subject.variables[name].unit for name in subject.reals}
    assert units["bell.displacement.x"] == "m"
    assert units["bell.velocity.x"] == "m/s"
    assert units["bell.rotation.y"] == "rad"
    assert units["bell.angular_velocity.y"] == "rad/s"
    for name in ("displacement.y", "velocity.z", "rotation.x", "angular_velocity.z"):
        assert f"bell.{name}" not in subject.variables


def test_a_free_group_falls_and_its_weight_is_not_in_its_force(bell):
    subject = bell('{ free = ["z"] }')
    subject.step(0.0, 0.5)
    fall, speed, force, work = subject.get(
        "bell.displacement.z", "bell.velocity.z", "bell.force.z", "bell.work"
    )
    assert math.isclose(fall, -0.125 * 9.81, rel_tol=1e-12)
    assert math.isclose(speed, -0.5 * 9.81, rel_tol=1e-12)
    assert (force, work) == (0.0, 0.0)
    mass, kinetic = subject.get("bell.mass", "energy.kinetic")
    assert math.isclose(kinetic, 0.5 * mass * speed**2, rel_tol=1e-12)


def test_a_driven_rotation_is_an_angle_without_bound(bell):
    subject = bell('{ driven = ["rotation.z"] }')
    assert subject.inputs == ["bell.rotation.z"]
    for turn in (3.5, 7.0, -20.0):
        subject.step(turn, 0.1)
        assert subject.get("bell.rotation.z") == [turn]


def test_half_a_turn_about_several_axes_discards_the_step_and_the_unit_goes_on(bell):
    subject = bell('{ driven = ["rotation.x", "rotation.y"] }')
    for name in subject.inputs:
        subject.set(name, 2.5)
    with pytest.raises(Exception, match="(?i)status|discard"):
        subject.slave.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.1)
    subject.step(1.0, 0.1)
    assert subject.get("bell.rotation.x", "bell.rotation.y") == [1.0, 1.0]


def test_a_saved_state_of_a_turning_group_continues_bit_for_bit(bell):
    subject = bell('{ driven = ["z"], free = ["x", "rotation.y"] }')
    subject.step(0.1, 0.1)
    saved = subject.slave.getFMUState()
    first = subject.step(0.3, 0.1)
    subject.slave.setFMUState(saved)
    subject.time = 0.1
    assert subject.step(0.3, 0.1) == first
    subject.slave.freeFMUState(saved)
