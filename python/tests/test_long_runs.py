"""Runs that are broken off and go on, steps whose length follows an error, several partners, units in parallel."""

import itertools
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg
from conftest import CHAIN, DROP

from cograin import (
    Aitken,
    Coupling,
    GaussSeidel,
    Interface,
    Newton,
    Oscillator,
    Partners,
    Quadratic,
    QuasiNewton,
    RigidBody,
    Secant,
    StepControl,
    Structure,
    Tolerance,
    Unit,
    UnitPartner,
    Verlet,
    couple,
)
from cograin.exchanges.progress import Progress

FLOOR = "floor.displacement.z"
ENDS = ["left.displacement.x", "right.displacement.x"]
TURNING = DROP.replace('driven = ["z"]', 'driven = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"]')
# A unit whose input is a force: a plate over a soft sphere.
PLATE = """
[run]
step = 1.0e-5
[material.s]
density = 2500.0
[pair.s.s]
normal_stiffness = 1.0e4
normal_damping = 0.0
[contact.touch.normal.hooke_stiffness]
[particles.foot]
material = "s"
list = [ { position = [0.0, 0.0, -0.05], radius = 0.05 } ]
[boundary.foot]
particles = { set = "foot" }
[boundary.plate]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, -1.0] }
material = "s"
mass = 0.1
motion = { loaded = ["z"] }
"""
SIX = [f"floor.{quantity}.{axis}" for quantity in ("displacement", "rotation") for axis in "xyz"]


def plate():
    """A partner that the marble pushes and that swings on."""
    partner = Oscillator(0.05, 1e3, 0.1)
    partner.place(velocity=0.05)
    return partner


def table():
    """A plate that turns where the marble does not hit its middle."""
    return RigidBody(2.0, [0.02, 0.03, 0.04], at=[0.0, 0.0, 0.0], centre=[0.02, 0.01, 0.0])


def two():
    """Ends of a chain, each on a spring of its own, one of them moving."""
    left, right = Oscillator(1.0, 30.0), Oscillator(2.0, 10.0, 0.5)
    left.place(velocity=0.01)
    return Partners(left, right)


RUNS = {
    # scene, interface, partner, exchange, control, step, end
    "secant": (DROP, [FLOOR], plate, Secant, None, 2e-3, 0.06),
    "aitken": (DROP, [FLOOR], plate, Aitken, None, 2e-3, 0.06),
    "newton": (DROP, [FLOOR], plate, lambda: Newton("differences"), None, 2e-3, 0.06),
    "gauss-seidel": (DROP, [FLOOR], plate, GaussSeidel, None, 2e-4, 0.048),
    "verlet": (DROP, [FLOOR], plate, Verlet, None, 2e-3, 0.06),
    "energy": (DROP, [FLOOR], plate, Secant, StepControl(energy=1e-6), 4e-3, 0.06),
    "error": (DROP, [FLOOR], plate, Secant, StepControl(error=1e-6), 4e-3, 0.06),
    "quadratic": (DROP.replace('driven = ["z"] }', 'driven = ["z"] }\ninput = "quadratic"'), [FLOOR], plate, Quadratic,
                  None, 4e-3, 0.06),
    "turning": (TURNING, [SIX], table, QuasiNewton, None, 4e-3, 0.06),
    "two partners": (CHAIN, ENDS, two, QuasiNewton, None, 4e-2, 0.4),
}  # fmt: skip


class BrokenOff(Exception):
    """What ends a run."""


def breaking(after=10**9):
    """A watched value that ends the run at this step; by default it never does."""
    steps = itertools.repeat(0.0, after - 1)

    def read():
        value = next(steps, None)
        if value is None:
            raise BrokenOff
        return value

    return {"watched": read}


def table_of(record, folder):
    """The bytes of a record."""
    record.save(folder / "record.csv")
    return (folder / "record.csv").read_bytes()


