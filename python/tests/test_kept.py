"""What is kept, results of a study and checkpoints of coupled runs, is never taken for that of something else."""

import functools
import inspect
import os
import shutil
import subprocess
import sys
import types
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse
from conftest import DROP
from scipy.interpolate import CubicSpline

import cograin
from cograin import (
    Aitken,
    FixedPoint,
    GaussSeidel,
    Interface,
    Jacobi,
    Modal,
    Newton,
    Oscillator,
    Partners,
    Quadratic,
    QuasiNewton,
    RigidBody,
    Secant,
    StepControl,
    Structure,
    Tolerance,
    Unit,
    UnitPartner,
    Verlet,
    couple,
)
from cograin.base.identity import differing, identity
from cograin.study import Changed, SceneRun, Study, UnitRun

# A ball falls on a floor; a second plane and a particle from a file are there to be changed.
SCENE = """
gravity = [0.0, 0.0, -9.81]
[run]
step = 1.0e-5
end = 0.002
[material.s]
density = 2500.0
[pair.s.s]
normal_stiffness = 1.0e5
normal_damping = 0.0
[contact.touch.normal.hooke_stiffness]
[particles.ball]
material = "s"
list = [ { position = [0.0, 0.0, 0.0501], radius = 0.05 } ]
[particles.other]
material = "s"
file = "other.csv"
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "s"
motion = { driven = ["z"] }
[boundary.side]
plane = { point = [-1.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "s"
motion = { driven = ["x"] }
"""
OTHER = "x,y,z,radius\n0.5,0,0.5,0.01\n"
DRIVEN = "time,floor.displacement.z\n0,0\n1,0.01\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The scene with its files, in the present folder."""
    (tmp_path / "scene.toml").write_text(SCENE)
    for name, text in (("other.csv", OTHER), ("more.csv", OTHER), ("inputs.csv", DRIVEN)):
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


# Studies


def first(run):
    """The kinetic energy at the end."""
    return {"energy": float(run.history["energy.kinetic"][-1])}


def second(run):
    """That at the start, under the same name."""
    return {"energy": float(run.history["energy.kinetic"][0])}


def edit(name, old, new):
    """Writes another text in place of one in a file of the present folder."""

    def change(_named):
        text = Path(name).read_text()
        assert old in text
        Path(name).write_text(text.replace(old, new))

    return change


def given(**values):
    """Other arguments of `SceneRun`."""
    return lambda named: named.update(values)


STUDIES = {
    "the scene's text": edit("scene.toml", "0.0501", "0.0502"),
    "a file that the scene names": edit("other.csv", "0.01", "0.02"),
    "a file that a row names": edit("more.csv", "0.01", "0.02"),
    "a file that an option names": edit("inputs.csv", "1,0.01", "1,0.02"),
    "an option": lambda named: named["options"].extend(["--set", "gravity=[0, 0, -1.0]"]),
    "end": lambda named: named["options"].extend(["--set", "run.end=0.001"]),
    "the scene's name and text": given(scene="twin.toml"),
    "what is read": given(read=second),
    "whether files are kept": given(keep=True),
    "the program": given(program="./program"),
}


@pytest.mark.parametrize("change", STUDIES.values(), ids=STUDIES)
def test_a_study_computes_anew_what_was_made_otherwise(change, folder, program, caplog):
    named = {
        "scene": "scene.toml",
        "program": str(program.path),
        "read": first,
        "options": ["--inputs", "inputs.csv"],
        "keep": False,
    }
    (folder / "twin.toml").write_text(SCENE.replace("2500.0", "2600.0"))
    shutil.copy(program.path, folder / "program")
    with (folder / "program").open("ab") as file:
        file.write(b"another build")
    rows = [{"particles.other.file": '"more.csv"', "run.seed": 1}]

    def study(where="kept"):
        work = SceneRun(**{**named, "options": list(named["options"])})
        made = Study(rows, work, folder / where)
        already = len(made.results)
        (result,) = made.run(workers=1, shown=False)
        assert not result.failed, result.error
        return already, {name: value for name, value in result.values.items() if name != "folder"}, result.seconds

    before, values, seconds = study()
    assert before == 0
    assert study() == (1, values, seconds), "what is the same is not run again"
    assert not caplog.records
    change(named)
    already, changed, _ = study()
    assert already == 0 and "1 results were made otherwise and are computed anew" in caplog.text
    assert changed == study("fresh")[1]
    assert study()[0] == 1
    assert len((folder / "kept" / "results.jsonl").read_text().splitlines()) == 2, "earlier results stay"


