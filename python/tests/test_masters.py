"""What a master owes its units: scales of every size, whole steps, flags, words."""

import os
import re
import signal
import threading
import time
import zipfile
from typing import ClassVar

import numpy as np
import pytest
from conftest import CHAIN, DROP

from cograin import (
    Aitken,
    Coupling,
    CouplingStopped,
    FixedPoint,
    GaussSeidel,
    Interface,
    Jacobi,
    Newton,
    Oscillator,
    Partners,
    Quadratic,
    QuasiNewton,
    Secant,
    Step,
    StepControl,
    Structure,
    Tolerance,
    Unit,
    UnitError,
    UnitPartner,
    Verlet,
    couple,
    stiffness,
)

FLOOR = "floor.displacement.z"
ENDS = ["left.displacement.x", "right.displacement.x"]
REPEATED = {
    "fixed point": FixedPoint,
    "aitken": Aitken,
    "secant": Secant,
    "quasi-newton": QuasiNewton,
    "newton": lambda: Newton("differences"),
}


class Contact:
    """A side without a unit: a spring of power 1.5 that is met at a distance, by the mean of both ends of a step."""

    names: ClassVar = ["wall.displacement.z"]
    work = None
    can_restore = keeps_itself = True
    has_derivatives = False

    def __init__(self, stiffness, gap):
        self.time, self.displacement, self.before = 0.0, np.zeros(1), np.zeros(1)
        self.stiffness, self.gap = stiffness, gap

    def at(self, place):
        overlap = np.maximum(place - self.gap, 0.0)
        return -self.stiffness * overlap * np.sqrt(overlap)

    def force(self, kind):
        return 0.5 * (self.at(self.before) + self.at(self.displacement))

    def advance(self, displacement, step, kind):
        self.before, self.displacement, self.time = self.displacement, displacement, step.end
        return self.force(kind)

    def save(self):
        self.saved = self.time, self.displacement, self.before

    def restore(self):
        self.time, self.displacement, self.before = self.saved


class Latch(Contact):
    """Particles whose mean force jumps by this much where their place at the end of a step passes the gap."""

    def force(self, kind):
        return np.where(self.displacement > self.gap, -self.stiffness, 0.0)


def meets(exchange, power, step=2.0**-10, end=2.0**-5):
    """A plate flies against the spring; lengths and times are scaled by 2 to this power, masses by its cube."""
    length, mass = 2.0**power, 2.0 ** (3 * power)
    # stiffness is force over length^1.5; powers of two are even for this
    side = Contact(1e7 * mass / length**2 * 2.0 ** (-0.5 * power) * 2.0 ** (0.5 * power) / length**0.5, 1e-3 * length)
    plate = Oscillator(0.1 * mass, 1e3 * mass / length**2)
    plate.place(velocity=0.5)
    return couple(side, plate, exchange, step=step * length, end=end * length, progress=False)


@pytest.mark.parametrize("make", REPEATED.values(), ids=REPEATED)
def test_a_scene_of_any_size_takes_the_same_evaluations_to_the_same_bits(make):
    here = meets(make(), 0)
    assert here["wall.mean_force.z"].min() < -1.0 and here["evaluations"].max() > 1
    for power in (-30, -20, 6, 20):
        there = meets(make(), power)
        assert np.array_equal(there["evaluations"], here["evaluations"])
        assert np.array_equal(there["wall.displacement.z"] * 2.0**-power, here["wall.displacement.z"])
        assert np.array_equal(there["wall.mean_force.z"] * 2.0 ** (-2 * power), here["wall.mean_force.z"])


def test_a_micron_scene_is_as_exact_as_a_large_one(opened):
    """Units in which everything is a millionth: an absolute tolerance accepted every first trial."""
    small = DROP.replace("0.06]", "0.06e-6]").replace("0.05 }", "0.05e-6 }")
    small = small.replace("normal_stiffness = 1.0e5", "normal_stiffness = 1.0e-1").replace("1.0e-5", "1.0e-11")
    small = small.replace("-9.81", "-9.81e6")
    ends = []
    for tolerance in (None, Tolerance(relative=1e-10)):
        plate = Oscillator(1e-18, 1e-2)
        side = Interface(opened(small), FLOOR)
        record = couple(side, plate, Secant(tolerance=tolerance), step=1e-9, end=1.2e-7)
        assert record["floor.mean_force.z"].min() < 0.0
        ends.append(record["floor.mean_force.z"])
    assert np.abs(ends[1] - ends[0]).max() <= 1e-5 * np.abs(ends[1]).max()


