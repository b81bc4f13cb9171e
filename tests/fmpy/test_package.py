"""A packaged model is a valid unit that the importer's own command line runs."""

import csv
import subprocess
import sys

import numpy as np
from fmpy.validation import validate_fmu


def test_the_validator_finds_nothing(unit, model):
    assert validate_fmu(str(unit(model))) == []


def test_the_validator_says_so_from_the_command_line(unit, model):
    done = subprocess.run(
        [sys.executable, "-m", "fmpy", "validate", unit(model)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_importer_simulates_it_from_the_command_line(unit, model, course, tmp_path):
    result = tmp_path / "result.csv"
    end = course.steps * course.interval
    done = subprocess.run(
        [sys.executable, "-m", "fmpy", "simulate", unit(model), "--stop-time", repr(end)]
        + ["--output-interval", repr(course.interval), "--output-file", result],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    rows = list(csv.reader(result.open()))
    values = np.array(rows[1:], dtype=float)
    assert abs(values[-1, 0] - end) < 1e-12, f"the last row is at {values[-1, 0]} s, not at {end} s"
    assert np.isfinite(values).all()
