"""A bed of grains as a real unit, heated through its floor by a partner: what one side gives, the other one keeps."""

import re

import numpy as np
import pytest
from test_precice import MODEL, Given, together

from cograin import (
    CouplingStopped,
    GaussSeidel,
    HeatCapacity,
    Interface,
    Mapping,
    Quadratic,
    QuasiNewton,
    Secant,
    Step,
    Structure,
    Unit,
    Verlet,
    couple,
    stiffness,
)
from cograin.precice import Surface, participate

#: Temperature of the partner, and that of the grains, at the start [K].
WARM, COLD = 400.0, 300.0
STEP, END = 0.05, 1.0  # [s]

# 27 grains between a floor and a lid, of both of which the partner gives the temperature.
BETWEEN = f"""
[run]
step = 1.0e-3
[heat]
frozen = true
[material.glass]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
conductivity = 20.0
specific_heat = 800.0
[pair.glass.glass]
restitution = 0.5
[contact.touch.normal.hertz]
[contact.touch.heat.constriction]
[particles.bed]
material = "glass"
temperature = {COLD}
lattice = {{ kind = "simple_cubic", counts = [3, 3, 3], radius = 1e-3, spacing = 1.99e-3, origin = [0, 0, 0.99e-3] }}
[boundary.floor]
plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
material = "glass"
temperature = {{ driven = {WARM} }}
[boundary.lid]
plane = {{ point = [0, 0, 5.96e-3], normal = [0, 0, -1] }}
material = "glass"
temperature = {{ driven = {WARM} }}
"""

# Without the lid.
FROZEN = BETWEEN.split("[boundary.lid]")[0]

# The same grains fall on the floor, jump, and rest.
FALLING = (
    FROZEN.replace("step = 1.0e-3", "step = 2.0e-5")
    .replace("[heat]\nfrozen = true", "")
    .replace("origin = [0, 0, 0.99e-3]", "origin = [0, 0, 1.5e-3]")
    .replace("[run]", "gravity = [0.0, 0.0, -9.81]\n[run]")
)

BOTH = ["floor.temperature", "lid.temperature"]
FINE = [[2.0, -1.0, -1.0], [-1.0, 1.5, -0.5], [-1.0, -0.5, 1.5]]  # a plate of three temperatures [W/K]


def shared(grains, plate, exchange, names=("floor.temperature",), step=STEP, end=END):
    """The record of a coupled run, after a look at heat: what the grains gained is what the plate lost."""
    before = grains["energy.heat"]
    record = couple(Interface(grains, list(names)), plate, exchange, step=step, end=end)
    gained = grains["energy.heat"] - before
    assert abs(gained) > 1e-4 and record.exchanged_work > 0.9 * abs(gained)
    assert abs(gained + plate.heat) <= 1e-12 * record.exchanged_work
    assert abs(plate.stored + plate.lost - plate.heat - plate.load_heat) <= 1e-12 * record.exchanged_work
    assert abs(record.interface_energy) <= 1e-12 * record.exchanged_work
    assert abs(grains["energy.heat_residual"]) <= 1e-12 * record.exchanged_work
    return record


@pytest.mark.parametrize(("text", "step", "end"), [(FROZEN, STEP, END), (FALLING, 1e-3, 0.04)])
def test_grains_that_rest_and_grains_that_fall_gain_what_the_plate_loses(opened, text, step, end):
    plate = HeatCapacity(0.05, start=WARM)
    record = shared(opened(text), plate, Secant(), step=step, end=end)
    assert not record.unconverged
    # Without a conductance nothing is lost: what it stores less is what it gave, though temperatures agree to 1e-6.
    assert abs(plate.stored - plate.heat) <= 1e-12 * record.exchanged_work