def test_a_long_way_before_the_contact_does_not_loosen_the_tolerance():
    ends = []
    for tolerance in (None, Tolerance(relative=1e-9)):
        side, plate = Contact(1e10, 0.5), Oscillator(1.0, 0.0)
        plate.place(velocity=1.0)
        record = couple(side, plate, Secant(tolerance=tolerance), step=1e-3, end=0.6, progress=False)
        ends.append(record["wall.mean_force.z"])
    assert np.abs(ends[1] - ends[0]).max() <= 1e-3 * np.abs(ends[1]).max()


def test_limits_that_are_given_stand_alone():
    assert Tolerance().relative == 1e-6 and Tolerance(1e-9).relative is None
    with pytest.raises(ValueError, match="expected numbers above 0, found nan"):
        Tolerance(float("nan"))


def test_sides_that_stand_apart_are_refused_however_small_they_are(opened):
    unit = opened(DROP, inputs={FLOOR: 1e-10})
    with pytest.raises(ValueError, match="the interface stands at"):
        couple(Interface(unit, FLOOR), Oscillator(1.0, 1.0), Secant(), step=1e-3, end=0.1)


@pytest.mark.parametrize("make", [Secant, QuasiNewton, Aitken, lambda: Newton("differences")])
def test_a_force_that_jumps_is_survived_with_the_defaults(make):
    # No displacement has the force between 0 and 5 N that would hold the spring at the gap.
    plate = Oscillator(0.0, 1e3, load=lambda time: 3.0)
    record = couple(Latch(5.0, 1e-3), plate, make(), step=1e-3, end=0.02, progress=False)
    assert len(record) == 20 and len(record.unconverged) == 20
    assert "the particles' force jumps" in record.summary
    assert record["refusals"].sum() == 0
    # What is kept is at the jump, as near as numbers are.
    assert record["wall.displacement.z"] == pytest.approx(np.full(20, 1e-3), rel=1e-9)


@pytest.mark.parametrize("make", [Secant, QuasiNewton])
def test_a_partner_with_mass_gets_through_a_jump_by_shorter_steps(make):
    plate = Oscillator(1.0, 0.0, load=lambda time: 3.0)
    record = couple(Latch(5.0, 1e-3), plate, make(), step=1e-2, end=0.08, progress=False)
    assert record["time"][-1] == pytest.approx(0.08)
    # It is pressed against the jump and stays there, within the way that the load takes it in a step.
    assert abs(plate.displacement[0] - 1e-3) <= 3.0 * 1e-2**2
    assert record["evaluations"].sum() < 100 * len(record)


class Stiff(Contact):
    """Three springs of power 1.5, ten thousand times as stiff as what they meet."""

    names: ClassVar = [f"{name}.displacement.x" for name in "abc"]

    def __init__(self):
        super().__init__(1e7, np.array([1e-3, -1e-3, 2e-3]))
        self.displacement = self.before = np.zeros(3)

    def force(self, kind):
        return self.at(self.displacement) - self.at(np.zeros(3))


def test_a_stiff_side_in_several_directions_is_solved_or_said_not_to_be():
    frame = np.array([[2e3, -5e2, 0.0], [-5e2, 2e3, -5e2], [0.0, -5e2, 2e3]])

    def run(exchange):
        partner = Structure(0.0, frame, load=lambda time: np.array([3.0, 2.0, 1.0]) * min(1.0, time / 5e-3))
        record = couple(Stiff(), partner, exchange, step=1e-3, end=0.02, progress=False)
        assert max((row.residual for row in record.unconverged), default=0.0) < 1e-4
        return record

    assert not run(Newton("differences")).unconverged
    try:
        run(QuasiNewton())
    except CouplingStopped as told:
        assert "displacements differ by" in str(told)


