"""Every model of the repository as a unit, and a small way to step it."""

import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest
from cograin import Unit

ROOT = Path(__file__).resolve().parents[2]
# Scenes of 25,000 grains and more are tested in small (test_bulk.py).
MODELS = sorted(scene.parent.name for scene in ROOT.glob("models/*/scene.toml") if "bulk_" not in scene.parent.name)


def pytest_addoption(parser):
    parser.addoption("--program", default="target/debug/cograin", help="the cograin command, from the root")


def pytest_generate_tests(metafunc):
    if "model" in metafunc.fixturenames:
        metafunc.parametrize("model", MODELS)


@pytest.fixture(scope="session")
def cograin(request):
    """Runs the command line and gives what it printed."""
    program = ROOT / request.config.getoption("--program")

    def run(*arguments, status=0):
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)
        said = done.stdout + done.stderr
        assert done.returncode == status, f"cograin {arguments} ended with {done.returncode}: {said}"
        return said

    return run


@pytest.fixture(scope="session")
def unit(cograin, tmp_path_factory):
    """Packages a model, with other values of these keys, once a session, and gives the path of its unit."""
    packaged = {}

    def package(model, *settings):
        if (model, settings) not in packaged:
            path = tmp_path_factory.mktemp(model) / f"{model}.fmu"
            given = [argument for setting in settings for argument in ("--set", setting)]
            cograin("export", ROOT / "models" / model / "scene.toml", "-o", path, "--overwrite", *given)
            packaged[model, settings] = path
        return packaged[model, settings]

    return package


# What an input of force or moment is given for each metre that a displacement would be given [N/m, N].
FORCES = {"force": 1e5, "moment": 1e2}


def given(name, displacement):
    """What an input is given where inputs of displacement are given this one [m]: others in proportion."""
    if name.endswith(".temperature"):
        return 300.0 + 1e6 * displacement
    if name.endswith(".applied_heat"):
        return 1e3 * displacement
    if name.endswith(".rate"):
        return abs(displacement)  # nothing is fed backwards
    return displacement * FORCES.get(name.split(".")[-2].split("_")[-1], 1.0)


@dataclass
class Course:
    """How a test drives a model: every driven displacement swings by this much in this time."""

    interval: float  # communication step [s], a multiple of the scene's step and of a nanosecond
    steps: int
    amplitude: float = 2e-5  # [m]

    def displacement(self, step):
        """A triangle of four steps up and four down [m]."""
        return self.amplitude * (4 - abs(step % 8 - 4)) / 4.0


COURSES = {
    "loaded_beam": Course(interval=2e-4, steps=6),
    "cantilever": Course(interval=1e-4, steps=20, amplitude=4e-7),
    "rock_core": Course(interval=1e-5, steps=4, amplitude=-2e-6),
    "piston_load": Course(interval=1e-4, steps=20),
    "triaxial": Course(interval=2e-5, steps=20),
    "drum": Course(interval=1e-3, steps=20),
    "drum_heat": Course(interval=1e-3, steps=20),
    "heated_plate": Course(interval=3e-3, steps=20),
    "hopper": Course(interval=1e-3, steps=40),  # the first grains reach the gate after 31 ms
    "plate": Course(interval=1e-4, steps=4),
    "wheel": Course(interval=1e-3, steps=20),
    "fluidised_column": Course(interval=1e-3, steps=8),
    "settling": Course(interval=1e-3, steps=8),
    "seepage": Course(interval=9e-4, steps=8),
    "brazilian": Course(interval=1e-5, steps=8, amplitude=-2e-6),
}


@pytest.fixture
def course(model):
    """The course of this model."""
    return COURSES.get(model, Course(interval=1e-3, steps=60))


class Slave:
    """A unit whose driven axes all take the same displacement; `slave` is fmpy's own, for calls without help."""

    def __init__(self, path, name="unit"):
        self.unit = Unit(path, name=name)
        self.slave = self.unit.slave
        self.variables = self.unit.variables
        self.inputs = self.unit.names("input")
        self.reals = [name for name in self.unit.names("output") if self.variables[name].type == "Real"]
        self.close = self.unit.close

    @property
    def time(self):
        """Where it stands [s]."""
        return self.unit.time

    @time.setter
    def time(self, time):
        self.unit.time = time

    def reference(self, name):
        """Value reference of a variable."""
        return self.variables[name].valueReference

    def set(self, name, value):
        """Sets a real input."""
        self.unit[name] = value

    def get(self, *names):
        """Values of real variables."""
        return self.unit.get(names).tolist()

    def step(self, displacement, interval):
        """Moves every driven axis there during one communication step, and loads the others in proportion; gives all real
        outputs."""
        for name in self.inputs:
            self.set(name, given(name, displacement))
        self.unit.step(interval, until=self.time + interval)
        return self.get(*self.reals)


@pytest.fixture
def slave():
    """Opens units; closes them after the test."""
    opened = []

    def opening(path, name="unit"):
        opened.append(Slave(path, name))
        return opened[-1]

    yield opening
    for each in opened:
        each.close()
