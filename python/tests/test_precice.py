"""A unit takes part in a coupling of preCICE: by a stand-in of the same calls, and by preCICE where it is installed."""

import os
import subprocess
import sys
import threading

import numpy as np
import pytest
from conftest import DROP, ROOT
from stand_in import Line, Participant

from cograin import Interface, Oscillator, Secant, Step, Unit, couple
from cograin.precice import Surface, participate

MODEL = ROOT / "models" / "precice_plate"
sys.path.insert(0, str(MODEL))
TURNING = DROP.replace('driven = ["z"]', 'driven = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"]')


@pytest.fixture(scope="module")
def bed(program, tmp_path_factory):
    """The unit of the model, at rest on its skin."""
    from grains import export

    return export(program, tmp_path_factory.mktemp("bed"))


def lasting(time):
    """The configuration of the model for another time [s]."""
    whole, end = (MODEL / "precice-config.xml").read_text(), 'max-time value="0.02"'
    assert end in whole
    return whole.replace(end, f'max-time value="{time}"')


def together(config, grains, other):
    """Runs two participants in two threads; gives what both return, and the one of the grains."""
    line, found = Line(), []
    mine = Participant("Grains", config, line)
    thread = threading.Thread(target=lambda: found.append(other(Participant("Plate", config, line))), daemon=True)
    thread.start()
    result = grains(mine)
    thread.join(60.0)
    return result, found[0], mine


def test_grains_and_an_elastic_plate_agree_as_couple_does(bed, tmp_path):
    import compare
    import grains
    import plate

    (tmp_path / "config.xml").write_text(lasting("0.012"))
    (table, skin), rows, mine = together(tmp_path / "config.xml", lambda one: grains.run(one, bed), plate.run)
    expected, stood = compare.couple(bed, end=0.012)
    assert len(rows) == 12 and rows[:, 0] == pytest.approx(expected[:, 0], abs=1e-12)
    # The measure of convergence is a millionth of the force.
    assert np.abs(rows[:, 1] - expected[:, 1]).max() < 3e-6 * np.abs(expected[:, 1]).max()
    assert np.abs(skin - stood).max() < 3e-6 * np.abs(stood).max()
    assert table["evaluations"].tolist() == mine.iterations and min(mine.iterations) > 1
    assert table["time"] == pytest.approx(rows[:, 0], abs=1e-12)


def test_a_whole_boundary_is_one_vertex(packaged, tmp_path):
    (tmp_path / "config.xml").write_text(lasting("0.06"))

    def plate():
        return Oscillator(0.1, 1e4)

    def other(participant):
        """The plate as another program would have it."""
        partner, time, kept, course = plate(), 0.0, None, []
        vertices = participant.set_mesh_vertices("Plate-Mesh", np.zeros((1, 3)))
        participant.initialize()
        while participant.is_coupling_ongoing():
            if participant.requires_writing_checkpoint():
                kept = time, partner.memory()
            length = participant.get_max_time_step_size()
            force = participant.read_data("Plate-Mesh", "Force", vertices, length)[0, 2:]
            now = Step(time, time + length, length)
            partner.advance(force, partner.predict(force, now), now)
            participant.write_data("Plate-Mesh", "Displacement", vertices, [[0.0, 0.0, partner.displacement[0]]])
            participant.advance(length)
            time = now.end
            if participant.requires_reading_checkpoint():
                time, memory = kept
                partner.recall(memory)
            else:
                course.append(partner.displacement[0])
        participant.finalize()
        return np.array(course)

    def grains(participant):
        with Unit(packaged(DROP)) as unit:
            surface = Surface(unit, "floor", "Grains-Mesh")
            return participate(participant, [surface], watch=["floor.force.z"])

    table, course, _ = together(tmp_path / "config.xml", grains, other)
    with Unit(packaged(DROP)) as unit:
        expected = couple(Interface(unit, "floor.displacement.z"), plate(), Secant(), step=1e-3, end=0.06)
    assert table.rows == len(course) == 60 and table["floor.force.z"].min() < -1.0
    assert np.abs(course - expected["floor.displacement.z"]).max() < 1e-5 * np.abs(course).max()


