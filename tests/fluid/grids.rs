//! A fluid on a grid: fields that are given cell by cell, and what the particles give back.

use crate::support::{read, start};
use cograin::interface::{Derivatives, Interface, Value};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::state::State;
use std::f64::consts::PI;

/// Asserts that a number is within a part of another.
#[track_caller]
fn assert_near(found: f64, expected: f64, part: f64) {
    let off = (found - expected).abs();
    assert!(off <= part * expected.abs(), "{found:e}, not {expected:e}: off by {:e} of it", off / expected.abs());
}

/// The value of a variable.
#[track_caller]
fn value(simulation: &Simulation, name: &str) -> f64 {
    let interface = Interface::of(simulation.scene());
    let index = interface.find(name).unwrap_or_else(|| panic!("there is no {name}"));
    interface.value(simulation, index).number()
}

/// Gives a field to the cells of a fluid: a vector for each.
fn give(simulation: &mut Simulation, field: &str, of_cell: impl Fn(usize) -> [f64; 3]) {
    let interface = Interface::of(simulation.scene());
    let cells = simulation.scene().fluid.as_ref().unwrap().cells(&simulation.scene().grids);
    for cell in 0..cells {
        for (axis, part) in ["x", "y", "z"].into_iter().zip(of_cell(cell)) {
            let name = format!("water.cell[{}].{field}.{axis}", cell + 1);
            let index = interface.find(&name).unwrap_or_else(|| panic!("there is no {name}"));
            interface.set(simulation, index, Value::Real(part)).unwrap();
        }
    }
}

/// Numbers of all cells, in sum.
fn sum(simulation: &Simulation, name: &str) -> f64 {
    let cells = simulation.scene().fluid.as_ref().unwrap().cells(&simulation.scene().grids);
    (1..=cells).map(|cell| value(simulation, &format!("water.cell[{cell}].{name}"))).sum()
}

/// Momentum of all that moves by forces along an axis, and the sum of its parts without their signs \[N s\].
fn momentum(simulation: &Simulation, axis: usize) -> [f64; 2] {
    let (particles, clumps) = (&simulation.state().particles, &simulation.state().clumps);
    let free = particles.slots().filter(|&slot| particles.owner[slot] == 0).map(|slot| particles.velocity[slot]);
    let parts: Vec<f64> = free.chain(clumps.velocity.iter().copied()).map(|row| row[3] * row[axis]).collect();
    [parts.iter().sum(), parts.iter().map(|part| part.abs()).sum()]
}

/// Asserts that in a communication step of this length the cells give what particles gain.
#[track_caller]
fn assert_given(simulation: &mut Simulation, interval: f64) {
    let before = [0, 1, 2].map(|axis| momentum(simulation, axis)[0]);
    simulation.advance(interval).unwrap();
    for axis in 0..3 {
        let [after, scale] = momentum(simulation, axis);
        let name = format!("mean_drag.{}", ["x", "y", "z"][axis]);
        let (gained, given) = (after - before[axis], -interval * sum(simulation, &name));
        assert!((gained - given).abs() < 1e-13 * scale, "{gained:e} gained, {given:e} given of {scale:e} N s");
        assert!(gained.abs() > 1e-6 * scale, "{gained:e} of {scale:e} N s");
    }
}

/// Grains and clumps that move through each other in the stirred water of a grid; `grid` and `more` tables.
fn stirred(threads: usize, grid: &str, more: &str) -> Simulation {
    start(&format!(
        r#"
[run]
step = 2.0e-5
threads = {threads}
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.a.a]
restitution = 0.6
friction = 0.4
[contact.all.normal.hertz]
[contact.all.tangential.history]
[clump.pair]
spheres = [{{ position = [0.0, 0.0, 0.0], radius = 2.0e-3 }}, {{ position = [3.0e-3, 0.0, 0.0], radius = 2.0e-3 }}]
[particles.pairs]
material = "a"
clump = "pair"
lattice = {{ kind = "simple_cubic", counts = [5, 5, 2], radius = 4.0e-3, spacing = 0.012, origin = [0.014, 0.014, 0.07] }}
[particles.grains]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.006, 0.006, 0.014], counts = [10, 10, 6], spacing = 8.0e-3, radius = 4.02e-3 }}
velocity = [0.4, 0.1, 0.6]
[grid.column]
{grid}
outputs = []
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
grid = "column"
velocity = "driven"
torque = true
[fluid.water.drag.di_felice]
{more}
"#
    ))
}

