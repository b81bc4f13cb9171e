"""A crate of somebody else with a contact sub-model, a rule of breakage and a shape of its own: its tests, its program, and a unit
of it in foreign hands."""

import math
import os
import shutil
import subprocess

import pytest
from cograin import Unit
from conftest import ROOT
from fmpy.validation import validate_fmu

CRATE = ROOT / "examples/own_law"

# The law of the scene: radius of the spheres, distance at the start, volume of a bridge, surface tension, contact angle.
RADIUS, DISTANCE, VOLUME, TENSION, ANGLE = 1e-3, 0.2e-3, 1e-11, 0.072, 0.5
RUPTURE = (1.0 + 0.5 * ANGLE) * VOLUME ** (1.0 / 3.0)


def pull(apart):
    """Force of the bridge on the sphere that is moved away [N]."""
    slope = apart / math.hypot(apart, math.sqrt(VOLUME / (math.pi * 0.5 * RADIUS)))
    return -4.0 * math.pi * 0.5 * RADIUS * TENSION * math.cos(ANGLE) * (1.0 - slope)


@pytest.fixture(scope="module")
def wet():
    """Builds the crate from outside of the workspace, in the folder that the workspace builds in: what both use is built
    once, of the same versions. Gives its program."""
    lock = CRATE / f"Cargo.lock.{os.getpid()}"
    shutil.copy(ROOT / "Cargo.lock", lock)
    lock.replace(CRATE / "Cargo.lock")  # whole at any time: another process may build
    place = {**os.environ, "CARGO_TARGET_DIR": str(ROOT / "target")}
    for work in (["test", "--lib"], ["build"]):
        done = subprocess.run(["cargo", *work], cwd=CRATE, env=place, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr

    def run(*arguments, status=0):
        done = subprocess.run(
            [ROOT / "target/debug/wet", *map(str, arguments)], capture_output=True, text=True, check=False
        )
        assert done.returncode == status, done.stdout + done.stderr
        return done.stdout + done.stderr

    return run


def test_its_program_checks_and_runs_the_scene(wet, tmp_path):
    assert "5 particles" in wet("check", CRATE / "scene.toml")
    wet("run", CRATE / "scene.toml", "-o", tmp_path / "out")
    assert (tmp_path / "out/history.csv").exists()


def test_the_program_without_it_names_what_it_has(cograin):
    said = cograin("check", CRATE / "scene.toml", status=2)
    assert "liquid_bridge" in said and "sjkr2" in said
    assert "breakage.quadratic_stress: no such key" in said and "mohr_coulomb" in said
    assert "ball: no such key" in said and "cylinder" in said


@pytest.fixture(scope="module")
def unit_path(wet, tmp_path_factory):
    """The scene as a unit."""
    path = tmp_path_factory.mktemp("wet") / "wet.fmu"
    wet("export", CRATE / "scene.toml", "-o", path)
    assert validate_fmu(path) == []
    return path


def driven(unit, boundary):
    """Displaces a boundary of the unit along x and gives the force on it, once nothing moves [N]."""

    def force(displacement):
        unit[f"{boundary}.displacement.x"] = displacement
        unit.step(2e-4)
        unit.step(1e-5)
        return unit[f"{boundary}.force.x"]

    return force


def test_a_unit_of_it_carries_the_contact_law(unit_path):
    with Unit(unit_path) as unit:
        tip = driven(unit, "tip")

        def force(apart):
            return tip(apart - DISTANCE)

        assert force(0.5 * RUPTURE) == 0.0, "no bridge before touch"
        force(-1e-6)
        for apart in (0.1 * RUPTURE, 0.5 * RUPTURE, 0.99 * RUPTURE):
            assert force(apart) == pytest.approx(pull(apart), rel=1e-6)
        assert force(1.01 * RUPTURE) == 0.0
        assert force(0.5 * RUPTURE) == 0.0, "a broken bridge does not form at a distance"


def test_a_unit_of_it_carries_the_rule_of_breakage(unit_path):
    # The normal stress k_n u of the bond reaches its strength at 1e-5 m; the force before is k_n A u.
    with Unit(unit_path) as unit:
        force = driven(unit, "pull")
        assert force(0.99e-5) == pytest.approx(-1e10 * math.pi * 1e-6 * 0.99e-5, rel=1e-6)
        assert unit["bonds.intact"] == 1
        assert force(1.01e-5) == 0.0
        assert unit["bonds.broken"] == 1
    with Unit(unit_path) as unit:
        unit["bond.neck.breakage.quadratic_stress.normal_strength"] = 2e5
        force = driven(unit, "pull")
        assert force(1.99e-5) < 0.0, "twice the strength, twice the stretch"
        assert force(2.01e-5) == 0.0


def test_a_unit_of_it_carries_the_shape(unit_path):
    # Hertz: 4/3 E* R^1/2 d^3/2, of a sphere 0.1 mm away from the ball.
    modulus = 5e7 / (2.0 * (1.0 - 0.25**2))
    with Unit(unit_path) as unit:
        force = driven(unit, "ball")
        assert force(-0.09e-3) == 0.0
        for overlap in (1e-6, 5e-6):
            expected = 4.0 / 3.0 * modulus * RADIUS**0.5 * overlap**1.5
            assert force(-0.1e-3 - overlap) == pytest.approx(expected, rel=1e-6)
