//! A sphere that is set down sliding on a plane slows at µ g, spins up, and rolls with five sevenths of its speed.
//!
//! Source: any mechanics text; ω = 5 µ g t/(2 r) while it slides, u = 5 u₀/7 once it rolls.

use crate::physics::stage::{HERTZ, Stage, assert_close, assert_near, material, plane, properties, scene, sphere};
use cograin::contact::{LawChoice, TangentialModel, tangential};

/// Gravity \[m/s²\].
const G: f64 = 9.81;

/// Radius \[m\].
const R: f64 = 0.05;

/// Coefficient of friction.
const MU: f64 = 0.3;

/// Speed at the start \[m/s\].
const SPEED: f64 = 1.0;

/// Sphere and plane, the sphere where its weight rests on the spring; overlap over radius is 1e-6.
fn sliding_sphere(law: LawChoice, restitution: f64) -> Stage {
    let mut body = sphere(R, 2500.0);
    let weight = body.mass() * G;
    let modulus = 1e9;
    // Weight = 4/3 E* √R δ^(3/2), E* = E/2 with ν = 0
    let overlap = (weight / (4.0 / 3.0 * modulus / 2.0 * R.sqrt())).powf(2.0 / 3.0);
    body.position = [0.0, 0.0, R - overlap];
    body.velocity[0] = SPEED;
    let mut scene = scene(law, 4e-6, vec![material(modulus, 0.0); 2], properties(restitution, MU), vec![body]);
    scene.gravity = [0.0, 0.0, -G];
    scene.boundaries = vec![plane([0.0; 3], [0.0, 0.0, 1.0], 1)];
    Stage::of(scene)
}

/// The spring needs a moment to reach the limit, and the arm is half an overlap short of the radius (2e-5).
const SPRING: f64 = 1e-3;

#[test]
fn slides_under_the_friction_of_its_weight() {
    // Without a dashpot, which would act on the whole speed until the spring is at its limit.
    let mut stage = sliding_sphere(HERTZ, 1.0);
    stage.steps(12_500); // 0.05 s, sliding ends at 2 u₀/(7 µ g) = 0.097 s
    let time = stage.simulation.time();
    assert_near(stage.velocity(0)[0], SPEED - MU * G * time, SPRING * SPEED, "speed");
    assert_near(stage.spin(0)[1], 2.5 * MU * G * time / R, SPRING * SPEED / R, "angular velocity");
}

#[test]
fn rolls_with_five_sevenths_of_its_speed() {
    for tangential in
        [HERTZ.tangential, TangentialModel::of::<tangential::no_history::NoHistory>(cograin::contact::NoKeys {})]
    {
        let mut stage = sliding_sphere(LawChoice { tangential, ..HERTZ }, 0.5);
        stage.steps(50_000);
        assert_close(stage.velocity(0)[0], 5.0 / 7.0 * SPEED, SPRING, "speed");
        assert_close(stage.spin(0)[1] * R, 5.0 / 7.0 * SPEED, SPRING, "speed of the surface");
    }
}