/// A grid around them.
const AROUND: &str = "box = [[0.0, 0.0, 0.0], [0.09, 0.09, 0.12]]\ncounts = [3, 4, 5]";

/// A velocity for each cell that is none of the others.
fn swirl(cell: usize) -> [f64; 3] {
    let phase = cell as f64;
    [0.3 * (1.7 * phase).sin(), 0.4 * (2.9 * phase).cos(), 0.2 * (0.7 * phase).sin()]
}

#[test]
fn cells_give_what_grains_and_clumps_gain_to_rounding() {
    let mut simulation = stirred(2, AROUND, "");
    for turn in 0..4 {
        give(&mut simulation, "velocity", |cell| swirl(cell + turn));
        assert_given(&mut simulation, 1e-3);
    }
    let coefficients = sum(&simulation, "drag_coefficient");
    assert!(coefficients > 0.0, "{coefficients:e} N s/m");
}

#[test]
fn cells_that_repeat_give_what_grains_gain_to_rounding() {
    let cell = "[cell]\nedges = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]]";
    let mut simulation = stirred(1, "box = [[0.0, 0.0, 0.0], [0.1, 0.1, 0.1]]\ncounts = [3, 4, 5]", cell);
    for turn in 0..20 {
        give(&mut simulation, "velocity", |cell| swirl(cell + turn));
        assert_given(&mut simulation, 2e-3);
    }
}

#[test]
fn threads_lanes_restored_and_repeated_steps_give_the_same_bits() {
    let run = |threads, width: Option<Width>, again: bool| {
        let mut simulation = stirred(threads, AROUND, "[output]\nenergy = true\nlosses = true");
        width.into_iter().for_each(|width| simulation.set_width(width));
        give(&mut simulation, "velocity", swirl);
        simulation.advance(1e-3).unwrap();
        if again {
            let scene = simulation.scene().clone();
            let bytes = simulation.state().to_bytes(scene.fingerprint);
            let state = State::from_bytes(&bytes, scene.fingerprint).unwrap();
            simulation = Simulation::resume(scene, state.clone()).unwrap();
            give(&mut simulation, "velocity", |cell| swirl(cell + 7));
            simulation.advance(1e-3).unwrap();
            simulation.restore(&state).unwrap();
        }
        give(&mut simulation, "velocity", |cell| swirl(cell + 1));
        simulation.advance(1e-3).unwrap();
        simulation.state().fingerprint()
    };
    let one = run(1, None, false);
    assert_eq!(run(3, None, false), one);
    assert_eq!(run(1, Some(Width::Least), false), one);
    assert_eq!(run(2, None, true), one);
}

#[test]
fn the_books_close_where_each_grain_has_a_flow_of_its_own() {
    let tables = "[output]\nenergy = true\nlosses = true";
    let mut simulation = stirred(1, AROUND, tables);
    give(&mut simulation, "velocity", swirl);
    for interval in [1e-3, 3e-4, 0.7e-5, 1e-3] {
        simulation.advance(interval).unwrap();
        let turnover = simulation.state().ledger.as_ref().unwrap().turnover;
        let residual = simulation.energy_residual().unwrap();
        assert!(residual.abs() < 1e-12 * turnover, "{residual:e} of {turnover:e} J");
    }
    assert!(value(&simulation, "energy.lost.drag") > 0.0);
}

/// A small grain that is led, in a box of cells; `fluid` keys.
fn led(position: [f64; 3], grid: &str, fluid: &str) -> Simulation {
    start(&format!(
        r#"
gravity = [0.0, 0.0, -10.0]
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.grain]
material = "a"
list = [{{ position = {position:?}, radius = 1.0e-3 }}]
[boundary.hand]
particles = {{ set = "grain" }}
motion = {{ driven = ["x", "y", "z"] }}
[grid.column]
{grid}
[fluid.water]
density = 1000.0
viscosity = 1.0
grid = "column"
{fluid}
[fluid.water.drag.di_felice]
"#
    ))
}

/// Six cells along x, three along y, two along z, from 0 on, each of 1 cm.
const SIX: &str = "box = [[0.0, 0.0, 0.0], [0.06, 0.03, 0.02]]\ncounts = [6, 3, 2]";