def test_a_jump_can_stop_a_run_or_be_accepted():
    plate = Oscillator(0.0, 1e3, load=lambda time: 3.0)
    with pytest.raises(CouplingStopped, match="force jumps"):
        couple(Latch(5.0, 1e-3), plate, Secant(), step=1e-3, end=0.02, control=StepControl(unconverged="stop"))
    with pytest.raises(ValueError, match="unconverged: expected 'shorten', 'accept' or 'stop', found 'ignore'"):
        StepControl(unconverged="ignore")


def test_two_units_on_one_degree_of_freedom(opened):
    one, other = opened(DROP, name="one"), opened(DROP, name="other")
    body = Structure(2.0, 1e4, at=[[1.0, 1.0]])
    record = couple(Interface(one, FLOOR) + Interface(other, FLOOR), body, QuasiNewton(), step=1e-3, end=0.15)
    assert not record.unconverged and record.exchanged_work > 0.1
    assert abs(record.interface_energy) <= 1e-12 * record.exchanged_work
    apart = record[f"one.{FLOOR}"] - record[f"other.{FLOOR}"]
    assert np.abs(apart).max() <= 1e-5 * np.abs(record[f"one.{FLOOR}"]).max()
    book = body.work + body.correction - body.energy
    assert abs(book) <= 1e-12 * record.exchanged_work
    # The same as one unit of its own on half of the structure.
    half = couple(Interface(opened(DROP), FLOOR), Oscillator(1.0, 5e3), Secant(), step=1e-3, end=0.15)
    assert record[f"one.{FLOOR}"] == pytest.approx(half[FLOOR], rel=1e-4, abs=1e-7)


# Steps that are left early


class Interrupted(Oscillator):
    """An oscillator whose prediction fails once, at this call."""

    def __init__(self, call, error):
        super().__init__(1.0, 1e4)
        self.left, self.error = call, error

    def predict(self, force, step):
        self.left -= 1
        if self.left == 0:
            raise self.error
        return super().predict(force, step)


MAKES = {**REPEATED, "quadratic": Quadratic}


@pytest.mark.parametrize("error", [RuntimeError("of the partner"), KeyboardInterrupt()], ids=["error", "ctrl-c"])
@pytest.mark.parametrize("name", MAKES)
def test_what_is_left_early_goes_on_with_the_same_bits(opened, name, error):
    text = DROP.replace("motion = { driven", 'input = "quadratic"\nmotion = { driven')
    make, step = MAKES[name], 1e-3
    whole = couple(Interface(opened(text), FLOOR), Oscillator(1.0, 1e4), make(), step=step, end=0.07)
    for call in (140, 141, 143):
        unit, plate = opened(text), Interrupted(call, error)
        if name == "quadratic":
            plate.predict_quadratically, plate.inner = plate.failing, plate.predict_quadratically
        coupling = Coupling(Interface(unit, FLOOR), plate, make(), step)
        with pytest.raises(type(error)):
            coupling.run(0.07, progress=False)
        begun = coupling.time
        assert unit.time == begun == len(coupling.record) * step and 0.0 < begun < 0.07
        if coupling.record.rows:
            assert unit[FLOOR] == plate.displacement[0] == coupling.record[FLOOR][-1]
        record = coupling.run(0.07, progress=False)
        for column in (FLOOR, "floor.mean_force.z", "evaluations", "time"):
            assert np.array_equal(record[column], whole[column])


def _failing(self, force, slope, step):
    self.left -= 1
    if self.left == 0:
        raise self.error
    return self.inner(force, slope, step)


Interrupted.failing = _failing


def test_an_error_while_the_partner_makes_its_step_takes_both_sides_back(drop):
    class Fails(Oscillator):
        broken = True

        def advance(self, force, displacement, step):
            super().advance(force, displacement, step)
            if step.begin == 5e-3 and self.broken:
                raise RuntimeError("after its step")

    plate = Fails(1.0, 1e4)
    plate.place(velocity=-0.1)
    coupling = Coupling(Interface(drop, FLOOR), plate, Secant(), 1e-3)
    with pytest.raises(RuntimeError, match="after its step"):
        coupling.run(0.01, progress=False)
    assert drop.time == coupling.time == 5e-3
    assert drop[FLOOR] == plate.displacement[0] == plate.position[0]
    plate.broken = False
    assert len(coupling.run(0.01, progress=False)) == 10


