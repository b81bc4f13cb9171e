//! A fluid without a partner: drag laws against closed forms, books, the scheme, and the same bits.

mod grids;

use crate::support::{read, start};
use cograin::interface::{Interface, Value};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::state::ledger::Source;
use cograin::state::{Loss, State};
use std::f64::consts::PI;

/// Diameter \[m\] of the grains.
const DIAMETER: f64 = 1.0e-4;
/// Their density \[kg/m³\].
const DENSITY: f64 = 2500.0;
/// Viscosity of water \[Pa s\].
const VISCOSITY: f64 = 1.0e-3;
/// Relaxation time of a grain by Stokes' law \[s\].
const RELAXATION: f64 = DENSITY * DIAMETER * DIAMETER / (18.0 * VISCOSITY);

/// Asserts that a number is within a part of another.
#[track_caller]
fn assert_near(found: f64, expected: f64, part: f64) {
    let off = (found - expected).abs();
    assert!(off <= part * expected.abs(), "{found:e}, not {expected:e}: off by {:e} of it", off / expected.abs());
}

/// A grain of glass in water.
fn grain(diameter: f64, (viscosity, step): (f64, f64), fluid: &str, more: &str) -> Simulation {
    let radius = 0.5 * diameter;
    start(&format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = {step:?}
[material.glass]
density = 2500.0
[particles.grain]
material = "glass"
list = [{{ position = [0.0, 0.0, 0.0], radius = {radius:?} }}]
[fluid.water]
density = 1000.0
viscosity = {viscosity:?}
{fluid}
{more}
"#
    ))
}

/// Velocity of the first particle \[m/s\].
fn velocity(simulation: &Simulation) -> [f64; 3] {
    let particles = &simulation.state().particles;
    let [x, y, z, _] = particles.velocity[particles.slot[0] as usize];
    [x, y, z]
}

/// The value of an output.
#[track_caller]
fn output(simulation: &Simulation, name: &str) -> f64 {
    let interface = Interface::of(simulation.scene());
    let index = interface.find(name).unwrap_or_else(|| panic!("there is no {name}"));
    interface.value(simulation, index).number()
}

#[test]
fn grains_fall_at_the_terminal_velocity_of_the_law() {
    for (law, small, large) in [
        ("schiller_naumann", 7.2941e-3, 0.145946),
        ("di_felice", 6.92152e-3, 0.134104),
        ("koch_hill", 7.89307e-3, 0.123815),
        ("beetstra", 7.69037e-3, 0.129735),
    ] {
        for (diameter, expected) in [(1e-4, small), (1e-3, large)] {
            let fluid = format!("porosity = 1.0\n[fluid.water.drag.{law}]");
            let mut simulation = grain(diameter, (VISCOSITY, diameter), &fluid, "");
            simulation.advance(20.0 * DENSITY * diameter * diameter / (18.0 * VISCOSITY)).unwrap();
            assert_near(-velocity(&simulation)[2], expected, 1e-5);
        }
    }
}

#[test]
fn the_terminal_velocity_of_stokes_is_exact_whatever_the_step() {
    // In honey, where a grain goes a small part of its radius in a relaxation time.
    let (viscosity, relaxation) = (10.0, 1e-4 * RELAXATION);
    let expected = DIAMETER * DIAMETER * 1500.0 * 9.81 / (18.0 * viscosity);
    for steps in [0.1, 1.0, 10.0, 100.0] {
        let fluid = "[fluid.water.drag.stokes]";
        let mut simulation = grain(DIAMETER, (viscosity, steps * relaxation), fluid, "");
        // What is left of the start falls by (x − 2)/(x + 2) in a step of x relaxation times.
        simulation.advance(1000.0 * steps.max(1.0) * relaxation).unwrap();
        assert_near(-velocity(&simulation)[2], expected, 4e-15);
    }
}

