"""Frames of a run are read by foreign readers, bit for bit."""

import csv

import meshio
import numpy as np
import pytest
import pyvista
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
