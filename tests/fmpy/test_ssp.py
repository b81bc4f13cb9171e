"""Systems of units in one file of SSP 1.0, which another program validates and simulates."""

import zipfile

import pytest
from cograin import Unit, UnitError
from cograin.ssp import save_ssp
from conftest import ROOT
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssd, read_ssv
from test_importers import linked_ecospy

STEP, STEPS = 1e-3, 60
#: A loaded piston leads that of a shaft, whose grains press back on it.
CONNECTIONS = [
    ("load.piston.displacement.z", "shaft.piston.displacement.z"),
    ("shaft.piston.force.z", "load.piston.applied_force.z"),
]


def by_hand(units, friction):
    """What each step gives where both sides get the other's values of the step before."""
    name = next(iter(friction)).partition(".")[2]
    with (
        Unit(units["load"]) as load,
        Unit(units["shaft"], parameters={name: next(iter(friction.values()))}) as shaft,
    ):
        rows, moved, force = [], 0.0, 0.0
        for _ in range(STEPS):
            load["piston.applied_force.z"], shaft["piston.displacement.z"] = force, moved
            load.step(STEP)
            shaft.step(STEP)
            moved, force = load["piston.displacement.z"], shaft["piston.force.z"]
            rows.append((moved, force, shaft["piston.work"]))
        return rows


def test_fmpy_validates_and_simulates_a_system_with_the_bits_of_its_units(unit, tmp_path):
    units = {"load": unit("piston_load"), "shaft": unit("piston")}
    friction = {"shaft.pair.grain.grain.friction": 0.1}
    path = save_ssp(tmp_path / "pair.ssp", units, CONNECTIONS, parameters=friction, end=STEP * STEPS)
    structure = read_ssd(str(path), validate=True)
    assert [element.name for element in structure.system.elements] == ["load", "shaft"]
    values = read_ssv(str(path), "parameters.ssv", validate=True)
    found = simulate_ssp(str(path), stop_time=STEP * (STEPS - 0.5), step_size=STEP, parameter_set=values)
    names = ("load.piston.displacement.z", "shaft.piston.force.z", "shaft.piston.work")
    rows = list(zip(*(found[name].tolist() for name in names), strict=True))
    assert rows == by_hand(units, friction)
    assert rows != by_hand(units, {"shaft.pair.grain.grain.friction": 0.5}), "the parameter acts"


def test_another_importer_opens_a_system_and_gets_the_bits_of_its_units(unit, tmp_path):
    # ecospy leaves out values of parameters that are bound at the system, so the system has none.
    ecospy = linked_ecospy()
    units = {"load": unit("piston_load"), "shaft": unit("piston")}
    path = save_ssp(tmp_path / "pair.ssp", units, CONNECTIONS)
    names = ("load::piston.displacement.z", "shaft::piston.force.z", "shaft::piston.work")
    with ecospy.EcosSimulation(step_size=STEP, ssp_path=str(path)) as simulation:
        simulation.init()
        rows = []
        for _ in range(STEPS):
            simulation.step(1)
            rows.append(tuple(simulation.get_real(name) for name in names))
        simulation.terminate()
    # The value that the parameter has by itself.
    assert rows == by_hand(units, {"shaft.pair.grain.grain.friction": 0.4})


def test_free_inputs_are_inputs_of_the_system(unit, tmp_path):
    path = save_ssp(tmp_path / "shaft.ssp", {"shaft": unit("piston")})
    found = simulate_ssp(
        str(path), stop_time=0.0105, step_size=STEP, input={"shaft:piston.displacement.z": lambda time: 1e-3 * time}
    )
    assert len(found) == 11 and found["shaft.piston.work"][-1] != 0.0


def test_the_same_system_gives_the_same_bytes_and_nothing_is_replaced_unasked(unit, tmp_path):
    units = {"shaft": unit("piston")}
    first, second = (save_ssp(tmp_path / folder, units) for folder in ("a.ssp", "b.ssp"))
    with zipfile.ZipFile(first) as one, zipfile.ZipFile(second) as two:
        assert one.read("resources/shaft.fmu") == two.read("resources/shaft.fmu") == units["shaft"].read_bytes()
        assert one.read("SystemStructure.ssd").replace(b'"a"', b'"b"') == two.read("SystemStructure.ssd")
    with pytest.raises(FileExistsError, match="overwrite=True"):
        save_ssp(first, units)


def test_what_does_not_fit_is_refused_by_name(cograin, unit, tmp_path):
    units, path = {"shaft": unit("piston")}, tmp_path / "wrong.ssp"
    force, moved = "shaft.piston.force.z", "shaft.piston.displacement.z"
    for connections, said in (
        ([("bed.floor.force.z", moved)], "expected a unit of the system, found 'bed'; there are shaft"),
        ([(force, "shaft.piston.work")], "shaft.piston.work: expected a variable of kind input, found one .* kind output"),
        ([(force, "shaft.piston.lift")], "found no such variable"),
        ([(force, moved), (force, moved)], "is connected 2 times"),
    ):
        with pytest.raises(ValueError, match=said):
            save_ssp(path, units, connections)
    arrays = tmp_path / "arrays.fmu"
    cograin("export", ROOT / "models" / "piston" / "scene.toml", "--fmi", "3", "-o", arrays)
    with pytest.raises(UnitError, match="expected a unit for co-simulation of FMI 2.0, found FMI 3.0"):
        save_ssp(path, {"shaft": arrays})
    assert not path.exists() and not list(tmp_path.glob(".*"))
