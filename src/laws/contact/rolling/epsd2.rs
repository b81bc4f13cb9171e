//! Rolling resistance of a spring as stiff as friction.

use super::rocking::{self, Keys, Spring};
use crate::base::number::{Number, Row, Vector};
use crate::laws::contact::{
    Contact, HistoryRow, MaterialPair, Missing, Needs, NormalForce, Objection, Response, Rolling, RollingResponse,
    coefficients, property,
};

coefficients! {
    /// A spring against rolling up to a limit, without a dashpot.
    ///
    /// ```text
    /// k_r = k_t R*²      T_max = µ_r R* N      C = 0      all else as `epsd`
    /// ```
    ///
    /// | symbol | meaning                                   | unit | comes from         |
    /// |--------|-------------------------------------------|------|--------------------|
    /// | k_t    | tangential stiffness                      | N/m  | the normal model   |
    /// | R*     | effective radius                          | m    | the contact        |
    /// | N      | magnitude of the normal force that friction sees | N | the law         |
    /// | µ_r    | coefficient of rolling friction           | 1    | `rolling_friction` |
    ///
    /// Nothing damps the rocking of a body that has stopped.
    ///
    /// Source: K. Iwashita & M. Oda, *J. Eng. Mech.* 124 (1998) 285–292; LIGGGHTS manual, `gran_rolling_friction_epsd2`.
    pub struct Epsd2 {
        /// µ_r.
        rolling_friction,
        /// 1 with `torsion`, otherwise 0.
        torsion,
        /// 1 with `engine_exact`, otherwise 0.
        engine,
        /// Step of the engine's set-up \[s\].
        set_up,
    }
}

/// k_r \[N m\].
#[inline(always)]
fn stiffness<N: Number>(contact: &Contact<N>, response: &Response<N>) -> N {
    response.tangential_stiffness * contact.radius * contact.radius
}

impl Rolling for Epsd2 {
    const NAME: &'static str = "epsd2";
    type Keys = Keys;
    const ACTIVE: bool = true;
    const HISTORY: Option<HistoryRow> = Some(rocking::HISTORY);
    const NEEDS: Needs = rocking::NEEDS;
    const TAKES_TANGENTIAL_STIFFNESS: bool = true;

    fn objection(keys: &Keys) -> Option<Objection> {
        keys.objection()
    }

    fn is_engine_exact(keys: &Keys) -> bool {
        keys.engine_exact
    }

    fn between(pair: &MaterialPair, keys: &Keys) -> Result<Self, Missing> {
        let [torsion, engine, set_up] = keys.numbers();
        Ok(Self::new(pair.get(&property::ROLLING_FRICTION)?, torsion, engine, set_up))
    }

    fn response(&self, contact: &Contact, response: &Response) -> RollingResponse {
        rocking::response(contact, [stiffness(contact, response), 0.0], self.torsion, self.engine)
    }

    fn elastic_energy(&self, contact: &Contact, response: &Response, history: Row) -> f64 {
        let (torque, stiffness) = (Vector::from(history), stiffness(contact, response));
        if stiffness > 0.0 { 0.5 * torque.dot(torque) / stiffness } else { 0.0 }
    }

    #[inline(always)]
    fn torque<N: Number>(
        law: Epsd2<N>,
        contact: &Contact<N>,
        normal: &NormalForce<N>,
        history: [N; 4],
        step: N,
    ) -> (Vector<N>, [N; 4]) {
        let spring = Spring {
            stiffness: stiffness(contact, &normal.response),
            damping: N::zero(),
            limit: law.rolling_friction * contact.radius * normal.seen.abs(),
            torsion: law.torsion,
            engine: law.engine,
            set_up: law.set_up,
        };
        spring.torque(contact, history, step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::{contact, normal_force};

    /// k_t R*² = 8 N/m · (¼ m)².
    const STIFFNESS: f64 = 0.5;

    /// Torque and history after a spin about y over half a second.
    fn torque(seen: f64) -> (Vector, Row) {
        let contact = Contact { relative_spin: Vector::new(0.0, 4.0, 3.0), ..contact() };
        let normal = NormalForce { seen, ..normal_force() };
        Epsd2::torque(Epsd2::new(0.125, 0.0, 0.0, 0.0), &contact, &normal, [0.0; 4], 0.5)
    }

    #[test]
    fn is_as_stiff_as_friction_and_has_no_dashpot() {
        assert_eq!(torque(1e4), (Vector::new(0.0, STIFFNESS * 2.0, 0.0), [0.0, STIFFNESS * 2.0, 0.0, 0.0]));
    }

    #[test]
    fn rolls_at_the_limit() {
        // T_max = ⅛ · ¼ m · 16 N
        assert_eq!(torque(16.0).0, Vector::new(0.0, 0.5, 0.0));
    }
}