class Given:
    """A coupling that is explicit: what the unit reads is known before, what it writes is kept."""

    def __init__(self, read, windows=5, dimensions=3):
        self.read, self.windows, self.dimensions = read, windows, dimensions
        self.time, self.written, self.vertices = 0.0, [], {}

    def get_mesh_dimensions(self, mesh):
        return self.dimensions

    def set_mesh_vertices(self, mesh, places):
        self.vertices[mesh] = places
        return np.arange(len(places))

    def requires_mesh_connectivity_for(self, mesh):
        return False

    def requires_initial_data(self):
        return False

    requires_writing_checkpoint = requires_reading_checkpoint = requires_initial_data

    def initialize(self):
        pass

    def is_coupling_ongoing(self):
        return self.windows > 0

    def is_time_window_complete(self):
        return True

    def get_max_time_step_size(self):
        return 1e-3

    def read_data(self, mesh, data, vertices, length):
        return np.array([self.read[data](self.time + length)])

    def write_data(self, mesh, data, vertices, values):
        self.written.append((data, np.array(values)))

    def advance(self, length):
        self.time += length
        self.windows -= 1

    def finalize(self):
        self.finished = True


def test_a_boundary_that_turns_reads_rotations_and_writes_moments(packaged):
    def moved(time):
        return [0.0, 1e-3 * time, 0.5 * time]

    def turned(time):
        return [0.3 * time, 0.2 * time, 0.0]

    with Unit(packaged(TURNING.replace("0.06]", "0.049]"))) as unit:
        surface = Surface(unit, "floor", "m", rotation="Turn", moment="Moment", at=[0.0, 0.0, 0.0])
        given = Given({"Displacement": moved, "Turn": turned})
        participate(given, [surface])
        assert given.finished and given.vertices["m"].shape == (1, 3)
        names = [f"floor.{quantity}.{axis}" for quantity in ("displacement", "rotation") for axis in "xyz"]
        assert unit.get(names) == pytest.approx([*moved(5e-3), *turned(5e-3)], abs=1e-15)
        (force, forces), (moment, _) = given.written[-2:]
        assert (force, moment) == ("Force", "Moment") and forces[0, 2] < -1.0
        assert forces[0] == pytest.approx(unit.get([f"floor.mean_force.{axis}" for axis in "xyz"]), rel=1e-12)


def test_what_cannot_take_part_is_said(packaged):
    with Unit(packaged(DROP)) as unit:
        sideways = Given({"Displacement": lambda time: [1e-3 * time, 0.0, 0.0]})
        with pytest.raises(
            ValueError, match=r"floor\.displacement\.x: expected a driven axis or no motion, found 1e-06"
        ):
            participate(sideways, [Surface(unit, "floor", "m")])
        with pytest.raises(ValueError, match="expected a mesh of 3 dimensions"):
            participate(Given({}, dimensions=2), [Surface(unit, "floor", "m")])
        with pytest.raises(ValueError, match=r"ball\.displacement: expected a driven boundary, found no such input"):
            participate(Given({}), [Surface(unit, "ball", "m")])
        with pytest.raises(ValueError, match="expected names of both rotation and moment"):
            Surface(unit, "floor", "m", rotation="Turn")
        with pytest.raises(ValueError, match="surfaces: expected at least one"):
            participate(Given({}), [])
        with pytest.raises(ValueError, match="expected forces of one kind"):
            participate(Given({}), [Surface(unit, "floor", "m"), Surface(unit, "floor", "n", kind="end")])


def test_the_real_library_finds_the_same(bed, tmp_path):
    pytest.importorskip("precice", reason="preCICE is not installed: only its stand-in was tried")
    import compare

    environment = {**os.environ, "PYTHONPATH": str(ROOT / "python")}
    started = [
        subprocess.Popen([sys.executable, "-c", text, MODEL, bed], cwd=tmp_path, env=environment)
        for text in (
            "import sys; sys.path.insert(0, sys.argv[1]); import precice, grains\n"
            "grains.run(precice.Participant('Grains', sys.argv[1] + '/precice-config.xml', 0, 1), sys.argv[2])",
            "import sys; sys.path.insert(0, sys.argv[1]); import precice, plate, numpy\n"
            "rows = plate.run(precice.Participant('Plate', sys.argv[1] + '/precice-config.xml', 0, 1))\n"
            "numpy.save('rows.npy', rows)",
        )
    ]
    try:
        assert [each.wait(timeout=300) for each in started] == [0, 0]
    finally:
        for each in started:
            each.kill()
    rows, (expected, _) = np.load(tmp_path / "rows.npy"), compare.couple(bed)
    assert np.abs(rows[:, 1] - expected[:, 1]).max() < 3e-6 * np.abs(expected[:, 1]).max()
