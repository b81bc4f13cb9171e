"""The fluid of a unit, cell by cell: a column and a plane of it are partners, and preCICE has its cells as a mesh."""

import numpy as np
import pytest
from test_precice import Given

import cograin
from cograin import Coupling, QuasiNewton, couple
from cograin.fluid import Column, FluidInterface
from cograin.plane_flow import PlaneFlow
from cograin.precice import Flow, participate

# The box of the fluid reaches a millimetre beyond floor and lid, so that what presses into them is inside.
GRAVITY, SIDE, HEIGHT, CELLS = 9.81, 5e-3, 0.032, 8
AREA = SIDE**2

BED = f"""
gravity = [0.0, 0.0, -{GRAVITY}]
[run]
seed = 1
step = 2.0e-5
[material.glass]
density = 2500.0
youngs_modulus = 2.0e6
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.7
friction = 0.3
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[cell]
edges = [[{SIDE}, 0.0, 0.0], [0.0, {SIDE}, 0.0], [0.0, 0.0, {HEIGHT}]]
periodic = ["x", "y"]
[particles.beads]
material = "glass"
packing = {{ box = [[0.0, 0.0, 0.0], [{SIDE}, {SIDE}, 0.011]], solid_fraction = 0.5, radius = 0.5e-3 }}
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "glass"
[boundary.lid]
plane = {{ point = [0.0, 0.0, {HEIGHT - 2e-3}], normal = [0.0, 0.0, -1.0] }}
material = "glass"
[grid.column]
box = [[0.0, 0.0, -1.0e-3], [{SIDE}, {SIDE}, {HEIGHT - 1e-3}]]
counts = [1, 1, {CELLS}]
outputs = ["density", "velocity"]
[fluid.fluid]
density = 1.2
viscosity = 1.8e-5
grid = "column"
velocity = "driven"
pressure = "total"
[fluid.fluid.drag.di_felice]
"""

#: The same in water.
WET = BED.replace("density = 1.2\nviscosity = 1.8e-5", "density = 1000.0\nviscosity = 1.0e-3")


def momentum(unit):
    """Momentum of the beads [N s]."""
    cells = unit.cells("column")
    return float(cells["density"] @ cells["velocity"][:, 2] * cells.volumes[0])


def mass(unit):
    """Mass of the beads [kg]."""
    cells = unit.cells("column")
    return float(cells["density"].sum() * cells.volumes[0])


def coupled(unit, inflow, interval):
    """A column of the fluid and its coupling."""
    side = FluidInterface(unit, "fluid")
    column = Column(side, inflow=inflow)
    return column, Coupling(side, column, QuasiNewton(), interval)


@pytest.mark.parametrize(
    ("text", "inflow", "interval"), [(BED, 0.9, 3e-3), (BED, 0.3, 1e-3), (WET, 0.0, 2e-3), (WET, 0.02, 2e-3)]
)
def test_grains_and_fluid_and_walls_keep_momentum_to_rounding(opened, text, inflow, interval):
    """In a gas 3 ms are ten relaxation times of the fluid; it lifts the bed. In water that is at rest they settle."""
    unit = opened(text)
    column, coupling = coupled(unit, inflow, interval)
    weight, solid, density = mass(unit) * GRAVITY, (1.0 - column.porosity).sum(), column.density
    before, held = column.porosity, momentum(unit) + column.momentum
    for _ in coupling.steps(interval * 6):
        fluid = 0.5 * (before + column.porosity).sum() * column.volume * density * GRAVITY
        walls = unit["floor.mean_force.z"] + unit["lid.mean_force.z"]
        through = density * AREA * inflow * (column.velocity[0] - column.velocity[-1])
        given = column.pressure_drop * AREA - weight - fluid - walls + through
        gained = momentum(unit) + column.momentum - held
        assert abs(gained - given * interval) < 1e-12 * weight * interval
        before, held = column.porosity, momentum(unit) + column.momentum
    assert abs((1.0 - column.porosity).sum() / solid - 1.0) < 1e-12
    evaluations = coupling.record["evaluations"]
    assert not coupling.record.unconverged and evaluations.mean() < 9 and evaluations.max() < 20


def test_a_run_that_was_broken_off_goes_on_with_the_same_bits(opened, tmp_path, monkeypatch):
    def run(unit, **named):
        side = FluidInterface(unit, "fluid")
        column = Column(side, inflow=0.01)
        return couple(side, column, QuasiNewton(), step=2e-3, end=8e-3, **named)

    def broken(*_):
        raise KeyboardInterrupt

    whole, file = run(opened(WET)), tmp_path / "run.checkpoint"
    with monkeypatch.context() as patched, pytest.raises(KeyboardInterrupt):
        steps = iter([None] * 2)
        patched.setattr(cograin.exchanges.coupling.Progress, "step", lambda *_: next(steps, broken) and broken())
        run(opened(WET), checkpoint=file)
    resumed = run(opened(WET), checkpoint=file)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole.table)


