//! The measured coefficient of restitution is the one given, and the error of the time step falls as it must.
//!
//! Source: set-up 3 of Chung & Ooi (2011); Tsuji's damping with the factor √(5/6) is exact for Hertz's force where
//! the attractive end of the contact is kept.

use crate::physics::stage::{SMOOTH, assert_near, hertz_duration, hit, material, properties, rigid, sphere};
use cograin::contact::normal::hooke;
use cograin::contact::{LawChoice, NormalModel, normal};
use cograin::quantity::Positive;
use cograin::scene::Particle;
use std::f64::consts::PI;

/// Aluminium oxide, 380 GPa and 0.23, radius 2.5 mm, 4000 kg/m³, at 3.9 m/s.
fn ball() -> Particle {
    let mut ball = sphere(0.0025, 4000.0);
    ball.velocity[2] = -3.9;
    ball
}

/// E* of aluminium oxide at a rigid plane \[Pa\].
const MODULUS: f64 = 380e9 / (1.0 - 0.23 * 0.23);

/// Duration of the elastic impact \[s\].
fn duration() -> f64 {
    hertz_duration(MODULUS, 0.0025, ball().mass(), 3.9)
}

/// Measured restitution.
fn measured(law: LawChoice, given: f64, duration: f64, steps: u64) -> f64 {
    let materials = vec![material(380e9, 0.23), rigid()];
    hit(law, materials, properties(given, 0.0), ball(), duration, steps).velocity[2] / 3.9
}

#[test]
fn hertz_rebounds_with_the_restitution_given() {
    for given in [0.2, 0.4, 0.6, 0.8, 0.95, 1.0] {
        // First order in the step where the dashpot begins; 4000 steps leave 1e-4.
        assert_near(measured(SMOOTH, given, duration(), 4000), given, 2e-4, "restitution");
    }
}

#[test]
fn two_hundred_steps_are_right_to_a_thousandth_from_0_4_on() {
    // At 0.2 the dashpot is so strong that its first step, which comes at full length, costs 1.3e-3.
    for given in [0.4, 0.6, 0.8, 1.0] {
        assert_near(measured(SMOOTH, given, duration(), 200), given, 1e-3, "restitution");
    }
}

#[test]
fn hooke_rebounds_with_the_restitution_given() {
    let keys = hooke::Keys { characteristic_velocity: Positive::new(3.9).unwrap() };
    let law = LawChoice { normal: NormalModel::of::<normal::hooke::Hooke>(keys), ..SMOOTH };
    let mass = ball().mass();
    // The spring stores at its largest overlap what Hertz's contact does there.
    let deepest = crate::physics::stage::hertz_overlap(MODULUS, 0.0025, mass, 3.9);
    let stiffness = 16.0 / 15.0 * 0.0025_f64.sqrt() * MODULUS * deepest.sqrt();
    for given in [0.3, 0.6, 0.9, 1.0] {
        // The dashpot acts at once and ends at once: half a step at either end, first order.
        assert_near(measured(law, given, PI * (mass / stiffness).sqrt(), 4000), given, 1e-3, "restitution");
    }
}

#[test]
fn an_elastic_impact_errs_with_the_step_as_velocity_verlet_must() {
    // Largest |e − 1| over the phase of the first step; order 2.5. One phase stays below the largest.
    for (steps, largest) in [(10, 2.6e-3), (20, 4.3e-4), (50, 4.1e-5), (100, 7.2e-6), (200, 1.3e-6)] {
        let error = (measured(SMOOTH, 1.0, duration(), steps) - 1.0).abs();
        assert!(error < 1.05 * largest, "{steps} steps: {error:e}, at most {largest:e}");
    }
}

/// Measured restitution of two equal spheres by `eepa` without plasticity and adhesion, of this radius \[m\], that meet at this speed \[m/s\].
fn measured_by_eepa(exponents: [f64; 2], given: f64, radius: f64, speed: f64) -> f64 {
    let [overlap, adhesion] = exponents;
    let sphere = |side: f64| {
        let (place, velocity) = (1.0001 * side * radius, -0.5 * side * speed);
        format!("{{ position = [{place:?}, 0.0, 0.0], radius = {radius:?}, velocity = [{velocity:?}, 0.0, 0.0] }}")
    };
    let text = format!(
        "[run]\nthreads = 1\nsafety = 0.05\n[material.g]\ndensity = 2500.0\nyoungs_modulus = 5e7\npoissons_ratio = 0.25\n\
         [pair.g.g]\nrestitution = {given}\nunloading_stiffness_ratio = 1.0\npull_off_force = 0.0\nsurface_energy = 0.0\n\
         [contact.c.normal.eepa]\noverlap_exponent = {overlap:?}\nadhesion_exponent = {adhesion:?}\n\
         [particles.p]\nmaterial = \"g\"\nlist = [{}, {}]\n",
        sphere(1.0),
        sphere(-1.0)
    );
    let mut simulation = crate::support::start(&text);
    // Impacts last some R/(√(E/ρ))^(4/5) V^(1/5).
    let before = simulation.kinetic_energy();
    for _ in 0..40 {
        simulation.advance(0.1 * radius / speed.powf(0.2)).expect("it moves slowly");
    }
    assert_eq!(simulation.contact_count(), 0);
    (simulation.kinetic_energy() / before).sqrt()
}

#[test]
fn eepa_rebounds_with_the_restitution_given_whatever_size_and_speed() {
    for exponents in [[1.5, 3.0], [1.0, 1.0]] {
        for radius in [0.5, 5e-3, 5e-7] {
            for speed in [0.05, 1.0] {
                for given in [0.6, 0.9] {
                    let found = measured_by_eepa(exponents, given, radius, speed);
                    assert!(
                        (found - given).abs() < 2e-3,
                        "{exponents:?}, {radius} m, {speed} m/s: {found}, {given} expected"
                    );
                }
            }
        }
    }
}
