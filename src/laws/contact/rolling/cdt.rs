//! Rolling resistance of constant size.

use crate::base::number::{Number, Vector};
use crate::laws::contact::{Contact, MaterialPair, Missing, NoKeys, NormalForce, Rolling, coefficients, property};

coefficients! {
    /// A torque of constant size against the relative spin (constant directional torque).
    ///
    /// ```text
    /// T   = µ_r k_n δ R* w/|w|,  w = ω_i − ω_j        0 for w = 0
    /// T_r = T − (T·n) n                               taken from i, given to j
    /// ```
    ///
    /// | symbol  | meaning                         | unit   | comes from         |
    /// |---------|---------------------------------|--------|--------------------|
    /// | w, n    | relative spin, unit normal      | rad/s, 1 | the contact      |
    /// | k_n δ   | elastic part of the normal force| N      | the normal model   |
    /// | R*      | effective radius                | m      | the contact        |
    /// | µ_r     | coefficient of rolling friction | 1      | `rolling_friction` |
    ///
    /// The length of the whole spin divides, then the part about the normal is taken off. A body that also spins about the
    /// normal thus rolls more easily. Damping, cohesion and `limit_force` do not change the torque. It never rests: about
    /// zero spin it changes sign from step to step.
    ///
    /// Source: J. Ai, J.-F. Chen, J. M. Rotter & J. Y. Ooi, *Powder Technol.* 206 (2011) 269–282, model A.
    pub struct Cdt {
        /// µ_r.
        rolling_friction,
    }
}

impl Rolling for Cdt {
    const NAME: &'static str = "cdt";
    type Keys = NoKeys;
    const ACTIVE: bool = true;
    const TAKES_OVERLAP: bool = true;

    fn between(pair: &MaterialPair, _keys: &NoKeys) -> Result<Self, Missing> {
        Ok(Self::new(pair.get(&property::ROLLING_FRICTION)?))
    }

    #[inline(always)]
    fn torque<N: Number>(
        law: Cdt<N>,
        contact: &Contact<N>,
        normal: &NormalForce<N>,
        history: [N; 4],
        _step: N,
    ) -> (Vector<N>, [N; 4]) {
        let spin = contact.relative_spin.length();
        let size = law.rolling_friction * (normal.response.normal_stiffness * contact.overlap) * contact.radius;
        let whole = contact.relative_spin * N::select(spin.greater(N::zero()), size / spin, N::zero());
        (whole - contact.normal * whole.dot(contact.normal), history)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::{assert_close, contact, normal_force};

    /// µ_r = ⅛, k_n δ = 1024/16384 N, R* = ¼ m.
    const SIZE: f64 = 0.125 * (1024.0 / 16384.0) * 0.25;

    /// The torque against this spin; the normal is z.
    fn torque(x: f64, y: f64, z: f64) -> Vector {
        let contact = Contact { relative_spin: Vector::new(x, y, z), ..contact() };
        Cdt::torque(Cdt::new(0.125), &contact, &normal_force(), [0.0; 4], 1.0).0
    }

    #[test]
    fn has_the_direction_of_the_spin_and_a_size_that_does_not_depend_on_it() {
        assert_eq!(torque(0.0, 5.0, 0.0), Vector::new(0.0, SIZE, 0.0));
        assert_eq!(torque(0.0, -80.0, 0.0), Vector::new(0.0, -SIZE, 0.0));
    }

    #[test]
    fn divides_by_the_whole_spin_and_then_takes_off_the_normal_part() {
        // |w| = 5 rad/s of which 4 are about the normal
        assert_close(torque(3.0, 0.0, 4.0).x, SIZE * 3.0 / 5.0, 1e-15);
        assert_eq!(torque(3.0, 0.0, 4.0).z, 0.0);
        assert_eq!(torque(0.0, 0.0, 4.0).length(), 0.0);
    }

    #[test]
    fn is_zero_without_spin() {
        assert_eq!(torque(0.0, 0.0, 0.0).length(), 0.0);
        assert!(torque(1e-170, 0.0, 0.0).length().is_finite());
    }

    #[test]
    fn sees_neither_damping_nor_cohesion() {
        let mut damped = NormalForce { force: 1e9, seen: 1e9, ..normal_force() };
        damped.response.normal_damping = 1e9;
        let contact = Contact { section_area: 1e9, ..contact() };
        assert_eq!(Cdt::torque(Cdt::new(0.125), &contact, &damped, [0.0; 4], 1.0).0.y, SIZE);
    }
}