#[test]
fn a_grain_approaches_its_terminal_velocity_as_an_exponential() {
    let expected = 1500.0 / 2500.0 * 9.81 * RELAXATION * (1.0 - (-2.0_f64).exp());
    let errors = [0.1, 0.05].map(|steps| {
        let mut simulation = grain(DIAMETER, (VISCOSITY, steps * RELAXATION), "[fluid.water.drag.stokes]", "");
        simulation.advance(2.0 * RELAXATION).unwrap();
        -velocity(&simulation)[2] - expected
    });
    assert!(errors[0].abs() < 1e-3 * expected, "{errors:?} m/s");
    assert_near(errors[0] / errors[1], 4.0, 0.1);
}

#[test]
fn the_scheme_is_of_second_order_whatever_the_law() {
    for law in ["schiller_naumann", "beetstra"] {
        let after = |step: f64| {
            let fluid = format!("porosity = 0.9\n[fluid.water.drag.{law}]");
            let mut simulation = grain(1e-3, (VISCOSITY, step), &fluid, "");
            simulation.advance(0.032).unwrap();
            velocity(&simulation)[2]
        };
        let exact = after(1e-5);
        let errors = [2e-3, 1e-3, 5e-4].map(|step| (after(step) - exact).abs());
        assert!(errors[0] / errors[1] > 3.5 && errors[1] / errors[2] > 3.5, "{law}: {errors:?} m/s");
    }
}

#[test]
fn no_relaxation_time_limits_the_step() {
    // Light grains: they follow the water at Re = 1 while they go a small part of their radius in many relaxation times.
    let (density, wind) = (2.5, 0.01);
    let relaxation = density * DIAMETER * DIAMETER / (18.0 * VISCOSITY);
    for law in ["stokes", "schiller_naumann", "koch_hill"] {
        for steps in [10.0, 100.0] {
            let mut simulation = start(&format!(
                r#"
[run]
step = {:?}
[material.foam]
density = {density:?}
[particles.grain]
material = "foam"
list = [{{ position = [0.0, 0.0, 0.0], radius = {:?}, velocity = [0.0, {wind:?}, 0.0] }}]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
velocity = [{wind:?}, 0.0, 0.0]
porosity = 1.0
[fluid.water.drag.{law}]
[output]
losses = true
"#,
                steps * relaxation,
                0.5 * DIAMETER
            ));
            simulation.advance(800.0 * steps * relaxation).unwrap();
            let [x, y, _] = velocity(&simulation);
            assert!((x / wind - 1.0).abs() < 1e-12 && (y / wind).abs() < 1e-12, "{law}, {steps}: {x}, {y} m/s");
            let taken = simulation.losses().unwrap()[Loss::Drag as usize];
            // Both components of the slip, and the wind brings as much as it takes along.
            let mass = density * PI / 6.0 * DIAMETER.powi(3);
            assert_near(taken, mass * wind * wind, 1e-9);
        }
    }
}

