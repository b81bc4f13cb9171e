"""A unit by names: values, states, exact times, refusals in words."""

import gc
import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
from conftest import DROP

from cograin import StepDiscarded, Unit, UnitError
from cograin.units.unpacked import KEPT


def swing(unit, first, last):
    """Rows of a short course."""
    rows = []
    for count in range(first, last):
        unit["piston.displacement.z"] = 1e-4 * np.sin(0.3 * count)
        unit.step(1e-3)
        rows.append(unit.get(["piston.mean_force.z", "piston.work"]).tolist())
    return rows


def test_steps_of_one_length_end_at_exact_multiples_of_it(drop):
    for count in range(1, 31):
        drop.step(1e-3)
        assert drop.time == count * 1e-3


def test_an_unknown_variable_is_answered_with_the_nearest(drop):
    with pytest.raises(UnitError, match=r"no variable floor.disp.z; the nearest is floor.displacement.z"):
        drop["floor.disp.z"]


def test_whole_variables_come_as_whole_numbers_and_arrays_as_arrays(drop):
    assert drop["contacts.count"] == 0
    assert isinstance(drop["contacts.count"], int)
    values = drop.get(["floor.force.z", "ball.displacement.z"])
    assert values.tolist() == [0.0, 0.0]
    with pytest.raises(UnitError, match="a Real is needed"):
        drop.get(["contacts.count"])


def test_cells_of_a_grid_are_arrays(opened):
    grid = """
[grid.shaft]
box = [[-0.05, -0.05, 0.0], [0.05, 0.05, 0.2]]
counts = [1, 2, 4]
outputs = ["porosity", "velocity", "stress", "count"]
"""
    unit = opened(DROP + grid)
    cells = unit.cells("shaft")
    assert repr(cells) == "<8 cells of shaft: porosity, velocity, stress, count>"
    assert cells.centres[3] == pytest.approx([0.0, 0.025, 0.075]) and cells.volumes == pytest.approx(np.full(8, 2.5e-4))
    unit.step(1e-3)
    solid = ((1.0 - cells["porosity"]) * cells.volumes).sum()
    assert solid == pytest.approx(4.0 / 3.0 * np.pi * 0.05**3, rel=1e-14)
    assert cells["velocity"].shape == (8, 3) and cells["velocity"][:, 2].min() == pytest.approx(-9.81e-3)
    assert cells["stress"].shape == (8, 6) and cells.components("stress") == ("xx", "yy", "zz", "xy", "xz", "yz")
    assert cells["count"].tolist() == [0, 0, 0, 1, 0, 0, 0, 0]
    with pytest.raises(KeyError, match="expected one of porosity, velocity, stress, count, found heat"):
        cells["heat"]
    with pytest.raises(UnitError, match="expected a grid of the unit, found bed; it has shaft"):
        unit.cells("bed")


def test_a_refused_value_changes_nothing_and_says_why(drop):
    with pytest.raises(UnitError, match=r"fmi2SetReal: .*found NaN"):
        drop["floor.displacement.z"] = float("nan")
    assert drop["floor.displacement.z"] == 0.0
    drop.step(1e-3)


def test_a_restored_state_repeats_itself_with_its_time(piston):
    with Unit(piston) as unit:
        swing(unit, 0, 10)
        state = unit.save()
        first = swing(unit, 10, 20)
        unit.restore(state)
        assert unit.time == 10 * 1e-3
        assert swing(unit, 10, 20) == first
        unit.restore(unit.save(into=state))
        unit.free(state)


def test_a_serialised_state_goes_on_in_another_process(piston, tmp_path):
    with Unit(piston) as unit:
        swing(unit, 0, 10)
        state = unit.save()
        (tmp_path / "state").write_bytes(unit.serialise(state))
        here = swing(unit, 10, 20)
    code = (
        "import sys; sys.path.insert(0, sys.argv[3]); from test_unit import swing; from cograin import Unit\n"
        "unit = Unit(sys.argv[1]); unit.restore(unit.deserialise(open(sys.argv[2], 'rb').read(), 0.01))\n"
        "print(swing(unit, 10, 20)); unit.close()"
    )
    command = [sys.executable, "-c", code, piston, tmp_path / "state", str(__file__).rsplit("/", 1)[0]]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip() == repr(here)


def test_a_discarded_step_says_its_reason_and_the_last_good_time(drop):
    drop.step(1e-3)
    drop["floor.displacement.z"] = 0.3
    with pytest.raises(StepDiscarded, match="went through boundary floor") as told:
        drop.step(1e-3)
    assert told.value.last_successful_time == 1e-3
    assert "floor" in told.value.reason
    drop["floor.displacement.z"] = 0.0
    drop.step(1e-3)
    assert drop.time == 2e-3


def test_a_start_input_puts_the_boundary_there_without_motion(opened):
    from conftest import DROP

    unit = opened(DROP, inputs={"floor.displacement.z": 5e-3}, start=2.0)
    assert (unit["floor.displacement.z"], unit.time) == (5e-3, 2.0)
    unit.step(1e-3)
    assert unit["floor.work"] == 0.0


def test_a_reset_unit_begins_anew(drop):
    first = [drop.step(1e-3), drop["ball.velocity.z"]]
    drop.reset()
    assert drop.time == 0.0
    assert [drop.step(1e-3), drop["ball.velocity.z"]] == first


def test_a_closed_unit_may_be_closed_again(piston):
    with Unit(piston) as unit:
        unit.step(1e-3)
    unit.close()


def test_instances_of_one_file_share_its_library_and_move_by_themselves(packaged):
    path = packaged(DROP)
    with Unit(path) as one, Unit(path) as other:
        assert one.folder == other.folder and one.slave.dll._handle == other.slave.dll._handle
        for _ in range(3):
            one.step(1e-3)
        assert other["ball.displacement.z"] == 0.0 > one["ball.displacement.z"]
        other.step(3e-3)
        assert other["ball.displacement.z"] == pytest.approx(one["ball.displacement.z"], rel=1e-12)
    with Unit(path) as later:
        assert later.folder == one.folder and later["ball.displacement.z"] == 0.0


def test_a_file_that_is_written_anew_is_another_unit(packaged, tmp_path):
    path = tmp_path / "one.fmu"
    shutil.copy(packaged(DROP), path)
    with Unit(path) as old:
        shutil.copy(packaged(DROP.replace("0.06", "0.07")), path)
        with Unit(path) as new:
            assert new.folder != old.folder and new.description.guid != old.description.guid
            old.step(1e-3)
            new.step(1e-3)


def test_what_was_unpacked_goes_when_many_others_are_open_and_when_the_process_ends(packaged, tmp_path):
    paths = [tmp_path / f"{count}.fmu" for count in range(KEPT + 1)]
    for path in paths:
        shutil.copy(packaged(DROP), path)
    first = Unit(paths[0])
    folder = first.folder
    first.close()
    for path in paths[1:]:
        Unit(path).close()
    assert folder.exists(), "while somebody has the unit"
    del first
    gc.collect()
    assert not folder.exists()
    script = (
        "import sys, cograin; unit = cograin.Unit(sys.argv[1]); unit.close(); print(unit.folder.exists(), unit.folder)"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", script, packaged(DROP)], capture_output=True, text=True, check=True, env=environment
    )
    was, name = done.stdout.split()
    assert was == "True" and not os.path.exists(name)
