"""The example of models/biaxial_fe_dem: its block balances, follows rotations, and one element is the single cell."""

import sys

import numpy as np
import pytest
from conftest import ROOT

pytest.importorskip("skfem")
sys.path.insert(0, str(ROOT / "models" / "biaxial_fe_dem"))

import fe_dem
from solid import Block, piola, stiffness, triangular

PRESSURE = 1e5
LAW = np.array([[9e7, 3e7, 1e6], [3e7, 8e7, -2e6], [1e6, -2e6, 2.5e7]])


def law(strains):
    """A stand-in of cells: linear in the strains, and as they are under pressure before."""
    return strains @ LAW.T - [PRESSURE, PRESSURE, 0.0]


def test_what_a_cell_feels_does_not_depend_on_how_it_is_turned():
    gradient = np.array([[0.97, 0.08], [0.03, 0.91]])
    turn, strains = triangular(gradient)
    stress = law(strains)
    angle = 2.1
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned, same = triangular(rotation @ gradient)
    assert same == pytest.approx(strains, abs=1e-14)
    assert piola(rotation @ gradient, turned, stress) == pytest.approx(
        rotation @ piola(gradient, turn, stress), rel=1e-12
    )


def test_the_change_of_forces_is_that_of_the_solver():
    block = Block(1.0, 2.0, (2, 3), PRESSURE)
    random = np.random.default_rng(5)
    displacement = 0.02 * random.standard_normal(block.basis.N)
    stresses = law(block.strains(displacement))
    tangents = np.tile(LAW, (block.points, 1, 1))
    matrix = block.matrix(displacement, stresses, tangents)
    way = random.standard_normal(block.basis.N)
    sides = [
        block.forces(displacement + sign * 1e-6 * way, law(block.strains(displacement + sign * 1e-6 * way)))
        for sign in (1, -1)
    ]
    found = (sides[0] - sides[1]) / 2e-6
    assert matrix @ way == pytest.approx(found, abs=1e-6 * np.abs(found).max())


def test_stiffness_is_the_derivative_of_the_stress():
    gradient = np.array([[1.02, -0.04], [0.06, 0.93]])[:, :, None]
    _, strains = triangular(gradient)
    found = stiffness(gradient, law(strains.T).T, LAW[:, :, None])
    for row, column in np.ndindex(2, 2):
        sides = []
        for sign in (1, -1):
            moved = gradient.copy()
            moved[row, column] += sign * 1e-6
            turn, there = triangular(moved)
            sides.append(piola(moved, turn, law(there.T).T))
        expected = (sides[0] - sides[1]) / 2e-6
        assert found[:, :, row, column] == pytest.approx(expected, abs=1e-6 * np.abs(LAW).max())


def test_one_element_is_the_single_cell(program, tmp_path):
    point, alone = fe_dem.units(program, tmp_path)
    # Grains near the faces bear nothing: they are left out with their images.
    told = program(
        "check", ROOT / "models/biaxial_fe_dem/cell.toml", "--from", tmp_path / "sand.checkpoint", "--stiffness"
    )
    assert "cell.stress.xx to strains" in told
    strains = np.array([0.002, 0.004, 0.006])
    single = -fe_dem.single(alone, np.log(1 - strains))
    with fe_dem.Test(Block(1.0, 2.0, (1, 1), PRESSURE, rough=False), point, 2) as test:
        found = [test.step(2.0 * 0.002) for _ in strains]
    assert [force for force, _, _ in found] == pytest.approx(single, rel=0.01)
    assert all(rest <= test.tolerance for _, _, rest in found)
    assert single[-1] > 1.2 * PRESSURE
