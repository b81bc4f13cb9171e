//! What a fluid without a grid gives to grains, clumps and groups, and the books of it.

use super::scenes::{DENSITY, DIAMETER, RELAXATION, VISCOSITY};
use crate::support::{assert_near, start, value};
use cograin::simulation::Simulation;
use cograin::state::Loss;
use cograin::state::ledger::Source;
use std::f64::consts::PI;

/// Grains that touch each other, a floor and a lid in a wind; `more` tables.
fn wind(fluid: &str, more: &str) -> Simulation {
    start(&format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2.0e-6
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.a.a]
restitution = 0.6
friction = 0.4
[contact.all.normal.hertz]
[contact.all.tangential.history]
[particles.box]
material = "a"
lattice = {{ kind = "simple_cubic", radius = 1.0e-3, counts = [4, 3, 3], origin = [0.0, 0.0, 0.98e-3], spacing = 1.98e-3 }}
velocity = [0.1, 0.3, -0.2]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
[fluid.air]
density = 1.2
viscosity = 1.8e-5
{fluid}
[output]
energy = true
losses = true
{more}
"#
    ))
}

#[test]
fn wind_on_a_box_of_grains_gives_them_what_it_loses() {
    // Nothing else acts along x and y but the floor, and pairs with each other.
    let mut simulation = wind("velocity = [8.0, 2.0, 0.0]\nporosity = 0.5\n[fluid.air.drag.beetstra]", "");
    let momentum = |simulation: &Simulation, axis: usize| -> f64 {
        simulation.state().particles.velocity.iter().map(|row| row[3] * row[axis]).sum()
    };
    for _ in 0..5 {
        let before = [0, 1].map(|axis| momentum(&simulation, axis));
        simulation.advance(4e-4).unwrap();
        for axis in 0..2 {
            let name = format!("air.mean_drag.{}", ["x", "y"][axis]);
            let drag = -value(&simulation, &name) * 4e-4;
            let floor = -simulation.state().boundaries[0].mean_force[axis] * 4e-4;
            let gained = momentum(&simulation, axis) - before[axis];
            let scale = drag.abs() + floor.abs() + 1e-7;
            assert!((gained - drag - floor).abs() < 1e-13 * scale, "{gained:e}, {drag:e}, {floor:e} N s");
        }
    }
    assert!(value(&simulation, "energy.residual").abs() < 1e-13 * value(&simulation, "air.work").abs());
}

#[test]
fn the_books_close_to_rounding_and_the_power_of_the_fluid_is_work_and_dissipation() {
    let mut simulation = wind("velocity = [8.0, 2.0, 1.0]\ntorque = true\n[fluid.air.drag.schiller_naumann]", "");
    for interval in [1e-3, 3e-4, 0.7e-6, 1e-3] {
        // One interval is shorter than a step: the next one begins with loads of that.
        simulation.advance(interval).unwrap();
        let ledger = simulation.state().ledger.as_ref().unwrap();
        assert!(simulation.energy_residual().unwrap().abs() < 1e-13 * ledger.turnover);
        let taken = simulation.losses().unwrap()[Loss::Drag as usize];
        let (work, on_grains) = (value(&simulation, "air.work"), ledger.work_of(Source::Fluid));
        assert!(taken > 0.0 && (work - taken - on_grains).abs() < 1e-9 * work, "{work:e}, {taken:e}, {on_grains:e} J");
    }
    let scale = value(&simulation, "air.work");
    assert!(simulation.physical_residual().unwrap().abs() < 1e-3 * scale, "{:?}", simulation.physical_residual());
}

/// A clump of two spheres that overlap, in a fluid.
fn clump(step: f64, fluid: &str) -> Simulation {
    start(&format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = {step:?}
[material.glass]
density = 2500.0
[clump.pair]
spheres = [{{ position = [0.0, 0.0, 0.0], radius = 5.0e-5 }}, {{ position = [5.0e-5, 0.0, 0.0], radius = 5.0e-5 }}]
[particles.pairs]
material = "glass"
clump = "pair"
list = [{{ position = [0.0, 0.0, 0.0], angular_velocity = [30.0, 20.0, 10.0], velocity = [0.1, 0.0, 0.0] }}]
[fluid.water]
density = 1000.0
viscosity = 1.0
{fluid}
[output]
energy = true
losses = true
"#
    ))
}

#[test]
fn a_clump_sinks_as_the_sphere_of_its_volume() {
    // Two spheres whose centres are R apart: each loses a cap of height R/2, of volume π h² (3R − h)/3.
    let r: f64 = 5e-5;
    let volume = 2.0 * (4.0 / 3.0 * PI * r.powi(3) - PI * (0.5 * r).powi(2) * (3.0 * r - 0.5 * r) / 3.0);
    let diameter = (6.0 / PI * volume).cbrt();
    let (viscosity, relaxation) = (1.0, 1e-3 * RELAXATION);
    let expected = diameter * diameter * 1500.0 * 9.81 / (18.0 * viscosity);
    for step in [0.1, 10.0] {
        let mut simulation = clump(step * relaxation, "torque = true\n[fluid.water.drag.stokes]");
        simulation.advance(300.0 * f64::max(step, 1.0) * relaxation).unwrap();
        assert_near(-simulation.state().clumps.velocity[0][2], expected, 1e-11);
        let spin = simulation.state().clumps.angular_velocity[0];
        assert!(spin.iter().all(|part| part.abs() < 1e-9), "{spin:?} rad/s");
        let ledger = simulation.state().ledger.as_ref().unwrap();
        assert!(simulation.energy_residual().unwrap().abs() < 1e-12 * ledger.turnover);
        let (work, taken) = (value(&simulation, "water.work"), value(&simulation, "energy.lost.drag"));
        assert!((work - taken - ledger.work_of(Source::Fluid)).abs() < 1e-12 * taken);
    }
}

