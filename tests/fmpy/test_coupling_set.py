"""The coupling set gives the errors and the energies that its page states, at steps that take no time."""

import argparse
import sys

import numpy as np
import pytest
from cograin import Program, Unit, Verlet
from conftest import ROOT

sys.path.insert(0, str(ROOT / "models" / "coupling_set"))

import couple  # noqa: E402
import problems  # noqa: E402
import stability  # noqa: E402
import theory  # noqa: E402
from peers.process import HERE, Process  # noqa: E402

# Problem, exchange, step, error: the scheme's own, from the table of the page.
CASES = [
    (problems.Drop(), "secant", 1e-3, 3.5e-3),
    (problems.Drop(), "secant", 5e-4, 8.6e-4),
    (problems.Drop(), "quadratic", 1e-3, 9.8e-6),
    (problems.Drop(), "Verlet", 1e-3, 2.8e-3),
    (problems.Drop(), "Gauss–Seidel", 1e-3, 3.4e-2),
]


@pytest.fixture(scope="module")
def opened(request, tmp_path_factory):
    """The unit of a problem."""
    program = Program(ROOT / request.config.getoption("--program"))
    folder, units = tmp_path_factory.mktemp("set"), {}

    def opening(problem):
        if problem.scene not in units:
            path = program.export(couple.HERE / problem.scene, folder / f"{problem.scene}.fmu")
            units[problem.scene] = Unit(path)
        return units[problem.scene]

    yield opening
    for unit in units.values():
        unit.close()


@pytest.mark.parametrize(("problem", "exchange", "step", "error"), CASES)
def test_errors_are_the_schemes_own_and_repeated_steps_keep_the_energy(opened, problem, exchange, step, error):
    (measure, _, touched, unconverged), _, said = couple.ours(problem, opened(problem), exchange, step)
    assert not said and not unconverged
    assert measure.error == pytest.approx(error, rel=0.02)
    if exchange in ("secant", "quadratic"):
        assert measure.interface <= 1e-9
        # A step in which sphere and plate meet has time steps that follow from the inputs tried: some take one evaluation more.
        assert touched <= 3.3


@pytest.mark.parametrize("ratio", [10.0, 100.0, 1000.0])
def test_verlet_grows_at_the_border_of_theory_and_not_one_step_below_it(opened, ratio):
    time_step, mass = 5e-4, 1.0 / ratio
    counts = np.arange(1, 120)
    border = theory.Linear("Verlet", mass, stability.DAMPING, time_step).border(counts)
    unit = opened(problems.TwoMasses())
    assert stability.grows(unit, Verlet, mass, border)
    assert not stability.grows(unit, Verlet, mass, border - time_step)


WORLD = '''
import sys
sys.path.insert(0, sys.argv[1])
from serving import serve

class World:
    """Velocity Verlet by hand."""
    def __init__(self, given):
        self.given, self.floor = given, 0.0
        ((_, _, centre, radius),) = given["spheres"]
        self.mass = 4.0 / 3.0 * 3.141592653589793 * radius**3 * given["density"]
        self.height, self.speed = centre - radius, given["velocity"]
        self.begin = self.height
    def rate(self):
        return -self.force() / self.mass - self.given["gravity"]
    def step(self, speed):
        length = self.given["time_step"]
        self.speed += 0.5 * length * self.rate()
        self.height += length * self.speed
        self.floor += length * speed
        self.speed += 0.5 * length * self.rate()
    def force(self):
        return -self.given["stiffness"] * max(self.floor - self.height, 0.0)
    def sphere(self):
        return self.height - self.begin, self.speed
    def save(self):
        self.kept = self.height, self.speed, self.floor
    def restore(self):
        self.height, self.speed, self.floor = self.kept

serve(World)
'''


@pytest.mark.parametrize(("exchange", "error"), [("Gauss–Seidel", 3.4e-2), ("secant", 3.5e-3)])
def test_a_program_of_its_own_is_a_side_of_the_same_exchanges(tmp_path, exchange, error):
    (tmp_path / "world.py").write_text(WORLD)

    class Side(Process):
        can_restore = True

        def __init__(self, problem):
            super().__init__([sys.executable, tmp_path / "world.py", HERE], problem)

    (measure, *_), taken, said = couple.theirs(problems.Drop(), Side, exchange, 1e-3)
    assert not said and taken > 0.0
    assert measure.error == pytest.approx(error, rel=0.02)


def test_a_program_that_ends_says_why_at_once(tmp_path):
    (tmp_path / "world.py").write_text("raise ValueError('no sphere today')")
    with pytest.raises(ChildProcessError, match="ValueError: no sphere today"):
        Process([sys.executable, tmp_path / "world.py"], problems.Drop())


def test_the_set_goes_on_where_other_programs_are_missing(monkeypatch, capfd):
    monkeypatch.setattr(couple, "NAMES", ("yade", "kratos"))
    monkeypatch.setenv("PATH", "")
    monkeypatch.setenv("KRATOS_PYTHON", "no-such-interpreter")
    options = argparse.Namespace(repeats=1, problems=["rod"])
    assert list(couple.of_peers(options)) == []
    said = capfd.readouterr().out
    assert "yade is left out: ImportError: no program yade on the path" in said
    assert "kratos is left out: ImportError: no KratosMultiphysics with DEMApplication in no-such-interpreter" in said
