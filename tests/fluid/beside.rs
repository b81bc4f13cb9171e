//! Added mass and the acceleration of the fluid, against closed forms.

use super::scenes::{SIX, give};
use crate::support::{assert_near, set, start, value, velocity_of_first};
use cograin::simulation::Simulation;
use std::f64::consts::PI;

/// Diameter \[m\] of the sphere.
const DIAMETER: f64 = 1.0e-4;

/// A sphere of this density in water of 1000 kg/m³ and of this viscosity; gravity along z, keys of the water.
pub(super) fn sphere(density: f64, gravity: f64, step: f64, (viscosity, keys): (f64, &str)) -> Simulation {
    start(&format!(
        r#"
gravity = [0.0, 0.0, {gravity:?}]
[run]
step = {step:?}
[material.a]
density = {density:?}
[particles.sphere]
material = "a"
list = [{{ position = [0.0, 0.0, 0.0], radius = {:?} }}]
[fluid.water]
density = 1000.0
viscosity = {viscosity:?}
{keys}
[fluid.water.drag.stokes]
[output]
energy = true
losses = true
"#,
        0.5 * DIAMETER
    ))
}

#[test]
fn a_light_sphere_approaches_its_terminal_velocity_with_the_added_mass() {
    let (density, viscosity, gravity) = (100.0, 1e-3, -10.0);
    let relaxation = (density + 500.0) * DIAMETER * DIAMETER / (18.0 * viscosity);
    let terminal = (1000.0 - density) * 10.0 * DIAMETER * DIAMETER / (18.0 * viscosity);
    let errors = [0.1, 0.05].map(|part| {
        let mut simulation = sphere(density, gravity, part * relaxation, (viscosity, "added_mass = 0.5"));
        simulation.advance(2.0 * relaxation).unwrap();
        velocity_of_first(&simulation)[2] - terminal * (1.0 - (-2.0_f64).exp())
    });
    assert!(errors[0].abs() < 1e-3 * terminal, "{errors:?} m/s of {terminal} m/s");
    assert_near(errors[0] / errors[1], 4.0, 0.1);
    let mut simulation = sphere(density, gravity, 10.0 * relaxation, (10.0 * viscosity, "added_mass = 0.5"));
    simulation.advance(1e4 * relaxation).unwrap();
    assert_near(velocity_of_first(&simulation)[2], 0.1 * terminal, 1e-13);
}

#[test]
fn a_bubble_rises_at_twice_gravity_and_goes_three_times_as_fast_as_water_that_starts() {
    let (density, viscosity) = (1e-6, 1e-12);
    let mut simulation = sphere(density, -10.0, 1e-5, (viscosity, "added_mass = 0.5"));
    simulation.advance(0.01).unwrap();
    assert_near(velocity_of_first(&simulation)[2], 0.01 * 2.0 * 10.0, 1e-6);
    let mut simulation = sphere(density, 0.0, 1e-5, (viscosity, "added_mass = 0.5\nvelocity = \"driven\""));
    for end in [0.2, 0.1, 0.4] {
        set(&mut simulation, "water.velocity.x", end);
        simulation.advance(0.01).unwrap();
        assert_near(velocity_of_first(&simulation)[0], 3.0 * end, 1e-6);
    }
}

#[test]
fn a_sphere_of_the_density_of_the_fluid_goes_exactly_with_it() {
    for viscosity in [1e-12, 1e-3, 1.0] {
        let keys = (viscosity, "added_mass = 0.5\nvelocity = \"driven\"");
        let mut simulation = sphere(1000.0, 0.0, 1e-5, keys);
        for (end, interval) in [(0.3, 0.01), (-0.2, 0.002), (0.5, 0.01), (0.5, 0.01), (0.7, 1e-4), (0.0, 1e-4)] {
            set(&mut simulation, "water.velocity.x", end);
            simulation.advance(interval).unwrap();
            // A rounding of the velocity in each of two thousand half kicks.
            assert!(
                (velocity_of_first(&simulation)[0] - end).abs() < 1e-13,
                "{:?} m/s",
                velocity_of_first(&simulation)
            );
            let volume = PI / 6.0 * DIAMETER.powi(3);
            let drag = value(&simulation, "water.mean_drag.x");
            assert!(drag.abs() < 1e-12 * 1000.0 * volume / interval, "{drag:e} N");
        }
    }
}

#[test]
fn the_impulse_of_a_ramp_is_that_of_the_whole_change_of_velocity() {
    let (volume, density, c) = (PI / 6.0 * DIAMETER.powi(3), 2500.0, 0.7);
    let mut simulation = sphere(density, 0.0, 1e-4, (1e-15, "added_mass = 0.7\nvelocity = \"driven\""));
    let (mut flow, mut before) = (0.0, 0.0);
    for (end, interval) in [(0.3, 0.01), (0.1, 0.003), (0.15, 2e-4), (0.4, 1e-4), (0.2, 5e-5)] {
        set(&mut simulation, "water.velocity.x", end);
        simulation.advance(interval).unwrap();
        let now = velocity_of_first(&simulation)[0];
        let expected = 1000.0 * volume * (end - flow + c * (end - flow - (now - before)));
        assert_near(density * volume * (now - before), expected, 1e-9);
        // What is no force of the pressure is drag.
        let drag = -interval * value(&simulation, "water.mean_drag.x");
        assert_near(drag, c * 1000.0 * volume * (end - flow - (now - before)), 1e-9);
        (flow, before) = (end, now);
    }
}