/// Drag of the fluid on the grain over the drag coefficient: the velocity that it sees.
fn seen(simulation: &Simulation) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| -sum(simulation, &format!("mean_drag.{axis}")) / sum(simulation, "drag_coefficient"))
}

#[test]
fn a_field_that_is_linear_in_space_is_seen_as_it_is_at_the_centre_of_a_grain() {
    let field = |[x, y, z]: [f64; 3]| [2.0 * x - 3.0 * y + 0.1, 5.0 * z - 1.0 * x, 0.7 + 4.0 * y];
    for place in [[0.0123, 0.0171, 0.0088], [0.051, 0.0053, 0.0149], [0.03, 0.015, 0.01]] {
        let mut simulation = led(place, SIX, "velocity = \"driven\"");
        let grid = simulation.scene().grids[0].shape;
        give(&mut simulation, "velocity", |cell| field(grid.centre(cell)));
        simulation.place(None).unwrap();
        simulation.advance(1e-3).unwrap();
        for (found, expected) in seen(&simulation).into_iter().zip(field(place)) {
            assert_near(found, expected, 1e-13);
        }
    }
}

#[test]
fn nothing_jumps_where_a_grain_crosses_faces() {
    // Across the face at x = 0.02 by 2e-9 m, and across the plane of centres at 0.025, at places between and on other faces.
    for (face, y, z) in [(0.02, 0.0123, 0.0091), (0.02, 0.01, 0.01), (0.025, 0.0171, 0.01)] {
        let force = |x: f64| {
            let fluid = "velocity = \"driven\"\npressure = \"total\"";
            let mut simulation = led([x, y, z], SIX, fluid);
            give(&mut simulation, "velocity", swirl);
            give(&mut simulation, "pressure_gradient", |cell| swirl(cell).map(|part| 1e5 * part));
            simulation.place(None).unwrap();
            simulation.state().boundaries[0].force
        };
        let (before, after) = (force(face - 1e-9), force(face + 1e-9));
        let largest = before.into_iter().map(f64::abs).fold(0.0, f64::max);
        for (before, after) in before.into_iter().zip(after) {
            // A change as large as the force from one cell to the next is one of 2e-7 on this way.
            assert!((before - after).abs() < 2e-6 * largest, "{before:e} N before, {after:e} N after");
        }
    }
}

#[test]
fn porosity_is_what_spheres_leave_by_their_exact_parts() {
    // A sphere whose centre is on an edge of four cells has a quarter in each.
    let simulation = led([0.02, 0.01, 0.005], SIX, "");
    let quarter = 0.25 * 4.0 / 3.0 * PI * 1e-9;
    for cell in [2, 3, 8, 9] {
        assert_near(value(&simulation, &format!("water.cell[{cell}].porosity")), 1.0 - quarter / 1e-6, 1e-14);
    }
    assert_near(36.0 - sum(&simulation, "porosity"), 4.0 * quarter / 1e-6, 1e-11);
}

#[test]
fn a_given_gradient_pushes_on_each_volume_and_contains_what_the_scene_says() {
    let volume = 4.0 / 3.0 * PI * 1e-9;
    let buoyancy = 1000.0 * 10.0 * volume;
    let field = |[x, _, z]: [f64; 3]| [3e3 * x, -20.0, 1e4 * z];
    for (pressure, beside) in [("total", 0.0), ("dynamic", buoyancy)] {
        let mut simulation = led([0.0123, 0.0171, 0.0088], SIX, &format!("pressure = {pressure:?}"));
        // Where nothing is given the fluid is at rest.
        assert_near(simulation.state().boundaries[0].force[2], buoyancy, 1e-13);
        let grid = simulation.scene().grids[0].shape;
        give(&mut simulation, "pressure_gradient", |cell| field(grid.centre(cell)));
        simulation.advance(1e-3).unwrap();
        let expected = field([0.0123, 0.0171, 0.0088]).map(|part| -volume * part);
        let force = simulation.state().boundaries[0].force;
        assert_near(force[0], expected[0], 1e-12);
        assert_near(force[1], expected[1], 1e-12);
        assert_near(force[2], expected[2] + beside, 1e-12);
        // The gradient is no drag.
        assert_eq!(sum(&simulation, "mean_drag.x"), 0.0);
    }
}