@pytest.mark.parametrize("fails", ["advance", "compliance"])
def test_an_explicit_run_whose_partner_failed_is_not_continued_silently(drop, fails):
    def fail(*_):
        raise RuntimeError("no more")

    plate = Oscillator(1.0, 1e4)
    coupling = Coupling(Interface(drop, FLOOR), plate, GaussSeidel(), 1e-3)
    setattr(plate, fails, fail)
    with pytest.raises(RuntimeError, match="no more"):
        coupling.advance()
    with pytest.raises(CouplingStopped, match="the units have made the step, the partner has not: no more"):
        coupling.advance()


@pytest.mark.parametrize("make", [GaussSeidel, Jacobi, Verlet, Secant])
def test_ctrl_c_leaves_both_sides_at_one_time(drop, make):
    calls = []

    def load(time):
        calls.append(time)
        if len(calls) == 40:
            os.kill(os.getpid(), signal.SIGINT)
        return 1.0

    plate = Oscillator(1.0, 1e4, load=load)
    coupling = Coupling(Interface(drop, FLOOR), plate, make(), 1e-3)
    with pytest.raises(KeyboardInterrupt):
        coupling.run(0.1, progress=False)
    assert 0.0 < coupling.time == drop.time == len(coupling.record) * 1e-3
    if make is not Jacobi:
        assert drop[FLOOR] == plate.displacement[0]
    record = coupling.run(0.1, progress=False)
    drop.reset()
    again = couple(Interface(drop, FLOOR), Oscillator(1.0, 1e4, load=lambda _: 1.0), make(), step=1e-3, end=0.1)
    assert np.array_equal(record[FLOOR], again[FLOOR])
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_ctrl_c_in_a_step_of_the_unit_leaves_its_time_right(drop):
    real = drop.slave.doStep

    def interrupted(*arguments):
        real(*arguments)
        os.kill(os.getpid(), signal.SIGINT)

    drop.slave.doStep = interrupted
    with pytest.raises(KeyboardInterrupt):
        drop.step(1e-3)
    drop.slave.doStep = real
    assert drop.time == 1e-3
    drop.step(1e-3)


@pytest.mark.parametrize("way", ["unit", "secant", "gauss-seidel", "parallel"])
def test_ctrl_c_ends_a_step_of_a_unit_that_takes_long(packaged, way):
    # Minutes, were it made to its end.
    length, short = 300.0, 1e-3
    with Unit(packaged(DROP)) as unit, Unit(packaged(DROP), name="other") as other:
        side = Interface(unit, FLOOR)
        if way == "parallel":
            side = side + Interface(other, FLOOR)
        exchange = GaussSeidel() if way == "gauss-seidel" else QuasiNewton()
        partner = Structure([1e3] * len(side.names), 1e9)
        coupling = Coupling(side, partner, exchange, length, parallel=way == "parallel")
        begun = time.monotonic()
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            unit.step(length) if way == "unit" else coupling.run(length, progress=False)
        assert time.monotonic() - begun < 30.0
        assert unit.time == other.time == coupling.time == 0.0
        timer.join()
        unit.step(short)
        other.step(short)
        assert np.array_equal(unit.outputs(), other.outputs()), "nothing of the step that was ended is left"


def test_a_partner_that_does_not_know_its_compliance_says_so_before_anything_moves(opened, piston):
    with Unit(piston) as other:
        partner = UnitPartner(other, force="piston.displacement.z", displacement="piston.force.z")
        unit = opened(DROP)
        before = unit.time, other.time
        with pytest.raises(ValueError, match="its compliance is not known"):
            Coupling(Interface(unit, FLOOR), partner, Newton(), 1e-3).advance()
        assert (unit.time, other.time) == before


