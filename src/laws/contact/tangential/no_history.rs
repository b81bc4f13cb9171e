//! Friction without memory.

use crate::base::number::Number;
use crate::laws::contact::{
    Contact, Friction, MaterialPair, Missing, NoKeys, NormalForce, Tangential, coefficients, property,
};

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
    const NAME: &'static str = "no_history";
    type Keys = NoKeys;
    const ACTIVE: bool = true;
    const HAS_SPRING: bool = false;
    const HAS_DASHPOT: bool = true;
    const LIMITS_DASHPOT: bool = true;

    fn between(pair: &MaterialPair, _keys: &NoKeys, _damped_at_touch: bool) -> Result<Self, Missing> {
        Ok(Self::new(pair.get(&property::FRICTION)?))
    }

    #[inline(always)]
    fn force<N: Number>(
        law: NoHistory<N>,
        contact: &Contact<N>,
        normal: &NormalForce<N>,
        history: [N; 4],
        _step: N,
    ) -> Friction<N> {
        let response = &normal.response;
        let speed = contact.slip.length();
        let limit = law.friction * normal.seen.abs();
        let sliding = (response.tangential_damping * speed).greater(limit);
        let damping = N::select(sliding, limit / speed, response.tangential_damping);
        Friction { force: -(contact.slip * damping), history, sliding }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::number::Vector;
    use crate::laws::contact::fixtures::{contact, normal_force};

    /// µ = ¼; slip is (3, 4, 0) m/s, γ_t = 2 kg/s.
    fn force(slip: Vector, pressure: f64) -> Vector {
        let contact = Contact { slip, ..contact() };
        let normal = NormalForce { seen: pressure, ..normal_force() };
        NoHistory::force(NoHistory::new(0.25), &contact, &normal, [0.0; 4], 1.0).force
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
}
