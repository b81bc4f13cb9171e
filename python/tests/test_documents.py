"""Scripts of the pages and examples run as they stand there."""

import re

import numpy as np
import pytest
from conftest import DROP, ROOT
from test_fluid import WET, coupled
from test_heated_bed import FROZEN


@pytest.fixture
def script(packaged, tmp_path, monkeypatch):
    """Runs a script beside a unit of this scene; gives its values."""

    def run(code, text, *changes):
        for found, instead in changes:
            assert found in code
            code = code.replace(found, instead)
        monkeypatch.chdir(tmp_path)
        (tmp_path / "bed.fmu").write_bytes(packaged(text).read_bytes())
        values = {}
        exec(code, values)
        return values

    return run


def example(name):
    """The text of an example."""
    return (ROOT / "examples" / name).read_text(encoding="utf-8")


def block(page, begin):
    """The block of a page that begins with these words."""
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / page).read_text(encoding="utf-8"), re.DOTALL)
    (found,) = [each for each in blocks if each.startswith(begin)]
    return found


def test_a_script_of_fmpy_alone_keeps_heat_to_rounding(script):
    found = script(example("heated_wall.py"), FROZEN, ("50.0", "0.05"))
    given = 0.05 * (found["start"] - found["wall"])
    assert found["heat"] > 0.1 and abs(found["heat"] - given) < 1e-12 * given


def test_a_column_of_water_by_fmpy_alone_is_that_of_cograin(script, opened):
    found = script(example("water_column.py"), WET)
    unit = opened(WET)
    column, coupling = coupled(unit, 0.0, 1e-3)
    for _ in coupling.steps(5e-3):
        pass
    # The script leaves out what the fluid conveys, and what weights spread of the force of the pressure.
    for mine, theirs in ((found["new"], column.velocity), (found["dp"], column.pressure_gradient)):
        assert np.abs(mine - theirs).max() < 0.02 * np.abs(theirs).max()


def test_one_line_of_fmpy_lags_by_a_step_unless_its_signals_are_early(script):
    line = block("fmu.md", "import fmpy\nimport numpy")
    early = script(line, DROP)
    wanted = 1e-3 * np.sin(300.0 * early["times"])
    assert np.abs(early["table"]["floor.displacement.z"][1:-1] - wanted[1:]).max() < 1e-15
    late = script(line, DROP, ('way["time"] -= H', "pass"))
    assert np.abs(late["table"]["floor.displacement.z"][1:-1] - wanted[:-1]).max() < 1e-15
