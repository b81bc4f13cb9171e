//! Elastic spheres without friction keep their energy, kinetic and stored, to the error of the step.

use crate::physics::momentum::cloud;
use crate::physics::stage::{SMOOTH, Stage, assert_close, material, properties, scene};

/// Young's modulus \[Pa\] with ν = 0, so that E* is half of it.
const MODULUS: f64 = 1e7;

/// Energy of Hertz's springs: 8/15 E* √R* δ^(5/2) \[J\].
fn stored(stage: &Stage) -> f64 {
    let radius = |index: u32| stage.simulation.scene().particles[index as usize].radius;
    let of = |first: u32, second: u32, overlap: f64| {
        let effective = radius(first) * radius(second) / (radius(first) + radius(second));
        8.0 / 15.0 * MODULUS / 2.0 * effective.sqrt() * overlap * overlap * overlap.sqrt()
    };
    let contacts = stage.simulation.contacts();
    contacts.iter().map(|contact| of(contact.first, contact.second.unwrap(), contact.overlap)).sum()
}

/// Largest relative change of the energy at a hundred moments of 0.02 s.
fn drift(step: f64) -> f64 {
    let mut stage = Stage::of(scene(SMOOTH, step, vec![material(MODULUS, 0.0)], properties(1.0, 0.0), cloud()));
    let before = stage.simulation.kinetic_energy() + stored(&stage);
    let mut largest = 0.0_f64;
    let mut most_stored = 0.0_f64;
    for _ in 0..100 {
        stage.steps((2e-4 / step).round() as u64);
        let spring = stored(&stage);
        most_stored = most_stored.max(spring);
        largest = largest.max((stage.simulation.kinetic_energy() + spring - before).abs() / before);
    }
    assert!(most_stored > 0.1 * before, "the cloud has hardly collided: {most_stored:e} of {before:e}");
    largest
}

#[test]
fn energy_is_kept_to_the_square_of_the_step() {
    let (coarse, fine) = (drift(1e-5), drift(2.5e-6));
    assert!(fine < 1e-4, "{fine:e}");
    // 16 for second order; impacts begin and end inside a step, which scatters it
    assert!(coarse / fine > 8.0, "{coarse:e} and {fine:e}");
    assert_close(1.0 + fine, 1.0, 1e-4, "energy");
}
