"""The two tests of rock: a unit made by another tool moves the specimen, in three importers and in the replay."""

import csv
import itertools
import json
import subprocess
import sys
import tomllib

import numpy as np
import pytest
from conftest import ROOT
from test_expected import compare, table

sys.path.insert(0, str(ROOT / "models" / "rock_core"))

import laboratory  # noqa: E402
import machine  # noqa: E402

PARAMETERS = {"speed": 1.0, "stiffness": 1e9, "mass": 20.0, "damping_ratio": 0.5}
INTERVAL = 1e-5  # [s]
STEPS = 6
# How expected.csv was made. The columns that are rounding alone were left out.
BRIEFLY = ["--speed", "1", "--end", "6e-5", "--no-picture"]


@pytest.fixture(scope="module")
def pair(request, tmp_path_factory):
    """The disc and the press as units."""
    program = ROOT / request.config.getoption("--program")
    return laboratory.units(program, ROOT / "models" / "brazilian" / "scene.toml", tmp_path_factory.mktemp("rock"))


def rows(ways, *arguments):
    """The first rows of one way to couple."""
    found = ways(*arguments)
    first = list(itertools.islice(found, STEPS))
    found.close()
    return np.array(first)


def test_ecospy_couples_to_the_bits_of_our_own_master(pair):
    ours = rows(machine.with_fmpy, *pair, PARAMETERS, INTERVAL, "parallel")
    assert ours[-1, machine.COLUMNS.index("upper.work")] > 0.0
    assert np.array_equal(ours, rows(machine.with_ecospy, *pair, PARAMETERS, INTERVAL))


def test_libcosimpy_couples_to_the_numbers_of_our_own_master(pair):
    ours = rows(machine.with_fmpy, *pair, PARAMETERS, INTERVAL, "parallel")
    theirs = rows(machine.with_libcosimpy, *pair, PARAMETERS, INTERVAL)
    # Its clock counts nanoseconds: the length of a step, and with it the press, differs by rounding.
    scale = np.maximum(np.abs(ours).max(axis=0), 1e-6)
    assert (np.abs(ours - theirs) / scale).max() < 1e-9


def test_an_implicit_exchange_closes_the_book_between_the_units(pair):
    taken = rows(machine.with_fmpy, *pair, PARAMETERS, INTERVAL, "implicit")
    work, specimen = (taken[:, machine.COLUMNS.index(name)] for name in ("upper.work", "press.specimen_work"))
    moved = np.abs(np.diff(taken[:, 1], prepend=0.0)).sum()
    assert work[-1] > 1e-6
    # The master repeats steps until the forces agree to a thousandth of a newton.
    assert abs(work[-1] + specimen[-1]) <= 1e-3 * moved


def test_the_press_keeps_its_energy_book(pair):
    taken = rows(machine.with_fmpy, *pair, PARAMETERS, INTERVAL, "sequential")
    names = ("press.drive_work", "press.specimen_work", "press.energy", "press.loss")
    drive, specimen, energy, loss = (taken[-1, machine.COLUMNS.index(name)] for name in names)
    assert drive > 1e-3
    assert abs(drive + specimen - energy - loss) < 1e-14 * drive * STEPS


def test_a_replay_gives_the_bits_of_the_coupled_unit(pair, cograin, tmp_path):
    taken = rows(machine.with_fmpy, *pair, PARAMETERS, INTERVAL, "sequential")
    with (tmp_path / "couple.csv").open("w", newline="") as text:
        # The platen is the only input of the unit among what was recorded.
        own = [machine.COLUMNS.index(name) for name in ("time", machine.PLATEN)]
        csv.writer(text).writerows([["time", machine.PLATEN], *taken[:, own].tolist()])
    scene = ROOT / "models" / "brazilian" / "scene.toml"
    cograin("run", scene, "--inputs", tmp_path / "couple.csv", "-o", tmp_path / "replay")
    names, replayed = table(tmp_path / "replay" / "history.csv")
    assert len(replayed) == STEPS + 1
    for name in (*machine.READ, "bonds.broken"):
        ours = taken[:, machine.COLUMNS.index(name)]
        assert np.array_equal(ours, replayed[1:, names.index(name)]), name
    books = json.loads((tmp_path / "replay" / "summary.json").read_text())
    assert abs(books["energy"]["relative_residual"]) <= 1e-12
    assert abs(books["momentum"]["relative_residual"]) <= 1e-12


def test_disc_and_core_are_of_one_material():
    core, disc = (
        tomllib.loads((ROOT / "models" / name / "scene.toml").read_text()) for name in ("rock_core", "brazilian")
    )
    for key in ("material", "pair", "contact", "damping"):
        assert core[key] == disc[key], key
    for each, name in ((core, "core"), (disc, "disc")):
        each["bond"]["cement"].pop("between")
        each["packing"] = each["particles"][name]["packing"]
        each["packing"].pop("cylinder")
    assert core["bond"] == disc["bond"]
    assert core["packing"] == disc["packing"]
    assert core["run"]["step"] == disc["run"]["step"]


@pytest.mark.parametrize("specimen", ["rock_core", "brazilian"])
def test_the_tests_of_rock_begin_as_expected(specimen, request, tmp_path):
    folder = ROOT / "models" / specimen
    program = ROOT / request.config.getoption("--program")
    command = [sys.executable, folder / "couple.py", "--program", program, "--output", tmp_path]
    subprocess.run([*command, *BRIEFLY], check=True, capture_output=True)
    # Spheres that touch one after the other make more of a last bit: some ten times as much in a communication step.
    compare(table(tmp_path / "couple.csv"), table(folder / "expected.csv"), 1e-6)
