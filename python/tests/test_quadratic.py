"""The exchange of higher order: order, energy, what it refuses."""

import copy

import numpy as np
import pytest
from conftest import CHAIN, DROP

from cograin import (
    Coupling,
    Interface,
    Newton,
    Oscillator,
    Partners,
    Quadratic,
    QuasiNewton,
    RigidBody,
    Secant,
    Step,
    Structure,
    Tolerance,
    UnitError,
    couple,
)

FLOOR = "floor.displacement.z"
ENDS = ["left.displacement.x", "right.displacement.x"]


def bent(text):
    """The scene with quadratic motion wherever the outside moves something."""
    return text.replace("motion = { driven", 'input = "quadratic"\nmotion = { driven')


def march(structure, force, length, count, off=0.0):
    """Steps under a force of time, standing `off` beside displacement and acceleration that were predicted."""
    for place in range(count):
        step = Step(place * length, (place + 1) * length, length)
        early, late = (np.array([force(step.middle + side * length / 12.0**0.5)]) for side in (-1.0, 1.0))
        mean, slope = 0.5 * (early + late), (late - early) / (length / 3.0**0.5)
        end, acceleration = structure.predict_quadratically(mean, slope, step)
        structure.advance_quadratically((mean, slope), (end + off, acceleration + off), step)
    return structure.displacement[0]


def test_a_structure_follows_its_closed_form_in_fourth_order():
    errors = []
    for length in (4e-2, 2e-2):
        found = march(Oscillator(2.0, 50.0), lambda _: 3.0, length, round(1.0 / length))
        errors.append(found - 3.0 / 50.0 * (1.0 - np.cos(5.0)))
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.02)


def test_the_energy_book_closes_with_dashpot_load_and_leftovers():
    one = Oscillator(2.0, 50.0, 0.7, load=lambda time: np.sin(9.0 * time))
    march(one, lambda time: 3.0 + time, 1e-2, 200, off=1e-9)
    assert one.loss > 0.0 and one.correction != 0.0
    left = one.work + one.load_work + one.correction - one.energy - one.loss
    assert abs(left) < 1e-13 * one.work


def test_a_dashpot_alone_moves_at_force_over_damping():
    assert march(Oscillator(0.0, 0.0, 4.0), lambda time: 2.0 * time, 0.1, 4) == pytest.approx(0.25 * 0.4**2)


def test_sparse_and_dense_matrices_are_one_structure():
    scipy = pytest.importorskip("scipy.sparse")
    mass, stiffness = np.diag([2.0, 1.0]), np.array([[3.0, -1.0], [-1.0, 2.0]])
    parts = [Structure(each(mass), each(stiffness), at=0) for each in (np.array, scipy.csc_matrix)]
    assert march(parts[0], np.sin, 0.1, 20) == pytest.approx(march(parts[1], np.sin, 0.1, 20), rel=1e-12)


def test_impulse_and_work_are_the_same_on_both_sides(opened):
    unit, plate = opened(bent(DROP)), Oscillator(1.0, 1e4)
    record = couple(Interface(unit, FLOOR), plate, Quadratic(), step=1e-3, end=0.15)
    assert record.exchanged_work > 0.1 and not record.unconverged
    assert abs(record.interface_energy) <= 1e-12 * record.exchanged_work
    assert unit["floor.work"] + plate.work == pytest.approx(0.0, abs=1e-12 * record.exchanged_work)


def test_two_directions_are_coupled_in_fourth_order(opened):
    # The time step of the unit is much shorter than the communication steps: its own error does not show.
    text = bent(CHAIN).replace("step = 1.0e-4", "step = 1.0e-5")
    area = np.pi * 0.05**2
    one, other = 5026.548245743668 * area, 10053.096491487338 * area
    matrix = np.array([[one, -one, 0.0], [-one, one + other, -other], [0.0, -other, other + 30.0]])
    squares, modes = np.linalg.eigh(matrix)
    rates, end, errors = np.sqrt(np.maximum(squares, 1e-300)), 0.96, []
    exact = modes @ (np.where(squares > 1e-9, np.sin(rates * end) / rates, end) * (modes.T @ [0.0, 0.0, 0.01]))
    for step in (8e-2, 4e-2):
        wall = Structure([1.0, 1.0], [0.0, 30.0])
        wall.place(velocity=[0.0, 0.01])
        exchange = Quadratic(QuasiNewton(tolerance=Tolerance(1e-13)))
        Coupling(Interface(opened(text), ENDS), wall, exchange, step).run(end)
        errors.append(abs(wall.displacement[1] - exact[2]))
    assert 10.0 < errors[0] / errors[1] < 30.0
    assert errors[1] < 2e-4 * abs(exact[2])


def test_two_partners_move_as_one_structure_of_both(opened):
    def walls():
        left, right = Oscillator(1.0, 5.0, 0.3), Structure([2.0], [30.0])
        right.place(velocity=[0.01])
        return left, right

    both = Structure([1.0, 2.0], np.diag([5.0, 30.0]), np.diag([0.3, 0.0]))
    both.place(velocity=[0.0, 0.01])
    step = Step(0.0, 4e-2, 4e-2)
    assert (Partners(*walls()).quadratic_compliance(step) == both.quadratic_compliance(step)).all()
    for make in (QuasiNewton, lambda **named: Newton("differences", **named)):
        ends = []
        for partner in (copy.deepcopy(both), Partners(*walls())):
            exchange = Quadratic(make(tolerance=Tolerance(1e-13)))
            record = Coupling(Interface(opened(bent(CHAIN)), ENDS), partner, exchange, 4e-2).run(0.4)
            ends.append(np.array([record[name] for name in ENDS]))
        assert np.abs(ends[1] - ends[0]).max() <= 1e-10 * np.abs(ends[0]).max()


def test_any_repeated_exchange_finds_both_numbers(opened):
    ends = []
    for make in (QuasiNewton, lambda **named: Newton("differences", **named)):
        plate, exchange = Oscillator(1.0, 1e4), Quadratic(make(tolerance=Tolerance(1e-12)))
        ends.append(couple(Interface(opened(bent(DROP)), FLOOR), plate, exchange, step=1e-3, end=0.06)[FLOOR])
    assert np.abs(ends[1] - ends[0]).max() <= 1e-8 * np.abs(ends[0]).max()


def test_what_cannot_move_along_parabolas_is_refused(opened):
    def begin(text, partner, exchange=None, **named):
        Coupling(Interface(opened(text), FLOOR, **named), partner, exchange or Quadratic(), 1e-3).advance()

    with pytest.raises(UnitError, match=r'input = "quadratic", found order 2'):
        begin(DROP, Oscillator(1.0, 1e4))
    with pytest.raises(ValueError, match="needs a partner with mass or damping"):
        begin(bent(DROP), Oscillator(0.0, 1e4))
    with pytest.raises(ValueError, match="expected 1 substep of the partner, found 3"):
        begin(bent(DROP), Oscillator(1.0, 1e4, substeps=3))
    with pytest.raises(ValueError, match="expected 1 substep of the units, found 2"):
        begin(bent(DROP), Oscillator(1.0, 1e4), substeps=2)
    body = RigidBody(1.0, [0.1, 0.1, 0.1], at=[[0.0, 0.0, 0.0]])
    with pytest.raises(ValueError, match="RigidBody: quadratic motion needs a partner with predict_quadratically"):
        Partners(body).predict_quadratically(np.zeros(6), np.zeros(6), Step(0.0, 1.0, 1.0))
    with pytest.raises(ValueError, match="a secant is for one direction"):
        begin(bent(DROP), Oscillator(1.0, 1e4), Quadratic(Secant()))
