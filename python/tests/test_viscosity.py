"""A granular gas in a cell that is sheared without end flows as kinetic theory says."""

import sys

import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "benches"))

from viscosity import grad, lun, simulated


def test_a_gas_that_is_sheared_has_the_viscosity_of_kinetic_theory(program, tmp_path):
    solid, restitution = 0.05, 0.9
    # Other seeds scatter by 4 % in temperature and viscosity, by 1.5 % in pressures.
    found = simulated(
        program.path.resolve(), tmp_path, solid, restitution, count=200, strain=25.0, start=5.0, stiff=30.0
    )
    theory, moments = lun(solid, restitution), grad(solid, restitution)
    pressure = sum(found.pressures) / 3
    assert found.temperature == pytest.approx(theory.temperature, rel=0.12)
    assert found.shear / found.temperature**0.5 == pytest.approx(theory.shear / theory.temperature**0.5, rel=0.1)
    assert pressure / found.temperature == pytest.approx(theory.pressures[0] / theory.temperature, rel=0.04)
    across = found.pressures[1] / pressure
    assert across == pytest.approx(3 * moments.pressures[1] / sum(moments.pressures), rel=0.06)


def test_both_theories_are_that_of_elastic_spheres_in_their_common_limit():
    # Chapman and Enskog's viscosity 5/16 sqrt(m T/pi)/d^2 for mass density and diameter 1, T the square of a velocity.
    for theory in (lun, grad):
        flow = theory(1e-6, 1.0 - 1e-9)
        assert flow.shear / flow.temperature**0.5 == pytest.approx(5 / 96 * 3.141592653589793**0.5, rel=1e-5)
        assert flow.pressures == pytest.approx([1e-6 * flow.temperature] * 3, rel=1e-5)
