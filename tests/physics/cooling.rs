//! What a gas of spheres dissipates in its impacts at a long time step, against a short one. The automatic step is as long as the hardest impact
//! allows: at `safety = 0.8` few time steps resolve one, which a dense slow flow does not feel.

use crate::support::start;
use std::fmt::Write;

/// Pairs of spheres.
const PAIRS: usize = 100;

/// Time in which they meet \[s\].
const TIME: f64 = 5e-3;

/// Head-on impacts as they come in a gas: closing speeds of Rayleigh's distribution, at any moment of a time step. Returns the part of the energy that
/// is lost.
fn lost(law: &str, restitution: f64, step: &str) -> f64 {
    let mut list = String::new();
    for pair in 0..PAIRS {
        let closing = 0.5 * (-2.0 * libm::log(1.0 - (pair as f64 + 0.5) / PAIRS as f64)).sqrt();
        // The golden section puts them evenly.
        let when = TIME * (0.618_033_988_749_894_8 * pair as f64).fract();
        let (x, y) = (0.5 * (2e-3 + closing * when), 0.01 * pair as f64);
        for side in [-1.0, 1.0] {
            let (place, velocity) = (side * x, -0.5 * side * closing);
            writeln!(
                list,
                "{{ position = [{place:?}, {y:?}, 0.0], radius = 1e-3, velocity = [{velocity:?}, 0.0, 0.0] }},"
            )
            .unwrap();
        }
    }
    let text = format!(
        "[run]\nthreads = 1\n{step}\nmax_overlap = 0.2\n[material.g]\ndensity = 2500.0\nyoungs_modulus = 5e7\n\
         poissons_ratio = 0.25\n[pair.g.g]\nrestitution = {restitution}\n{law}\n[particles.p]\nmaterial = \"g\"\nlist = [\n{list}]\n"
    );
    let mut simulation = start(&text);
    let begun = simulation.kinetic_energy();
    simulation.advance(1.4 * TIME).expect("it runs");
    assert_eq!(simulation.contact_count(), 0);
    1.0 - simulation.kinetic_energy() / begun
}

#[test]
#[allow(
    clippy::print_stdout,
    reason = "the figures of docs/speed-and-accuracy.md are what this test prints with --nocapture"
)]
fn impacts_of_a_gas_are_right_to_some_per_cent_at_the_default_step_and_not_at_a_long_one() {
    for (name, law) in
        [("hertz", "[contact.c.normal.hertz]"), ("hooke", "[contact.c.normal.hooke]\ncharacteristic_velocity = 0.5")]
    {
        for restitution in [0.9_f64, 0.7, 0.5] {
            let right = 1.0 - restitution * restitution;
            let [long, default, fifth] =
                ["safety = 0.8", "", "safety = 0.2"].map(|step| lost(law, restitution, step) / right - 1.0);
            println!(
                "{name}, e = {restitution}: {:+.1} % at safety 0.8, {:+.1} % at 0.2, {:+.1} % by default",
                100.0 * long,
                100.0 * fifth,
                100.0 * default
            );
            assert!(default.abs() < 0.05, "{name}, e = {restitution}: {default} at the default step");
            assert!(long.abs() > 2.0 * default.abs(), "{name}, e = {restitution}: {long} at safety 0.8");
        }
    }
}