#[test]
fn an_impact_in_a_fluid_is_that_of_a_spring_and_a_dashpot_to_the_ground() {
    // Without weight and buoyancy: m ẍ + β ẋ + k x = 0, until the spring is released.
    let (k, speed) = (0.5_f64, 0.01);
    let mass = DENSITY * PI / 6.0 * DIAMETER.powi(3);
    let beta = 3.0 * PI * VISCOSITY * DIAMETER;
    let out = |steps: f64| {
        let step = (mass / k).sqrt() / steps;
        let mut simulation = start(&format!(
            r#"
[run]
step = {step:?}
[material.glass]
density = 2500.0
[pair.glass.glass]
normal_stiffness = {k:?}
normal_damping = 0.0
tangential_stiffness = 0.0
tangential_damping = 0.0
[contact.all.normal.hooke_stiffness]
[particles.grain]
material = "glass"
list = [{{ position = [0.0, 0.0, 5.0e-5], radius = 5.0e-5, velocity = [0.0, 0.0, -{speed:?}] }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "glass"
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
[fluid.water.drag.stokes]
"#
        ));
        // Past the contact, whatever the step; drag then goes on by itself.
        let time = 1.5 * PI * (mass / k).sqrt();
        simulation.advance(time).unwrap();
        velocity(&simulation)[2]
    };
    let rate = 0.5 * beta / mass;
    let frequency = (k / mass - rate * rate).sqrt();
    let contact = PI / frequency;
    let left = 1.5 * PI * (mass / k).sqrt() - contact;
    let expected = speed * (-rate * contact).exp() * (-beta / mass * left).exp();
    let errors = [out(50.0) - expected, out(100.0) - expected];
    assert!(errors[1].abs() < 1e-3 * expected, "{errors:?} m/s of {expected} m/s");
    assert!(errors[0].abs() > 2.0 * errors[1].abs(), "{errors:?} m/s");
}

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
            let drag = -output(&simulation, &name) * 4e-4;
            let floor = -simulation.state().boundaries[0].mean_force[axis] * 4e-4;
            let gained = momentum(&simulation, axis) - before[axis];
            let scale = drag.abs() + floor.abs() + 1e-7;
            assert!((gained - drag - floor).abs() < 1e-13 * scale, "{gained:e}, {drag:e}, {floor:e} N s");
        }
    }
    assert!(output(&simulation, "energy.residual").abs() < 1e-13 * output(&simulation, "air.work").abs());
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
        let (work, on_grains) = (output(&simulation, "air.work"), ledger.work_of(Source::Fluid));
        assert!(taken > 0.0 && (work - taken - on_grains).abs() < 1e-9 * work, "{work:e}, {taken:e}, {on_grains:e} J");
    }
    let scale = output(&simulation, "air.work");
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
        let (work, taken) = (output(&simulation, "water.work"), output(&simulation, "energy.lost.drag"));
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
    assert_near(output(&simulation, "water.mean_drag.x"), -drag, 1e-12);
    assert_near(output(&simulation, "water.work"), drag * 0.3 * 0.01, 1e-12);
    assert_near(output(&simulation, "energy.lost.drag"), drag * 0.2 * 0.01, 1e-12);
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
fn a_driven_velocity_is_reached_at_the_end_of_the_step_on_a_ramp() {
    // A light grain follows: its velocity is that of the fluid, a relaxation time ago.
    let mut simulation = grain(DIAMETER, (VISCOSITY, 1e-5), "velocity = \"driven\"\n[fluid.water.drag.stokes]", "");
    let interface = Interface::of(simulation.scene());
    let index = interface.find("water.velocity.x").unwrap();
    interface.set(&mut simulation, index, Value::Real(0.4)).unwrap();
    simulation.advance(0.02).unwrap();
    assert_eq!(simulation.state().fluid.as_ref().unwrap().velocity.now[0][..3], [0.4, 0.0, 0.0]);
    let lag = 20.0 * RELAXATION * (1.0 - (-0.02 / RELAXATION).exp());
    assert_near(velocity(&simulation)[0], 0.4 - lag, 1e-5);
    simulation.advance(0.02).unwrap();
    assert_near(velocity(&simulation)[0], 0.4, 1e-5);
}

#[test]
fn a_prescribed_velocity_is_that_of_the_motion() {
    let fluid = "velocity = { prescribed = { x = 0.01, z = { sine = { amplitude = 0.001, frequency = 5.0 } } } }\n\
                 [fluid.water.drag.stokes]";
    let mut simulation = grain(DIAMETER, (VISCOSITY, 1e-4), fluid, "");
    simulation.advance(0.03).unwrap();
    let expected = 0.001 * 2.0 * PI * 5.0 * (2.0 * PI * 5.0 * 0.03_f64).cos();
    assert_near(output(&simulation, "water.velocity.x"), 0.01, 0.0);
    assert_near(output(&simulation, "water.velocity.z"), expected, 1e-12);
}