@pytest.mark.parametrize("exchange", [Secant, QuasiNewton])
def test_small_capacities_and_none_at_all_converge_though_the_gain_is_above_1(opened, exchange):
    for capacity, conductance in ((3e-4, 0.0), (1e-7, 0.01), (0.0, 0.01), (0.0, 1e-5)):
        grains = opened(FROZEN)
        plate = HeatCapacity(capacity, conductance, start=WARM, ambient=WARM)
        compliance = plate.compliance(Step(0.0, STEP, STEP))[0, 0]
        gain = compliance * stiffness(Interface(grains, "floor.temperature"), STEP)[0]
        assert gain > 1.0
        record = shared(grains, plate, exchange())
        assert not record.unconverged and record["evaluations"].max() <= 8
        assert np.abs(plate.temperature - record["floor.temperature"][-1]).max() < 1e-3


def test_an_explicit_exchange_multiplies_its_error_by_that_gain(opened):
    plate = HeatCapacity(0.0, 1e-3, start=WARM, ambient=WARM)
    with pytest.raises(CouplingStopped, match=r"floor\.temperature: expected 0 K or above, found -"):
        couple(Interface(opened(FROZEN), "floor.temperature"), plate, GaussSeidel(), step=STEP, end=0.5)


def test_several_temperatures_of_a_plate_are_found_together(opened):
    plate = HeatCapacity([0.05, 0.02, 0.001], np.array(FINE) * 0.05, start=WARM, at=[0, 2], ambient=COLD)
    record = shared(opened(BETWEEN), plate, QuasiNewton(), BOTH)
    assert not record.unconverged and plate.temperature.max() < WARM


def test_a_structure_of_first_order_is_a_plate_too(opened):
    first = Structure(0.0, np.array(FINE) * 0.05, [0.05, 0.02, 0.01], at=[0, 2])
    first.place(WARM)
    second = HeatCapacity([0.05, 0.02, 0.01], np.array(FINE) * 0.05, start=WARM, at=[0, 2])
    tables = [
        couple(Interface(opened(BETWEEN), BOTH), partner, QuasiNewton(), step=STEP, end=END)
        for partner in (first, second)
    ]
    assert abs(tables[0].interface_energy) <= 1e-12 * tables[0].exchanged_work
    for name in BOTH:
        assert np.abs(tables[0][name] - tables[1][name]).max() < 1e-3


@pytest.mark.parametrize("capacity", [0.0, 0.05])
@pytest.mark.parametrize(("exchange", "said"), [(Quadratic, "quadratic motion"), (Verlet, "needs a mass")])
def test_exchanges_of_second_order_are_refused_in_words(opened, exchange, said, capacity):
    plate = HeatCapacity(capacity, 0.01, start=WARM, ambient=WARM)
    with pytest.raises(ValueError, match=said):
        couple(Interface(opened(FROZEN), "floor.temperature"), plate, exchange(), step=STEP, end=END)


#: The floor as a mesh of two triangles, whose corners move and have temperatures of their own.
CORNERS = "v -0.01 -0.01 0\nv 0.02 -0.01 0\nv 0.02 0.02 0\nv -0.01 0.02 0\nf 1 2 3\nf 1 3 4\n"
MESH = FALLING.replace(
    "plane = { point = [0, 0, 0], normal = [0, 0, 1] }", 'mesh = { file = "floor.obj" }\nnodes = "driven"'
)


@pytest.fixture(scope="module")
def warm_nodes(program, tmp_path_factory):
    """A unit whose floor has temperatures at its nodes."""
    folder = tmp_path_factory.mktemp("nodes")
    (folder / "floor.obj").write_text(CORNERS)
    (folder / "scene.toml").write_text(MESH)
    path = program.export(folder / "scene.toml", folder / "bed.fmu")
    with Unit(path) as unit:
        if "floor.node[1].temperature" not in unit.variables:
            pytest.skip("this program gives a mesh one temperature")
    return path


