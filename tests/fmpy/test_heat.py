"""A unit whose floor has a temperature that the master gives, and whose lid takes up heat."""

import fmpy
import numpy as np
import pytest
from cograin import Unit
from fmpy.validation import validate_fmu

SCENE = """
[run]
step = 1.0e-3
end = 1.0
[heat]
frozen = true
[material.glass]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
conductivity = 1.0
specific_heat = 800.0
[pair.glass.glass]
restitution = 0.5
[contact.touch.normal.hertz]
[contact.touch.heat.constriction]
[particles.bed]
material = "glass"
temperature = 300.0
lattice = { kind = "simple_cubic", counts = [3, 3, 3], radius = 1.0e-3, spacing = 1.99e-3, origin = [0, 0, 0.99e-3] }
[boundary.floor]
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
material = "glass"
temperature = "driven"
[boundary.lid]
plane = { point = [0, 0, 5.96e-3], normal = [0, 0, -1] }
material = "glass"
temperature = 310.0
heat_capacity = 0.05
"""


@pytest.fixture(scope="module")
def path(cograin, tmp_path_factory):
    """The unit."""
    folder = tmp_path_factory.mktemp("heat")
    (folder / "scene.toml").write_text(SCENE)
    cograin("export", folder / "scene.toml", "-o", folder / "heat.fmu", "--overwrite")
    return folder / "heat.fmu"


def test_its_description_is_valid_and_names_kelvin_and_watt(path):
    assert validate_fmu(str(path)) == []
    description = fmpy.read_model_description(str(path))
    units = {unit.name: unit.baseUnit for unit in description.unitDefinitions}
    assert units["K"].K == 1
    assert (units["W"].kg, units["W"].m, units["W"].s) == (1, 2, -3)
    starts = {variable.name: variable.start for variable in description.modelVariables}
    assert float(starts["floor.temperature"]) == 300.0


def test_what_the_floor_gives_is_what_the_grains_gain(path):
    with Unit(path) as unit:
        heat, given = 0.0, 0.0
        for temperature, length in [(320.0, 0.1), (350.0, 0.05), (330.0, 0.2)]:
            unit["floor.temperature"] = temperature
            unit["lid.applied_heat"] = 0.01
            unit.step(length)
            given -= (unit["floor.mean_heat_flow"] + unit["lid.mean_heat_flow"]) * length
            heat = unit["energy.heat"]
        assert heat == pytest.approx(given, rel=1e-12)
        assert abs(unit["energy.heat_residual"]) < 1e-12 * heat
        assert 0.05 * (unit["lid.temperature"] - 310.0) == pytest.approx(unit["lid.heat"] + 0.01 * 0.35, rel=1e-9)


def test_it_goes_on_with_the_same_bits_after_its_state_is_restored(path):
    names = ["floor.mean_heat_flow", "lid.temperature", "energy.heat"]
    with Unit(path) as unit:
        unit["floor.temperature"] = 320.0
        unit.step(0.1)
        state, ends = unit.save(), []
        for _ in range(2):
            unit.restore(state)
            unit["floor.temperature"] = 340.0
            unit.step(0.1)
            ends.append(unit.get(names))
        assert np.array_equal(*ends)


def test_the_derivative_by_temperature_is_that_of_differences(path):
    with Unit(path) as unit:
        unit["floor.temperature"] = 320.0
        unit.step(0.1)
        state, flows = unit.save(), []
        for temperature in (339.0, 341.0, 340.0):
            unit.restore(state)
            unit["floor.temperature"] = temperature
            unit.step(0.1)
            flows.append(unit["floor.mean_heat_flow"])
        derivative = unit.derivative(["floor.mean_heat_flow"], ["floor.temperature"])[0, 0]
        assert derivative == pytest.approx(0.5 * (flows[1] - flows[0]), rel=1e-8)
        assert derivative < 0.0


def test_the_function_of_fmi_itself_gives_derivatives_of_heat_flows(path):
    outputs = ["floor.mean_heat_flow", "lid.mean_heat_flow", "energy.heat"]
    with Unit(path) as unit:
        references = [unit.variables[name].valueReference for name in [*outputs, "floor.temperature"]]
        unit["floor.temperature"] = 320.0
        unit.step(0.1)
        state, found = unit.save(), []
        for temperature in (338.0, 342.0, 340.0):
            unit.restore(state)
            unit["floor.temperature"] = temperature
            unit.step(0.1)
            found.append(unit.get(outputs))
        # For 2 K, of the outputs at the end of the step by the input that was set before it.
        told = unit.slave.getDirectionalDerivative(references[:3], references[3:], [2.0])
        assert list(told) == pytest.approx(0.5 * (found[1] - found[0]), rel=1e-7)
        # The grains gain what they do not give to the two boundaries.
        assert told[2] == pytest.approx(-0.1 * (told[0] + told[1]), rel=1e-9)
        assert told[0] < 0.0 < told[1]
