//! Along its axis a chain of bonds swings as masses on springs do, each mode at its closed form.

use crate::physics::chain::{AXIAL, CLAMP, MASS, Motion, chain, in_order};
use crate::physics::stage::assert_close;
use crate::support::start;
use std::f64::consts::PI;

/// Bonds of the chain.
const BONDS: usize = 10;

/// w_j = 2 √(k/m) sin((2 j − 1) π/(2 (2 N + 1))) of a chain that is held at one end \[rad/s\].
fn frequency(mode: usize) -> f64 {
    2.0 * (AXIAL / MASS).sqrt() * (wave(mode) / 2.0).sin()
}

/// Phase from one sphere to the next.
fn wave(mode: usize) -> f64 {
    (2 * mode - 1) as f64 * PI / (2 * BONDS + 1) as f64
}

/// The angular frequency of a mode, from three looks after each other at each of the time steps \[rad/s\].
fn found(formulation: &str, mode: usize, step: f64) -> f64 {
    let shape = |sphere: usize| (wave(mode) * sphere as f64).sin();
    let motions: Vec<Motion> = (0..=BONDS).map(|sphere| [[1e-3 * shape(sphere), 0.0, 0.0], [0.0; 3]]).collect();
    let mut simulation = start(&chain(formulation, step, &motions, CLAMP));
    // Some thirty periods of the slowest mode.
    let course: Vec<f64> = (0..2000)
        .map(|_| {
            simulation.advance(step).unwrap();
            let rows = in_order(&simulation, &simulation.state().particles.velocity);
            rows.enumerate().map(|(sphere, [x, ..])| x * shape(sphere)).sum()
        })
        .collect();
    // v(t + Δt) + v(t − Δt) = 2 cos(ω Δt) v(t), fitted.
    let sums = course.windows(3).map(|three| ((three[0] + three[2]) * three[1], three[1] * three[1]));
    let (both, own) = sums.fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
    (both / (2.0 * own)).acos() / step
}

#[test]
fn each_mode_has_the_frequency_of_masses_on_springs() {
    // A tenth of the stable step 2/ω_max: what velocity Verlet shifts is (ω Δt)²/24 < 1.7e-3 of a frequency.
    let step = 0.1 * (MASS / AXIAL).sqrt();
    for formulation in ["finite_rotation", "incremental", "engine_exact"] {
        for mode in 1..=BONDS {
            let (found, expected) = (found(formulation, mode, step), frequency(mode));
            let what = format!("{formulation}, mode {mode}");
            let shift = (expected * step).powi(2) / 24.0;
            assert_close(found, expected, 1.1 * shift + 1e-7, &what);
            // The shift taken away: sin(ω Δt/2) of the integrator is ω Δt/2 of the springs.
            let bare = 2.0 / step * (found * step / 2.0).sin();
            assert_close(bare, expected, 1e-7, &what);
        }
    }
}
