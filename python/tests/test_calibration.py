"""The example of models/calibration: it finds what is known, with the uncertainty that it states."""

import sys

import numpy as np
import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "models" / "calibration"))

from calibrate import KEYS, BothTests, Surface, calibrate

TRUE = (0.45, 0.12)


def results(friction, rolling):
    """A stand-in of the two tests: an angle that both coefficients raise, void ratios that one does."""
    return {
        "angle": 8.0 + 12.0 * friction + 30.0 * rolling + 25.0 * friction * rolling - 4.0 * friction**2,
        "void_ratio_2": 0.62 + 0.25 * friction - 0.12 * friction**2 + 0.05 * rolling,
        "void_ratio_30": 0.52 + 0.22 * friction - 0.10 * friction**2 + 0.06 * rolling,
    }


def study(random, scatter):
    """Columns of a study over a grid, with scatter."""
    friction, rolling = (part.ravel() for part in np.meshgrid([0.1, 0.3, 0.5, 0.8], [0.0, 0.1, 0.25]))
    columns = {KEYS[0]: friction, KEYS[1]: rolling}
    for name, values in results(friction, rolling).items():
        columns[name] = values + random.normal(0.0, scatter[name], len(values))
    return columns


def test_the_coefficients_are_found_and_the_uncertainty_is_that_of_many_repetitions():
    random = np.random.default_rng(1)
    errors = {"angle": 0.3, "void_ratio_2": 4e-3, "void_ratio_30": 4e-3}
    right = {name: (value, errors[name]) for name, value in results(*TRUE).items()}
    exact = calibrate(study(random, dict.fromkeys(errors, 0.0)), right)
    assert exact[0] == pytest.approx(TRUE, abs=1e-6) and exact[2] < 1e-10
    found, stated = [], []
    for _ in range(150):
        measured = {name: (value + random.normal(0.0, error), error) for name, (value, error) in right.items()}
        point, covariance, _ = calibrate(study(random, dict.fromkeys(errors, 0.0)), measured)
        found.append(point)
        stated.append(np.sqrt(np.diag(covariance)))
    assert np.mean(found, axis=0) == pytest.approx(TRUE, abs=0.01)
    assert np.std(found, axis=0) == pytest.approx(np.mean(stated, axis=0), rel=0.2)


def test_scatter_of_the_packings_is_in_the_uncertainty():
    random = np.random.default_rng(2)
    measured = {name: (value, 1e-6) for name, value in results(*TRUE).items()}
    quiet, loud = (
        calibrate(study(random, {"angle": size, "void_ratio_2": 1e-2 * size, "void_ratio_30": 1e-2 * size}), measured)
        for size in (0.05, 0.5)
    )
    assert np.all(np.sqrt(np.diag(loud[1])) > 4.0 * np.sqrt(np.diag(quiet[1])))
    friction = np.linspace(0.0, 1.0, 400)
    noisy = Surface.through(friction, friction[::-1] ** 2, 3.0 + random.normal(0.0, 0.2, 400))
    assert noisy.scatter == pytest.approx(0.2, rel=0.1) and noisy((0.5, 0.25)) == pytest.approx(3.0, abs=0.1)


def test_both_tests_answer_rolling_friction(program):
    low, high = (BothTests(program.path)({KEYS[0]: 0.5, KEYS[1]: value, "run.seed": 1}) for value in (0.0, 0.25))
    assert high["angle"] > low["angle"] + 4.0
    assert high["void_ratio_2"] > low["void_ratio_2"] and low["void_ratio_2"] > low["void_ratio_30"] > 0.2
