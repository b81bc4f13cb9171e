"""Frames of a run are read by foreign readers, bit for bit."""

import csv

import fmpy
import meshio
import numpy as np
import pytest
import pyvista
from cograin import Unit, UnitError
from conftest import ROOT

MODEL = ROOT / "models" / "piston"


@pytest.fixture(scope="session")
def frames(cograin, tmp_path_factory):
    """The frames of a run of the small model, by time."""
    folder = tmp_path_factory.mktemp("frames")
    cograin("run", MODEL / "scene.toml", "--set", "output.boundaries=true", "-o", folder)
    return sorted(folder.glob("**/particles*.vtu"))


@pytest.fixture(scope="session")
def written():
    """What the scene starts from."""
    rows = list(csv.DictReader((MODEL / "grains.csv").open()))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def ordered(points, data):
    """Everything in the order of the particles' numbers."""
    order = np.argsort(data["id"])
    return {"points": points[order], **{name: np.asarray(values)[order] for name, values in data.items()}}


def with_meshio(path):
    mesh = meshio.read(path)
    return ordered(mesh.points, mesh.point_data)


def with_pyvista(path):
    grid = pyvista.read(path)
    return ordered(np.asarray(grid.points), {name: grid.point_data[name] for name in grid.point_data.keys()})


@pytest.mark.parametrize("read", [with_meshio, with_pyvista])
def test_the_first_frame_has_the_bits_of_the_scene(frames, written, read):
    frame = read(frames[0])
    assert frame["points"].tobytes() == np.column_stack([written[axis] for axis in "xyz"]).tobytes()
    assert frame["radius"].tobytes() == written["radius"].tobytes()


def test_both_readers_find_the_same_bits_in_every_frame(frames):
    assert len(frames) == 6
    for path in frames:
        one, other = with_meshio(path), with_pyvista(path)
        assert one.keys() == other.keys()
        for name, values in one.items():
            assert values.dtype == other[name].dtype, f"{path.name}, {name}"
            assert values.tobytes() == other[name].tobytes(), f"{path.name}, {name}"


def test_the_collection_names_every_frame_with_its_time(frames):
    (collection,) = frames[0].parent.glob("particles*.pvd")
    reader = pyvista.get_reader(collection)
    assert np.allclose(reader.time_values, 0.02 * np.arange(6), rtol=0.0, atol=1e-12)
    reader.set_active_time_value(reader.time_values[-1])
    assert reader.read()[0].points.tobytes() == pyvista.read(frames[-1]).points.tobytes()


def test_forces_on_the_facets_of_a_boundary_add_up_to_its_force_in_the_history(frames):
    folder = frames[0].parent
    rows = list(csv.DictReader((folder / "history.csv").open()))
    names = [name.removesuffix(".force.x") for name in rows[0] if name.endswith(".force.x") and ".mean_" not in name]
    assert len(names) > 3
    for number in (1, 5):
        grid = pyvista.read(folder / f"boundaries_{number:06}.vtu")
        mesh = meshio.read(folder / f"boundaries_{number:06}.vtu")
        assert np.array_equal(np.concatenate(mesh.cell_data["force"]), grid.cell_data["force"])
        (row,) = (row for row in rows if abs(float(row["time"]) - 0.02 * number) < 1e-9)
        for index, name in enumerate(names):
            found = grid.cell_data["force"][grid.cell_data["boundary"] == index].sum(axis=0)
            expected = np.array([float(row[f"{name}.force.{axis}"]) for axis in "xyz"])
            assert np.allclose(found, expected, rtol=0.0, atol=1e-9 * np.abs(expected).max()), name


@pytest.fixture(scope="module")
def exported(cograin, tmp_path_factory):
    """The small model with frames of its boundaries and contacts: its unit, and the files that a run of it writes."""
    folder = tmp_path_factory.mktemp("exported")
    text = (MODEL / "scene.toml").read_text()
    for part in MODEL.iterdir():
        if part.suffix == ".csv":
            (folder / part.name).write_bytes(part.read_bytes())
    scene = folder / "scene.toml"
    scene.write_text(text.replace("[output]", "[output]\nboundaries = true\ncontacts = true"))
    cograin("export", scene, "-o", folder / "piston.fmu", "--overwrite")
    cograin("run", scene, "-o", folder / "run")
    return folder / "piston.fmu", written_frames(folder / "run")


def written_frames(folder):
    """The frames and collections in a folder: what each file holds, by name."""
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.suffix in (".vtu", ".pvd")}


@pytest.mark.parametrize("parts", [1, 4])
def test_a_unit_writes_the_frames_of_a_run_of_its_scene(exported, tmp_path, parts):
    unit, expected = exported
    folder = tmp_path / "frames"
    fmpy.simulate_fmu(unit, start_values={"run.frames": str(folder)}, stop_time=0.1, output_interval=0.02 / parts)
    found = written_frames(folder)
    assert len(found) == 3 * (6 + 1)
    assert found.keys() == expected.keys()
    different = [name for name in found if found[name] != expected[name]]
    assert not different
    frame = meshio.read(folder / "particles_000005.vtu")
    assert len(frame.points) == len(np.unique(frame.point_data["id"]))
    assert np.allclose(pyvista.get_reader(folder / "contacts.pvd").time_values, 0.02 * np.arange(6), rtol=0.0, atol=1e-12)


def test_the_folder_is_a_text_of_every_unit_and_empty_at_first(exported):
    description = fmpy.read_model_description(exported[0])
    (variable,) = (variable for variable in description.modelVariables if variable.type == "String")
    found = (variable.name, variable.causality, variable.variability, variable.initial, variable.start)
    assert found == ("run.frames", "parameter", "fixed", "exact", "")
    with Unit(exported[0]) as unit:
        assert unit["run.frames"] == ""


def test_a_unit_in_python_writes_frames_and_refuses_a_folder_that_is_used(exported, tmp_path):
    unit, expected = exported
    parameters = {"run.frames": str(tmp_path / "frames")}
    with Unit(unit, parameters=parameters) as one:
        assert one["run.frames"] == parameters["run.frames"]
        one.step(0.02)
        with pytest.raises(UnitError, match="run.frames: .*in use by process"):
            Unit(unit, parameters=parameters)
    for number in (0, 1):
        name = f"boundaries_{number:06}.vtu"
        assert (tmp_path / "frames" / name).read_bytes() == expected[name]
    with pytest.raises(UnitError, match="run.frames: .*an empty folder.*results of an earlier run"):
        Unit(unit, parameters=parameters)


def test_frames_that_are_lost_on_the_way_are_a_warning_in_python(exported, tmp_path, caplog):
    folder = tmp_path / "frames"
    with Unit(exported[0], parameters={"run.frames": str(folder)}) as unit:
        unit.step(0.02)
        (folder / "particles_000001.vtu").mkdir()
        unit.step(0.02)
        unit.step(0.02)
        assert unit.time == pytest.approx(0.06)
    (said,) = (record for record in caplog.records if record.levelname == "WARNING")
    assert "particles_000001.vtu: cannot be written" in said.getMessage()
    assert "no more frames are written, everything else goes on" in said.getMessage()
