"""The pile and the probe: the rolling law with one grain, and the two stages one after the other."""

import csv
import math
import sys

import numpy as np
import pytest
from cograin import Program
from conftest import ROOT

FOLDER = ROOT / "models" / "pile_and_probe"
sys.path.insert(0, str(FOLDER))

import heap  # noqa: E402
import sweep  # noqa: E402


@pytest.mark.parametrize("friction", [0.1, 0.2])
def test_one_grain_rolls_where_the_slope_is_steeper_than_its_rolling_friction(request, tmp_path, friction):
    program = Program(ROOT / request.config.getoption("--program"))
    assert abs(sweep.rolls(program, tmp_path, friction, 0.98 * friction)) < 1e-12
    angle = math.atan(1.1 * friction)
    expected = 5.0 / 7.0 * 9.81 * (math.sin(angle) - friction * math.cos(angle)) * 0.5
    # Its spring is stretched first, which takes a little of the way.
    assert sweep.rolls(program, tmp_path, friction, 1.1 * friction) == pytest.approx(expected, rel=0.02)


def test_a_cone_of_spheres_has_its_slope():
    random = np.random.default_rng(1)
    away, turn = 0.045 * np.sqrt(random.uniform(size=20000)), random.uniform(0.0, 2.0 * np.pi, 20000)
    below = random.uniform(size=20000) * (0.03 - 0.5 * away)
    points = np.stack([away * np.cos(turn), away * np.sin(turn), below], axis=1)
    tops = heap.surface(points, np.full(20000, 1e-5))
    assert np.polyfit(*tops.T, 1)[0] == pytest.approx(-0.5, abs=0.05)


def test_the_probe_takes_over_the_pile_with_what_came(cograin, tmp_path):
    pile, probe = tmp_path / "pile", tmp_path / "probe"
    cograin("run", FOLDER / "scene.toml", "--inputs", FOLDER / "input.csv", "--set", "run.end=0.15", "-o", pile)
    course = tmp_path / "course.csv"
    course.write_text("time,probe.displacement.z\n0.0,0.0\n0.15,0.0\n0.18,-0.037\n")
    said = cograin("run", FOLDER / "probe.toml", "--from", pile / "checkpoint.cograin", "--inputs", course, "-o", probe)
    assert "probe" in said  # it is new, and the program says so
    before, after = (list(csv.DictReader((folder / "history.csv").open())) for folder in (pile, probe))
    assert int(before[-1]["feed.count"]) > 100
    assert float(after[0]["everything.mass"]) == pytest.approx(float(before[-1]["everything.mass"]), rel=1e-12)
    left = float(after[-1]["everything.mass"]) + float(after[-1]["over_the_rim.mass"])
    assert left == pytest.approx(float(before[-1]["everything.mass"]), rel=1e-12)
    assert max(float(row["probe.force.z"]) for row in after) > 0.0
    assert float(after[-1]["probe.work"]) > 0.0