def test_a_unit_as_partner_is_taken_back_too(opened):
    unit, other = opened(DROP), opened(CHAIN)
    partner = UnitPartner(other, force=ENDS[0], displacement="free.displacement.x")
    calls = []
    real = other.get

    def failing(names):
        calls.append(names)
        if len(calls) == 4:
            raise RuntimeError("no answer")
        return real(names)

    coupling = Coupling(Interface(unit, FLOOR), partner, FixedPoint(), 1e-3)
    coupling.advance()
    other.get = failing
    with pytest.raises(RuntimeError, match="no answer"):
        coupling.run(0.05, progress=False)
    assert unit.time == other.time == coupling.time


# Names, flags, words


def test_names_that_are_the_same_are_refused(opened):
    one, other = opened(DROP), opened(DROP)
    with pytest.raises(ValueError, match="expected units of different names, found scene twice"):
        Interface(one, FLOOR) + Interface(other, FLOOR)
    with pytest.raises(ValueError, match=r"expected each displacement once, found floor.displacement.z twice"):
        Interface(one, [FLOOR, FLOOR])
    with pytest.raises(ValueError, match="different names of its columns, found time twice"):
        Coupling(Interface(one, FLOOR), Oscillator(1.0, 1.0), Secant(), 1e-3, watch={"time": lambda: 0.0})
    with pytest.raises(ValueError, match="expected another unit as the partner"):
        Coupling(
            Interface(one, FLOOR), UnitPartner(one, force=FLOOR, displacement="ball.displacement.z"), Secant(), 1e-3
        )
    record = couple(Interface(one, FLOOR), Oscillator(1.0, 1.0), Secant(), step=1e-3, end=2e-3, watch=[FLOOR])
    assert record.names.count(FLOOR) == 1


def test_units_of_different_times_are_refused(opened):
    one, other = opened(DROP, name="one"), opened(DROP, name="other")
    other.step(1e-3)
    with pytest.raises(ValueError, match=r"other: expected to stand at 0 s, as the others do, found 0.001 s"):
        Coupling(Interface(one, FLOOR) + Interface(other, FLOOR), Structure([1.0, 1.0], 1.0), QuasiNewton(), 1e-3)
    partner = UnitPartner(other, force=FLOOR, displacement="ball.displacement.z")
    with pytest.raises(ValueError, match="other: expected to stand at 0 s"):
        Coupling(Interface(one, FLOOR), partner, FixedPoint(), 1e-3)


def test_an_output_is_not_moved(drop):
    with pytest.raises(ValueError, match=r"ball.displacement.z is an output; an input is needed"):
        Interface(drop, "ball.displacement.z")


@pytest.fixture
def altered(packaged, tmp_path):
    """A unit of another tool: the same with other flags."""
    opened = []

    def make(text, **flags):
        path = tmp_path / f"other{len(opened)}.fmu"
        with zipfile.ZipFile(packaged(text)) as source, zipfile.ZipFile(path, "w") as target:
            for item in source.namelist():
                data = source.read(item)
                if item == "modelDescription.xml":
                    for flag, value in flags.items():
                        data = re.sub(rb' %s="[a-z]+"' % flag.encode(), b"", data)
                        data = data.replace(b"<CoSimulation", b'<CoSimulation %s="%s"' % (flag.encode(), value), 1)
                target.writestr(item, data)
        opened.append(Unit(path))
        return opened[-1]

    yield make
    for unit in opened:
        unit.close()


def test_a_unit_without_states_is_refused_where_they_are_needed(altered):
    unit = altered(DROP, canGetAndSetFMUstate=b"false")
    with pytest.raises(
        ValueError, match=r"Secant: needs units that save and restore their states; other0 cannot \(can"
    ):
        couple(Interface(unit, FLOOR), Oscillator(1.0, 1e4), Secant(), step=1e-3, end=0.1)
    with pytest.raises(UnitError, match=r"cannot save its state \(canGetAndSetFMUstate\)"):
        unit.save()
    with pytest.raises(ValueError, match="stiffness: needs units that save"):
        stiffness(Interface(unit, FLOOR), 1e-3)
    assert len(couple(Interface(unit, FLOOR), Oscillator(1.0, 1e4), GaussSeidel(), step=1e-3, end=0.1)) == 100


