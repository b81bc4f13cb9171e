"""A unit of a cell is the micro simulation of the Micro Manager, by a stand-in of its calls."""

from typing import ClassVar

import numpy as np
import pytest

from cograin import Unit, UnitError
from cograin.micro_manager import Cell

# A body-centred cubic lattice, pressed: neighbours overlap by 4 % of a radius.
LATTICE = """
[run]
step = 1.0e-5
[material.s]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
[pair.s.s]
restitution = 0.5
friction = 0.3
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.g]
material = "s"
list = [ { position = [0.0, 0.0, 0.0], radius = 1.0e-3 }, { position = [1.13e-3, 1.13e-3, 1.13e-3], radius = 1.0e-3 } ]
[cell]
edges = [[2.26e-3, 0.0, 0.0], [0.0, 2.26e-3, 0.0], [0.0, 0.0, 2.26e-3]]
motion = { driven = ["xx", "yy", "zz", "xz"] }
"""
STRAINS = ["cell.strain.xx", "cell.strain.yy", "cell.strain.zz"]
STRESSES = ["cell.mean_stress.xx", "cell.mean_stress.yy", "cell.mean_stress.zz"]
WINDOW = 1e-3


@pytest.fixture
def micro(packaged):
    """The class that a user derives."""

    class MicroSimulation(Cell):
        path = packaged(LATTICE)
        read: ClassVar = {"NormalStrain": STRAINS, "ShearStrain": ["cell.strain.xz"]}
        write: ClassVar = {"NormalStress": STRESSES, "ShearStress": ["cell.mean_stress.xz"]}

    return MicroSimulation


def macro_data(time, part):
    """What the macroscopic model gives a cell: scalars as numbers, vectors as arrays."""
    return {"NormalStrain": np.array([0.0, 2.0, -5.0]) * part * time, "ShearStrain": 3.0 * part * time}


def direct(path, parts):
    """The stresses of a unit that steps without trials."""
    with Unit(path) as unit:
        rows = []
        for window, part in enumerate(parts, 1):
            given = macro_data(window * WINDOW, part)
            unit.set([*STRAINS, "cell.strain.xz"], [*given["NormalStrain"], given["ShearStrain"]])
            unit.step(WINDOW)
            rows.append(unit.get([*STRESSES, "cell.mean_stress.xz"]))
    return np.array(rows)


def test_windows_that_are_repeated_give_what_a_unit_gives_without_trials(micro):
    cells = [micro(number) for number in range(3)]
    parts = [1.0, 0.5, 2.0]
    found = [[] for _ in cells]
    for window in range(1, 5):
        kept = [cell.get_state() for cell in cells]
        for trial in (0.7, 1.2, 1.0):
            for cell, state in zip(cells, kept, strict=True):
                cell.set_state(state)
            answers = [
                cell.solve(macro_data(window * WINDOW, trial * part), WINDOW)
                for cell, part in zip(cells, parts, strict=True)
            ]
        for rows, answer in zip(found, answers, strict=True):
            assert isinstance(answer["ShearStress"], float) and answer["NormalStress"].shape == (3,)
            rows.append([*answer["NormalStress"], answer["ShearStress"]])
    for part, rows in zip(parts, found, strict=True):
        assert (np.array(rows) == direct(micro.path, [part] * 4)).all()
    for cell in cells:
        cell.destroy()
        cell.destroy()


def test_a_state_fits_another_cell(micro):
    # Adaptivity gives a cell the state of one that is like it; load balancing makes it anew in another process.
    first, second = micro(0), micro(-1)
    second.set_global_id(7)
    assert second.get_global_id() == 7
    first.solve(macro_data(WINDOW, 1.0), WINDOW)
    second.set_state(first.get_state())
    answers = [cell.solve(macro_data(2 * WINDOW, 1.0), WINDOW) for cell in (first, second)]
    assert (answers[0]["NormalStress"] == answers[1]["NormalStress"]).all()
    assert answers[0]["ShearStress"] == direct(micro.path, [1.0, 1.0])[1, 3]
    first.destroy()
    second.destroy()


def test_what_is_written_is_there_before_the_first_window(micro):
    cell = micro(0)
    assert set(cell.initialize()) == {"NormalStress", "ShearStress"}
    cell.destroy()


def refused(micro, **attributes):
    """What a class with other attributes says when it is made."""
    with pytest.raises(UnitError) as error:
        type("MicroSimulation", (micro,), attributes)(0)
    return str(error.value)


def test_names_that_do_not_fit_are_refused_before_the_first_window(micro):
    found = refused(micro, read={"Strain": ["cell.stress.xx"]})
    assert found == "read['Strain']: expected an input of the unit, found cell.stress.xx: output"
    assert refused(micro, write={"Stress": ["cell.stres.xx"]}).endswith("the nearest is cell.stress.xx")
    assert refused(micro, write={"Stress": "cell.stress.xx"}) == (
        "write['Stress']: expected a list of names, found 'cell.stress.xx'"
    )


def test_data_that_do_not_fit_are_refused(micro):
    cell = micro(4)
    with pytest.raises(UnitError, match="-4: expected data ShearStrain, found NormalStrain"):
        cell.solve({"NormalStrain": [0.0, 0.0, 0.0]}, WINDOW)
    with pytest.raises(ValueError, match="-4: expected 3 values, one for each name, found 2"):
        cell.solve({"NormalStrain": [0.0, 0.0], "ShearStrain": 0.0}, WINDOW)
    with pytest.raises(UnitError, match="expected a finite number, found NaN"):
        cell.solve({"NormalStrain": [0.0, np.nan, 0.0], "ShearStrain": 0.0}, WINDOW)
    assert cell.unit.time == 0.0
    cell.destroy()
