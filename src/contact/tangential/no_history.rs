//! Friction without memory.

use crate::contact::{Contact, MaterialPair, Missing, NoKeys, Response, Tangential, coefficients};
use crate::number::{Number, Vector};

coefficients! {
    /// A tangential dashpot up to Coulomb's limit.
    ///
    /// ```text
    /// F_t = −min(γ_t, µ N/|v_t|) v_t          0 for v_t = 0
    /// ```
    ///
    /// | symbol | meaning                            | unit | comes from       |
    /// |--------|------------------------------------|------|------------------|
    /// | v_t    | slip velocity                      | m/s  | the contact      |
    /// | γ_t    | tangential damping                 | kg/s | the normal model |
    /// | N      | magnitude of the normal force seen | N    | the law          |
    /// | µ      | coefficient of friction            | 1    | `friction`       |
    ///
    /// Nothing holds a body on a slope: it creeps with γ_t v_t = its pull. For flow, not for rest.
    ///
    /// Source: P. K. Haff & B. T. Werner, *Powder Technol.* 48 (1986) 239–245.
    pub struct NoHistory {
        /// µ.
        friction,
    }
}

impl Tangential for NoHistory {
    type Keys = NoKeys;
    const ACTIVE: bool = true;
    const HAS_SPRING: bool = false;
    const HAS_DASHPOT: bool = true;

    fn between(pair: &MaterialPair, _keys: &NoKeys) -> Result<Self, Missing> {
        Ok(Self::new(pair.friction()?))
    }

    #[inline(always)]
    fn force<N: Number>(
        law: NoHistory<N>,
        contact: &Contact<N>,
        response: &Response<N>,
        pressure: N,
        spring: Vector<N>,
        _step: N,
    ) -> (Vector<N>, Vector<N>, N::Mask) {
        let speed = contact.slip.length();
        let limit = law.friction * pressure;
        let sliding = (response.tangential_damping * speed).greater(limit);
        let damping = N::select(sliding, limit / speed, response.tangential_damping);
        (-(contact.slip * damping), spring, sliding)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::fixtures::{contact, response};

    /// µ = ¼; slip is (3, 4, 0) m/s, γ_t = 2 kg/s.
    fn force(slip: Vector, pressure: f64) -> Vector {
        let contact = Contact { slip, ..contact() };
        NoHistory::force(NoHistory::new(0.25), &contact, &response(), pressure, Vector::zero(), 1.0).0
    }

    #[test]
    fn damps_slip_below_the_limit() {
        assert_eq!(force(contact().slip, 100.0), Vector::new(-6.0, -8.0, 0.0));
    }

    #[test]
    fn slides_against_the_slip_at_the_limit() {
        // µ N = 2.5 N along −(3, 4, 0)/5
        assert_eq!(force(contact().slip, 10.0), Vector::new(-1.5, -2.0, 0.0));
    }

    #[test]
    fn is_at_rest_without_slip_and_without_pressure() {
        assert_eq!(force(Vector::zero(), 10.0).length(), 0.0);
        assert_eq!(force(Vector::zero(), 0.0).length(), 0.0);
        assert_eq!(force(contact().slip, 0.0).length(), 0.0);
    }

    #[test]
    fn leaves_the_spring_alone() {
        let spring = Vector::new(1.0, 2.0, 3.0);
        let after = NoHistory::force(NoHistory::new(0.25), &contact(), &response(), 1.0, spring, 1.0).1;
        assert_eq!(after, spring);
    }
}
