"""A study's table is whole, whatever its runs do: fail, kill their process, or are broken off."""

import json
import os
import random
import signal
import time
from pathlib import Path

import numpy
import pytest

from cograin import Unit, UnitError
from cograin.study import SceneRun, Study, StudyError, UnitRun, checked, grid, main, read_rows

SCENE = """
gravity = [0.0, 0.0, -9.81]
[run]
end = 0.01
step = 1.0e-5
[material.s]
density = 2500.0
[particles.ball]
material = "s"
list = [{ position = [0.0, 0.0, 1.0], radius = 0.05 }]
"""


def square(row):
    """Fails below 0, and kills its process at 13."""
    if row["x"] == 13:
        os.kill(os.getpid(), signal.SIGKILL)
    if row["x"] < 0:
        raise ValueError(f"{row['x']} is below 0")
    return {"square": row["x"] ** 2}


def counted(row):
    """Leaves a mark each time that it is called."""
    with Path(row["marks"]).open("a") as text:
        text.write(f"{row['x']}\n")
    return {"twice": 2 * row["x"]}


def test_results_stand_in_the_order_of_the_table_with_failures_and_their_messages(tmp_path):
    results = Study({"x": [3, -1, 2]}, square, tmp_path).run(workers=2, shown=False)
    assert [result.values.get("square") for result in results] == [9, None, 4]
    assert results[1].error == "ValueError: -1 is below 0"
    lines = (tmp_path / "results.csv").read_text().splitlines()
    assert lines[0] == "x,square,error,seconds" and lines[2].startswith("-1,,ValueError: -1 is below 0,")


def test_a_run_that_kills_its_process_takes_no_other_with_it(tmp_path):
    results = Study({"x": [1, 13, 2, 3, 4, 5]}, square, tmp_path).run(workers=2, shown=False)
    assert [result.values.get("square") for result in results] == [1, None, 4, 9, 16, 25]
    assert results[1].error == "the process that ran it died, 3 times"


def test_a_study_that_was_broken_off_goes_on_where_it_was(tmp_path):
    marks, folder = str(tmp_path / "marks"), tmp_path / "study"
    rows = [{"x": x, "marks": marks} for x in range(6)]
    Study(rows[:3], counted, folder).run(workers=1, shown=False)
    # The line that was being written when the power went.
    with (folder / "results.jsonl").open("a") as text:
        text.write('{"row": {"x": 3')
    results = Study(rows, counted, folder).run(workers=1, shown=False)
    assert [result.values["twice"] for result in results] == [0, 2, 4, 6, 8, 10]
    assert sorted(map(int, Path(marks).read_text().split())) == list(range(6)), "each was done once"
    assert len(Study(rows, counted, folder).results) == 6


def test_failures_are_done_again_where_that_is_asked_for(tmp_path):
    rows = {"x": [-1]}
    Study(rows, square, tmp_path).run(workers=1, shown=False)
    kept = (tmp_path / "results.jsonl").read_text()
    Study(rows, square, tmp_path).run(workers=1, shown=False)
    assert (tmp_path / "results.jsonl").read_text() == kept
    Study(rows, square, tmp_path).run(workers=1, shown=False, retry=True)
    assert len((tmp_path / "results.jsonl").read_text().splitlines()) == 2


def test_a_scene_is_run_with_the_values_of_each_row(program, tmp_path):
    (tmp_path / "fall.toml").write_text(SCENE)
    rows = grid(**{"gravity": ["[0.0, 0.0, -1.0]", "[0.0, 0.0, -2.0]", "[0.0, 0.0]"], "run.end": [0.01]})
    results = Study(rows, SceneRun(tmp_path / "fall.toml", program=program.path), tmp_path / "out").run(
        workers=2, shown=False
    )
    mass = 2500.0 * 4.0 / 3.0 * 3.141592653589793 * 0.05**3
    for gravity, result in zip((1.0, 2.0), results, strict=False):
        assert result.values["energy.kinetic"] == pytest.approx(0.5 * mass * (gravity * 0.01) ** 2, rel=1e-9)
    assert "gravity" in results[2].error and "Traceback" not in results[2].error