#[test]
fn a_spin_decays_by_the_torque_of_stokes() {
    // I = π ρ d⁵/60 and the dashpot π µ d³: a relaxation time of ρ d²/(60 µ).
    let relaxation = DENSITY * DIAMETER * DIAMETER / (60.0 * VISCOSITY);
    let mut simulation = start(&format!(
        r#"
[run]
step = {:?}
[material.glass]
density = 2500.0
[particles.grain]
material = "glass"
list = [{{ position = [0.0, 0.0, 0.0], radius = 5.0e-5, angular_velocity = [3.0, 0.0, 4.0] }}]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
torque = true
[fluid.water.drag.stokes]
"#,
        0.01 * relaxation
    ));
    simulation.advance(relaxation).unwrap();
    let spin = simulation.state().particles.angular_velocity[0];
    assert_near(spin[0], 3.0 * (-1.0_f64).exp(), 3e-5);
    assert_near(spin[2], 4.0 * (-1.0_f64).exp(), 3e-5);
}

#[test]
fn the_force_of_a_group_has_the_drag_and_the_buoyancy_of_its_particles() {
    let mut simulation = start(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 1.0e-4
[material.glass]
density = 2500.0
[particles.rod]
material = "glass"
list = [{ position = [0.0, 0.0, 0.0], radius = 1.0e-3 }, { position = [3.0e-3, 0.0, 0.0], radius = 1.0e-3 }]
[boundary.rod]
particles = { set = "rod" }
motion = { prescribed = { x = 0.1 } }
[fluid.water]
density = 1000.0
viscosity = 1.0
velocity = [0.3, 0.0, 0.0]
[fluid.water.drag.stokes]
[output]
losses = true
"#,
    );
    simulation.advance(0.01).unwrap();
    let force = simulation.state().boundaries[0].mean_force;
    let (drag, volume) = (2.0 * 3.0 * PI * 2e-3 * 0.2, 2.0 * PI / 6.0 * 8e-9);
    assert_near(force[0], drag, 1e-12);
    assert_near(force[2], volume * 1000.0 * 9.81, 1e-12);
    assert_near(value(&simulation, "water.mean_drag.x"), -drag, 1e-12);
    assert_near(value(&simulation, "water.work"), drag * 0.3 * 0.01, 1e-12);
    assert_near(value(&simulation, "energy.lost.drag"), drag * 0.2 * 0.01, 1e-12);
    assert!(simulation.physical_residual().unwrap().abs() < 1e-12 * drag * 0.3 * 0.01);
}

#[test]
fn settling_ends_where_the_floor_bears_what_the_water_does_not() {
    let mut simulation = start(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 1.0e-5
[material.glass]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.5
[contact.all.normal.hertz]
[particles.grain]
material = "glass"
list = [{ position = [0.0, 0.0, 1.0e-3], radius = 1.0e-3 }]
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "glass"
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
velocity = [0.0, 0.0, 0.05]
[fluid.water.drag.stokes]
"#,
    );
    // Damping of settling vanishes where the whole load does, drag included.
    simulation.damp_rest(0.5);
    simulation.advance(0.1).unwrap();
    let expected = PI / 6.0 * 8e-9 * 1500.0 * 9.81 - 3.0 * PI * 1e-3 * 2e-3 * 0.05;
    assert_near(-simulation.state().boundaries[0].force[2], expected, 1e-9);
}

#[test]
fn grains_in_a_cell_that_repeats_are_dragged_once() {
    let mut simulation = start(
        r#"
[run]
step = 1.0e-4
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.a.a]
restitution = 0.6
[contact.all.normal.hertz]
[particles.a]
material = "a"
list = [{ position = [0.5e-3, 5.0e-3, 5.0e-3], radius = 1.0e-3 }, { position = [8.52e-3, 5.0e-3, 5.0e-3], radius = 1.0e-3 }]
[cell]
edges = [[0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]]
[fluid.oil]
density = 900.0
viscosity = 1.0
velocity = [0.0, 0.1, 0.0]
[fluid.oil.drag.stokes]
[output]
energy = true
"#,
    );
    simulation.advance(1e-3).unwrap();
    let momentum: f64 = simulation
        .state()
        .particles
        .slots()
        .map(|slot| simulation.state().particles.velocity[slot])
        .map(|v| v[3] * v[1])
        .sum();
    assert_near(-value(&simulation, "oil.mean_drag.y") * 1e-3, momentum, 1e-13);
    let ledger = simulation.state().ledger.as_ref().unwrap();
    assert!(simulation.energy_residual().unwrap().abs() < 1e-13 * ledger.turnover);
}
