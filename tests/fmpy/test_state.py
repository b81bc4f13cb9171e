"""A saved state continues bit for bit: in the instance, in another one, and in another process."""

import subprocess
import sys
from pathlib import Path

import pytest
from conftest import Slave
from fmpy.fmi1 import FMICallException


def run(slave, course, first, last):
    """Rows of the outputs of these steps."""
    return [slave.step(course.displacement(step), course.interval) for step in range(first, last + 1)]


def test_two_units_in_one_process_do_not_disturb_each_other(unit, model, course, slave):
    alone = run(slave(unit(model)), course, 1, course.steps)
    one, other = slave(unit(model), "one"), slave(unit(model), "other")
    interleaved = []
    for step in range(1, course.steps + 1):
        interleaved += run(one, course, step, step)
        other.step(-course.displacement(step), course.interval)
    assert interleaved == alone


def test_a_restored_unit_repeats_itself(unit, model, course, slave):
    half = course.steps // 2
    subject = slave(unit(model))
    run(subject, course, 1, half)
    saved, time = subject.slave.getFMUstate(), subject.time
    first = run(subject, course, half + 1, course.steps)
    subject.slave.setFMUstate(saved)
    subject.time = time
    assert run(subject, course, half + 1, course.steps) == first
    subject.slave.freeFMUstate(saved)


def test_a_serialised_state_continues_in_another_process(unit, model, course, slave, tmp_path):
    half = course.steps // 2
    subject = slave(unit(model))
    run(subject, course, 1, half)
    saved = subject.slave.getFMUstate()
    state = tmp_path / "state"
    state.write_bytes(bytes(subject.slave.serializeFMUstate(saved)))
    subject.slave.freeFMUstate(saved)
    here = run(subject, course, half + 1, course.steps)

    there = subprocess.run(
        [sys.executable, __file__, unit(model), state, model, repr(subject.time), str(half)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert there.returncode == 0, there.stderr
    assert there.stdout.splitlines() == [repr(list(row)) for row in here]


def test_a_damaged_state_is_refused_and_the_unit_goes_on(unit, model, course, slave):
    subject, untouched = slave(unit(model), "one"), slave(unit(model), "other")
    saved = subject.slave.getFMUstate()
    blob = bytearray(subject.slave.serializeFMUstate(saved))
    subject.slave.freeFMUstate(saved)
    blob[len(blob) // 2] ^= 1
    with pytest.raises(FMICallException):
        subject.slave.deSerializeFMUstate(bytes(blob))
    assert run(subject, course, 1, 2) == run(untouched, course, 1, 2)


def continue_elsewhere(path, state, model, time, half):
    """What the other process does: restores the bytes, runs the second half, prints the rows."""
    from conftest import COURSES, Course

    course = COURSES.get(model, Course(interval=1e-3, steps=60))
    subject = Slave(path)
    restored = subject.slave.deSerializeFMUstate(Path(state).read_bytes())
    subject.slave.setFMUstate(restored)
    subject.slave.freeFMUstate(restored)
    subject.time = half * course.interval
    for row in run(subject, course, half + 1, course.steps):
        print(repr(list(row)))
    subject.close()


if __name__ == "__main__":
    continue_elsewhere(sys.argv[1], sys.argv[2], sys.argv[3], float(sys.argv[4]), int(sys.argv[5]))