def test_a_unit_is_stepped_with_the_values_of_each_row(piston, tmp_path):
    work = UnitRun(piston, step=1e-3, end=0.005, outputs=["piston.work", "energy.kinetic"])
    results = Study(
        {"piston.displacement.z": [0.0, 1e-4], "pair.grain.grain.friction": [0.1, 0.4]}, work, tmp_path
    ).run(workers=1, shown=False)
    assert [result.error for result in results] == ["", ""]
    assert results[0].values["piston.work"] == 0.0
    results = Study({"piston.displacement.y": [0.0]}, work, tmp_path).run(workers=1, shown=False)
    assert "no variable piston.displacement.y" in results[0].error


def test_the_command_line_reads_a_table_and_says_what_failed(program, tmp_path, capsys):
    (tmp_path / "fall.toml").write_text(SCENE)
    (tmp_path / "table.csv").write_text("run.end,run.step\n0.01,1e-5\n0.01,-1\n")
    words = [
        tmp_path / "table.csv",
        tmp_path / "fall.toml",
        "-o",
        tmp_path / "out",
        "--program",
        program.path,
        "--workers",
        "1",
    ]
    assert main(map(str, words)) == 1
    said = capsys.readouterr()
    assert "2 runs, 1 failed" in said.out and "run.step" in said.err.replace("step: ", "run.step: ")
    assert main([str(tmp_path / "none.csv"), *map(str, words[1:])]) == 2