def test_a_study_of_a_unit_computes_anew_what_was_made_otherwise(folder, program):
    unit = program.export("scene.toml", "scene.fmu")
    rows = {"floor.displacement.z": [1e-3]}
    base = {"unit": unit, "step": 1e-3, "end": 2e-3, "outputs": ["floor.work"]}

    def kept(**named):
        study = Study(rows, UnitRun(**{**base, **named}), "kept")
        found = len(study.results)
        study.run(workers=1, shown=False)
        return found

    assert [kept(), kept()] == [0, 1]
    for named in ({"step": 5e-4}, {"end": 1e-3}, {"outputs": ["energy.kinetic"]}):
        assert [kept(**named), kept(**named)] == [0, 1], named
    edit("other.csv", "0.01", "0.02")({})
    program.export("scene.toml", "scene.fmu")
    assert [kept(), kept()] == [0, 1]
    assert set(vars(UnitRun(**base))) == set(base), "every argument of UnitRun is changed above"


def test_a_scene_that_changes_while_a_study_runs_ends_it_in_words(folder, program):
    study = Study({"run.seed": [1, 2]}, SceneRun("scene.toml", program=program.path), "kept")
    keep = study._keep

    def kept(result):
        keep(result)
        edit("scene.toml", "0.0501", "0.0502")({})

    study._keep = kept
    with pytest.raises(Changed, match="expected what it began with, found another: scene; run it again"):
        study.run(workers=1, shown=False)
    again = Study({"run.seed": [1, 2]}, SceneRun("scene.toml", program=program.path), "kept")
    assert not again.results, "the first row is that of the scene before"


MODULE = """
FACTOR = {factor}
def helper(x):
    return {helper} * x
def work(row):
    {comment}
    return {{"result": FACTOR * helper(row["x"])}}
"""


@pytest.mark.parametrize("cluster", [False, True])
def test_a_function_is_known_by_its_code_and_by_what_it_uses(folder, monkeypatch, cluster):
    monkeypatch.syspath_prepend(folder)

    def results(factor=1, helper=1, comment="pass"):
        (folder / "worker.py").write_text(MODULE.format(factor=factor, helper=helper, comment=comment))
        code = "from cograin.study import Study; from worker import work; import sys\n"
        code += "if __name__ == '__main__':\n"
        if cluster:
            code += " from dask.distributed import Client, LocalCluster\n"
            code += (
                " cluster = LocalCluster(1, threads_per_worker=1, dashboard_address=None)\n client = Client(cluster)\n"
            )
        how = "client=client" if cluster else "workers=1"
        code += " study = Study({'x': [1]}, work, 'kept'); before = len(study.results)\n"
        code += f" print(before, study.run({how}, shown=False)[0].values['result'])\n"
        if cluster:
            code += " client.close(); cluster.close()\n"
        (folder / "script.py").write_text(code)
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join([str(folder), *sys.path]),
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        done = subprocess.run(
            [sys.executable, "script.py"], env=environment, capture_output=True, text=True, cwd=folder
        )
        assert done.returncode == 0, done.stderr
        return tuple(map(int, done.stdout.split()))

    if cluster:
        pytest.importorskip("dask.distributed")
        assert [results(), results(helper=5)] == [(0, 1), (0, 5)]
        return
    assert results() == (0, 1)
    assert results(comment="# a comment changes nothing\n    pass") == (1, 1)
    assert results(factor=3) == (0, 3)
    assert results(helper=5) == (0, 5)
    assert results() == (1, 1), "what was made before is still there"


