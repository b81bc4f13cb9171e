"""Models still give the numbers that stand beside them: a change shows here, whether wanted or not."""

import csv
import subprocess
import sys

import numpy as np
import pytest
from conftest import MODELS, ROOT


def table(path):
    """Names and numbers of a CSV file."""
    rows = list(csv.reader(path.open()))
    return rows[0], np.array(rows[1:], dtype=float)


def compare(found, expected, tolerance):
    """Fails where a column is off by more than the tolerance, over its largest magnitude, in the rows that were run."""
    (names, values), (expected_names, expected_values) = found, expected
    assert len(values) > 1
    for column, name in enumerate(expected_names):
        if name == "energy.residual":
            continue  # rounding
        theirs = expected_values[: len(values), column]
        error = np.abs(values[:, names.index(name)] - theirs).max() / max(np.abs(theirs).max(), 1e-300)
        assert error <= tolerance, f"{name}: off by {error:.1e} of its largest magnitude"


def test_every_model_has_expected_numbers_and_a_readme():
    for model in MODELS:
        for name in ("expected.csv", "readme.md"):
            assert (ROOT / "models" / model / name).is_file(), f"models/{model}/{name} is missing"


def test_the_piston_gives_its_expected_numbers(unit, tmp_path):
    folder = ROOT / "models" / "piston"
    result = tmp_path / "result.csv"
    command = [sys.executable, "-m", "fmpy", "simulate", unit("piston"), "--input-file", folder / "input.csv"]
    command += ["--stop-time", "0.1", "--output-interval", "1e-3", "--output-file", result]
    subprocess.run(command, check=True, capture_output=True)
    # The same bits everywhere; another order of operations would grow from a last bit to some 1e-7 in this time.
    compare(table(result), table(folder / "expected.csv"), 1e-9)


@pytest.mark.parametrize("name", ["piston_load", "triaxial", "wheel", "pile_and_probe", "chute_wear"])
def test_a_model_that_runs_by_itself_begins_as_expected(cograin, name, tmp_path):
    folder = ROOT / "models" / name
    expected = table(folder / "expected.csv")
    inputs = ["--inputs", folder / "input.csv"] if (folder / "input.csv").exists() else []
    cograin("run", folder / "scene.toml", *inputs, "--set", f"run.end={expected[1][-1, 0]}", "-o", tmp_path / "out")
    # Where grains collide freely a last bit grows tenfold in 5 ms.
    compare(table(tmp_path / "out" / "history.csv"), expected, 1e-6)


def test_the_drum_begins_as_expected_and_its_energy_book_closes(request, tmp_path):
    folder = ROOT / "models" / "drum"
    program = ROOT / request.config.getoption("--program")
    command = [sys.executable, folder / "couple.py", "--program", program, "--output", tmp_path]
    subprocess.run([*command, "--end", "0.1", "--no-picture"], check=True, capture_output=True)
    names, rows = table(tmp_path / "couple.csv")
    expected_names, expected = table(folder / "expected.csv")
    compare((names, rows[3::4][: len(expected)]), (expected_names, expected), 1e-6)
    residual, kinetic = (np.abs(rows[:, names.index(f"energy.{name}")]).max() for name in ("residual", "kinetic"))
    assert residual < 1e-12 * kinetic, f"{residual:.1e} J of {kinetic:.1e} J"


def test_the_warm_drum_begins_as_expected_and_its_heat_is_what_it_lost(request, tmp_path):
    folder = ROOT / "models" / "drum_heat"
    program = ROOT / request.config.getoption("--program")
    command = [sys.executable, folder / "couple.py", "--program", program, "--output", tmp_path]
    done = subprocess.run([*command, "--end", "0.1", "--no-picture"], check=True, capture_output=True, text=True)
    names, rows = table(tmp_path / "couple.csv")
    expected_names, expected = table(folder / "expected.csv")
    compare((names, rows[4::4][: len(expected)]), (expected_names, expected), 1e-6)
    last = dict(zip(names, rows[-1], strict=True))
    warming = ("normal_damping", "tangential_damping", "sliding", "rolling")
    lost = sum(last[f"energy.lost.{cause}"] for cause in warming)
    assert lost > 1e-5 and abs(last["energy.heat"] + last["drum.heat"] - lost) < 1e-12 * lost
    left = float(done.stdout.rsplit("what is left", 1)[1].split()[0])
    assert abs(left) < 1e-6 * lost, done.stdout


