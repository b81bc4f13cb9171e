"""Small scenes as units, made by the command line once a session."""

import shutil
import signal
from pathlib import Path

import pytest

from cograin import Program, Unit

ROOT = Path(__file__).resolve().parents[2]

DROP = """
gravity = [0.0, 0.0, -9.81]
[run]
step = 1.0e-5
[material.s]
density = 2500.0
[pair.s.s]
normal_stiffness = 1.0e5
normal_damping = 0.0
[contact.touch.normal.hooke_stiffness]
[particles.ball]
material = "s"
list = [ { position = [0.0, 0.0, 0.06], radius = 0.05 } ]
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "s"
motion = { driven = ["z"] }
[boundary.ball]
particles = { set = "ball" }
motion = { free = ["z"] }
"""

# Two spheres in a row, bonded between two driven groups: linear, two directions, never in contact.
CHAIN = """
[run]
step = 1.0e-4
[material.s]
density = 1909.859317102744
[particles.left]
material = "s"
list = [ { position = [0.0, 0.0, 0.0], radius = 0.05 } ]
[particles.free]
material = "s"
list = [ { position = [0.1, 0.0, 0.0], radius = 0.05 } ]
[particles.right]
material = "s"
list = [ { position = [0.2, 0.0, 0.0], radius = 0.05 } ]
[bond.spring]
between = ["left", "free"]
create_distance = 0.11
normal_stiffness = 5026.548245743668
tangential_stiffness = 0.0
[bond.other]
between = ["free", "right"]
create_distance = 0.11
normal_stiffness = 10053.096491487338
tangential_stiffness = 0.0
[boundary.left]
particles = { set = "left" }
motion = { driven = ["x"] }
[boundary.free]
particles = { set = "free" }
motion = { free = ["x"] }
[boundary.right]
particles = { set = "right" }
motion = { driven = ["x"] }
"""


def pytest_addoption(parser):
    parser.addoption("--program", default="target/debug/cograin", help="the cograin command, from the root")


@pytest.fixture(scope="session", autouse=True)
def interruptible():
    """A shell makes what it runs in the background deaf to Ctrl-C: the tests listen all the same."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def program(request):
    """The command line."""
    return Program(ROOT / request.config.getoption("--program"))


@pytest.fixture(scope="session")
def packaged(program, tmp_path_factory):
    """Packages the text of a scene, once a session; gives the unit's path."""
    made = {}

    def package(text):
        if text not in made:
            folder = tmp_path_factory.mktemp("unit")
            (folder / "scene.toml").write_text(text)
            made[text] = program.export(folder / "scene.toml", folder / "scene.fmu")
        return made[text]

    return package


@pytest.fixture
def opened(packaged):
    """Opens a unit of a scene; closes it after the test."""
    units = []

    def opening(text, **named):
        units.append(Unit(packaged(text), **named))
        return units[-1]

    yield opening
    for unit in units:
        unit.close()


@pytest.fixture
def drop(opened):
    """A sphere above a plate that the outside moves."""
    return opened(DROP)


@pytest.fixture
def served(opened):
    """The sphere above a plate that a servo moves."""
    return opened(DROP.replace('driven = ["z"]', "servo = { z = { speed = 0.1 } }"))


@pytest.fixture
def chain(opened):
    """A free mass between two driven ends."""
    return opened(CHAIN)


@pytest.fixture(scope="session")
def piston(program, tmp_path_factory):
    """The path of the unit of models/piston."""
    folder = tmp_path_factory.mktemp("piston")
    shutil.copytree(ROOT / "models" / "piston", folder / "piston")
    return program.export(folder / "piston" / "scene.toml", folder / "piston.fmu")
