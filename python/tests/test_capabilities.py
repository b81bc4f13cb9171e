"""What a master heeds: capabilities of units, wrong arguments, threads, looks."""

import re
import threading
import zipfile

import numpy as np
import pytest
from conftest import CHAIN, DROP
from test_interruptions import MAKES
from test_masters import ENDS, FLOOR

from cograin import (
    Coupling,
    CouplingStopped,
    FixedPoint,
    GaussSeidel,
    Interface,
    Newton,
    Oscillator,
    Partners,
    QuasiNewton,
    Secant,
    Step,
    StepControl,
    Structure,
    Unit,
    UnitError,
    UnitPartner,
    couple,
    stiffness,
)


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