def test_a_unit_of_one_length_of_steps_is_not_given_shorter_ones(altered):
    unit = altered(DROP, canHandleVariableCommunicationStepSize=b"false")
    plate = Oscillator(1e9, 0.0)
    plate.place(velocity=60.0)
    with pytest.raises(CouplingStopped, match=r"other0 takes no other \(canHandleVariableCommunicationStepSize\)"):
        couple(Interface(unit, FLOOR), plate, GaussSeidel(), step=1e-3, end=0.01)


def test_other_flags_are_heeded(altered):
    plain = altered(DROP, canSerializeFMUstate=b"false", canInterpolateInputs=b"false")
    with pytest.raises(UnitError, match="canSerializeFMUstate"):
        plain.serialise(plain.save())
    with pytest.raises(UnitError, match="canInterpolateInputs"):
        plain.set_rates([FLOOR], [1.0])
    lonely = altered(CHAIN, canBeInstantiatedOnlyOncePerProcess=b"true")
    with pytest.raises(UnitError, match="canBeInstantiatedOnlyOncePerProcess"):
        Unit(lonely.path)
    lonely.close()
    Unit(lonely.path).close()


def flags_of(unit, act):
    """What the unit is told about earlier states in each step of a course."""
    told, real = [], unit.slave.fmi2DoStep
    unit.slave.fmi2DoStep = lambda component, time, length, final: (
        told.append(final),
        real(component, time, length, final),
    )[1]
    act()
    unit.slave.fmi2DoStep = real
    return told


def test_a_unit_is_told_whether_an_earlier_state_may_come_back(drop):
    assert flags_of(drop, lambda: drop.step(1e-3)) == [1]
    plate = Oscillator(1.0, 1e4)
    assert flags_of(drop, lambda: couple(Interface(drop, FLOOR), plate, GaussSeidel(), step=1e-3, end=3e-3)) == [1, 1]
    told = flags_of(drop, lambda: couple(Interface(drop, FLOOR), plate, Secant(), step=1e-3, end=5e-3))
    assert told and set(told) == {0}
    drop.reset()
    state = drop.save()
    assert flags_of(drop, lambda: drop.step(1e-3)) == [0]
    drop.free(state)
    assert flags_of(drop, lambda: drop.step(1e-3)) == [1]
    data = drop.serialise(state := drop.save())
    drop.free(state)
    assert flags_of(drop, lambda: drop.step(1e-3)) == [0] and data


def test_a_closed_unit_says_so(packaged):
    unit = Unit(packaged(DROP))
    state = unit.save()
    unit.close()
    for call in (
        lambda: unit[FLOOR],
        lambda: unit.set([FLOOR], [0.0]),
        lambda: unit.step(1e-3),
        unit.save,
        lambda: unit.restore(state),
        unit.reset,
    ):
        with pytest.raises(UnitError, match="scene: the unit is closed"):
            call()


