"""What crosses a boundary is the same on both sides."""

import csv
import json
import math
import re
import shutil

import meshio
import numpy as np
import pytest
from conftest import ROOT


def boundaries(slave):
    """The boundaries of a unit that are led by displacements, each with its inputs, those of nodes too."""
    inputs = {}
    for name in slave.inputs:
        if name.endswith((".temperature", ".applied_heat")):
            continue
        boundary, *_, quantity, _ = name.split(".") if not name.endswith(".rate") else (None, "rate", None)
        if quantity in ("applied_force", "applied_moment", "target_force", "velocity", "pressure_gradient", "rate"):
            continue
        assert quantity == "displacement", f"{name} is an input that this test does not know"
        inputs.setdefault(boundary, []).append(name)
    return inputs


def test_change_of_work_is_minus_mean_force_times_displacement(unit, model, course, slave):
    subject = slave(unit(model))
    driven = boundaries(subject)
    if not driven:
        held = "tests/bodies/loaded.rs, tests/boundaries/servo.rs and tests/fluid hold the books of forces and fluids"
        pytest.skip(f"{model} is led by no displacement: {held}")
    leading = [name for name in subject.inputs if not name.endswith(".rate")]
    assert len(leading) == sum(map(len, driven.values())), f"{model} is led by forces, too"
    work, exchanged, before = dict.fromkeys(driven, 0.0), dict.fromkeys(driven, 0.0), 0.0
    for step in range(1, course.steps + 1):
        displacement = course.displacement(step)
        subject.step(displacement, course.interval)
        for boundary, inputs in driven.items():
            means = [name.replace(".displacement.", ".mean_force.") for name in inputs]
            now, *forces = subject.get(f"{boundary}.work", *means)
            terms = [force * (displacement - before) for force in forces]
            exchanged[boundary] += math.fsum(map(abs, terms))
            error = now - work[boundary] + math.fsum(terms)
            assert abs(error) <= 1e-12 * exchanged[boundary], f"step {step}, {boundary}: {error} J are on one side only"
            work[boundary] = now
        before = displacement
    assert all(exchanged.values()), f"no work was exchanged ({exchanged}): the test shows nothing"


def test_setting_an_input_changes_no_output_until_the_next_step(unit, model, course, slave):
    subject = slave(unit(model))
    subject.step(course.displacement(1), course.interval)
    # The error of a servo is that of the target which is set.
    outputs = [name for name in subject.reals if ".servo_error." not in name]
    before = subject.get(*outputs)
    for name in subject.inputs:
        subject.set(name, 0.5 * course.amplitude)
    assert subject.get(*outputs) == before


def test_mean_values_are_the_present_ones_before_the_first_step(unit, model, slave):
    subject = slave(unit(model))
    for name in subject.reals:
        if ".mean_force." in name:
            assert subject.get(name) == subject.get(name.replace(".mean_force.", ".force.")), name
        if name.endswith(".work"):
            assert subject.get(name) == [0.0], name


@pytest.fixture(scope="session")
def piston_run(cograin, tmp_path_factory):
    """What `cograin run` leaves of the small model."""
    folder = tmp_path_factory.mktemp("run")
    cograin("run", ROOT / "models" / "piston" / "scene.toml", "-o", folder)
    return folder


def test_momentum_of_the_grains_changes_by_gravity_and_the_impulses_of_the_boundaries(piston_run):
    frames = sorted(piston_run.glob("**/particles*.vtu"))
    momentum = []
    for frame in (frames[0], frames[-1]):
        data = meshio.read(frame).point_data
        mass = 4.0 / 3.0 * np.pi * data["radius"] ** 3 * 2500.0
        momentum.append([math.fsum(mass * data["velocity"][:, axis]) for axis in range(3)])
    rows = list(csv.DictReader((piston_run / "history.csv").open()))
    times = np.array([float(row["time"]) for row in rows])
    lengths = np.diff(times)
    for axis, gravity in zip("xyz", (0.0, 0.0, -9.81), strict=True):
        names = [name for name in rows[0] if name.endswith(f".mean_force.{axis}")]
        impulses = [-float(row[name]) * length for name in names for row, length in zip(rows[1:], lengths, strict=True)]
        weight = gravity * mass.sum() * (times[-1] - times[0])
        place = "xyz".index(axis)
        error = momentum[1][place] - momentum[0][place] - math.fsum(impulses) - weight
        scale = math.fsum(map(abs, impulses)) + abs(weight)
        assert abs(error) <= 1e-12 * scale, f"{axis}: momentum is off by {error} of {scale} N s"


def test_books_of_every_model_close(cograin, model, course, tmp_path):
    folder = tmp_path / "model"
    shutil.copytree(ROOT / "models" / model, folder)
    text = (folder / "scene.toml").read_text()
    text = re.sub(r"(?m)^end = .*$", f"end = {min(0.004, 20 * course.interval)}", text)
    text = re.sub(r"(?m)^energy = .*$", "", text).replace("[output]", "[output]\nenergy = true")
    (folder / "scene.toml").write_text(text)
    cograin("run", folder / "scene.toml", "-o", tmp_path / "out")
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["steps"] > 10
    assert abs(summary["energy"]["relative_residual"]) <= 1e-12
    assert abs(summary["momentum"]["relative_residual"]) <= 1e-12
