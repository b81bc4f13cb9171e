"""A unit begins where another scene came to: the last stage of a protocol may be a coupled one."""

import csv

import pytest
from cograin import Unit

SCENE = """
gravity = [0.0, 0.0, -9.81]
[run]
step = 1.0e-5
end = 0.03
[material.glass]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.5
friction = FRICTION
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.few]
material = "glass"
list = [
    { position = [0.000, 0.000, 0.005], radius = 0.005 },
    { position = [0.0101, 0.001, 0.005], radius = 0.005 },
    { position = [0.004, 0.0089, 0.005], radius = 0.005 },
    { position = [0.0047, 0.0033, 0.0135], radius = 0.005 },
]
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "glass"
[boundary.lid]
plane = { point = [0.0, 0.0, 0.0205], normal = [0.0, 0.0, -1.0] }
material = "glass"
motion = MOTION
[output]
history_interval = 1.0e-3
"""


@pytest.fixture(scope="module")
def stages(cograin, tmp_path_factory):
    """The last row of a run with little friction, and the unit of a scene with more whose lid is driven."""
    folder = tmp_path_factory.mktemp("protocol")
    for name, friction, motion in (
        ("prepare", "0.1", "{ prescribed = { z = -0.1 } }"),
        ("couple", "0.5", '{ driven = ["z"] }'),
    ):
        text = SCENE.replace("FRICTION", friction).replace("MOTION", motion)
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    cograin("run", folder / "prepare.toml", "-o", folder / "prepared")
    checkpoint, unit = folder / "prepared" / "checkpoint.cograin", folder / "couple.fmu"
    said = cograin("export", folder / "couple.toml", "--from", checkpoint, "-o", unit, "--overwrite")
    assert "not taken along" not in said
    with (folder / "prepared" / "history.csv").open() as file:
        return list(csv.DictReader(file))[-1], unit


def test_it_begins_with_the_displacement_the_motion_and_the_springs_of_the_stage_before(stages):
    before, path = stages
    with Unit(path) as unit:
        assert unit.get(["lid.displacement.z"])[0] == pytest.approx(-3e-3, abs=1e-12)
        kinetic, elastic = unit.get(["energy.kinetic", "energy.elastic"])
        assert kinetic == pytest.approx(float(before["energy.kinetic"]), rel=1e-12)
        assert elastic == pytest.approx(float(before["energy.elastic"]), rel=1e-9)
        assert elastic > 0.0


def test_it_goes_on_from_there_without_a_jump_of_the_load(stages):
    before, path = stages
    with Unit(path) as unit:
        unit.set(["lid.displacement.z"], [-3e-3])
        unit.step(1e-5)
        force = unit.get(["floor.force.z"])[0]
        assert force < 0.0
        assert force == pytest.approx(float(before["floor.force.z"]), rel=0.05)
