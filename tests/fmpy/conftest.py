"""Every model of the repository as a unit, and a small master to step it."""

import subprocess
from dataclasses import dataclass
from pathlib import Path

import fmpy
import pytest
from fmpy.fmi2 import FMU2Slave

ROOT = Path(__file__).resolve().parents[2]
MODELS = sorted(scene.parent.name for scene in ROOT.glob("models/*/scene.toml"))


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
    """Packages a model, once a session, and gives the path of its unit."""
    packaged = {}

    def package(model):
        if model not in packaged:
            path = tmp_path_factory.mktemp(model) / f"{model}.fmu"
            cograin("export", ROOT / "models" / model / "scene.toml", "-o", path)
            packaged[model] = path
        return packaged[model]

    return package


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
    "brazilian": Course(interval=1e-5, steps=8, amplitude=-2e-6),
}


@pytest.fixture
def course(model):
    """The course of this model."""
    return COURSES.get(model, Course(interval=1e-3, steps=60))


class Slave:
    """One instance of a unit in fmpy."""

    def __init__(self, path, name="unit"):
        self.description = fmpy.read_model_description(path, validate=False)
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self.inputs = [name for name, variable in self.variables.items() if variable.causality == "input"]
        self.reals = [
            name
            for name, variable in self.variables.items()
            if variable.causality == "output" and variable.type == "Real"
        ]
        self.slave = FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=fmpy.extract(path),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.slave.instantiate()
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        self.time = 0.0

    def reference(self, name):
        """Value reference of a variable."""
        return self.variables[name].valueReference

    def set(self, name, value):
        """Sets a real input."""
        self.slave.setReal([self.reference(name)], [value])

    def get(self, *names):
        """Values of real variables."""
        return self.slave.getReal([self.reference(name) for name in names])

    def step(self, displacement, interval):
        """Moves every driven axis there during one communication step; gives all real outputs."""
        for name in self.inputs:
            self.set(name, displacement)
        self.slave.doStep(currentCommunicationPoint=self.time, communicationStepSize=interval)
        self.time += interval
        return self.get(*self.reals)

    def close(self):
        """Ends the instance and unloads its library."""
        self.slave.terminate()
        self.slave.freeInstance()


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
