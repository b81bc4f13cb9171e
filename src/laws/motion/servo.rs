//! `servo`: the axis moves so that the particles press on the boundary with a given force.

use super::{Motion, ShownVariables};
use crate::base::quantity::{Finite, Positive};
use serde::Deserialize;

/// Share of the missing force that a servo gives at once. Below 1, with which a wave that comes back is taken up whole; what is
/// missing falls by (1 − α)/(1 + α) on each way of a wave to and fro.
const SHARE: f64 = 0.7;

/// By how much the way of a time step grows where nothing touches.
const GROWTH: f64 = 1.01;

/// An axis that reaches the input `<boundary>.target_force.<axis>`.
///
/// ```text
/// v = α (F − F_t)/Z,      at most the speed limit, and towards the target at most max(w, |F|/K)/Δt
/// ```
///
/// F is the force of the particles on the boundary, F_t its target, Z = K t the mechanical impedance of what touches: its stiffness K times the
/// time that a wave takes through it, which for a chain of masses m and springs k is √(k m) whatever its length. w = |F_t|/2K with the
/// stiffness that was felt last near the target: so much no time step goes beyond touch. Where nothing touches, w grows by a
/// hundredth in each time step, so what left is met again, each time nearer to the target; where nothing was ever felt, the limit alone
/// holds.
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

    /// The velocity where the particles press so, and are to press so \[N\], in a time step of this length \[s\].
    pub(crate) fn velocity(&self, [force, target]: [f64; 2], felt: &Felt, step: f64) -> f64 {
        let velocity = SHARE * (force - target) / felt.impedance;
        let nears = (target - force) * target > 0.0;
        let most =
            if nears && felt.way > 0.0 { felt.way.max(force.abs() / felt.stiffness) / step } else { f64::INFINITY };
        let limit = self.limit().min(most);
        // It is not a number where nothing is missing and nothing touches.
        if velocity.is_nan() { 0.0 } else { velocity.clamp(-limit, limit) }
    }

    /// The way that a time step of this length \[s\] may go towards what no longer touches, after one in which it might go this way \[m\].
    pub(crate) fn further(&self, way: f64, step: f64) -> f64 {
        (way * GROWTH).min(self.limit() * step)
    }
}

/// What a servo feels of what it presses on.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Felt {
    /// Mechanical impedance; 0 where nothing touches \[kg/s\].
    pub(crate) impedance: f64,
    /// Stiffness; 0 where nothing touches \[N/m\].
    pub(crate) stiffness: f64,
    /// The way that a time step may go towards the target; 0 where nothing was felt so far \[m\].
    pub(crate) way: f64,
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

    /// At most 0.5 m/s.
    fn servo() -> Servo {
        Servo { target: Finite::default(), speed: Positive::new(0.5).unwrap() }
    }

    #[test]
    fn the_speed_is_a_share_of_what_is_missing_and_no_more_than_the_limit() {
        let felt = Felt { impedance: 10.0, stiffness: 1e3, way: 1.0 };
        assert_eq!(servo().velocity([1.0, 3.0], &felt, 1e-3), -SHARE * 2.0 / 10.0);
        assert_eq!(servo().velocity([200.0, 0.0], &felt, 1e-3), 0.5);
        assert_eq!(servo().velocity([0.0, 1e-9], &Felt::default(), 1e-3), -0.5);
        assert_eq!(servo().velocity([0.0, 0.0], &Felt::default(), 1e-3), 0.0);
    }

    #[test]
    fn a_time_step_goes_no_further_towards_the_target_than_the_way_or_what_is_pressed_already() {
        let felt = Felt { impedance: 1e-3, stiffness: 1e3, way: 1e-5 };
        assert_eq!(servo().velocity([0.001, 1.0], &felt, 1e-3), -1e-2);
        assert_eq!(servo().velocity([0.1, 1.0], &felt, 1e-3), -0.1);
        assert_eq!(servo().velocity([-0.1, -1.0], &felt, 1e-3), 0.1);
        // Away from it the limit alone holds.
        assert_eq!(servo().velocity([2.0, 1.0], &felt, 1e-3), 0.5);
    }

    #[test]
    fn where_nothing_touches_the_way_grows_up_to_the_limit() {
        assert_eq!(servo().further(1e-6, 1e-3), GROWTH * 1e-6);
        assert_eq!(servo().further(1.0, 1e-3), 0.5e-3);
    }
}
