//! `servo`: the axis moves so that the particles press on the boundary with a given force.

use super::{Motion, ShownVariables};
use crate::base::quantity::{Finite, Positive};
use serde::Deserialize;

/// Share of the missing force that a servo gives at once. Below 1, with which a wave that comes back is taken up whole; what is
/// missing falls by (1 − α)/(1 + α) on each way of a wave to and fro.
const SHARE: f64 = 0.7;

/// An axis that reaches the input `<boundary>.target_force.<axis>`.
///
/// ```text
/// v = α (F − F_t)/Z,      at most the speed limit
/// ```
///
/// F is the force of the particles on the boundary, F_t its target, Z = K t the mechanical impedance of what touches: its stiffness times the
/// time that a wave takes through it, which for a chain of masses m and springs k is √(k m) whatever its length.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Servo {
    /// What the input starts with \[N\].
    #[serde(default)]
    target: Finite,
    /// The largest speed \[m/s\].
    speed: Positive,
}

impl Servo {
    /// The largest speed \[m/s\].
    pub(crate) fn limit(&self) -> f64 {
        self.speed.get()
    }

    /// The velocity at which this much force is missing \[N\], with this impedance \[kg/s\].
    pub(crate) fn velocity(&self, missing: f64, impedance: f64) -> f64 {
        let limit = self.limit();
        let velocity = -SHARE * missing / impedance;
        // It is not a number where nothing is missing and nothing touches.
        if velocity.is_nan() { 0.0 } else { velocity.clamp(-limit, limit) }
    }
}

impl Motion for Servo {
    fn words(&self, unit: &str) -> Option<String> {
        Some(format!("servo, from {} N on, at most {} {unit}", self.target.get(), self.limit()))
    }

    fn seen(&self) -> ShownVariables {
        ShownVariables::Servo
    }

    fn first_input(&self) -> f64 {
        self.target.get()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_speed_is_a_share_of_what_is_missing_and_no_more_than_the_limit() {
        let servo = Servo { target: Finite::default(), speed: Positive::new(0.5).unwrap() };
        assert_eq!(servo.velocity(2.0, 10.0), -SHARE * 2.0 / 10.0);
        assert_eq!(servo.velocity(-200.0, 10.0), 0.5);
        assert_eq!(servo.velocity(1e-9, 0.0), -0.5);
        assert_eq!(servo.velocity(0.0, 0.0), 0.0);
    }
}