# Coupled runs


def plate(mass=0.05, stiffness=1e3, damping=0.1, velocity=0.05, **named):
    """A partner that the ball pushes and that swings on."""
    partner = Oscillator(mass, stiffness, damping, **named)
    partner.place(velocity=velocity)
    return partner


def late(amplitude):
    """A load that sets in after the break."""
    return lambda time: amplitude if time > 0.03 else 0.0


class Pulled(Oscillator):
    """A partner of one's own, whose pull sets in after the break."""

    def __init__(self, pull):
        super().__init__(0.05, 1e3, 0.1)
        self.pull = pull

    def predict(self, force, step):
        return super().predict(force + (self.pull if step.begin > 0.03 else 0.0), step)


def by_default(time, amplitude=1.0):
    return amplitude if time > 0.03 else 0.0


AMPLITUDE = types.SimpleNamespace(amplitude=1.0)


def by_global(time):
    return AMPLITUDE.amplitude if time > 0.03 else 0.0


TIMES = [0.0, 0.02, 0.03, 0.04, 0.05, 0.06]


def watching(sign):
    """A watched value that is another one under the same name."""
    return {"watched": lambda: sign * 1.0}


RESUMED = {
    "a parameter of the unit": {"parameters": {"pair.s.s.normal_stiffness": 2e5}},
    "an input of the unit at its start": {"inputs": {"side.displacement.x": 1e-3}},
    "an input that is given later": {"later": {"side.displacement.x": 1e-3}},
    "the scene": {"scene": SCENE.replace("2500.0", "2600.0")},
    "a file of the scene": {"file": OTHER.replace("0.01", "0.02")},
    "steps before the run": {"before": 1},
    "the communication step": {"step": 2e-3},
    "the exchange": {"exchange": lambda: Aitken()},
    "a setting of the exchange": {"exchange": lambda: Secant(limit=59)},
    "the guess of the exchange": {"exchange": lambda: Secant(stiffness=1.0)},
    "its tolerance": {"exchange": lambda: Secant(tolerance=Tolerance(displacement=1e-4))},
    "the control": {"control": StepControl(energy=1e-3)},
    "the mass of the partner": {"partner": lambda: plate(mass=0.06)},
    "its stiffness": {"partner": lambda: plate(stiffness=1.1e3)},
    "its damping": {"partner": lambda: plate(damping=0.2)},
    "its velocity at the start": {"partner": lambda: plate(velocity=0.06)},
    "its substeps": {"partner": lambda: plate(substeps=2)},
    "a load of later": {"partner": lambda: plate(load=late(2.0))},
    "a load by a default value": {"partner": lambda: plate(load=by_default)},
    "a load by what it is given": {"partner": lambda: plate(load=functools.partial(by_default, amplitude=2.0))},
    "a load by a curve": {"partner": lambda: plate(load=CubicSpline(TIMES, [0, 0, 0, 1, 2, 3]))},
    "a partner of one's own": {"partner": lambda: Pulled(2.0)},
    "what is watched": {"watch": ["energy.kinetic"]},
    "how it is watched": {"watch": watching(-1.0)},
}
#: What the run that is broken off has, where it is not the usual one.
BEGUN = {
    "a load of later": {"partner": lambda: plate(load=late(1.0))},
    "a load by what it is given": {"partner": lambda: plate(load=functools.partial(by_default, amplitude=1.0))},
    "a load by a curve": {"partner": lambda: plate(load=CubicSpline(TIMES, [0, 0, 0, 1, 2, 4]))},
    "a partner of one's own": {"partner": lambda: Pulled(1.0)},
    "how it is watched": {"watch": watching(1.0)},
}