/// Grains and clumps that fall on a floor through a fluid which stirs them.
const STIRRED: &str = r#"
gravity = [0.3, 0.0, -9.81]
[run]
step = 2.0e-5
threads = THREADS
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
spheres = [{ position = [0.0, 0.0, 0.0], radius = 2.0e-3 }, { position = [3.0e-3, 0.0, 0.0], radius = 2.0e-3 }]
[particles.pairs]
material = "a"
clump = "pair"
lattice = { kind = "simple_cubic", counts = [5, 5, 2], radius = 4.0e-3, spacing = 0.012, origin = [0.004, 0.004, 0.06] }
[particles.grains]
material = "a"
lattice = { kind = "simple_cubic", origin = [0.004, 0.004, 0.004], counts = [12, 12, 6], spacing = 8.0e-3, radius = 4.02e-3 }
velocity = [0.4, 0.1, -0.6]
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
porosity = 0.7
torque = true
velocity = { prescribed = { x = { sine = { amplitude = 0.01, frequency = 50.0 } } } }
[fluid.water.drag.di_felice]
[output]
energy = true
losses = true
"#;

#[test]
fn threads_lanes_and_restored_states_give_the_same_bits() {
    let run = |threads: &str, width: Option<Width>, restored: bool| {
        let mut simulation = start(&STIRRED.replace("THREADS", threads));
        width.into_iter().for_each(|width| simulation.set_width(width));
        simulation.advance(1e-3).unwrap();
        if restored {
            let scene = simulation.scene().clone();
            let bytes = simulation.state().to_bytes(scene.fingerprint);
            let state = State::from_bytes(&bytes, scene.fingerprint).unwrap();
            simulation = Simulation::resume(scene, state).unwrap();
        }
        simulation.advance(1e-3).unwrap();
        simulation.state().fingerprint()
    };
    let one = run("1", None, false);
    assert_eq!(run("3", None, false), one);
    assert_eq!(run("1", Some(Width::Least), false), one);
    assert_eq!(run("2", None, true), one);
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
    assert_near(-output(&simulation, "oil.mean_drag.y") * 1e-3, momentum, 1e-13);
    let ledger = simulation.state().ledger.as_ref().unwrap();
    assert!(simulation.energy_residual().unwrap().abs() < 1e-13 * ledger.turnover);
}

#[test]
fn lengths_scaled_by_a_power_of_two_give_the_same_bits() {
    // Density stays, viscosity goes with length²/time.
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
list = [{{ position = [0.0, 0.0, 0.0], radius = {r:?} }}]
[fluid.water]
density = 1000.0
viscosity = {mu:?}
porosity = 0.6
velocity = [{:?}, 0.0, 0.0]
[fluid.water.drag.beetstra]
"#,
            -9.81 * lengths / (times * times),
            0.25 * lengths / times
        ));
        simulation.advance(200.0 * step).unwrap();
        velocity(&simulation).map(|part| (part * times / lengths).to_bits())
    };
    assert_eq!(run(1.0, 1.0), run(4.0, 2.0));
    assert_eq!(run(1.0, 1.0), run(0.125, 0.5));
}

#[test]
fn a_law_of_another_crate_is_a_row() {
    use cograin::drag::Drag;
    use cograin::scene::{Models, Source};
    /// Twice Stokes' drag.
    #[derive(Debug)]
    struct Twice;
    impl Drag for Twice {
        const NAME: &'static str = "twice";
        type Keys = cograin::contact::NoKeys;
        const OF_ONE_SPHERE: bool = true;
        fn of(_keys: &Self::Keys) -> Self {
            Self
        }
        fn factor(&self, _porosity: f64, _reynolds: f64) -> f64 {
            2.0
        }
    }
    let text = r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 1e-4
[material.glass]
density = 2500.0
[particles.grain]
material = "glass"
list = [{ position = [0.0, 0.0, 0.0], radius = 5.0e-5 }]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
[fluid.water.drag.twice]
"#;
    assert!(read(text).unwrap_err().contains("twice"));
    let models = Models::standard().with_drag::<Twice>();
    let source = Source { name: "scene.toml".to_owned(), text: text.to_owned(), files: Default::default() };
    let scene = models.scene(&source, &[]).map_err(|errors| errors.to_string()).unwrap();
    let mut simulation = Simulation::new(std::sync::Arc::new(scene)).unwrap();
    simulation.advance(0.05).unwrap();
    assert_near(-velocity(&simulation)[2], DIAMETER * DIAMETER * 1500.0 * 9.81 / (36.0 * VISCOSITY), 1e-13);
}
