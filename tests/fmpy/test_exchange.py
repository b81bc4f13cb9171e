"""Runs in which particles come and go: their balances, what their frames hold, and how large their files get."""

import csv
import json
import re
import signal
import subprocess
import time

import meshio
import numpy as np
import pytest
import pyvista
from conftest import ROOT

SCENE = """
gravity = [0.0, 0.0, -9.81]
[run]
end = 0.2
step = 1e-5
seed = 7
[material.glass]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.6
friction = 0.4
[contact.all.normal.hertz]
[contact.all.tangential.history]
[particles.low]
material = "glass"
list = [{ position = [-0.02, 0.0, 0.0139], radius = 0.002 }, { position = [-0.02, 0.01, 0.0139], radius = 0.002 }]
[particles.high]
material = "glass"
list = [{ position = [-0.02, 0.0, 0.02], radius = 0.001 }]
[boundary.chute]
plane = { point = [0.0, 0.0, 0.0], normal = [0.5, 0.0, 0.8660254037844386] }
material = "glass"
[region.mouth]
box = [[-0.02, -0.03, 0.04], [0.02, 0.03, 0.06]]
[region.bin]
box = [[0.06, -1.0, -1.0], [1.0, 1.0, 1.0]]
[insertion.feed]
region = "mouth"
material = "glass"
sizes = { uniform = [0.001, 0.0015] }
count_rate = 2000.0
velocity = [0.5, 0.0, -1.0]
scatter = 0.2
[outlet.end]
region = "bin"
[flow_meter.gate]
polygon = [[0.05, -1.0, -1.0], [0.05, 1.0, -1.0], [0.05, 1.0, 1.0], [0.05, -1.0, 1.0]] # its front is towards x
[output]
energy = true
losses = true
history_interval = 0.02
frame_interval = 0.02
checkpoint_interval = 0.1
"""
UNITS = {"kB": 1e3, "MB": 1e6, "GB": 1e9}


def size(number, unit):
    """Bytes, and by how many the printed number may be rounded."""
    digits = len(number.partition(".")[2])
    return float(number) * UNITS[unit], 0.5 * 10.0**-digits * UNITS[unit]


@pytest.fixture(scope="module")
def chute(cograin, tmp_path_factory):
    """A run of the chute: its folder, its scene, and what `check` foretells."""
    folder = tmp_path_factory.mktemp("chute")
    scene = folder / "chute.toml"
    scene.write_text(SCENE)
    foretold = cograin("check", scene)
    cograin("run", scene, "-o", folder / "out")
    return folder / "out", scene, foretold


def test_what_comes_and_goes_closes_mass_momentum_and_energy(chute):
    folder, _, _ = chute
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["momentum"]["exchanged"] is not None
    assert summary["momentum"]["relative_residual"] < 1e-12
    assert abs(summary["energy"]["relative_residual"]) < 1e-12
    last = list(csv.DictReader((folder / "history.csv").open()))[-1]
    assert int(last["feed.count"]) > 350 and int(last["end.count"]) > 100
    there = meshio.read(max(folder.glob("particles_*.vtu"))).point_data
    own = 2500.0 * 4.0 / 3.0 * np.pi * (2 * 0.002**3 + 0.001**3)
    mass = own + float(last["feed.mass"]) - float(last["end.mass"])
    assert there["mass"].sum() == pytest.approx(mass, rel=1e-12)
    assert len(there["id"]) == 3 + int(last["feed.count"]) - int(last["end.count"])


def test_a_flow_meter_tells_what_is_behind_it_or_gone(chute):
    folder, _, _ = chute
    rows = list(csv.DictReader((folder / "history.csv").open()))
    mass = np.array([float(row["gate.mass"]) for row in rows])
    flow = np.array([float(row["gate.mass_flow"]) for row in rows])
    assert flow[0] == 0.0 and np.abs(flow[1:] * 0.02 - np.diff(mass)).max() < 1e-12 * mass[-1]
    for number, row in enumerate(rows):
        frame = meshio.read(folder / f"particles_{number:06}.vtu")
        behind = frame.points[:, 0] >= 0.05
        assert int(row["gate.count"]) == int(row["end.count"]) + behind.sum()
        went = float(row["end.mass"]) + frame.point_data["mass"][behind].sum()
        assert mass[number] == pytest.approx(went, rel=1e-12, abs=1e-18)
    assert int(rows[-1]["gate.count"]) > 100


