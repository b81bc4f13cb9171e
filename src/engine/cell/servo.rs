//! A component of the strain that reaches a stress.
//!
//! ```text
//! dε/dt = g (σ_t − σ) / (K Δt),      at most the largest rate
//! ```
//!
//! K is the stiffness of the network to this strain where every particle goes with the cell: what is missing falls by the factor 1 − g
//! in a time step, or more slowly where particles give way. Where nothing touches, the largest rate leads to the stress.

use crate::scene::StressServo;

/// Share of the missing stress that a time step gives: small, so that particles have time to go where forces lead them.
const SHARE: f64 = 0.01;

/// The rate of the strain where the stress is this and is to be that \[Pa\], of a cell so stiff \[Pa\], in a time step of this length
/// \[s\] \[1/s\].
pub(super) fn rate(servo: &StressServo, [stress, target]: [f64; 2], stiffness: f64, step: f64) -> f64 {
    let rate = SHARE * (target - stress) / (stiffness * step);
    // It is not a number where nothing is missing and nothing touches.
    if rate.is_nan() { 0.0 } else { rate.clamp(-servo.max_rate, servo.max_rate) }
}

#[cfg(test)]
mod tests {
    use super::{SHARE, rate};
    use crate::scene::StressServo;

    #[test]
    fn the_rate_is_a_share_of_what_is_missing_and_no_more_than_the_limit() {
        let servo = StressServo { stress: -1e5, max_rate: 0.5 };
        assert_eq!(rate(&servo, [-1e5, -2e5], 1e9, 1e-3), -SHARE * 1e5 / 1e6);
        assert_eq!(rate(&servo, [-1e5, 1e5], 1e6, 1e-6), 0.5);
        assert_eq!(rate(&servo, [0.0, -1e5], 0.0, 1e-3), -0.5);
        assert_eq!(rate(&servo, [0.0, 0.0], 0.0, 1e-3), 0.0);
    }
}
