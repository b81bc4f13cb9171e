//! What a scene or a master gives: velocities and pressure gradients.

use super::scenes::{DIAMETER, RELAXATION, SIX, VISCOSITY, give, grain, led, sum};
use crate::support::{assert_near, read, set, start, value, velocity_of_first};
use std::f64::consts::PI;

#[test]
fn a_driven_velocity_is_reached_at_the_end_of_the_step_on_a_ramp() {
    // A light grain follows: its velocity is that of the fluid, a relaxation time ago.
    let mut simulation = grain(DIAMETER, (VISCOSITY, 1e-5), "velocity = \"driven\"\n[fluid.water.drag.stokes]", "");
    set(&mut simulation, "water.velocity.x", 0.4);
    simulation.advance(0.02).unwrap();
    assert_eq!(simulation.state().fluid.as_ref().unwrap().velocity.now[0][..3], [0.4, 0.0, 0.0]);
    let lag = 20.0 * RELAXATION * (1.0 - (-0.02 / RELAXATION).exp());
    assert_near(velocity_of_first(&simulation)[0], 0.4 - lag, 1e-5);
    simulation.advance(0.02).unwrap();
    assert_near(velocity_of_first(&simulation)[0], 0.4, 1e-5);
}

#[test]
fn a_prescribed_velocity_is_that_of_the_motion() {
    let fluid = "velocity = { prescribed = { x = 0.01, z = { sine = { amplitude = 0.001, frequency = 5.0 } } } }\n\
                 [fluid.water.drag.stokes]";
    let mut simulation = grain(DIAMETER, (VISCOSITY, 1e-4), fluid, "");
    simulation.advance(0.03).unwrap();
    let expected = 0.001 * 2.0 * PI * 5.0 * (2.0 * PI * 5.0 * 0.03_f64).cos();
    assert_near(value(&simulation, "water.velocity.x"), 0.01, 0.0);
    assert_near(value(&simulation, "water.velocity.z"), expected, 1e-12);
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
    set(&mut simulation, "water.pressure_gradient.z", -5000.0);
    simulation.advance(0.01).unwrap();
    // It is there throughout the communication step, but for the half kick that begins it.
    let row = simulation.state().particles.velocity[0];
    assert_near(row[2], 0.01 * (-10.0 + (1000.0 * 10.0 + 5000.0 * (1.0 - 0.5e-3)) / 2500.0), 1e-9);
}

#[test]
fn a_second_fluid_is_refused() {
    let error = read("[fluid.a]\ndensity = 1.0\nviscosity = 1.0\n[fluid.a.drag.stokes]\n[fluid.b]\n").unwrap_err();
    assert!(error.contains("two would overlap"), "{error}");
}