#[test]
fn a_gradient_without_a_grid_is_one_for_all_places() {
    let mut simulation = start(
        r#"
gravity = [0.0, 0.0, -10.0]
[run]
step = 1.0e-5
[material.a]
density = 2500.0
[particles.grain]
material = "a"
list = [{ position = [0.0, 0.0, 0.0], radius = 1.0e-3 }]
[fluid.water]
density = 1000.0
viscosity = 1.0e-12
pressure = "dynamic"
[fluid.water.drag.stokes]
"#,
    );
    let interface = Interface::of(simulation.scene());
    let index = interface.find("water.pressure_gradient.z").unwrap();
    interface.set(&mut simulation, index, Value::Real(-5000.0)).unwrap();
    simulation.advance(0.01).unwrap();
    // It is there throughout the communication step, but for the half kick that begins it.
    let row = simulation.state().particles.velocity[0];
    assert_near(row[2], 0.01 * (-10.0 + (1000.0 * 10.0 + 5000.0 * (1.0 - 0.5e-3)) / 2500.0), 1e-9);
}

#[test]
fn a_uniform_flow_on_a_grid_is_that_of_a_fluid_without_one() {
    let keys = "viscosity = 1.0e-3\ndensity = 1000.0\nvelocity = [0.1, 0.2, -0.05]";
    let run = |fluid: &str| {
        let mut simulation = start(&format!(
            r#"
gravity = [0.0, 0.0, -10.0]
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.grains]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.01, 0.01, 0.01], counts = [4, 4, 4], spacing = 4.0e-3, radius = 1.5e-3 }}
[grid.column]
box = [[0.0, 0.0, 0.0], [0.04, 0.04, 0.04]]
counts = [1, 1, 1]
[fluid.water]
{keys}
{fluid}
[fluid.water.drag.beetstra]
"#
        ));
        simulation.advance(0.02).unwrap();
        let row = simulation.state().particles.velocity[5];
        ([row[0], row[1], row[2]], simulation.state().fluid.as_ref().unwrap().mean[0])
    };
    let porosity = 1.0 - 64.0 * 4.0 / 3.0 * PI * 1.5e-3_f64.powi(3) / 0.04_f64.powi(3);
    let (one, drag) = run("grid = \"column\"");
    let (other, expected) = run(&format!("porosity = {porosity:?}"));
    one.into_iter().zip(other).for_each(|(one, other)| assert_near(one, other, 1e-12));
    drag.into_iter().zip(expected).for_each(|(drag, expected)| assert_near(drag, expected, 1e-12));
}

#[test]
fn no_fluid_acts_outside_of_the_box() {
    let simulation = led([0.0123, 0.0171, 0.0201], SIX, "velocity = [1.0, 0.0, 0.0]");
    assert_eq!(simulation.state().boundaries[0].force, [0.0; 3]);
    let simulation = led([0.0123, 0.0171, 0.0199], SIX, "velocity = [1.0, 0.0, 0.0]");
    assert!(simulation.state().boundaries[0].force[0] > 0.0);
}

#[test]
fn a_grain_at_a_face_of_a_cell_that_repeats_sees_both_sides() {
    let mut simulation = start(
        r#"
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.grain]
material = "a"
list = [{ position = [0.0, 0.005, 0.005], radius = 1.0e-3 }]
[cell]
edges = [[0.04, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]]
[grid.column]
box = [[0.0, 0.0, 0.0], [0.04, 0.01, 0.01]]
counts = [4, 1, 1]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
velocity = "driven"
grid = "column"
[fluid.water.drag.stokes]
"#,
    );
    let half = 2.0 / 3.0 * PI * 1e-9;
    for cell in [1, 4] {
        assert_near(value(&simulation, &format!("water.cell[{cell}].porosity")), 1.0 - half / 1e-6, 1e-14);
    }
    give(&mut simulation, "velocity", |cell| [0.0, [0.1, 9.0, 9.0, 0.3][cell], 0.0]);
    simulation.place(None).unwrap();
    simulation.advance(1e-5).unwrap();
    let drags = [1, 2, 3, 4].map(|cell| value(&simulation, &format!("water.cell[{cell}].mean_drag.y")));
    assert!(drags[0] < 0.0 && (drags[0] - drags[3]).abs() < 1e-12 * drags[0].abs(), "{drags:?} N");
    assert_eq!(drags[1..3], [0.0; 2]);
    let coefficient = 2.0 * value(&simulation, "water.cell[1].drag_coefficient");
    // In a hundredth of a relaxation time the grain follows a little.
    assert_near(-2.0 * drags[0], coefficient * 0.2, 0.1);
}

