"""What `couple.py` of a recipe prints makes sense."""

import os
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

# Recipe, what it prints, and between which numbers the last one is.
SAID = {
    "drum": (r"1\.600,(\S+),", 2.8, 3.0),  # the motor holds 3 rad/s but for what its torque needs
    "plate": (r"the middle sags by (\S+) mm", 0.5, 1.0),  # of a membrane of 400 N/m under half a kilogram
    "loaded_beam": (r"the middle is (\S+) mm lower", 0.011, 0.013),  # the weight over the stiffness of the first mode
}


@pytest.mark.parametrize("recipe", SAID)
def test_a_recipe_couples_to_its_end_and_prints_sense(recipe, program, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    program("new", recipe)
    folder = tmp_path / recipe
    shutil.copy(ROOT / "command" / "recipes" / recipe / "couple.py", folder)  # whichever program it is
    path = f"{program.path.resolve().parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT / "python")}
    done = subprocess.run(
        [sys.executable, "couple.py"], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    pattern, low, high = SAID[recipe]
    assert low < float(re.search(pattern, done.stdout).group(1)) < high, done.stdout