class BrokenOff(Exception):
    """What ends a run."""


@pytest.fixture(scope="module")
def exported():
    """Units by the texts that they were made of."""
    return {}


@pytest.fixture
def coupled(exported, folder, program, monkeypatch):
    """Runs the ball on its plate, to its end or to a step."""

    def run(stop=None, **named):
        (folder / "scene.toml").write_text(named.get("scene", SCENE))
        (folder / "other.csv").write_text(named.get("file", OTHER))
        key = ((folder / "scene.toml").read_text(), (folder / "other.csv").read_text())
        if key not in exported:
            exported[key] = program.export("scene.toml", "scene.fmu").read_bytes()
        unit = folder / "scene.fmu"
        unit.write_bytes(exported[key])
        settings = {"run.threads": named.get("threads", 1), **named.get("parameters", {})}
        with Unit(unit, parameters=settings, inputs=named.get("inputs", {})) as ball, monkeypatch.context() as patched:
            for name, value in named.get("later", {}).items():
                ball[name] = value
            for _ in range(named.get("before", 0)):
                ball.step(1e-3)
            steps = iter(range(stop or 10**9))

            def count(*_):
                if next(steps, None) is None:
                    raise BrokenOff

            patched.setattr(cograin.exchanges.coupling.Progress, "step", count)
            side, partner = Interface(ball, "floor.displacement.z"), named.get("partner", plate)()
            start = named.get("before", 0) * 1e-3
            return couple(side, partner, named.get("exchange", Secant)(), step=named.get("step", 1e-3),
                          end=start + named.get("end", 0.06), control=named.get("control"),
                          watch=named.get("watch", []), checkpoint=named.get("checkpoint"))  # fmt: skip

    return run


@pytest.mark.parametrize("name", RESUMED)
def test_a_run_that_was_made_otherwise_is_not_gone_on_with(name, coupled, folder):
    begun, file = BEGUN.get(name, {}), folder / "run.checkpoint"
    with pytest.raises(BrokenOff):
        coupled(stop=20, checkpoint=file, **begun)
    kept = file.read_bytes()
    with pytest.raises(ValueError, match=r"expected a checkpoint of this run, found one of another: .* differ; delete"):
        coupled(checkpoint=file, **{**begun, **RESUMED[name]})
    assert file.read_bytes() == kept
    assert len(coupled(checkpoint=file, **begun)) == 60


def test_a_load_by_a_global_value_is_looked_at(coupled, folder, monkeypatch):
    file, named = folder / "run.checkpoint", {"partner": lambda: plate(load=by_global)}
    with pytest.raises(BrokenOff):
        coupled(stop=20, checkpoint=file, **named)
    with monkeypatch.context() as patched, pytest.raises(ValueError, match="amplitude"):
        patched.setattr(AMPLITUDE, "amplitude", 2.0)
        coupled(checkpoint=file, **named)
    assert len(coupled(checkpoint=file, **named)) == 60


def test_what_changes_no_bit_may_be_other(coupled, folder):
    with pytest.raises(BrokenOff):
        coupled(stop=20, checkpoint=folder / "run.checkpoint")
    os.rename(folder / "run.checkpoint", folder / "moved.checkpoint")
    longer = coupled(checkpoint=folder / "moved.checkpoint", threads=2, end=0.07)
    assert [row.values for row in longer] == [row.values for row in coupled(end=0.07)]


# Every argument of what a run is made of