def test_wrong_arguments_are_answered_in_words(drop, tmp_path):
    with pytest.raises(ValueError, match="expected 2 values, one for each name, found 1"):
        drop.set([FLOOR, "run.threads"] if drop.variable("run.threads").type == "Real" else [FLOOR, FLOOR], [0.0])
    with pytest.raises(UnitError, match=r"missing.fmu: expected a unit, found no such file"):
        Unit(tmp_path / "missing.fmu")
    (tmp_path / "text.fmu").write_text("no archive")
    with pytest.raises(UnitError, match=r"text.fmu: expected a unit, found a file that cannot be read"):
        Unit(tmp_path / "text.fmu")
    state = drop.save()
    drop.free(state)
    with pytest.raises(UnitError, match="expected a saved state, found one that was freed"):
        drop.restore(state)
    with pytest.raises(UnitError, match="expected a saved state, found None"):
        drop.restore(None)
    with pytest.raises(ValueError, match=r"until: expected about 0.001 s, found -5 s"):
        drop.step(1e-3, until=-5.0)
    assert drop.time == 0.0
    for make, words in (
        (lambda: Oscillator(float("nan"), 1e4), "mass: expected finite numbers"),
        (lambda: Structure(np.eye(2), [1.0, float("inf")]), "stiffness: expected finite numbers"),
        (lambda: Oscillator(-1.0, 1e4), "mass: expected numbers from 0 on, found -1"),
        (lambda: Secant(tolerance=1e-6), r"tolerance: expected Tolerance\(displacement=..\), .*, found 1e-06"),
        (lambda: StepControl(halvings=1.5), "halvings: expected a whole number from 0 on, found 1.5"),
        (Partners, "partners: expected one at least"),
        (lambda: Interface(drop, []), "interface: expected names of displacements, found none"),
    ):
        with pytest.raises(ValueError, match=words):
            make()
    plate = Oscillator(1.0, 1e4)
    for step in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="step: expected a finite number above 0"):
            Coupling(Interface(drop, FLOOR), plate, Secant(), step)
    coupling = Coupling(Interface(drop, FLOOR), plate, Secant(), 1e-3)
    coupling.run(5e-3, progress=False)
    with pytest.raises(ValueError, match=r"end: expected a time from 0.005 s on, found 0.002 s"):
        coupling.run(2e-3)
    with pytest.raises(ValueError, match=r"end: expected a whole number of steps of 0.001 s, found inf"):
        coupling.run(float("inf"))


def test_units_run_in_threads_to_the_same_bits(packaged):
    def run(into):
        with Unit(packaged(DROP)) as unit:
            record = couple(Interface(unit, FLOOR), Oscillator(1.0, 1e4), Secant(), step=1e-3, end=0.15)
            into.append(record[FLOOR])

    found = []
    threads = [threading.Thread(target=run, args=(found,)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    run(found)
    assert len(found) == 5 and all(np.array_equal(one, found[0]) for one in found)


def test_what_is_only_looked_at_changes_no_bit(opened):
    whole = couple(
        Interface(opened(CHAIN), ENDS),
        Structure([1.0, 1.0], [0.0, 30.0], load=lambda _: [0.0, 1.0]),
        QuasiNewton(),
        step=4e-3,
        end=0.4,
    )
    unit = opened(CHAIN)
    wall = Structure([1.0, 1.0], [0.0, 30.0], load=lambda _: [0.0, 1.0])
    coupling = Coupling(Interface(unit, ENDS), wall, QuasiNewton(), 4e-3, watch=["free.velocity.x", "contacts.count"])
    for row in coupling.steps(0.4):
        if len(coupling.record) % 3 == 0:
            state = unit.save()
            unit.derivative(["left.mean_force.x"], ENDS)
            stiffness(Interface(unit, ENDS), 4e-3)
            unit.restore(state)
            unit.free(state)
            wall.predict(np.array([1.0, 2.0]), Step(row.time, row.time + 1.0, 1.0))
    for name in (*ENDS, "evaluations"):
        assert np.array_equal(coupling.record[name], whole[name])


@pytest.mark.parametrize("name", MAKES)
def test_an_exchange_begins_every_run_as_its_first(opened, name):
    text = DROP.replace("motion = { driven", 'input = "quadratic"\nmotion = { driven')
    exchange, found = MAKES[name](), []
    for _ in range(3):
        found.append(couple(Interface(opened(text), FLOOR), Oscillator(1.0, 1e4), exchange, step=1e-3, end=0.07))
    for record in found[1:]:
        assert np.array_equal(record[FLOOR], found[0][FLOOR])
        assert np.array_equal(record["evaluations"], found[0]["evaluations"])
    with pytest.raises(ValueError, match=r"exchange: expected an exchange, such as Secant\(\), found <class"):
        Coupling(Interface(opened(text), FLOOR), Oscillator(1.0, 1e4), Secant, 1e-3)


def test_stiffness_needs_no_length_where_the_units_give_derivatives(chain):
    area = np.pi * 0.05**2
    found = stiffness(Interface(chain, ENDS), 1e-4)
    assert found == pytest.approx(0.5 * area * np.array([5026.548245743668, 10053.096491487338]), rel=1e-6)
    assert chain.time == 0.0
