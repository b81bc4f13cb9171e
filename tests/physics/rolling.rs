//! Rolling resistance of constant size slows, stops, and holds as the closed forms say; it never comes to rest.
//!
//! Source: J. Ai et al., *Powder Technol.* 206 (2011) 269–282: with torque µ_r R N a rolling sphere slows at
//! 5 µ_r g/7; on an incline it gains 5 (sin θ − µ_r cos θ) g/7, or holds for µ_r ≥ tan θ.

use crate::physics::stage::{
    HERTZ, SMOOTH, Stage, assert_close, assert_near, material, plane, properties, scene, sphere,
};
use cograin::contact::{LawChoice, NoKeys, RollingModel, property, rolling};

/// Gravity \[m/s²\].
const G: f64 = 9.81;

/// Radius \[m\].
const R: f64 = 0.05;

/// Coefficient of rolling friction.
const MU: f64 = 0.05;

/// Overlap over radius is 2e-5, arms are half of it short; a change of load at the start adds as much.
const ARM: f64 = 1e-4;

/// A sphere that rests on a plane with its elastic force, under gravity along `down`, at this speed and spin.
fn resting(law: LawChoice, down: [f64; 3], friction: f64, speed: f64, spin: f64) -> Stage {
    let mut body = sphere(R, 2500.0);
    let modulus = 1e9;
    let overlap = (body.mass() * -down[2] / (4.0 / 3.0 * modulus / 2.0 * R.sqrt())).powf(2.0 / 3.0);
    body.position = [0.0, 0.0, R - overlap];
    body.velocity[0] = speed;
    body.angular_velocity[1] = spin;
    let pair = properties(0.5, friction).with(&property::ROLLING_FRICTION, MU);
    let rough = LawChoice { rolling: RollingModel::of::<rolling::cdt::Cdt>(NoKeys {}), ..law };
    let mut scene = scene(rough, 4e-6, vec![material(modulus, 0.0); 2], pair, vec![body]);
    scene.gravity = down;
    scene.boundaries = vec![plane([0.0; 3], [0.0, 0.0, 1.0], 1)];
    Stage::of(scene)
}

/// Gravity on a plane that is inclined by an angle with this sine, downhill along x.
fn inclined(sine: f64) -> [f64; 3] {
    [G * sine, 0.0, -G * (1.0 - sine * sine).sqrt()]
}

#[test]
fn a_rolling_sphere_slows_at_five_sevenths_of_the_resistance() {
    let mut stage = resting(HERTZ, inclined(0.0), 0.8, 1.0, 1.0 / R);
    stage.steps(50_000);
    let lost = 1.0 - stage.velocity(0)[0];
    // The tangential spring takes up the decelerating force with a jolt: 1e-3 of the loss.
    assert_close(lost, 5.0 / 7.0 * MU * G * stage.simulation.time(), 1e-3, "speed lost");
}

#[test]
fn a_rolling_sphere_stops_after_the_distance_of_the_energy_balance() {
    let speed = 0.1;
    let mut stage = resting(HERTZ, inclined(0.0), 0.8, speed, speed / R);
    stage.steps(100_000); // it stops after 7 v₀/(5 µ_r g) = 0.285 s
    assert_close(stage.position(0)[0], 0.7 * speed * speed / (MU * G), 2e-3, "distance");
    // It never rests: the residual torque turns its sign from step to step, about zero spin.
    let noise = 2.5 * MU * G * stage.step / R;
    assert_near(stage.spin(0)[1], 0.0, 50.0 * noise, "angular velocity");
    let torque = stage.torque(0)[1].abs();
    assert!(torque > 0.1 * MU * R * 4.0 / 3.0 * std::f64::consts::PI * R * R * R * 2500.0 * G, "{torque:e} N m");
}

#[test]
fn a_sphere_spinning_on_a_smooth_plane_slows_by_the_torque_on_its_inertia() {
    let mut stage = resting(SMOOTH, inclined(0.0), 0.0, 0.0, 10.0);
    stage.steps(25_000);
    let lost = 10.0 - stage.spin(0)[1];
    assert_close(lost, 5.0 * MU * G * stage.simulation.time() / (2.0 * R), ARM, "angular velocity lost");
}

#[test]
fn a_sphere_gains_speed_down_an_incline_that_is_steep_enough() {
    let sine = 0.2;
    let mut stage = resting(HERTZ, inclined(sine), 0.8, 0.0, 0.0);
    stage.steps(50_000);
    let along = 5.0 / 7.0 * G * (sine - MU * (1.0 - sine * sine).sqrt());
    assert_close(stage.velocity(0)[0], along * stage.simulation.time(), 1e-3, "speed");
}

#[test]
fn a_sphere_stays_on_an_incline_that_is_not() {
    let mut stage = resting(HERTZ, inclined(0.04), 0.8, 0.0, 0.0);
    stage.steps(50_000);
    // Free rolling would have gained 5/7 · 0.04 g · 0.2 s = 0.056 m/s.
    assert_near(stage.velocity(0)[0], 0.0, 1e-4, "speed");
}
