"""Structures against closed forms, and their energy books."""

import numpy as np
import pytest

from cograin import Modal, Oscillator, Partners, Step, Structure
from cograin.base.vector import vector


def march(structure, force, length, count, off=0.0):
    """Steps under a force of time, standing `off` beside the prediction; gives the displacements."""
    found = []
    for place in range(count):
        step = Step(place * length, (place + 1) * length, length)
        pull = vector(force(step.middle))
        structure.advance(pull, structure.predict(pull, step) + off, step)
        found.append(structure.displacement)
    return np.array(found)


def test_an_oscillator_follows_its_closed_form_in_second_order():
    errors = []
    for length in (2e-3, 1e-3):
        one = Oscillator(2.0, 50.0)
        found = march(one, lambda _: 3.0, length, round(1.0 / length))[-1, 0]
        errors.append(found - 3.0 / 50.0 * (1.0 - np.cos(5.0)))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=1e-3)


def test_the_energy_book_closes_with_dashpot_load_and_leftovers():
    one = Oscillator(2.0, 50.0, 0.7, load=lambda time: np.sin(9.0 * time), substeps=3)
    march(one, lambda time: 3.0 + time, 1e-2, 200, off=1e-9)
    assert one.loss > 0.0 and one.correction != 0.0
    left = one.work + one.load_work + one.correction - one.energy - one.loss
    assert abs(left) < 1e-13 * one.work


def test_a_static_structure_stands_where_the_force_puts_it():
    one = Oscillator(0.0, 50.0)
    assert march(one, lambda _: 3.0, 1e-2, 3)[:, 0] == pytest.approx([0.06, 0.06, 0.06])
    assert one.loss == pytest.approx(0.5 * 50.0 * 0.06**2)


def test_a_dashpot_alone_moves_at_force_over_damping():
    assert march(Oscillator(0.0, 0.0, 4.0), lambda _: 2.0, 0.1, 4)[-1, 0] == pytest.approx(0.2)


def test_substeps_are_steps_of_the_same_structure():
    fine, coarse = Oscillator(2.0, 50.0, 0.7), Oscillator(2.0, 50.0, 0.7, substeps=4)
    assert march(coarse, lambda _: 3.0, 4e-3, 25)[-1] == pytest.approx(march(fine, lambda _: 3.0, 1e-3, 100)[-1])


def test_modes_dense_and_sparse_matrices_are_one_structure():
    scipy = pytest.importorskip("scipy.sparse")
    mass, stiffness = np.diag([2.0, 1.0, 1.0]), np.array([[3.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    squares, shapes = np.linalg.eigh(np.diag([0.5**0.5, 1.0]) @ stiffness[:2, :2] @ np.diag([0.5**0.5, 1.0]))
    shapes = np.diag([0.5**0.5, 1.0]) @ shapes
    parts = [
        Structure(mass, stiffness, at=[1, 0], fixed=[2]),
        Structure(scipy.csr_matrix(mass), scipy.csr_matrix(stiffness), at=[1, 0], fixed=[2]),
        Modal(np.sqrt(squares) / (2.0 * np.pi), shapes.T[:, [1, 0]]),
    ]
    courses = [march(part, lambda time: [1.0, -0.5 * time], 0.05, 40) for part in parts]
    for course in courses[1:]:
        assert course == pytest.approx(courses[0], rel=1e-10, abs=1e-13)
    assert parts[0].field[2] == 0.0


def test_velocity_verlet_is_of_second_order():
    errors = []
    for length in (2e-3, 1e-3):
        one = Oscillator(2.0, 50.0)
        for place in range(round(1.0 / length)):
            one.kick(vector(3.0), vector(3.0), Step(place * length, (place + 1) * length, length))
        errors.append(one.displacement[0] - 3.0 / 50.0 * (1.0 - np.cos(5.0)))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=1e-3)


def test_a_structure_that_nothing_holds_is_refused_in_words():
    step = Step(0.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="nothing that holds it"):
        Oscillator(0.0, 0.0).predict(vector(1.0), step)
    with pytest.raises(ValueError, match="velocity Verlet needs a mass"):
        Oscillator(0.0, 1.0).drift(vector(1.0), step)


def test_partners_beside_each_other_take_their_own_directions():
    both = Partners(Oscillator(1.0, 10.0), Oscillator(0.0, 20.0))
    step = Step(0.0, 0.1, 0.1)
    alone = Oscillator(1.0, 10.0).predict(vector(1.0), step)[0]
    assert both.predict(vector([1.0, 1.0]), step) == pytest.approx([alone, 0.05])
    assert both.compliance(step)[0, 1] == 0.0


def test_finite_elements_of_scikit_fem_are_a_partner():
    skfem = pytest.importorskip("skfem")
    from skfem.helpers import dd

    basis = skfem.Basis(skfem.MeshLine(np.linspace(0.0, 2.0, 9)), skfem.ElementLineHermite())
    bending = skfem.BilinearForm(lambda u, v, _: 7.0 * dd(u)[0, 0] * dd(v)[0, 0]).assemble(basis)
    clamp, tip = basis.nodal_dofs[:, 0], basis.nodal_dofs[0, -1]
    beam = Structure(0.0 * bending, bending, at=tip, fixed=clamp)
    assert beam.predict(vector(1.0), Step(0.0, 1.0, 1.0))[0] == pytest.approx(2.0**3 / (3.0 * 7.0), rel=1e-10)


def test_velocity_verlet_is_of_second_order_with_a_dashpot_too():
    errors = []
    for step in (2e-2, 1e-2):
        plate, none = Oscillator(1.0, 100.0, 4.0), np.zeros(1)
        plate.place(velocity=1.0)
        for count in range(round(1.0 / step)):
            now = Step(count * step, (count + 1) * step, step)
            plate.drift(none, now)
            plate.kick(none, none, now)
        rate = np.sqrt(100.0 - 4.0)
        errors.append(abs(plate.position[0] - np.exp(-2.0) * np.sin(rate) / rate))
    assert 3.8 < errors[0] / errors[1] < 4.2
