"""What a run leaves comes back as numbers with their units, and as pictures."""

import base64
import re
import sys
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import DROP, ROOT

from cograin import Interface, Oscillator, Secant, couple
from cograin.results import ResultError, Run, Table, joined, read_frame, read_image, read_table, unit_of

SCENE = """
gravity = [0.0, 0.0, -9.81]
[run]
end = 0.02
step = 1.0e-5
[material.s]
density = 2500.0
[pair.s.s]
normal_stiffness = 1.0e4
normal_damping = 0.0
tangential_stiffness = 1.0e3
tangential_damping = 0.0
friction = 0.3
[contact.touch.normal.hooke_stiffness]
[contact.touch.tangential.history]
[particles.left]
material = "s"
list = [{ position = [0.0, 0.0, 0.0099], radius = 0.01 }, { position = [0.0, 0.0, 0.0297], radius = 0.01 }]
[particles.right]
material = "s"
list = [{ position = [0.05, 0.0, 0.03], radius = 0.01, velocity = [0.3, 0.0, 0.0] }]
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "s"
motion = { driven = ["z"] }
[bond.glue]
between = ["left", "left"]
create_distance = 0.02
normal_stiffness = 1.0e8
tangential_stiffness = 1.0e8
[bond.glue.breakage]
max_normal_stress = 1.0
[output]
history_interval = 1.0e-3
frame_interval = 1.0e-2
contacts = true
boundaries = true
energy = true
losses = true
[derived.support]
sum = ["floor.force.z", "floor.mean_force.z"]
[grid.cut]
box = [[-0.02, -0.02, 0.0], [0.07, 0.01, 0.04]]
counts = [3, 1, 2]
outputs = ["porosity", "velocity", "stress", "count", "count_by_set"]
[region.all]
box = [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]]
"""