def test_the_heated_plate_begins_as_expected_and_no_heat_is_lost(request, tmp_path):
    folder = ROOT / "models" / "heated_plate"
    program = ROOT / request.config.getoption("--program")
    command = [sys.executable, folder / "couple.py", "--program", program, "--output", tmp_path]
    subprocess.run([*command, "--end", "0.2", "--no-picture"], check=True, capture_output=True)
    names, rows = table(tmp_path / "couple.csv")
    expected_names, expected = table(folder / "expected.csv")
    # The plate's factorisation is the machine's own, to rounding.
    compare((names, rows[1::2][: len(expected)]), (expected_names, expected), 1e-6)
    last = dict(zip(names, rows[-1], strict=True))
    exchanged = np.abs(rows[:, names.index("plate.mean_heat_flow")] * rows[:, names.index("length")]).sum()
    given = -(rows[:, names.index("plate.mean_heat_flow")] * rows[:, names.index("length")]).sum()
    assert exchanged > 0.1 and abs(last["energy.heat"] - given) < 1e-12 * exchanged
    left = last["heater"] - last["stored"] - last["left"] - last["energy.heat"]
    assert abs(left) < 1e-11 * last["heater"], f"{left:.1e} J"


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("fluidised_column", ["--end", "0.02"]),
        ("settling", ["--counts", "200", "490"]),
        ("seepage", ["--end", "0.008"]),
    ],
)
def test_grains_in_a_fluid_do_as_expected(request, name, options, tmp_path):
    folder = ROOT / "models" / name
    program = ROOT / request.config.getoption("--program")
    command = [sys.executable, folder / "couple.py", "--program", program, "--output", tmp_path, "--no-picture"]
    subprocess.run([*command, *options], check=True, capture_output=True)
    compare(table(tmp_path / "couple.csv"), table(folder / "expected.csv"), 1e-6)


def test_the_loaded_beam_begins_as_expected(request, tmp_path):
    folder = ROOT / "models" / "loaded_beam"
    program = ROOT / request.config.getoption("--program")
    command = [sys.executable, folder / "couple.py", "--program", program, "--output", tmp_path]
    subprocess.run([*command, "--end", "0.01", "--no-failure"], check=True, capture_output=True)
    # The beam's factorisation is the machine's own, to rounding.
    compare(table(tmp_path / "couple.csv"), table(folder / "expected.csv"), 1e-6)


def test_the_ice_begins_as_expected(request, tmp_path):
    folder = ROOT / "models" / "ice_beam"
    program = ROOT / request.config.getoption("--program")
    command = [sys.executable, folder / "couple.py", "--program", program, "--output", tmp_path]
    subprocess.run([*command, "--end", "0.2", "--no-frames"], check=True, capture_output=True)
    compare(table(tmp_path / "couple.csv"), table(folder / "expected.csv"), 1e-9)


def test_the_energy_book_of_the_ice_closes_while_it_breaks(unit, slave):
    # Fifty times as fast as the hull of the model: pieces fly at speeds for which its step of 1e-4 s is too long.
    ice = slave(unit("ice_beam", "run.step=5e-5"))
    for step in range(1, 31):
        ice.step(1e-3 * step, 1e-3)
    broken = ice.slave.getInteger([ice.reference("bonds.broken")])[0]
    assert broken > 20, f"a hull at 1 m/s broke {broken} bonds"
    work, residual = ice.get("hull.work", "energy.residual")
    assert abs(residual) < 1e-12 * work, f"{residual:.1e} J of {work:.1e} J"


def test_the_cantilever_bends_and_rings_as_theory_says(request, tmp_path):
    folder = ROOT / "models" / "cantilever"
    program = ROOT / request.config.getoption("--program")
    command = [sys.executable, folder / "couple.py", "--program", program, "--output", tmp_path]
    done = subprocess.run([*command, "--levels", "2", "--periods", "6"], check=True, capture_output=True, text=True)
    names, rows = table(tmp_path / "couple.csv")
    expected_names, expected = table(folder / "expected.csv")
    assert names == expected_names
    # The same deflections as in every second row of the table; what the master waited for is 1e-10 of the force.
    for name in ("displacement", "force", "rotation", "clamp_moment"):
        column = names.index(name)
        assert np.allclose(rows[:, column], expected[1::2, column], rtol=1e-8, atol=0.0), name
    bending, ringing = done.stdout.split("ringing:")
    for line in bending.splitlines()[2:4]:
        assert abs(float(line.split()[3])) < 1e-9, line
    for line in ringing.splitlines()[2:5]:
        assert abs(float(line.split()[3])) < 1e-4, line
