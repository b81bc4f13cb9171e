"""A crate of somebody else with a contact sub-model of its own: its tests, its program, and a unit of it in foreign hands."""

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
    shutil.copy(ROOT / "Cargo.lock", CRATE)
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
    assert "2 particles" in wet("check", CRATE / "scene.toml")
    wet("run", CRATE / "scene.toml", "-o", tmp_path / "out")
    assert (tmp_path / "out/history.csv").exists()


def test_the_program_without_it_names_the_models_that_it_has(cograin):
    said = cograin("check", CRATE / "scene.toml", status=2)
    assert "liquid_bridge" in said and "sjkr2" in said


def test_a_unit_of_it_carries_the_law(wet, tmp_path):
    path = tmp_path / "wet.fmu"
    wet("export", CRATE / "scene.toml", "-o", path)
    assert validate_fmu(path) == []
    with Unit(path) as unit:

        def force(apart):
            unit["tip.displacement.x"] = apart - DISTANCE
            unit.step(1e-3)
            return unit["tip.force.x"]

        assert force(0.5 * RUPTURE) == 0.0, "no bridge before touch"
        force(-1e-6)
        for apart in (0.1 * RUPTURE, 0.5 * RUPTURE, 0.99 * RUPTURE):
            assert force(apart) == pytest.approx(pull(apart), rel=1e-6)
        assert force(1.01 * RUPTURE) == 0.0
        assert force(0.5 * RUPTURE) == 0.0, "a broken bridge does not form at a distance"