def test_what_is_inserted_has_the_velocity_the_scatter_and_the_seed_that_are_asked_for(cograin, tmp_path):
    """Without forces the velocities stay as they were given."""

    def inserted(seed, name):
        scene, out = tmp_path / f"{name}.toml", tmp_path / name
        kept = [part for part in re.split(r"(?m)^(?=\[)", SCENE) if re.match(r"\[(material|region|insertion|output)", part)]
        run = f"[run]\nend = 0.5\nstep = 1e-4\nseed = {seed}\n"
        scene.write_text(run + "".join(kept).replace("frame_interval = 0.02", "frame_interval = 0.5"))
        cograin("run", scene, "-o", out)
        frame = meshio.read(max(out.glob("particles_*.vtu")))
        return frame.point_data["velocity"], frame.point_data["radius"], frame.points

    velocity, radius, points = inserted(1, "one")
    assert len(radius) > 900
    off = velocity - [0.5, 0.0, -1.0]
    assert np.abs(off).max() <= 0.2
    # Even chances: mean 0 and mean square 0.2²/3, to four deviations of so many samples.
    assert np.abs(off.mean(axis=0)).max() < 4.0 * 0.2 / np.sqrt(3.0 * len(off))
    assert np.abs((off**2).mean(axis=0) / (0.2**2 / 3.0) - 1.0).max() < 4.0 * np.sqrt(0.8 / len(off))
    assert radius.min() >= 0.001 and radius.max() <= 0.0015
    assert all(np.array_equal(one, other) for one, other in zip((velocity, radius, points), inserted(1, "again"), strict=True))
    assert not np.array_equal(velocity[:100], inserted(2, "other")[0][:100])


def test_a_run_that_is_interrupted_and_resumed_leaves_the_same_files(request, cograin, chute, tmp_path):
    whole, scene, _ = chute
    program = ROOT / request.config.getoption("--program")
    # A test that runs in the background may have inherited that interruptions are ignored.
    command = ["env", "--default-signal=INT", program, "run", scene, "-o", tmp_path]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
        while not (tmp_path / "particles_000003.vtu").exists() and run.poll() is None:
            time.sleep(0.002)
        run.send_signal(signal.SIGINT)
    cograin("run", scene, "-o", tmp_path, "--resume")
    names = {path.name for path in whole.iterdir()} - {"summary.json"}
    assert names == {path.name for path in tmp_path.iterdir()} - {"summary.json"}
    assert not [name for name in names if (whole / name).read_bytes() != (tmp_path / name).read_bytes()]


def test_the_sets_of_particles_stand_in_the_frames(chute):
    folder, _, _ = chute
    for path in sorted(folder.glob("particles_*.vtu")):
        frame, grid = meshio.read(path).point_data, pyvista.read(path)
        assert np.array_equal(frame["set"], grid.point_data["set"])
        # The first set has the ids 1 and 2, the second one 3; what came later is of none.
        expected = np.select([frame["id"] <= 2, frame["id"] == 3], [0, 1], -1)
        assert np.array_equal(frame["set"], expected), path.name
    first = meshio.read(folder / "particles_000000.vtu").point_data
    assert first["set"].tolist() == [0, 0, 1]


def test_one_set_alone_is_not_named(cograin, tmp_path):
    scene = tmp_path / "one.toml"
    scene.write_text(SCENE[: SCENE.index("[particles.high]")] + SCENE[SCENE.index("[boundary.chute]") :])
    cograin("run", scene, "--set", "run.end=0.02", "-o", tmp_path / "out")
    assert "set" not in meshio.read(tmp_path / "out" / "particles_000000.vtu").point_data


def test_files_are_as_large_as_check_foretells(chute):
    folder, _, foretold = chute
    frames = re.search(r"(\d+) frames of ([\d.]+) (\w+) to ([\d.]+) (\w+), ([\d.]+) (\w+) to ([\d.]+) (\w+) in all", foretold)
    assert frames, foretold
    count, least, most, least_all, most_all = int(frames[1]), *(size(frames[k], frames[k + 1]) for k in (2, 4, 6, 8))
    sizes = [path.stat().st_size for path in sorted(folder.glob("particles_*.vtu"))]
    assert len(sizes) == count
    assert min(sizes) >= least[0] - least[1] and max(sizes) <= most[0] + most[1]
    assert least_all[0] - least_all[1] <= sum(sizes) <= most_all[0] + most_all[1]
    # The range means something: the largest frame comes from particles that came.
    assert max(sizes) > 2 * min(sizes)
    checkpoint = re.search(r"a checkpoint of ([\d.]+) (\w+) to ([\d.]+) (\w+)", foretold)
    assert checkpoint, foretold
    least, most = size(checkpoint[1], checkpoint[2]), size(checkpoint[3], checkpoint[4])
    assert least[0] - least[1] <= (folder / "checkpoint.cograin").stat().st_size <= most[0] + most[1]