@pytest.fixture(scope="module")
def folder(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    (folder / "scene.toml").write_text(SCENE)
    program("run", folder / "scene.toml", "-o", folder / "out")
    return folder / "out"


def test_names_of_every_kind_tell_their_units():
    for name, unit in {
        "lid.force.z": "N",
        "grain.position.x": "m",
        "grain.torque.y": "N.m",
        "pair.normal_force": "N",
        "pair.overlap": "m",
        "overlap.max": "1",
        "energy.lost.sliding": "J",
        "lid.stiffness.z": "N/m",
        "cell.stiffness.xx.xx": "Pa",
        "lid.servo_error.z": "N",
        "cell.servo_error.xx": "Pa",
        "cell.conjugate_stress.xz": "Pa",
        "heap.granular_temperature": "m2/s2",
        "bed.cell[3].stress.xx": "Pa",
        "bed.cell[3].count_by_set.mass": "1",
    }.items():
        assert unit_of(name) == unit, name


def test_the_page_of_variables_has_the_units_that_their_names_tell():
    page = (ROOT / "docs" / "fmu.md").read_text(encoding="utf-8").split("## Parameters")[0]
    found = {}
    for names, unit in re.findall(r"^\| (`.*?) \| ([A-Za-z0-9/.]+) \|", page, re.MULTILINE):
        stem = re.sub(r"<[^>]*>", "a", re.match(r"`([^`]*)`", names)[1])
        if not stem.endswith(".rate"):
            found[stem] = unit
    assert len(found) > 60
    assert {name: unit_of(name) for name in found} == found


def test_the_history_is_a_table_by_names(folder):
    history = Run(folder).history
    assert history.rows == 21
    assert history["time"][-1] == 0.02
    with pytest.raises(KeyError, match=r"the nearest is floor\.force\.z"):
        history["floor.force.zz"]


def test_a_run_and_a_record_know_units_that_names_do_not_tell(folder, opened):
    assert Run(folder).history.unit_of("support") == "N" and unit_of("support") == "1"
    feed = """
[region.above]
box = [[-1.0, -1.0, 1.0], [1.0, 1.0, 2.0]]
[insertion.feed]
region = "above"
material = "s"
sizes = { radius = 0.05 }
count_rate = 0.0
"""
    floor = Interface(opened(DROP + feed), "floor.displacement.z")
    record = couple(floor, Oscillator(0.1, 1e4), Secant(), step=1e-3, end=2e-3, watch=["feed.rate", "feed.mass"])
    assert [record.table.unit_of(name) for name in ("feed.rate", "feed.mass", "length")] == ["1/s", "kg", "s"]


def test_a_file_that_is_not_there_is_told_in_words(tmp_path):
    with pytest.raises(ResultError) as error:
        read_table(tmp_path / "no.csv")
    assert str(error.value) == f"{tmp_path}/no.csv: expected a table of numbers (CSV): No such file or directory"


def test_what_is_shown_at_a_prompt_fits_there(folder):
    run = Run(folder)
    assert repr(run) == f"<Run in {folder}: .history, .summary, .frames, .breakage>"
    assert repr(run.history).startswith("<Table of 21 rows: time [s], ") and repr(run.history).endswith(" more>")
    assert repr(run.frames[0].particles).startswith("<Cloud of 3 points, 3 cells: radius, id, ")


def test_frames_are_the_arrays_that_meshio_reads(folder):
    meshio = pytest.importorskip("meshio")
    for kind in ("particles", "contacts", "boundaries", "bonds"):
        path = folder / f"{kind}_000000.vtu"
        ours, theirs = read_frame(path), meshio.read(path)
        assert np.array_equal(ours.points, theirs.points), kind
        assert ours.fields.keys() == theirs.point_data.keys()
        for name, values in theirs.point_data.items():
            assert np.array_equal(ours[name], values), (kind, name)
        ends = [list(cell) for block in theirs.cells for cell in block.data]
        assert [list(cell) for cell in ours.cells] == ends, kind


def test_fields_of_a_grid_are_the_arrays_that_vtk_reads(folder):
    pyvista = pytest.importorskip("pyvista")
    ours, theirs = read_image(folder / "grid_cut_000001.vti"), pyvista.read(folder / "grid_cut_000001.vti")
    assert np.abs(ours.centres - theirs.cell_centers().points).max() < 1e-15
    names = ["porosity", "velocity", "stress", "count", "count_by_set"]
    assert list(ours.fields) == list(theirs.cell_data.keys()) == names
    for name, values in theirs.cell_data.items():
        assert np.array_equal(ours[name], np.asarray(values).reshape(ours[name].shape)), name
    stress = theirs.GetCellData().GetArray("stress")
    assert tuple(stress.GetComponentName(place) for place in range(6)) == ours.components["stress"]
    assert ours.components["stress"] == ("xx", "yy", "zz", "xy", "xz", "yz")


def test_a_grid_shows_where_the_spheres_are(folder):
    last = Run(folder).frames[-1]
    assert last.grids == ["cut"]
    image, particles = last.grid("cut"), last.particles
    assert repr(image) == "<Image of 3 x 1 x 2 cells: porosity, velocity, stress, count, count_by_set>"
    assert image["count_by_set"].sum(axis=0).tolist() == [2, 1] and image["count"].sum() == 3
    solid = ((1.0 - image["porosity"]) * image.edges.prod()).sum()
    assert solid <= 3 * 4 / 3 * np.pi * 0.01**3
    place = np.floor((particles.points - image.lower) / image.edges).astype(int)
    assert image.box("count")[tuple(place.T)].min() >= 1
    with pytest.raises(ResultError, match=r"grid_heap_000002\.vti: expected a frame of cograin: No such file"):
        last.grid("heap")


def test_a_frame_knows_its_time_and_what_it_has(folder):
    first, *_, last = Run(folder).frames
    assert [first.time, last.time] == [0.0, 0.02]
    assert len(last.particles) == 3 and len(first.contacts) == 2 and len(last.boundaries.cells) == 1
    assert first.bonds is not None and len(first.bonds.cells) == 1


def test_files_that_are_no_results_are_refused_in_words(tmp_path):
    with pytest.raises(ResultError, match="found no history"):
        Run(tmp_path)
    for text, reason in [
        ("", "heading"),
        ("time,a,a\n", "heading"),
        ("time,a\n1\n", "line 2: expected 2"),
        ("time\nx\n", "numbers"),
    ]:
        (tmp_path / "table.csv").write_text(text)
        with pytest.raises(ResultError, match=reason):
            read_table(tmp_path / "table.csv")
    for data in (b"", b"<VTKFile/>", b"\xff\x00", b"<VTKFile><UnstructuredGrid><Piece/></UnstructuredGrid></VTKFile"):
        (tmp_path / "frame.vtu").write_bytes(data)
        with pytest.raises(ResultError, match=r"frame\.vtu: expected"):
            read_frame(tmp_path / "frame.vtu")


def test_tables_become_those_of_pandas_and_xarray(folder):
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    history = Run(folder).history
    frame = history.to_pandas()
    assert frame.index.name == "time" and frame.attrs["units"]["floor.force.z"] == "N"
    assert (frame["floor.work"].to_numpy() == history["floor.work"]).all()
    dataset = history.to_xarray()
    assert dataset["energy.kinetic"].attrs["units"] == "J" and dataset.sizes == {"time": 21}


def test_everything_that_a_run_has_is_drawn(folder, tmp_path):
    pytest.importorskip("matplotlib")
    from cograin.plot import draw, main

    made = {path.name for path in draw(folder, tmp_path / "pictures")}
    assert made == {
        "history.png", "energy.png", "packing_velocity.png", "packing_force.png", "packing_set.png", "force_chains.png",
        "cracks.png", "animation.gif", "cut_porosity.png", "cut_velocity.png", "cut_stress.png", "cut_count.png",
    }  # fmt: skip
    for path in (tmp_path / "pictures").iterdir():
        assert path.stat().st_size > 3000, path
    assert main([str(tmp_path / "nothing")]) == 2
    assert main([str(folder), "-o", str(tmp_path / "other"), "--by", "colour"]) == 2


def test_a_record_of_a_coupled_run_is_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    from cograin.plot import draw

    time = np.linspace(0.0, 1.0, 50)
    rows = "\n".join(f"{t},{np.sin(5 * t)},{1e-3 * np.cos(5 * t)}" for t in time)
    (tmp_path / "coupled.csv").write_text(f"time,table.mean_force.z,table.displacement.z\n{rows}\n")
    assert [path.name for path in draw(tmp_path / "coupled.csv")] == ["history.png"]


def test_components_of_a_quantity_without_unit_share_a_panel(tmp_path):
    pytest.importorskip("matplotlib")
    from cograin.plot import history

    names = ["cell.strain.xx", "cell.strain.yz", "cell.stress.xx", "cell.stress.yz", "cell.porosity"]
    (tmp_path / "cell.csv").write_text(f"{','.join(['time', *names])}\n0,0,0,0,0,0.4\n1,-0.1,0.05,-1e4,5e3,0.3\n")
    panels = history(read_table(tmp_path / "cell.csv")).axes
    drawn = [{line.get_label() for line in panel.get_lines()} for panel in panels]
    assert drawn == [set(names[2:4]), set(names[:2]), {names[4]}]


def test_a_package_that_is_missing_is_named_with_the_extra_that_brings_it(folder, monkeypatch, tmp_path, capsys):
    import sys

    from cograin.plot import main
    from cograin.study import Study

    study = Study({"x": [1]}, len, tmp_path / "study")
    cases = {
        "pandas": (Run(folder).history.to_pandas, "tables"),
        "xarray": (Run(folder).history.to_xarray, "tables"),
        "pyarrow": (lambda: study.save(tmp_path / "table.parquet"), "study"),
    }
    for module, (act, extra) in cases.items():
        with monkeypatch.context() as patched:
            patched.setitem(sys.modules, module, None)
            with pytest.raises(ModuleNotFoundError, match=rf"{module}: not found; install cograin\[{extra}\]"):
                act()
    with monkeypatch.context() as patched:
        patched.setitem(sys.modules, "matplotlib.figure", None)
        assert main([str(folder)]) == 1
    assert "not found; install cograin[plot]" in capsys.readouterr().err


PAIR = """
gravity = [0.0, 0.0, 0.0]
[run]
end = 0.001
step = 1.0e-5
[material.s]
density = 2500.0
[pair.s.s]
normal_stiffness = 1.0e4
normal_damping = 0.0
[contact.touch.normal.hooke_stiffness]
[clump.rod]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }, { position = [0.01, 0.0, 0.0], radius = 0.01 }]
[particles.p]
material = "s"
list = [{ position = [0.0145, 0.05, 0.05], radius = 0.01 }, { position = [0.106, 0.0678, 0.05], radius = 0.01 }]
[particles.rods]
material = "s"
clump = "rod"
list = [{ position = [0.06, 0.05, 0.05], radius = 0.02 }]
[cell]
edges = [[0.1, 0.0, 0.0], [0.02, 0.1, 0.0], [0.0, 0.0, 0.1]]
[output]
frame_interval = 1.0e-3
contacts = true
"""


def test_force_chains_go_through_the_faces_of_a_cell(program, tmp_path):
    pytest.importorskip("matplotlib")
    from cograin.plot import force_chains

    (tmp_path / "scene.toml").write_text(PAIR)
    program("run", tmp_path / "scene.toml", "-o", tmp_path / "out")
    frame = Run(tmp_path / "out").frames[0]
    assert len(frame.clumps) == 1 and len(frame.cell.cells) == 12
    assert np.allclose(frame.edges, [[0.1, 0.0, 0.0], [0.02, 0.1, 0.0], [0.0, 0.0, 0.1]])
    (lines,) = [each for each in force_chains(frame, "z").axes[0].collections if hasattr(each, "get_segments")]
    lengths = [float(np.linalg.norm(end - begin)) for begin, end in lines.get_segments()]
    # Two halves of one contact, at both faces; none goes through the packing.
    assert len(lengths) == 2 and max(lengths) < 0.02


def test_a_notebook_shows_tables_and_runs(folder):
    shown = Run(folder)._repr_html_()
    assert "<th>time [s]</th>" in shown and shown.count("<tr>") == 11 and "21 rows" in shown
    assert "&lt;Run in" in shown


def test_a_frame_is_drawn_in_space(folder, tmp_path, capsys):
    pytest.importorskip("pyvista")
    image = pytest.importorskip("PIL.Image")
    from cograin.view import main

    def drawn(*words):
        assert main([str(folder), "-o", str(tmp_path / "view.png"), *words]) == 0, capsys.readouterr().err
        return np.asarray(image.open(tmp_path / "view.png").convert("RGB")).reshape(-1, 3)

    pictures = [
        drawn(*words) for words in (["--by", "set"], ["--chains"], ["--facets", "normal_pressure", "--view", "x"])
    ]
    for picture in pictures:
        assert (picture.min(axis=1) < 245).mean() > 0.01, "more than the background"
    assert (np.ptp(pictures[0], axis=1) > 60).any(), "sets have colours"
    assert not np.array_equal(pictures[0], pictures[1])
    glass, metal = drawn("--by", "set"), drawn("--by", "set", "--solid", "floor")
    assert metal.mean() < glass.mean() - 1.0, "metal is darker than glass"
    assert main([str(folder), "-o", str(tmp_path / "film.gif")]) == 0
    assert image.open(tmp_path / "film.gif").n_frames == len(Run(folder).frames)
    for words in (
        ["--by", "colour"],
        ["--facets", "paint"],
        ["--solid", "lid"],
        ["--frame", "99"],
        ["-o", str(tmp_path / "view.txt")],
    ):
        assert main([str(folder), *words]) == 2
    assert "expected one of radius" in capsys.readouterr().err


def test_histories_of_a_run_that_went_on_beyond_its_end_join_as_one_longer_run(program, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE)
    program("run", scene, "-o", tmp_path / "whole")
    program("run", scene, "-o", tmp_path / "first", "--end", "0.01")
    start = tmp_path / "first" / "checkpoint.cograin"
    program("run", scene, "-o", tmp_path / "second", "--from", start)
    whole, first, second = (Run(tmp_path / name).history for name in ("whole", "first", "second"))
    found = joined(first, second)
    assert list(found) == list(whole) and found.rows == whole.rows and second["floor.work"][0] == 0.0
    for name in whole:
        assert np.allclose(found[name], whole[name], rtol=1e-9, atol=1e-12 * np.abs(whole[name]).max()), name
    assert found.unit_of("support") == "N"
    with pytest.raises(ResultError, match=r"begins at a time of the one before, up to 0\.02 s, or .*, found 0 s"):
        joined(second, first)
    # What resumes begins with the next row and counts on: the same bits.
    program("run", scene, "-o", tmp_path / "rest", "--resume", start, "--end", "0.02")
    rest = Run(tmp_path / "rest").history
    told = joined(first, rest)
    assert all(np.array_equal(told[name], whole[name]) for name in whole)
    late = Table({name: rest[name][1:] for name in rest})
    with pytest.raises(ResultError, match="or with the row after it"):
        joined(first, late)


def test_a_film_is_written_frame_by_frame(folder, tmp_path, monkeypatch):
    pytest.importorskip("pyvista")
    from cograin.view import save

    got = []

    def write_frames(path, size, *, fps, quality, macro_block_size):
        got.append((path, tuple(size), fps))
        assert all(side % macro_block_size == 0 for side in size), "a side that is no multiple is scaled"
        while True:
            picture = yield
            assert picture.shape == (size[1], size[0], 3) and picture.flags["C_CONTIGUOUS"]
            got.append(picture)

    # The encoder itself is large, and no part of the environment of the tests.
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", SimpleNamespace(write_frames=write_frames))
    path = save(Run(folder), tmp_path / "film.mp4", by="set", pause=0.25)
    assert got[0] == (str(path), (1200, 900), 4.0) and len(got) == 1 + len(Run(folder).frames)


def test_frames_name_what_they_number(folder):
    frame = Run(folder).frames[-1]
    assert frame.names("set") == {0: "left", 1: "right"} and frame.names("material") == {0: "s"}
    assert frame.names("boundary") == frame.names("group") == {0: "floor"} and frame.names("radius") == {}
    pytest.importorskip("matplotlib")
    from cograin.plot import packing

    told = [text.get_text() for text in packing(frame, "set").axes[0].get_legend().get_texts()]
    assert told == ["left", "right"]
    assert replace(frame, folder=frame.folder / "elsewhere").names("set") == {}


def test_a_section_of_a_grid_shows_the_cells_that_a_plane_cuts(falling):
    pytest.importorskip("matplotlib")
    from cograin.plot import section

    numbers = np.arange(24, dtype="<f8")  # along x first, then y, then z
    data = base64.b64encode(np.uint64(numbers.nbytes).tobytes() + numbers.tobytes()).decode()
    frame = falling.frames[0]
    (frame.folder / f"grid_air_{frame.number:06}.vti").write_text(
        f'<VTKFile type="ImageData"><ImageData WholeExtent="0 4 0 3 0 2" Origin="0 0 0" Spacing="1 1 2"><Piece>'
        "<CellData>"
        f'<DataArray type="Float64" Name="density">{data}</DataArray></CellData></Piece></ImageData></VTKFile>'
    )
    drawn = section(frame, "air", view="y", at=0.99).axes[0]
    assert drawn.collections[0].get_array().ravel().tolist() == [8.0, 9.0, 10.0, 11.0, 20.0, 21.0, 22.0, 23.0]
    with pytest.raises(ResultError, match="expected view x, y or z"):
        section(frame, "air", view="w")


def test_a_frame_is_a_page_that_stands_alone(folder, tmp_path):
    pytest.importorskip("trame_pyvista")
    from cograin.view import main

    assert main([str(folder), "-o", str(tmp_path / "view.html"), "--time", "0.01"]) == 0
    page = (tmp_path / "view.html").read_text()
    assert len(page) > 1e5 and "<script src=" not in page


def test_a_bed_at_rest_is_not_coloured_by_its_rounding():
    from cograin.plot.values import ends, still
    from cograin.results import Cloud

    bed = Cloud(np.zeros((3, 3)), {"radius": np.full(3, 1e-3), "mass": np.full(3, 1e-5)})
    assert still(bed, 2.0)["velocity"] == 5e-6 and still(bed, 0.0) == {}
    assert ends(bed, "velocity", np.array([1e-12, 2e-12, 3e-12]), 2.0) == (1e-12, 5e-6)
    assert ends(bed, "force", np.array([1e-16, 2e-16, 3e-16]), 2.0)[1] == pytest.approx(2.5e-11)
    assert ends(bed, "temperature", np.array([300.0, 300.0, 301.0]), 2.0)[1] == pytest.approx(300.98)


FALLING = """
gravity = [0.0, 0.0, -10.0]
[run]
end = 0.004
step = 1.0e-5
[material.s]
density = 2500.0
[pair.s.s]
normal_stiffness = 1.0e4
normal_damping = 0.0
[contact.touch.normal.hooke_stiffness]
[clump.rod]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }, { position = [0.01, 0.0, 0.0], radius = 0.01 }]
[particles.balls]
material = "s"
list = [{ position = [0.0, 0.0, 0.1], radius = 0.01 }]
[particles.rods]
material = "s"
clump = "rod"
list = [{ position = [0.06, 0.0, 0.1], radius = 0.01 }]
[boundary.tube]
cylinder = { from = [0.0, 0.0, -0.1], to = [0.0, 0.0, 0.2], radius = 0.1 }
material = "s"
[output]
frame_interval = 1.0e-3
boundaries = true
"""


@pytest.fixture(scope="module")
def falling(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("falling")
    (folder / "scene.toml").write_text(FALLING)
    program("run", folder / "scene.toml", "-o", folder / "out")
    return Run(folder / "out")


def test_a_force_means_the_same_on_a_sphere_and_on_a_clump(falling):
    from cograin.plot.values import values

    frame = falling.frames[-1]
    ball, *rods = values(frame, frame.particles, "force")
    # Nothing but weight acts: that of the ball, and that of the whole rod on both of its spheres.
    assert ball == pytest.approx(10.0 * frame.particles["mass"][0])
    assert rods == pytest.approx([10.0 * frame.clumps["mass"][0]] * 2)


def test_a_slice_has_the_particles_that_it_cuts_and_the_walls(falling):
    pytest.importorskip("matplotlib")
    from cograin.plot import packing

    frame = falling.frames[-1]
    circles, lines = (
        packing(frame, "radius", "z", at=float(frame.particles.points[0, 2]) + 0.006).axes[0].collections[::-1]
    )
    assert circles.get_offsets().shape == (3, 2)
    assert circles.get_widths()[0] == pytest.approx(2.0 * 0.008)
    places = np.concatenate(lines.get_segments())
    assert np.hypot(*places.T) == pytest.approx(np.full(len(places), 0.1), rel=0.02)
    assert len(packing(frame, "radius", "z", at=0.19).axes[0].collections) == 1, "walls alone"


def test_columns_time_names_and_format_are_chosen(falling, folder, tmp_path):
    pytest.importorskip("matplotlib")
    from cograin.plot import history, main, packing

    drawn = history(Run(folder).history, ["floor.force.z", "energy.kinetic"], over="floor.work")
    assert [panel.get_xlabel().split(" [")[0] for panel in drawn.axes] == ["", "floor.work"]
    words = ["--columns", "floor.force.z", "--over", "floor.work", "--format", "svg"]
    assert main([str(folder), "-o", str(tmp_path), *words]) == 0
    assert (tmp_path / "over_floor.work.svg").read_text().startswith("<?xml")
    assert main([str(folder), "-o", str(tmp_path), "--columns", "floor.forze.z"]) == 2
    assert falling.frame_at(0.0024).time == 0.002
    legend = packing(falling.frames[0], "set", names={0: "balls", 1: "rods"}).axes[0].get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["balls", "rods"]
    words = ["--time", "0.002", "--by", "set", "--names", "balls", "rods", "--slice", "0.0"]
    assert main([str(falling.folder), "-o", str(tmp_path / "chosen"), *words]) == 0
    assert not (tmp_path / "chosen" / "animation.gif").exists()
    assert main([str(falling.folder), "-o", str(tmp_path / "no"), "--by", "colour"]) == 2


def test_temperatures_that_differ_by_little_are_told_apart():
    from cograin.plot.space import _base

    assert [_base(*ends) for ends in ((300.0001, 300.002), (0.0, 1.0), (300.0, 420.0), (5.0, 5.0))] == [300, 0, 0, 0]
