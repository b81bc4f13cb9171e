"""The hopper: its controller as a unit, the begin of the coupled run, and the mass that comes and goes."""

import subprocess
import sys

import numpy as np
import pytest
from cograin import Unit
from conftest import ROOT
from fmpy.validation import validate_fmu
from test_expected import compare, table

FOLDER = ROOT / "models" / "hopper"


@pytest.fixture(scope="module")
def ran(request, tmp_path_factory):
    """The folder of a short run in which the gate opens early."""
    folder = tmp_path_factory.mktemp("hopper")
    program = ROOT / request.config.getoption("--program")
    command = [sys.executable, FOLDER / "couple.py", "--program", program, "--output", folder, "--no-picture"]
    subprocess.run([*command, "--end", "0.1", "--begin", "0.02"], check=True, capture_output=True)
    return folder


def test_the_hopper_begins_as_expected_and_no_mass_is_lost(ran):
    names, rows = table(ran / "couple.csv")
    expected_names, expected = table(FOLDER / "expected.csv")
    compare((names, rows[::10][: len(expected)]), (expected_names, expected), 1e-6)
    column = {name: rows[:, place] for place, name in enumerate(names)}
    there, came = column["everything.mass"], column["feed.mass"]
    went = column["drain.mass"] + column["spilt.mass"]
    assert came[-1] > 0.0 and column["below_the_gate.mass"][-1] > 0.0
    assert np.abs(there - there[0] - came + went).max() < 1e-12 * there[0]


def test_the_controller_opens_below_and_shuts_above_at_the_speed_of_the_gate(ran):
    path = ran / "Controller.fmu"
    assert validate_fmu(str(path)) == []
    with Unit(path, parameters={"begin": 0.01, "speed": 1.0}) as controller:
        found = []
        for mass in [0.0] * 100 + [0.067] * 5 + [0.071] * 20 + [0.067] * 60:
            controller["mass"] = mass
            controller.step(1e-3)
            found.append(controller["position"])
    found = np.array(found)
    assert (found[:10] == 0.0).all() and found[11] > 0.0
    assert found[104] == pytest.approx(0.05) and np.diff(found).max() == pytest.approx(1e-3)
    # Between the thresholds it goes on with what it did.
    assert found[124] == pytest.approx(0.03) and found[-1] == pytest.approx(0.0, abs=1e-15)