/// A bed of grains that are held, in one cell through which water flows; the velocity between the grains.
fn bed(velocity: f64) -> Simulation {
    start(&format!(
        r#"
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.bed]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.5e-3, 0.5e-3, 0.5e-3], counts = [10, 10, 10], spacing = 1.0e-3, radius = 0.5e-3 }}
[boundary.holder]
particles = {{ set = "bed" }}
motion = "fixed"
[grid.column]
box = [[0.0, 0.0, 0.0], [0.01, 0.01, 0.01]]
counts = [1, 1, 1]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
velocity = [0.0, 0.0, {velocity:?}]
grid = "column"
[fluid.water.drag.gidaspow]
"#
    ))
}

#[test]
fn a_fixed_bed_has_erguns_pressure_drop() {
    // −∇p = n f_d/ε, the drag on a volume over its part that is fluid.
    let (superficial, porosity, d) = (0.01, 1.0 - PI / 6.0, 1e-3);
    let mut simulation = bed(superficial / porosity);
    simulation.advance(1e-3).unwrap();
    let found = -value(&simulation, "water.cell[1].mean_drag.z") / (1e-6 * porosity);
    let solid = 1.0 - porosity;
    let viscous = 150.0 * 1e-3 * superficial * solid * solid / (d * d);
    let inertial = 1.75 * 1000.0 * superficial * superficial * solid / d;
    assert_near(found, (viscous + inertial) / porosity.powi(3), 1e-12);
    let coefficient = value(&simulation, "water.cell[1].drag_coefficient");
    assert_near(coefficient * superficial / porosity, found * 1e-6 * porosity, 1e-13);
}

#[test]
fn a_floor_bears_the_weight_less_buoyancy_and_drag() {
    let mut simulation = start(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2.0e-5
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.a.a]
restitution = 0.3
[contact.all.normal.hertz]
[particles.bed]
material = "a"
lattice = { kind = "simple_cubic", origin = [0.5e-3, 0.5e-3, 0.5e-3], counts = [4, 4, 4], spacing = 1.0e-3, radius = 0.5e-3 }
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
[grid.column]
box = [[0.0, 0.0, 0.0], [0.004, 0.004, 0.005]]
counts = [1, 1, 1]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
velocity = [0.0, 0.0, 2.0e-3]
grid = "column"
[fluid.water.drag.koch_hill]
"#,
    );
    simulation.advance(0.2).unwrap();
    simulation.advance(0.01).unwrap();
    let volume = 64.0 * PI / 6.0 * 1e-9;
    let drag = -value(&simulation, "water.cell[1].mean_drag.z");
    let floor = -simulation.state().boundaries[0].mean_force[2];
    assert_near(floor, volume * 1500.0 * 9.81 - drag, 1e-9);
    assert!(drag > 0.01 * floor, "{drag:e} N of {floor:e} N");
}

#[test]
fn lengths_scaled_by_a_power_of_two_give_the_same_bits_in_cells() {
    let run = |lengths: f64, times: f64| {
        let (r, mu, step) = (1e-3 * lengths, 1e-3 * lengths * lengths / times, 1e-4 * times);
        let mut simulation = start(&format!(
            r#"
gravity = [0.0, 0.0, {:?}]
[run]
step = {step:?}
[material.glass]
density = 2500.0
[particles.grain]
material = "glass"
list = [{{ position = [{:?}, {:?}, {:?}], radius = {r:?} }}]
[grid.column]
box = [[0.0, 0.0, 0.0], [{:?}, {:?}, {:?}]]
counts = [3, 2, 5]
[fluid.water]
density = 1000.0
viscosity = {mu:?}
grid = "column"
velocity = "driven"
[fluid.water.drag.beetstra]
"#,
            -9.81 * lengths / (times * times),
            0.0153 * lengths,
            0.0133 * lengths,
            0.0353 * lengths,
            0.03 * lengths,
            0.03 * lengths,
            0.04 * lengths,
        ));
        give(&mut simulation, "velocity", |cell| swirl(cell).map(|part| part * lengths / times));
        simulation.advance(100.0 * step).unwrap();
        let row = simulation.state().particles.velocity[0];
        [0, 1, 2].map(|axis| (row[axis] * times / lengths).to_bits())
    };
    assert_eq!(run(1.0, 1.0), run(4.0, 2.0));
    assert_eq!(run(1.0, 1.0), run(0.125, 0.5));
}

