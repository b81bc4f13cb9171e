//! Rolling resistance of a spring with a dashpot.

use super::rocking::{self, Keys, Spring};
use crate::base::number::{Number, Row, Vector};
use crate::laws::contact::{
    Contact, HistoryRow, MaterialPair, Missing, Needs, NormalForce, Objection, Response, Rolling, RollingResponse,
    coefficients, property,
};

coefficients! {
    /// A spring and dashpot against rolling up to a limit (elastic-plastic spring-dashpot).
    ///
    /// ```text
    /// w     = ω_i − ω_j without its part along n          (all of it with `torsion`)
    /// k_r   = 2.25 k_n µ_r² R*²       C = 2 η_r √(J k_r)   J = 1.4 p q/(p + q), p = m_i R_i², q = m_j R_j²
    /// M     ← M without its part along n                   (not with `torsion`)
    /// T     = M + k_r w Δt            T_max = µ_r R* N
    /// |T| > T_max:   T ← T T_max/|T|,  M ← T               (rolling)
    /// else:          M ← T,  T ← T + C w                   (rocking)
    /// ```
    ///
    /// T is taken from i and given to j.
    ///
    /// | symbol | meaning                                   | unit  | comes from                |
    /// |--------|-------------------------------------------|-------|---------------------------|
    /// | M      | torque of the spring                      | N m   | the history               |
    /// | w      | relative spin                             | rad/s | the contact               |
    /// | R*     | effective radius                          | m     | the contact               |
    /// | J      | moment of inertia about the contact; 1.4 m R² at a wall | kg m² | the contact  |
    /// | k_n    | normal stiffness                          | N/m   | the normal model          |
    /// | N      | magnitude of the normal force that friction sees | N | the law                |
    /// | µ_r    | coefficient of rolling friction           | 1     | `rolling_friction`        |
    /// | η_r    | fraction of critical damping              | 1     | `rolling_viscous_damping` |
    ///
    /// The limit applies to the spring alone: the dashpot drops out when it is reached. N holds the dashpot of the normal
    /// force, and attraction with `tangential_reduce`. M is not rescaled when k_r changes.
    ///
    /// `engine_exact` does as the engine. M keeps its direction in space. At a wall w is multiplied by (R − δ/2)/(R − δ).
    /// The evaluation before the first step stretches the spring by `set_up_step` and forgets it.
    ///
    /// Source: J. Ai, J.-F. Chen, J. M. Rotter & J. Y. Ooi, *Powder Technol.* 206 (2011) 269–282, model C; LIGGGHTS
    /// manual, `gran_rolling_friction_epsd`.
    pub struct Epsd {
        /// µ_r.
        rolling_friction,
        /// η_r.
        damping,
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
fn stiffness<N: Number>(rolling_friction: N, contact: &Contact<N>, response: &Response<N>) -> N {
    let length = rolling_friction * contact.radius;
    N::splat(2.25) * response.normal_stiffness * length * length
}

/// C \[N m s\] of η_r and k_r \[N m\].
#[inline(always)]
fn damping<N: Number>(fraction: N, stiffness: N, contact: &Contact<N>) -> N {
    /// Moment of inertia about the point of contact over that of a point mass at the centre.
    const ABOUT_CONTACT: f64 = 1.4;
    let inertia = N::splat(ABOUT_CONTACT) * contact.rolling_inertia;
    N::splat(2.0) * fraction * (inertia * stiffness).sqrt()
}

impl Rolling for Epsd {
    const NAME: &'static str = "epsd";
    type Keys = Keys;
    const ACTIVE: bool = true;
    const HISTORY: Option<HistoryRow> = Some(rocking::HISTORY);
    const NEEDS: Needs = rocking::NEEDS;

    fn objection(keys: &Keys) -> Option<Objection> {
        keys.objection()
    }

    fn is_engine_exact(keys: &Keys) -> bool {
        keys.engine_exact
    }

    fn between(pair: &MaterialPair, keys: &Keys) -> Result<Self, Missing> {
        let [torsion, engine, set_up] = keys.numbers();
        Ok(Self::new(
            pair.get(&property::ROLLING_FRICTION)?,
            pair.get(&property::ROLLING_VISCOUS_DAMPING)?,
            torsion,
            engine,
            set_up,
        ))
    }

    fn response(&self, contact: &Contact, response: &Response) -> RollingResponse {
        let stiffness = stiffness(self.rolling_friction, contact, response);
        let parts = [stiffness, damping(self.damping, stiffness, contact)];
        rocking::response(contact, parts, self.torsion, self.engine)
    }

    fn elastic_energy(&self, contact: &Contact, response: &Response, history: Row) -> f64 {
        let (torque, stiffness) = (Vector::from(history), stiffness(self.rolling_friction, contact, response));
        if stiffness > 0.0 { 0.5 * torque.dot(torque) / stiffness } else { 0.0 }
    }

    #[inline(always)]
    fn torque<N: Number>(
        law: Epsd<N>,
        contact: &Contact<N>,
        normal: &NormalForce<N>,
        history: [N; 4],
        step: N,
    ) -> (Vector<N>, [N; 4]) {
        let stiffness = stiffness(law.rolling_friction, contact, &normal.response);
        let spring = Spring {
            stiffness,
            damping: damping(law.damping, stiffness, contact),
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
    use crate::laws::contact::fixtures::{assert_close, contact, normal_force};

    /// µ_r = ⅛, η_r = ½; R* = ¼ m, k_n = 1024 N/m, rolling inertia ½ kg m².
    fn law(torsion: f64, engine: f64) -> Epsd {
        Epsd::new(0.125, 0.5, torsion, engine, 0.0)
    }

    /// 2.25 · 1024 N/m · (1/32 m)².
    const STIFFNESS: f64 = 2.25;

    /// Torque and history after a spin (x, y, z) over `step`, at the normal z.
    fn torque(law: Epsd, spin: [f64; 3], seen: f64, history: Row, step: f64) -> (Vector, Row) {
        let contact = Contact { relative_spin: spin.into(), ..contact() };
        Epsd::torque(law, &contact, &NormalForce { seen, ..normal_force() }, history, step)
    }

    #[test]
    fn rocks_on_spring_and_dashpot_below_the_limit() {
        let (found, history) = torque(law(0.0, 0.0), [0.0, 4.0, 3.0], 1e4, [1.0, 0.0, 0.0, 0.0], 0.5);
        assert_eq!(history, [1.0, STIFFNESS * 4.0 * 0.5, 0.0, 0.0]);
        let damping = 2.0 * 0.5 * (1.4 * 0.5 * STIFFNESS).sqrt();
        assert_close(found.y, history[1] + damping * 4.0, 1e-15);
        assert_eq!([found.x, found.z], [1.0, 0.0]);
    }

    #[test]
    fn rolls_at_the_limit_of_the_spring_without_the_dashpot() {
        // T_max = ⅛ · ¼ m · 64 N = 2 N m; a pull presses as much as a push
        for seen in [64.0, -64.0] {
            let (found, history) = torque(law(0.0, 0.0), [0.0, 4.0, 0.0], seen, [0.0; 4], 5.0);
            assert_eq!((found, history), (Vector::new(0.0, 2.0, 0.0), [0.0, 2.0, 0.0, 0.0]));
        }
    }

    #[test]
    fn torque_stays_in_the_tangent_plane_but_not_in_the_engine() {
        let of = |law| torque(law, [0.0; 3], 1e4, [1.0, 0.0, 5.0, 0.0], 0.5).1;
        assert_eq!(of(law(0.0, 0.0)), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(of(law(0.0, 1.0)), [1.0, 0.0, 5.0, 0.0]);
        assert_eq!(of(law(1.0, 0.0)), [1.0, 0.0, 5.0, 0.0]);
    }

    #[test]
    fn resists_spin_about_the_normal_where_asked() {
        let of = |law| torque(law, [0.0, 0.0, 4.0], 1e4, [0.0; 4], 0.5).1[2];
        assert_eq!([of(law(0.0, 0.0)), of(law(1.0, 0.0))], [0.0, STIFFNESS * 2.0]);
    }

    #[test]
    fn nothing_is_remembered_before_the_first_step() {
        let (found, history) = torque(Epsd::new(0.125, 0.0, 0.0, 1.0, 0.5), [0.0, 4.0, 0.0], 1e4, [0.0; 4], 0.0);
        assert_eq!((found.y, history), (STIFFNESS * 2.0, [0.0; 4]), "the engine's set-up stretches and forgets");
        let (found, history) = torque(Epsd::new(0.125, 0.0, 0.0, 0.0, 0.0), [0.0, 4.0, 0.0], 1e4, [0.0; 4], 0.0);
        assert_eq!((found.y, history), (0.0, [0.0; 4]));
    }

    #[test]
    fn spin_at_a_wall_is_that_of_the_body_but_not_in_the_engine() {
        let wall = Contact { relative_spin: Vector::new(0.0, 4.0, 0.0), per_reach: 0.0, ..contact() };
        let of = |law| Epsd::torque(law, &wall, &NormalForce { seen: 1e4, ..normal_force() }, [0.0; 4], 0.5).1[1];
        assert_eq!(of(law(0.0, 0.0)), STIFFNESS * 2.0);
        let arms = (0.25 - 0.5 / 16384.0) / (0.25 - 1.0 / 16384.0);
        assert_close(of(law(0.0, 1.0)), STIFFNESS * 2.0 * arms, 1e-15);
    }

    #[test]
    fn spring_and_dashpot_are_told_apart_and_at_a_wall_as_the_engine_sees_the_spin() {
        let damping = 2.0 * 0.5 * (1.4 * 0.5 * STIFFNESS).sqrt();
        let of = |law: Epsd, contact: &Contact| {
            let found = law.response(contact, &normal_force().response);
            [found.bending_stiffness, found.bending_damping, found.torsional_stiffness, found.torsional_damping]
        };
        assert_eq!(of(law(0.0, 0.0), &contact()), [STIFFNESS, damping, 0.0, 0.0]);
        assert_eq!(of(law(1.0, 0.0), &contact()), [STIFFNESS, damping, STIFFNESS, damping]);
        let wall = Contact { per_reach: 0.0, ..contact() };
        let arms = (0.25 - 0.5 / 16384.0) / (0.25 - 1.0 / 16384.0);
        assert_eq!(of(law(0.0, 1.0), &wall), [STIFFNESS * arms, damping * arms, 0.0, 0.0]);
        assert_eq!(of(law(0.0, 0.0), &wall), [STIFFNESS, damping, 0.0, 0.0]);
        // An impact that is foreseen to reach the centre is bounded as one at half of the radius.
        for overlap in [0.125, 0.25, 0.5] {
            let deep = Contact { overlap, ..wall };
            assert_eq!(of(law(0.0, 1.0), &deep), [1.5 * STIFFNESS, 1.5 * damping, 0.0, 0.0]);
        }
    }

    #[test]
    fn stores_the_energy_of_the_torque() {
        let energy = law(0.0, 0.0).elastic_energy(&contact(), &normal_force().response, [3.0, 0.0, 0.0, 0.0]);
        assert_eq!(energy, 0.5 * 9.0 / STIFFNESS);
    }
}
