"""The plate: its elements, the mapping to the skin, and the begin of the coupled run."""

import subprocess
import sys

import numpy as np
import pytest
from cograin import Mapping, Unit
from conftest import ROOT
from test_expected import compare, table

sys.path.insert(0, str(ROOT / "models" / "plate"))

from plate import Design, Plate, navier, navier_evenly  # noqa: E402


def at_rest(plate, forces):
    """Deflection of the middle under forces on the inner nodes, by the finite elements [m]."""
    position = np.linalg.solve(plate.stiffness.toarray(), plate.at @ forces)
    return (plate.at.T @ position)[np.flatnonzero(plate.inside == plate.middle)[0]]


def test_the_elements_bend_as_the_closed_solution_says():
    rigidity, span = Design().rigidity, Design().span
    evenly = navier_evenly(Design(), -1.0)
    assert evenly == pytest.approx(-0.00406235 * span**2 / rigidity, rel=1e-5)  # Timoshenko's table
    errors = []
    for cells in (12, 24):
        plate = Plate(Design(), cells)
        places = plate.places[plate.inside, :2]
        forces = -0.1 - np.sin(90.0 * places[:, 0]) * np.cos(40.0 * places[:, 1])
        exact = navier(plate.design, places, forces)
        assert at_rest(plate, forces) == pytest.approx(exact, rel=5e-4 * (12 / cells) ** 3)
        errors.append(at_rest(plate, -np.full(len(places), cells**-2.0)) / evenly - 1.0)
    # An even load that linear cells share out bends the plate less by (π h)²/6, of which the page speaks.
    assert errors[0] == pytest.approx(-((np.pi / 12) ** 2) / 6.0, rel=0.1)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.01)


@pytest.mark.parametrize("cells", [12, 40])
def test_a_rigid_motion_of_the_plate_gives_no_force_by_the_mapping(unit, cells):
    with Unit(unit("plate")) as one, Unit(unit("plate"), name="other") as other:
        skin, rigid = one.nodes("skin"), other.nodes("skin")
        plate = Plate(Design(), cells)
        # All nodes, those on the supports too: a rigid motion takes no heed of them.
        mapping = Mapping(plate.places, plate.triangles, skin.places)
        for count in range(1, 7):
            motion = np.array([0.0, 0.0, 2e-4 * count]), np.array([1e-3, -2e-3, 0.0]) * count
            moved = motion[0] + np.cross(motion[1], plate.places)
            expected = motion[0] + np.cross(motion[1], skin.places)
            skin.displacement, rigid.displacement = mapping.displacement(moved), expected
            assert np.abs(skin.displacement - expected).max() < 1e-16
            for each in (one, other):
                each.step(1e-3)
            largest = np.abs(rigid.force).max()
            assert np.abs(skin.force - rigid.force).max() <= 1e-9 * largest
            back = mapping.force(skin.force)
            assert np.abs(back.sum(axis=0) - skin.force.sum(axis=0)).max() <= 1e-13 * np.abs(skin.force).sum()
            moments = np.cross(plate.places, back).sum(axis=0) - np.cross(skin.places, skin.force).sum(axis=0)
            assert np.abs(moments).max() <= 1e-13 * np.abs(skin.force).sum()
        assert largest > 1e-3


def test_the_plate_begins_as_expected_and_both_sides_do_the_same_work(request, tmp_path):
    folder = ROOT / "models" / "plate"
    program = ROOT / request.config.getoption("--program")
    command = [sys.executable, folder / "couple.py", "--program", program, "--output", tmp_path, "--no-replay"]
    subprocess.run([*command, "--cells", "24", "--end", "0.01"], check=True, capture_output=True)
    names, rows = table(tmp_path / "couple_24.csv")
    # The plate's factorisation is the machine's own, to rounding; what agrees to a nanometre need not agree to more.
    compare((names, rows), table(folder / "expected.csv"), 1e-3)
    work, of_plate = rows[:, names.index("work")], rows[:, names.index("plate_work")]
    assert abs(work[-1] + of_plate[-1]) <= 1e-12 * np.abs(np.diff(of_plate, prepend=0.0)).sum()