def test_nodes_take_the_temperatures_of_another_mesh_and_no_heat_is_lost_on_the_way(warm_nodes):
    with Unit(warm_nodes) as grains:
        nodes = grains.nodes("floor")
        grid = np.array([[x, y, 0.0] for y in (-0.01, 0.005, 0.02) for x in (-0.01, 0.005, 0.02)])
        faces = [[a, b, c] for k in (0, 1, 3, 4) for a, b, c in ((k, k + 1, k + 4), (k, k + 4, k + 3))]
        mapping = Mapping(grid, faces, nodes.places)
        plate = HeatCapacity(np.full(9, 0.01), start=WARM)
        side = Interface(grains, nodes.names("temperature"), through=mapping.shares)
        record = couple(side, plate, QuasiNewton(), step=1e-3, end=0.04)
        gained = grains["energy.heat"]
        assert gained > 1e-6 and abs(gained + plate.heat) <= 1e-12 * record.exchanged_work
        assert abs(gained + nodes.heat.sum()) <= 1e-12 * record.exchanged_work
        assert nodes.temperature == pytest.approx(mapping.temperature(plate.temperature), rel=1e-6)


def test_a_wall_of_another_program_agrees_by_precice_as_it_does_by_couple(opened, tmp_path):
    text = (MODEL / "precice-config.xml").read_text().replace('max-time value="0.02"', 'max-time value="0.2"')
    for found, instead in (
        ("data:vector", "data:scalar"),
        ('"Force"', '"Heat-Flow"'),
        ('"Displacement"', '"Temperature"'),
    ):
        assert found in text
        text = text.replace(found, instead)
    text = re.sub(r'time-window-size value="[^"]*"', 'time-window-size value="0.01"', text)
    (tmp_path / "config.xml").write_text(text)

    def wall():
        return HeatCapacity(0.01, start=WARM)

    def other(participant):
        """The wall as another program would have it."""
        partner, time, kept = wall(), 0.0, None
        vertices = participant.set_mesh_vertices("Plate-Mesh", np.zeros((1, 3)))
        participant.initialize()
        while participant.is_coupling_ongoing():
            if participant.requires_writing_checkpoint():
                kept = time, partner.memory()
            length = participant.get_max_time_step_size()
            flow = participant.read_data("Plate-Mesh", "Heat-Flow", vertices, length)
            now = Step(time, time + length, length)
            partner.advance(flow, partner.predict(flow, now), now)
            participant.write_data("Plate-Mesh", "Temperature", vertices, partner.temperature)
            participant.advance(length)
            time = now.end
            if participant.requires_reading_checkpoint():
                time, memory = kept
                partner.recall(memory)
        participant.finalize()
        return partner

    grains = opened(FROZEN)
    surface = Surface(grains, "floor", "Grains-Mesh", None, None, temperature="Temperature", heat="Heat-Flow")
    table, partner, _ = together(tmp_path / "config.xml", lambda one: participate(one, [surface]), other)
    alone, plate = opened(FROZEN), wall()
    couple(Interface(alone, "floor.temperature"), plate, Secant(), step=0.01, end=0.2)
    assert table.rows == 20 and partner.temperature < WARM - 1.0
    assert partner.temperature == pytest.approx(plate.temperature, rel=1e-6)
    # The flow of the last iteration is that which the wall took: no heat is lost, whatever is left between both.
    assert grains["energy.heat"] == pytest.approx(-partner.stored, rel=1e-4)


def test_a_boundary_reads_its_temperature_from_precice_and_writes_its_heat_flow(opened):
    grains = opened(FROZEN)
    given = Given({"Temperature": lambda time: [WARM + 1e4 * time]})
    surface = Surface(grains, "floor", "m", None, None, temperature="Temperature", heat="Heat-Flow")
    participate(given, [surface])
    assert grains["floor.temperature"] == WARM + 50.0
    names, flows = zip(*given.written, strict=True)
    assert set(names) == {"Heat-Flow"} and flows[-1].shape == (1,)
    assert flows[-1][0] == grains["floor.mean_heat_flow"]
    with pytest.raises(ValueError, match="expected names of both temperature and heat"):
        Surface(grains, "floor", "m", temperature="Temperature")
    with pytest.raises(ValueError, match="no such input; displacement=None and force=None leave it where it stands"):
        participate(given, [Surface(grains, "floor", "m", temperature="Temperature", heat="Heat-Flow")])
    with pytest.raises(ValueError, match="expected names of data, found none"):
        Surface(grains, "floor", "m", None, None)