@pytest.mark.parametrize("run", RUNS.values(), ids=RUNS)
def test_a_run_broken_off_at_any_step_goes_on_to_the_same_bytes(run, packaged, tmp_path, monkeypatch):
    scene, names, partner, exchange, control, step, end = run
    path, file = packaged(scene), tmp_path / "run.checkpoint"

    def made(watch, **named):
        with Unit(path) as unit:
            side = Interface(unit, names[0])
            for name in names[1:]:
                side = side + Interface(unit, name)
            return couple(side, partner(), exchange(), step=step, end=end, control=control, watch=watch, **named)

    def break_off(place, **named):
        """In the middle of a step, from which an explicit exchange does not come back, or between two steps."""
        if exchange().repeats and place % 3:
            watch, between = breaking(place), lambda: 0.0
        else:
            watch, between = breaking(), breaking(place)["watched"]
        with monkeypatch.context() as patched, pytest.raises(BrokenOff):
            patched.setattr(Progress, "step", lambda *_: between())
            made(watch, checkpoint=file, **named)

    whole = made(breaking())
    expected = table_of(whole, tmp_path)
    count = len(whole)
    # Some breaks follow a checkpoint that was written by the clock, others are the first one.
    for place in range(2, count + 1, max(1, count // 16)):
        break_off(place, every=0.0 if place % 2 else 1e9)
        assert file.is_file()
        assert table_of(made(breaking(), checkpoint=file), tmp_path) == expected, place
        assert not file.exists(), "what is finished leaves no checkpoint"
    for place in range(2, count, 1 + count // 3):
        break_off(place if not file.exists() else 2)
    assert table_of(made(breaking(), checkpoint=file), tmp_path) == expected, "broken off several times"


KILLED = """
import sys, time
from cograin import Interface, Oscillator, Secant, Unit, couple
with Unit(sys.argv[1]) as unit:
    table = Oscillator(0.05, 1e3, 0.1)
    slow = {"watched": lambda: time.sleep(0.01) or 0.0}
    side = Interface(unit, "floor.displacement.z")
    couple(side, table, Secant(), step=1e-3, end=0.1, watch=slow, checkpoint=sys.argv[2], every=0.0).save(sys.argv[3])
"""


def test_a_run_that_is_killed_goes_on(packaged, tmp_path):
    unit, folder = packaged(DROP), tmp_path / "runs"
    folder.mkdir()
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}

    def started(name):
        words = [sys.executable, "-c", KILLED, unit, folder / "checkpoint", folder / name]
        return subprocess.Popen(list(map(str, words)), env=environment)

    assert started("whole.csv").wait() == 0
    for _ in range(3):
        running, found = (
            started("killed.csv"),
            (folder / "checkpoint").stat().st_mtime_ns if any(folder.glob("checkpoint")) else 0,
        )
        deadline = time.monotonic() + 60.0
        while not (folder / "checkpoint").exists() or (folder / "checkpoint").stat().st_mtime_ns == found:
            assert time.monotonic() < deadline and running.poll() is None
            time.sleep(0.005)
        time.sleep(0.05)
        running.kill()
        running.wait()
    assert not (folder / "killed.csv").exists()
    assert started("killed.csv").wait() == 0
    assert (folder / "killed.csv").read_bytes() == (folder / "whole.csv").read_bytes()
    # What was being written when the process died is all that may be left.
    assert {file.name for file in folder.iterdir() if not file.name.startswith(".checkpoint.")} == {
        "whole.csv",
        "killed.csv",
    }


def test_a_unit_as_the_partner_goes_on_too(opened, packaged, tmp_path):
    def made(watch, **named):
        with Unit(packaged(DROP)) as unit, Unit(packaged(PLATE), name="plate") as other:
            partner = UnitPartner(other, force="plate.applied_force.z", displacement="plate.displacement.z")
            return couple(Interface(unit, FLOOR), partner, Secant(), step=2e-3, end=0.06, watch=watch, **named)

    expected = table_of(made(breaking()), tmp_path)
    for place in (2, 11, 25, 28):
        with pytest.raises(BrokenOff):
            made(breaking(place), checkpoint=tmp_path / "run")
        assert table_of(made(breaking(), checkpoint=tmp_path / "run"), tmp_path) == expected


def test_checkpoints_of_other_runs_are_refused_in_words(opened, packaged, tmp_path):
    file = tmp_path / "run"

    def made(partner=None, exchange=None, scene=DROP, watch=(), step=1e-3, **named):
        with Unit(packaged(scene)) as unit:
            side = Interface(unit, FLOOR)
            return couple(side, partner or plate(), exchange or Secant(), step=step, end=0.06, watch=watch,
                          checkpoint=file, **named)  # fmt: skip

    with pytest.raises(BrokenOff):
        made(watch=breaking(30))
    kept = file.read_bytes()
    heavier = Oscillator(0.06, 1e3, 0.1)
    heavier.place(velocity=0.05)
    for named, word in (
        ({"partner": heavier}, "answer of the partner"),
        ({"partner": Oscillator(0.05, 1e3, 0.1)}, "answer of the partner"),
        ({"exchange": Verlet()}, "exchange"),
        ({"step": 2e-3}, "step"),
        ({"watch": ["ball.velocity.z"]}, "columns"),
        ({"scene": DROP.replace("2500.0", "2600.0")}, "scene.file"),
    ):
        with pytest.raises(ValueError, match=f"expected a checkpoint of this run, found one of another: .*{word}"):
            made(**{"watch": breaking(), **named})
        assert file.read_bytes() == kept
    for damaged in (b"", b"PK", kept[:-100], kept[:200], b"x" + kept, b"\x00" * 64):
        file.write_bytes(damaged)
        with pytest.raises(ValueError, match="expected a checkpoint of a coupled run, found"):
            made(watch=breaking())
    file.write_bytes(kept)
    with pytest.raises(ValueError, match=r"exchange\.tolerance\.displacement"):
        made(watch=breaking(), exchange=Secant(tolerance=Tolerance(1e-12)))
    assert len(made(watch=breaking())) == 60

    class Forgetful:
        displacement = np.zeros(1)

    with pytest.raises(ValueError, match=r"Forgetful has no memory\(\) and recall\(\)"):
        made(Forgetful())
    with Unit(packaged(DROP)) as unit:
        coupling = Coupling(Interface(unit, FLOOR), plate(), Secant(), 1e-3)
        coupling.run(0.01)
        with pytest.raises(ValueError, match=r"expected a run from its first step on, found one at 0\.01 s"):
            coupling.run(0.02, checkpoint=file)


# Masses on springs and dashpots at both ends of a bonded bar of three spheres; the left one is hit.
MASS, SPRING, DASHPOT, SPEED = 2.0, 2e4, 80.0, 0.05


def hit():
    """The two partners."""
    left, right = Oscillator(MASS, SPRING, DASHPOT), Oscillator(MASS, SPRING, DASHPOT)
    left.place(velocity=SPEED)
    return Partners(left, right)


def bar(times):
    """Closed form: displacements of both ends, by the exponential of the matrix of the three masses."""
    area = np.pi * 0.05**2
    one, other = 5026.548245743668 * area, 10053.096491487338 * area
    mass = np.diag([MASS, 1909.859317102744 * 4.0 / 3.0 * np.pi * 0.05**3, MASS])
    stiffness = np.array([[SPRING + one, -one, 0.0], [-one, one + other, -other], [0.0, -other, SPRING + other]])
    change = np.zeros((6, 6))
    change[:3, 3:] = np.eye(3)
    change[3:, :3] = -np.linalg.solve(mass, stiffness)
    change[3:, 3:] = -np.linalg.solve(mass, np.diag([DASHPOT, 0.0, DASHPOT]))
    return np.array([scipy.linalg.expm(change * now)[[0, 2], 3] * SPEED for now in times])


@pytest.fixture
def shaken(opened):
    """Runs the bar between its partners; gives the record and its largest error."""
    unit = opened(CHAIN.replace("step = 1.0e-4", "step = 1.0e-5"))

    def run(step, control=None, exchange=None):
        unit.reset()
        side = Interface(unit, ENDS[0]) + Interface(unit, ENDS[1])
        record = couple(side, hit(), exchange or QuasiNewton(), step=step, end=1.8, control=control)
        found = np.array([row.displacement for row in record])
        return record, float(np.abs(found - bar(record["time"])).max())

    return run


@pytest.mark.parametrize("exchange", [QuasiNewton, Verlet])
def test_two_partners_on_two_boundaries_of_one_unit_follow_the_closed_form(shaken, exchange):
    errors = [shaken(step, exchange=exchange())[1] for step in (4e-3, 2e-3)]
    assert 3.5 < errors[0] / errors[1] < 4.5
    assert errors[1] < 1e-2 * np.abs(bar(np.linspace(0.0, 0.1, 101))).max()


def test_the_length_of_steps_follows_the_error_that_is_allowed(shaken):
    fixed, error_of_fixed = shaken(1.25e-3)
    found = [shaken(2e-2, StepControl(error=error, halvings=10)) for error in (3e-6, 1e-6, 3e-7)]
    errors = [error for _, error in found]
    # In proportion to what is allowed.
    assert 2.0 < errors[0] / errors[1] < 4.5 and 2.0 < errors[1] / errors[2] < 4.5
    adaptive = found[-1][0]
    assert errors[-1] < error_of_fixed
    assert len(adaptive) < len(fixed) / 4 and adaptive["evaluations"].sum() < fixed["evaluations"].sum() / 4
    # Short where the bar swings, long where it has come to rest.
    assert adaptive["length"][:10].max() < 1e-3 and adaptive["length"].max() == 2e-2
    assert adaptive["refusals"].sum() < 0.02 * len(adaptive)


def test_an_explicit_exchange_follows_it_too(shaken):
    coarse, fine = (shaken(2e-2, StepControl(error=error, halvings=10), Verlet())[1] for error in (1e-6, 1e-7))
    assert 5.0 < coarse / fine < 20.0


def test_an_error_that_cannot_be_controlled_is_refused(opened):
    for error in (0.0, -1.0, float("nan")):
        with pytest.raises(ValueError, match="error: expected a number above 0"):
            StepControl(error=error)
    bent = DROP.replace('driven = ["z"] }', 'driven = ["z"] }\ninput = "quadratic"')
    with pytest.raises(ValueError, match="expected an exchange whose boundary moves straight, found Quadratic"):
        couple(
            Interface(opened(bent), FLOOR), plate(), Quadratic(), step=1e-3, end=0.01, control=StepControl(error=1e-6)
        )


def both(packaged, **named):
    """Two marbles fall on one plate."""
    with (
        Unit(packaged(DROP), name="one") as one,
        Unit(packaged(DROP.replace("0.06]", "0.055]")), name="other") as other,
    ):
        partner = Structure([0.1, 0.1], np.array([[2e3, -1e3], [-1e3, 2e3]]))
        return couple(
            Interface(one, FLOOR) + Interface(other, FLOOR), partner, QuasiNewton(), step=1e-3, end=0.06, **named
        )


def test_units_in_parallel_find_the_same_bits(packaged, monkeypatch):
    expected = both(packaged)
    inside, most, lock, step = 0, 0, threading.Lock(), Unit.step

    def counted(unit, *arguments, **named):
        nonlocal inside, most
        with lock:
            inside += 1
            most = max(most, inside)
        time.sleep(1e-3)
        try:
            step(unit, *arguments, **named)
        finally:
            with lock:
                inside -= 1

    monkeypatch.setattr(Unit, "step", counted)
    found = both(packaged, parallel=True)
    assert most == 2
    assert [row.values for row in found] == [row.values for row in expected]
    with pytest.raises(ValueError, match="parallel: expected an Interface, found str"):
        couple("side", plate(), Secant(), step=1e-3, end=0.01, parallel=True)


def test_what_a_unit_says_in_parallel_is_heard_and_no_unit_is_left_in_a_step(packaged, monkeypatch):
    step, made = Unit.step, []

    def failing(unit, *arguments, **named):
        if unit.name == "other" and len(made) == 20:
            raise BrokenOff("other")
        if unit.name == "one":
            made.append(unit)
        step(unit, *arguments, **named)

    monkeypatch.setattr(Unit, "step", failing)
    with pytest.raises(BrokenOff, match="other"):
        both(packaged, parallel=True)


def test_leftovers_are_not_in_the_way(packaged, tmp_path):
    assert not list(Path(tmp_path).iterdir())
    record = both(packaged, checkpoint=tmp_path / "run", every=0.0)
    assert len(record) == 60 and not list(tmp_path.iterdir())