#: A layer of cells in which a block of beads stands, held by a hand.
BLOCK = f"""
gravity = [0.0, 0.0, -{GRAVITY}]
[run]
step = 1.0e-4
[material.glass]
density = 2500.0
[particles.beads]
material = "glass"
lattice = {{ kind = "simple_cubic", counts = [10, 4, 20], radius = 0.5e-3, origin = [20.5e-3, 0.5e-3, 0.5e-3] }}
[boundary.hand]
particles = {{ set = "beads" }}
motion = "fixed"
[grid.layer]
box = [[0.0, 0.0, 0.0], [0.05, 0.004, 0.02]]
counts = [10, 1, 4]
outputs = []
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
grid = "layer"
velocity = "driven"
pressure = "total"
[fluid.water.drag.di_felice]
"""


def test_the_pressure_of_what_flows_through_a_block_in_a_plane_is_what_holds_the_block(opened):
    unit = opened(BLOCK)
    side = FluidInterface(unit, "water", "xz")
    walls = {"z_low": (0.005, 0.0), "z_high": (0.005, 0.0)}  # they go along, so that the flow is the same everywhere
    plane = PlaneFlow(side, velocity={"x_low": (0.005, 0.0), **walls})
    record = couple(side, plane, QuasiNewton(), step=0.01, end=0.05)
    assert not record.unconverged and record["evaluations"].max() < 12
    assert np.abs(plane.flux - [0.005, 0.0]).max() < 1e-6
    corners, pressure = plane.pressure
    ends = [pressure[np.isclose(corners[:, 0], place)].mean() for place in (0.0, 0.05)]
    assert (ends[0] - ends[1]) * 8e-5 == pytest.approx(unit["hand.mean_force.x"], rel=1e-5)


def test_what_cannot_be_a_partner_is_refused_in_words(opened):
    unit = opened(BED)
    side = FluidInterface(unit, "fluid")
    with pytest.raises(ValueError, match="axes: expected some of x, y and z, found 'zz'"):
        FluidInterface(unit, "fluid", "zz")
    with pytest.raises(ValueError, match="a column has one axis, found an interface of xz"):
        Column(FluidInterface(unit, "fluid", "xz"))
    with pytest.raises(ValueError, match="expected cells one above the other along x"):
        Column(FluidInterface(unit, "fluid", "x"))
    with pytest.raises(ValueError, match="a plane has two axes"):
        PlaneFlow(side, velocity={})


def test_sides_of_a_plane_that_cannot_be_are_refused_in_words(opened):
    side = FluidInterface(opened(BLOCK), "water", "xz")
    still = (0.0, 0.0)
    closed = dict.fromkeys(("x_low", "x_high", "z_low", "z_high"), still)
    for velocity, pressure, said in (
        ({"left": still}, {}, "velocity: expected sides among x_low, x_high, z_low, z_high, found left"),
        ({}, {"left": 1.0}, "pressure: expected sides among x_low, x_high, z_low, z_high, found left"),
        (closed, {}, "velocity: expected a side that is open, found none"),
        ({"x_low": still}, {"x_low": 1.0}, "pressure: expected a side that is open, found x_low"),
        ({"x_low": {(0.001, 0.002): still}}, {}, "velocity: expected stretches of a cell and more"),
        ({"x_low": (None, 0.0)}, {}, "velocity: expected a number across a side"),
    ):
        with pytest.raises(ValueError, match=said):
            PlaneFlow(side, velocity=velocity, pressure=pressure)


@pytest.mark.parametrize(
    ("said", "instead", "message"),
    [
        ('pressure = "total"', 'pressure = "dynamic"', 'expected pressure = "total", found "dynamic"'),
        ('pressure = "total"', "", 'expected pressure = "total", found none'),
        ('velocity = "driven"', "", 'expected velocity = "driven", found another one'),
    ],
)
def test_a_fluid_that_no_partner_can_move_is_refused_in_words(opened, said, instead, message):
    unit = opened(BED.replace(said, instead))
    with pytest.raises(ValueError, match=message):
        FluidInterface(unit, "fluid")


def test_a_partner_has_density_viscosity_and_gravity_of_its_unit(opened):
    for density in (1.2, 2.4):
        side = FluidInterface(opened(BED, parameters={"fluid.fluid.density": density}), "fluid")
        assert (side.density, side.viscosity) == (density, 1.8e-5)
        assert side.rest == pytest.approx([-density * GRAVITY], rel=1e-15)


#: Beads one above the other, a spring each between them, and a load on the uppermost.
SPRING, WIDE, SMALL, POROSITY = 1e4, 1.2e-3, 1e-3, 1.0 - np.pi / 6.0 / 1.44