DENSE = np.array([[2.0, -1.0], [-1.0, 2.0]])
SPARSE = scipy.sparse.csc_matrix(DENSE)
EXCHANGE = {"tolerance": Tolerance(energy=1e-9), "force": "end", "limit": 7}
#: For each kind: arguments that must be given, and another value of every argument.
ARGUMENTS = {
    GaussSeidel: ({}, {"force": "mean"}),
    Jacobi: ({}, {"force": "mean"}),
    Verlet: ({}, {}),
    FixedPoint: ({}, {**EXCHANGE, "relaxation": 0.3}),
    Aitken: ({}, {**EXCHANGE, "relaxation": 0.3}),
    Secant: ({}, {**EXCHANGE, "stiffness": 3.0}),
    QuasiNewton: ({}, {**EXCHANGE, "relaxation": 0.3, "reuse": 2}),
    Newton: ({}, {**EXCHANGE, "derivative": "differences", "keep": True, "perturbation": 1e-9}),
    Quadratic: ({}, {"exchange": QuasiNewton(limit=7)}),
    Tolerance: ({}, {"displacement": 1.0, "force": 1.0, "energy": 1.0, "relative": 1.0}),
    StepControl: ({}, {"energy": 1.0, "error": 1.0, "unconverged": "stop", "halvings": 2}),
    Oscillator: (
        {"mass": 1.0, "stiffness": 1.0},
        {"mass": 2.0, "stiffness": 2.0, "damping": 1.0, "load": late(1.0), "substeps": 2},
    ),
    Structure: (
        {"mass": SPARSE, "stiffness": SPARSE},
        {"mass": 2 * SPARSE, "stiffness": SPARSE + 1e-9 * scipy.sparse.eye(2, format="csc"), "damping": SPARSE,
         "at": [0], "fixed": [0], "load": late(1.0), "substeps": 2},
    ),
    Modal: (
        {"frequencies": [1.0, 2.0], "shapes": [[1.0], [1.0]]},
        {"frequencies": [1.0, 3.0], "shapes": [[1.0], [2.0]], "masses": 2.0, "damping_ratios": 0.1, "substeps": 2},
    ),
    RigidBody: (
        {"mass": 1.0, "inertia": 1.0},
        {"mass": 2.0, "inertia": 2.0, "at": [1.0, 0.0, 0.0], "centre": [1.0, 0.0, 0.0], "gravity": [0.0, 0.0, 1.0],
         "load": late(1.0), "pivot": [0.0, 0.0, 1.0], "velocity": [1.0, 0.0, 0.0], "angular_velocity": [1.0, 0.0, 0.0]},
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", ARGUMENTS, ids=lambda kind: kind.__name__)
def test_every_argument_of_an_exchange_or_a_partner_is_part_of_what_a_run_is(kind):
    needed, others = ARGUMENTS[kind]
    known = [name for name in inspect.signature(kind).parameters if name not in ("args", "kwargs")]
    assert set(known) - set(others) == set(), "another value of each argument"
    base = identity(kind(**needed), "it")
    assert not differing(base, identity(kind(**needed), "it")), "the same again is the same"
    for name, value in others.items():
        assert differing(base, identity(kind(**{**needed, name: value}), "it")), name


def test_partners_and_arrays_are_compared_entry_by_entry():
    def made(last):
        return identity(Partners(Oscillator(1.0, 1.0), Structure(np.eye(3), np.diag([1.0, 2.0, last]))), "partner")

    (other,) = differing(made(3.0), made(3.0 + 1e-15 * 4))
    assert other == "partner.partners[2].stiffness"


def test_a_unit_that_is_a_partner_is_part_of_what_a_run_is(folder, program):
    served = DROP.replace('driven = ["z"]', 'loaded = ["z"]').replace(
        'material = "s"\nmotion', 'material = "s"\nmass = 1.0\nmotion'
    )
    (folder / "plate.toml").write_text(served)
    program.export("plate.toml", "plate.fmu")

    def made(**named):
        with Unit("plate.fmu") as unit:
            names = {"force": "floor.applied_force.z", "displacement": "floor.displacement.z"}
            return identity(UnitPartner(unit, **{**names, **named}), "partner")

    assert not differing(made(), made())
    for named in ({"compliance": "differences"}, {"perturbation": 1e-3}, {"displacement": "floor.velocity.z"}):
        assert differing(made(), made(**named)), named
