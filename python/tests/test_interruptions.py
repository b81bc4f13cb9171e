"""Steps that an error or Ctrl-C leaves early."""

import os
import signal
import threading
import time

import numpy as np
import pytest
from conftest import DROP
from test_masters import FLOOR, REPEATED

from cograin import (
    Coupling,
    CouplingStopped,
    GaussSeidel,
    Interface,
    Jacobi,
    Oscillator,
    Quadratic,
    QuasiNewton,
    Secant,
    Structure,
    Unit,
    Verlet,
    couple,
)


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