def chain(beads, load, step):
    """A scene of so many beads in a fluid that can leave above."""
    places = ", ".join(f"{{ position = [0.0, 0.0, {(i + 0.5) * SMALL!r}], radius = 0.5e-3 }}" for i in range(beads))
    height = SMALL * (beads + 1)
    return f"""
[run]
step = {step!r}
[material.a]
density = 1.0
[pair.a.a]
normal_stiffness = {SPRING}
normal_damping = 0.0
[contact.touch.normal.hooke_stiffness]
[cell]
edges = [[{WIDE}, 0.0, 0.0], [0.0, {WIDE}, 0.0], [0.0, 0.0, {height!r}]]
periodic = ["x", "y"]
[particles.chain]
material = "a"
list = [{places}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
[force.load]
particles = {{ ids = [{beads}] }}
force = [0.0, 0.0, {-load!r}]
[grid.column]
box = [[0.0, 0.0, 0.0], [{WIDE}, {WIDE}, {height!r}]]
counts = [1, 1, {beads + 1}]
outputs = []
[fluid.pores]
density = 1.0e-3
viscosity = 1.0
grid = "column"
velocity = "driven"
pressure = "total"
[fluid.pores.drag.stokes]
"""


def consolidated(opened, beads, steps, end):
    """Settlement of a loaded chain over its last one, and that of springs and dashpots, at the end of each step."""
    dashpot = 3.0 * np.pi * SMALL / POROSITY  # of 1 Pa s, all of which the beads displace moves against them
    length = end * beads**2 * dashpot / SPRING / steps
    load = 1e-4 * SMALL * SPRING / beads
    # A seventh of a radian of a bead on its springs.
    step = length / np.ceil(length / (0.15 * np.sqrt(np.pi / 6.0 * SMALL**3 / SPRING)))
    unit = opened(chain(beads, load, float(step)))
    side = FluidInterface(unit, "pores")
    coupling, moved, found = Coupling(side, Column(side), QuasiNewton(), length), 0.0, []
    for _ in coupling.steps(length * steps):
        flux = side.response(side.force("mean")).solid_flux[beads - 1, 0]
        moved -= flux * length / (1.0 - POROSITY)
        found.append(moved * SPRING / (beads * load))
    rates = 4.0 * SPRING / dashpot * np.sin((2 * np.arange(beads) + 1) * np.pi / (2 * (2 * beads + 1))) ** 2
    stiff = 2.0 * np.eye(beads) - np.eye(beads, k=1) - np.eye(beads, k=-1)
    stiff[-1, -1] = 1.0
    shares = np.linalg.eigh(stiff)[1][-1] ** 2 / rates
    times = length * np.arange(1, steps + 1)
    return np.array(found), 1.0 - np.exp(-np.outer(times, rates)) @ shares / shares.sum()


def test_a_loaded_column_consolidates_as_springs_and_dashpots_do_and_with_many_beads_as_terzaghi_says(opened):
    """A step of the column is implicit: the difference is of first order in it, and gone where it is extrapolated."""
    beside = []
    for beads in (8, 16):
        coarse, closed = (each[4::5] for each in consolidated(opened, beads, 20, 0.848))
        fine, _ = (each[9::10] for each in consolidated(opened, beads, 40, 0.848))
        assert np.abs(fine - closed).max() < 6e-3
        assert np.abs(2.0 * fine - coarse - closed).max() < 4e-4
        beside.append(0.89997892 - (2.0 * fine - coarse)[-1])
    # Half a layer at the end, of which continua know nothing.
    assert beside[0] / beside[1] == pytest.approx(2.0, abs=0.2) and 0.0 < beside[1] < 0.02


class Fields(Given):
    """What another program gives the cells; each window is made twice."""

    repeated = False

    def read_data(self, mesh, data, vertices, length):
        return np.array([self.read[data](self.time + length)] * len(vertices))

    def requires_writing_checkpoint(self):
        self.repeated = not self.repeated
        return self.repeated

    def requires_reading_checkpoint(self):
        return self.repeated

    def is_time_window_complete(self):
        return not self.repeated

    def advance(self, length):
        if not self.repeated:
            super().advance(length)


def test_precice_has_the_cells_as_a_mesh(opened):
    unit = opened(WET)
    gradient = [0.0, 0.0, -1000.0 * GRAVITY]
    other = Fields({"Velocity": lambda time: [0.0, 0.0, 5.0 * time], "Pressure-Gradient": lambda time: gradient})
    table = participate(other, [Flow(unit, "fluid", "Cells", solid_flux="Solid-Flux")], watch=["fluid.work"])
    cells = unit.cells("fluid")
    assert np.array_equal(other.vertices["Cells"], cells.centres)
    assert table["time"] == pytest.approx(1e-3 * np.arange(1, 6)) and table["evaluations"].tolist() == [2] * 5
    assert cells["velocity"][:, 2] == pytest.approx(np.full(CELLS, 0.025))
    written = dict(other.written)
    assert set(written) == {"Drag", "Porosity", "Solid-Flux"}
    assert np.array_equal(written["Drag"], cells["mean_drag"]) and written["Drag"].shape == (CELLS, 3)
    assert np.array_equal(written["Porosity"], cells["porosity"])
    # A window that is made again gives the same.
    drags = [values for name, values in other.written if name == "Drag"]
    assert all(np.array_equal(one, again) for one, again in zip(drags[::2], drags[1::2], strict=True))
