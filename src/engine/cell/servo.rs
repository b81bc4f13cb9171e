//! A component of the strain that reaches a stress.
//!
//! ```text
//! dε/dt = h + α (σ_t − σ)/Z      dh/dt = (σ_t − σ)/(n J)      each at most the largest rate
//! Z = √(K J)      J = m/d
//! ```
//!
//! K is the stiffness of the network and of the velocities to this strain where every particle goes with the cell. m is the mean mass of the
//! particles, d³ the volume for each: a wave goes from a particle to the next in the time √(J/K). What is missing falls in 1/α of that
//! time, or more slowly where particles give way. h is the rate that the other strains ask for in the mean: with it, the mean of the
//! stress is the target at any rate of these. Where nothing touches, the largest rate leads to the stress.

use crate::scene::StressServo;

/// α. The strain's rate changes the stress of dashpots at once: at 1 it swings where these are nearly critical.
const SHARE: f64 = 0.25;

/// n: the inertia of the rate that is held, over J. The damping is ½ α √(n k) of the critical one, where the packing is k times as stiff as
/// if every particle went with the cell.
const HEAVIER: f64 = 100.0;

/// What a servo acts on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Felt {
    /// What the stress lacks of the target \[Pa\].
    pub(super) error: f64,
    /// K \[Pa\].
    pub(super) stiffness: f64,
    /// J \[kg/m\].
    pub(super) inertia: f64,
}

/// The rate of the strain in a time step of this length \[s\] \[1/s\], beside the rate that is held, which follows.
pub(super) fn rate(servo: &StressServo, felt: Felt, held: &mut f64, step: f64) -> f64 {
    let Felt { error, stiffness, inertia } = felt;
    let limited = |rate: f64| rate.clamp(-servo.max_rate, servo.max_rate);
    // It is not a number where nothing is missing and nothing touches.
    let answer = SHARE * error / (stiffness * inertia).sqrt();
    let rate = if answer.is_nan() { *held } else { limited(*held + answer) };
    *held = limited(*held + step * error / (HEAVIER * inertia));
    rate
}

#[cfg(test)]
mod tests {
    use super::{Felt, HEAVIER, SHARE, rate};
    use crate::scene::{ServedStress, StressServo};

    const SERVO: StressServo = StressServo { stress: -1e5, of: ServedStress::Own, max_rate: 0.5 };

    #[test]
    fn the_rate_is_a_share_of_what_is_missing_over_the_impedance_and_no_more_than_the_limit() {
        let alone = |error, stiffness| rate(&SERVO, Felt { error, stiffness, inertia: 1.0 }, &mut 0.0, 1e-6);
        assert_eq!(alone(-1e3, 1e8), -SHARE * 0.1);
        assert_eq!(alone(1e5, 1e6), 0.5);
        assert_eq!(alone(-1e5, 0.0), -0.5);
        assert_eq!(alone(0.0, 0.0), 0.0);
    }

    #[test]
    fn the_rate_that_is_held_grows_with_what_is_missing_up_to_the_limit() {
        let mut held = 0.1;
        let felt = Felt { error: 10.0, stiffness: 1e8, inertia: 1.0 };
        assert_eq!(rate(&SERVO, felt, &mut held, 1e-3), 0.1 + SHARE * 1e-3);
        assert_eq!(held, 0.1 + 1e-2 / HEAVIER);
        rate(&SERVO, Felt { error: 1e6, ..felt }, &mut held, 1.0);
        assert_eq!(held, 0.5);
    }
}