#[test]
fn a_group_that_stays_is_pushed_by_the_whole_acceleration() {
    let mut simulation = start(
        r#"
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.rod]
material = "a"
list = [{ position = [0.0, 0.0, 0.0], radius = 1.0e-3 }, { position = [3.0e-3, 0.0, 0.0], radius = 1.0e-3 }]
[boundary.rod]
particles = { set = "rod" }
motion = "fixed"
[fluid.water]
density = 1000.0
viscosity = 1.0e-12
added_mass = 0.5
velocity = "driven"
[fluid.water.drag.stokes]
"#,
    );
    let volume = 2.0 * PI / 6.0 * 8e-9;
    let mut flow = 0.0;
    for end in [0.2, -0.1, 0.5] {
        set(&mut simulation, "water.velocity.y", end);
        simulation.advance(0.01).unwrap();
        let change = (end - flow) / 0.01;
        assert_near(simulation.state().boundaries[0].mean_force[1], 1500.0 * volume * change, 1e-7);
        assert_near(-value(&simulation, "water.mean_drag.y"), 500.0 * volume * change, 1e-7);
        flow = end;
    }
}

#[test]
fn a_prescribed_velocity_gives_its_impulse_to_a_light_sphere() {
    let motion =
        "velocity = { prescribed = { x = { sine = { amplitude = 0.001, frequency = 5.0 } } } }\nadded_mass = 0.5";
    let mut simulation = sphere(100.0, 0.0, 1e-4, (1e-15, motion));
    let begun = 0.001 * 2.0 * PI * 5.0;
    for _ in 0..7 {
        simulation.advance(0.013).unwrap();
        let change = value(&simulation, "water.velocity.x") - begun;
        assert_near(velocity_of_first(&simulation)[0], change * 1500.0 / 600.0, 1e-9);
    }
}

#[test]
fn an_elastic_impact_gives_back_all_its_speed() {
    // m + m_a bounces off the spring: half a period of it, and nothing is lost to the water that is carried along.
    let (k, speed, radius, density) = (0.5_f64, 0.01, 0.5 * DIAMETER, 100.0);
    let mass = (density + 500.0) * PI / 6.0 * DIAMETER.powi(3);
    let half_period = PI * (mass / k).sqrt();
    let out = |steps: f64| {
        let mut simulation = start(&format!(
            r#"
[run]
step = {:?}
[material.a]
density = {density:?}
[pair.a.a]
normal_stiffness = {k:?}
normal_damping = 0.0
tangential_stiffness = 0.0
tangential_damping = 0.0
[contact.all.normal.hooke_stiffness]
[particles.sphere]
material = "a"
list = [{{ position = [0.0, 0.0, {radius:?}], radius = {radius:?}, velocity = [0.0, 0.0, -{speed:?}] }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
[fluid.water]
density = 1000.0
viscosity = 1.0e-15
added_mass = 0.5
[fluid.water.drag.stokes]
[output]
energy = true
"#,
            half_period / steps
        ));
        simulation.advance(0.5 * half_period).unwrap();
        let turned = velocity_of_first(&simulation)[2];
        simulation.advance(0.7 * half_period).unwrap();
        let ledger = simulation.state().ledger.as_ref().unwrap();
        assert!(simulation.energy_residual().unwrap().abs() < 1e-13 * ledger.turnover);
        [turned, velocity_of_first(&simulation)[2]]
    };
    let [turned, left] = out(200.0);
    assert!(turned.abs() < 1e-3 * speed, "{turned} m/s in the middle");
    assert_near(left, speed, 1e-3);
}

#[test]
fn in_a_flow_that_stretches_a_sphere_of_the_density_of_the_fluid_goes_with_it() {
    // u = (k x, −k y, 0): Du/Dt = k² (x, y, 0), and x = x₀ exp(k t).
    let (k, from) = (2.0, [0.026, 0.017]);
    let errors = [2e-3, 1e-3].map(|step| {
        let mut simulation = start(&format!(
            r#"
[run]
step = {step:?}
[material.a]
density = 1000.0
[particles.sphere]
material = "a"
list = [{{ position = [{:?}, {:?}, 0.01], radius = 2.0e-3, velocity = [{:?}, {:?}, 0.0] }}]
[grid.column]
{SIX}
outputs = []
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
grid = "column"
velocity = "driven"
added_mass = 0.5
[fluid.water.drag.stokes]
"#,
            from[0],
            from[1],
            k * (from[0] - 0.02),
            -k * (from[1] - 0.015)
        ));
        let grid = simulation.scene().grids[0].shape;
        give(&mut simulation, "velocity", |cell| {
            let [x, y, _] = grid.centre(cell);
            [k * (x - 0.02), -k * (y - 0.015), 0.0]
        });
        simulation.place(None).unwrap();
        simulation.advance(0.4).unwrap();
        let row = simulation.state().particles.position[0];
        row[0] - 0.02 - (from[0] - 0.02) * (0.4 * k).exp()
    });
    assert!(errors[0].abs() < 1e-7, "{errors:?} m");
    assert_near(errors[0] / errors[1], 4.0, 0.2);
}

#[test]
fn a_gradient_that_is_given_contains_what_accelerates_the_fluid() {
    // Added mass alone acts beside the gradient, which is 0 here.
    let keys = "added_mass = 0.5\nvelocity = \"driven\"\npressure = \"dynamic\"";
    let mut simulation = sphere(500.0, 0.0, 1e-4, (1e-15, keys));
    for end in [0.2, -0.1, 0.5] {
        set(&mut simulation, "water.velocity.x", end);
        simulation.advance(0.01).unwrap();
        assert_near(velocity_of_first(&simulation)[0], 0.5 * end, 1e-9);
    }
}