#[test]
fn fields_are_by_kind_cell_by_cell() {
    let simulation = led([0.0123, 0.0171, 0.0088], SIX, "velocity = \"driven\"\npressure = \"dynamic\"");
    let interface = Interface::of(simulation.scene());
    let first = interface.find("water.cell[1].velocity.x").unwrap();
    let names: Vec<_> = (first..first + 4).map(|index| interface.variables()[index].name.clone()).collect();
    let expected = [
        "water.cell[1].velocity.x",
        "water.cell[1].velocity.y",
        "water.cell[1].velocity.z",
        "water.cell[2].velocity.x",
    ];
    assert_eq!(names, expected);
    let gradient = interface.find("water.cell[1].pressure_gradient.x").unwrap();
    assert_eq!(gradient, first + 3 * 36);
    assert!(interface.find("water.velocity.x").is_none() && interface.find("water.mean_drag.x").is_none());
}

#[test]
fn derivatives_of_drag_by_velocities_are_the_weights_and_the_coefficient() {
    let mut simulation = led([0.0123, 0.0171, 0.0088], SIX, "velocity = \"driven\"");
    give(&mut simulation, "velocity", |_| [1e-6, 0.0, 0.0]);
    simulation.place(None).unwrap();
    simulation.advance_or_roll_back(1e-3).unwrap();
    let interface = Interface::of(simulation.scene());
    let input = interface.find("water.cell[2].velocity.x").unwrap();
    let output = interface.find("water.cell[2].mean_drag.x").unwrap();
    let found =
        interface.derivatives(&mut simulation, &mut Derivatives::default(), (&[output], &[(input, 1.0)])).unwrap()[0];
    let [all, share] = [sum(&simulation, "drag_coefficient"), value(&simulation, "water.cell[2].drag_coefficient")];
    // On a ramp half of a change acts in the mean.
    assert_near(found, -0.5 * share * share / all, 0.05);
}

#[test]
fn a_second_fluid_is_refused() {
    let error = read("[fluid.a]\ndensity = 1.0\nviscosity = 1.0\n[fluid.a.drag.stokes]\n[fluid.b]\n").unwrap_err();
    assert!(error.contains("two would overlap"), "{error}");
}

#[test]
fn a_step_that_is_made_again_keeps_momentum_at_ten_relaxation_times_of_the_fluid() {
    let (side, mu) = (5e-3_f64, 1.8e-3);
    let mut simulation = start(&format!(
        r#"
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.grains]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [1.0e-3, 1.0e-3, 1.0e-3], counts = [3, 3, 3], spacing = 1.5e-3, radius = 0.5e-3 }}
[grid.column]
box = [[0.0, 0.0, 0.0], [{side:?}, {side:?}, {side:?}]]
counts = [1, 1, 1]
[fluid.water]
density = 1.2
viscosity = {mu:?}
grid = "column"
velocity = {{ driven = [1.0, 0.0, 0.0] }}
[fluid.water.drag.stokes]
"#
    ));
    let porosity = value(&simulation, "water.cell[1].porosity");
    let mass = 1.2 * porosity * side.powi(3);
    let interval = 10.0 * mass / (27.0 * 3.0 * PI * mu * 1e-3 * porosity);
    let mut velocity = 1.0;
    for _ in 0..20 {
        let (saved, mut end) = (simulation.state().clone(), velocity);
        for turn in 0.. {
            simulation.restore(&saved).unwrap();
            give(&mut simulation, "velocity", |_| [end, 0.0, 0.0]);
            simulation.advance(interval).unwrap();
            let drag = value(&simulation, "water.cell[1].mean_drag.x");
            let lacks = mass * (end - velocity) - interval * drag;
            if lacks.abs() < 1e-13 * mass {
                break;
            }
            assert!(turn < 10, "{lacks:e} N s of {mass:e}");
            // Newton's method: on a ramp half of the change acts in the mean.
            end -= lacks / (mass + 0.5 * interval * value(&simulation, "water.cell[1].drag_coefficient"));
        }
        velocity = end;
        let all = mass * velocity + momentum(&simulation, 0)[0];
        assert_near(all, mass, 2.5e-12);
        assert!(velocity.abs() < 1.0, "{velocity} m/s");
    }
    assert!(velocity.abs() < 0.02, "{velocity} m/s");
}