def test_a_cluster_does_what_a_lost_worker_left(tmp_path):
    distributed = pytest.importorskip("dask.distributed")
    marks = str(tmp_path / "marks")
    rows = [{"x": x, "marks": marks} for x in range(20)]
    with (
        distributed.LocalCluster(2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        next(iter(cluster.workers.values())).process.process.kill()
        results = Study(rows, counted, tmp_path / "study").run(client=client, shown=False)
    assert [result.values.get("twice") for result in results] == [2 * x for x in range(20)]


def brief(row):
    """Takes a while, and tells which process did it."""
    time.sleep(0.02)
    return {"square": row["x"] ** 2, "process": os.getpid()}


def interfering(study, at, act):
    """Does something when so many results are there."""
    keep = study._keep

    def kept(result):
        keep(result)
        if len(study.results) == at:
            act(result)

    study._keep = kept
    return study


def whole(results, folder):
    """Whether a table has each of fifty rows once, with its result."""
    lines = (folder / "results.csv").read_text().splitlines()
    squares = [result.values.get("square") for result in results]
    return squares == [x**2 for x in range(50)] and [int(line.split(",")[0]) for line in lines[1:]] == list(range(50))


def test_fifty_runs_on_two_cores_of_which_a_process_is_killed_and_that_are_broken_off(tmp_path):
    rows = {"x": list(range(50))}

    def kill(result):
        os.kill(result.values["process"], signal.SIGKILL)

    def break_off(result):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interfering(Study(rows, brief, tmp_path), 25, break_off).run(workers=2, shown=False)
    study = Study(rows, brief, tmp_path)
    assert len(study.results) == 25
    assert whole(interfering(study, 35, kill).run(workers=2, shown=False), tmp_path)


def test_a_process_dies_where_the_host_takes_no_notice_of_the_signal_to_end(tmp_path):
    def kill(result):
        os.kill(result.values["process"], signal.SIGKILL)

    before = signal.signal(signal.SIGTERM, lambda *_: None)
    try:
        results = interfering(Study({"x": list(range(50))}, brief, tmp_path), 10, kill).run(workers=2, shown=False)
    finally:
        signal.signal(signal.SIGTERM, before)
    assert whole(results, tmp_path)


def test_fifty_runs_on_a_cluster_of_which_a_worker_is_killed_in_the_middle(tmp_path):
    distributed, killed = pytest.importorskip("dask.distributed"), []
    with (
        distributed.LocalCluster(2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):

        def kill(result):
            killed.append(result.values["process"])
            os.kill(killed[0], signal.SIGKILL)

        results = interfering(Study({"x": list(range(50))}, brief, tmp_path), 20, kill).run(client=client, shown=False)
    assert whole(results, tmp_path)
    with pytest.raises(ProcessLookupError):
        os.kill(killed[0], 0)


def test_values_that_a_unit_cannot_take_are_said(piston):
    with Unit(piston) as unit:
        for name, value, expected in (
            ("piston.displacement.z", "4[x", "a number"),
            ("piston.displacement.z", 10**400, "a number"),
            ("piston.displacement.z", None, "a number"),
            ("run.threads", 0.5, "a whole number of 32 bits"),
            ("run.threads", "2", "a whole number of 32 bits"),
            ("run.threads", 2**31, "a whole number of 32 bits"),
        ):
            with pytest.raises(UnitError, match=f"piston: {name}: expected {expected}, found"):
                unit[name] = value
        with pytest.raises(UnitError, match=r"piston\.displacement\.z: expected a number, found 'x'"):
            unit.set(("piston.displacement.z",), ["x"])


def test_mutated_tables_give_words_and_no_other_exception(tmp_path):
    rng = random.Random(1)
    good = b"run.seed,pair.a.a.friction\n1,0.1\n2,0.2\n"
    path = tmp_path / "table.csv"
    for _ in range(5000):
        data = bytearray(good)
        for _ in range(rng.randint(1, 4)):
            place = rng.randrange(len(data))
            kind = rng.randrange(4)
            if kind == 0:
                data[place] = rng.randrange(256)
            elif kind == 1:
                del data[place : place + rng.randint(1, 5)]
                data = data or bytearray(b",")
            elif kind == 2:
                data[place:place] = bytes(rng.choices(b',"\n\r\0=;\xff 1eE-+naif', k=rng.randint(1, 3)))
            else:
                data[place:place] = data[rng.randrange(len(data)) :]
        path.write_bytes(data)
        try:
            for row in read_rows(path):
                assert all(isinstance(value, float | int | str) for value in row.values())
        except StudyError as error:
            assert str(error).startswith(str(path))


@pytest.mark.parametrize(
    "table",
    [
        [],
        {},
        {"a": [1], "b": [1, 2]},
        [{"a": 1}, {"b": 1}],
        [{"a": float("nan")}],
        [{"a": None}],
        [{"": 1}],
        [{"a=b": 1}],
        [1],
        "x",
        {"a": [""]},
        {"a": 1},
        {"a": "text"},
        {"a": {"b": 1}},
        {"a": numpy.array(1.5)},
        [{"a": numpy.array([1, 2])}],
        [{"a": "\ud800"}],
        [{"\ud800": 1}],
        5,
        [[{"a": 1}]],
    ],
)
def test_tables_that_are_none_are_refused(table, tmp_path):
    with pytest.raises(StudyError):
        Study(table, square, tmp_path)


def test_a_folder_with_other_text_is_refused(tmp_path):
    (tmp_path / "results.jsonl").write_text(
        "hello\n" + json.dumps({"row": {"x": 1}, "values": {}, "error": "", "seconds": 0})
    )
    with pytest.raises(StudyError, match="line 1: expected a result"):
        Study({"x": [1]}, square, tmp_path)


def test_a_table_that_no_study_wrote_stays_as_it_is(tmp_path):
    (tmp_path / "results.csv").write_text("mine")
    with pytest.raises(StudyError, match=r"results\.csv: expected a folder without it"):
        Study({"x": [1]}, square, tmp_path)
    assert (tmp_path / "results.csv").read_text() == "mine"


def test_numbers_of_numpy_are_plain_numbers():
    assert checked({"x": numpy.array([1, 2])}) == [{"x": 1}, {"x": 2}]
