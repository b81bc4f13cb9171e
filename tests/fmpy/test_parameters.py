"""Numbers of the scene as parameters, in the hands of a foreign importer."""

import subprocess
import sys
from pathlib import Path

import pytest
from cograin import Unit, UnitError
from fmpy import read_model_description
from fmpy.validation import validate_fmu

FRICTION = "pair.glass.glass.friction"
DENSITY = "material.glass.density"

SCENE = """
gravity = [0.0, 0.0, -9.81]

[run]
step = 1.0e-5
threads = 1

[material.glass]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.3

[pair.glass.glass]
restitution = 0.5
friction = 0.4

[contact.touch.normal.hertz]
[contact.touch.tangential.history]

[particles.bed]
material = "glass"
lattice = { kind = "simple_cubic", radius = 0.01, spacing = 0.01999, origin = [0.01, 0.01, 0.00999], counts = [3, 3, 3] }

[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "glass"
motion = { driven = ["x", "z"] }
"""


@pytest.fixture(scope="module")
def bed(cograin, tmp_path_factory):
    """Packages the bed, with settings, and gives the path of its unit."""
    folder = tmp_path_factory.mktemp("parameters")
    (folder / "bed.toml").write_text(SCENE)

    def package(name, *settings):
        path = folder / f"{name}.fmu"
        cograin("export", folder / "bed.toml", "-o", path, "--overwrite", *(f"--set={setting}" for setting in settings))
        return path

    return package


def course(unit, first, last):
    """Outputs while the floor goes aside."""
    rows = []
    for step in range(first, last + 1):
        unit["floor.displacement.x"] = 2e-5 * step
        unit.step(1e-4, until=1e-4 * step)
        rows.append(list(unit.get(["floor.force.x", "floor.force.z", "floor.work", "energy.kinetic"])))
    return rows


def test_the_description_says_what_may_be_changed_and_when(bed):
    path = bed("described")
    assert validate_fmu(str(path)) == []
    variables = {variable.name: variable for variable in read_model_description(str(path)).modelVariables}
    friction, density = variables[FRICTION], variables[DENSITY]
    assert (friction.causality, friction.variability, friction.start) == ("parameter", "tunable", "0.4")
    assert (float(friction.min), friction.unit) == (0.0, "1")
    assert (density.causality, density.variability, density.unit) == ("parameter", "fixed", "kg/m3")
    assert variables["run.threads"].type == "Integer"


def test_a_parameter_does_what_set_does_on_the_command_line(bed):
    with Unit(bed("plain"), parameters={FRICTION: 0.05, DENSITY: 2000.0}) as given:
        here = course(given, 1, 8)
    with Unit(bed("set", f"{FRICTION}=0.05", f"{DENSITY}=2000.0")) as written:
        assert course(written, 1, 8) == here


def test_a_parameter_that_is_tuned_goes_on_in_another_process(bed, tmp_path):
    path = bed("tuned")
    with Unit(path) as unit:
        course(unit, 1, 4)
        unit[FRICTION] = 0.05
        saved = unit.slave.getFMUstate()
        state = tmp_path / "state"
        state.write_bytes(bytes(unit.slave.serializeFMUstate(saved)))
        here = course(unit, 5, 10)
        unit.slave.setFMUstate(saved)
        unit.time = 4e-4
        assert course(unit, 5, 10) == here
        with pytest.raises(UnitError, match="fixed parameter"):
            unit[DENSITY] = 2000.0
    there = subprocess.run([sys.executable, __file__, path, state], capture_output=True, text=True, check=False)
    assert there.returncode == 0, there.stderr
    assert there.stdout.splitlines() == [repr(row) for row in here]


def go_on(path, state):
    """Continues a serialised state here."""
    with Unit(path) as unit:
        unit.slave.setFMUstate(unit.slave.deSerializeFMUstate(Path(state).read_bytes()))
        unit.time = 4e-4
        for row in course(unit, 5, 10):
            print(repr(row))


if __name__ == "__main__":
    go_on(*sys.argv[1:])