/// Two warm grains in a fluid on a grid of six cells, at rest; `fluid` keys.
fn warm(fluid: &str) -> Simulation {
    start(&format!(
        r#"
[run]
step = 1.0e-3
[material.a]
density = 2500.0
specific_heat = 800.0
[particles.grains]
material = "a"
temperature = 400.0
list = [{{ position = [0.0123, 0.0171, 0.0088], radius = 1.0e-3 }}, {{ position = [0.0523, 0.0071, 0.0188], radius = 2.0e-3 }}]
[grid.column]
{SIX}
[fluid.water]
density = 1.2
viscosity = 1.8e-5
conductivity = 0.026
specific_heat = 1005.0
{fluid}
[fluid.water.drag.stokes]
"#
    ))
}

/// Temperature of a grain \[K\].
fn temperature(simulation: &Simulation, index: usize) -> f64 {
    simulation.state().heat.as_ref().unwrap().temperature(index)
}

#[test]
fn a_grain_cools_in_air_at_rest_as_an_exponential() {
    // Nu = 2: τ = ρ c d²/(12 k).
    let mut simulation = warm("temperature = 300.0\n[fluid.water.heat.ranz_marshall]");
    simulation.advance(5.0).unwrap();
    for (index, diameter) in [(0, 2e-3_f64), (1, 4e-3)] {
        let relaxation = 2500.0 * 800.0 * diameter * diameter / (12.0 * 0.026);
        let expected = 300.0 + 100.0 * (-5.0 / relaxation).exp();
        assert_near(temperature(&simulation, index) - 300.0, expected - 300.0, 1e-4);
    }
}

#[test]
fn cells_take_the_heat_that_grains_lose_to_rounding() {
    let mut simulation =
        warm("temperature = 300.0\ngrid = \"column\"\nvelocity = [0.1, 0.0, 0.0]\n[fluid.water.heat.gunn]");
    let capacities = [1e-3_f64, 2e-3].map(|radius| 2500.0 * 800.0 * 4.0 / 3.0 * PI * radius.powi(3));
    let heat = |simulation: &Simulation| {
        let of = |index: usize| capacities[index] * temperature(simulation, index);
        of(0) + of(1)
    };
    for _ in 0..3 {
        let before = heat(&simulation);
        simulation.advance(0.05).unwrap();
        let [lost, taken] = [before - heat(&simulation), 0.05 * sum(&simulation, "mean_heat_flow")];
        assert!(lost > 0.0);
        assert_near(taken, lost, 1e-9);
    }
    let name = "energy.heat_residual";
    assert!(value(&simulation, name).abs() < 1e-12 * heat(&simulation), "{name}");
}

#[test]
fn a_driven_temperature_is_that_between_the_centres_of_cells() {
    let keys = "grid = \"column\"\ntemperature = \"driven\"\n[fluid.water.heat.ranz_marshall]";
    let mut simulation = warm(keys);
    let interface = Interface::of(simulation.scene());
    let grid = simulation.scene().grids[0].shape;
    for cell in 0..36 {
        let index = interface.find(&format!("water.cell[{}].temperature", cell + 1)).unwrap();
        interface.set(&mut simulation, index, Value::Real(300.0 + 1e3 * grid.centre(cell)[0])).unwrap();
    }
    simulation.place(None).unwrap();
    simulation.advance(1e-3).unwrap();
    let found = 400.0 - sum(&simulation, "mean_heat_flow") / sum(&simulation, "heat_conductance");
    // Nu = 2, so that conductances go by diameters: 1 to 2.
    assert_near(found, 300.0 + 1e3 * (0.0123 + 2.0 * 0.0523) / 3.0, 1e-12);
}
