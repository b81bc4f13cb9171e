//! Friction with a tangential spring that remembers.

use crate::base::number::{Number, Vector};
use crate::laws::contact::{
    Contact, Friction, HistoryRow, MaterialPair, Missing, NoKeys, NormalForce, Tangential, coefficients, property,
};

coefficients! {
    /// Coulomb friction with a tangential spring and dashpot.
    ///
    /// ```text
    /// s ← s + v_t Δt,  then  s ← s − (s·n) n
    /// k_t |s| > µ N:   F_t = −µ N s/|s|,   s ← −F_t/k_t       (sliding)
    /// else:            F_t = −k_t s − γ_t v_t                  (sticking)
    /// ```
    ///
    /// | symbol   | meaning                            | unit    | comes from       |
    /// |----------|------------------------------------|---------|------------------|
    /// | s        | tangential spring                  | m       | the history      |
    /// | v_t, n   | slip velocity, unit normal         | m/s, 1  | the contact      |
    /// | k_t, γ_t | tangential stiffness and damping   | N/m, kg/s | the normal model |
    /// | N        | magnitude of the normal force seen | N       | the law          |
    /// | µ        | coefficient of friction            | 1       | `friction`       |
    ///
    /// The limit applies to the spring alone: while the contact sticks, spring and dashpot together may exceed µ N. k_t is
    /// the present one, and s is not rescaled. A contact that is sheared under a small overlap and released under a larger
    /// one thus gains energy. It gains 41 % of the first work where the overlap doubles, none the other way round (Elata &
    /// Berryman, *Mech. Mater.* 24 (1996) 229–240).
    ///
    /// Source: L. E. Silbert et al., *Phys. Rev. E* 64 (2001) 051302.
    pub struct History {
        /// µ.
        friction,
    }
}

impl Tangential for History {
    const NAME: &'static str = "history";
    type Keys = NoKeys;
    const ACTIVE: bool = true;
    const HISTORY: Option<HistoryRow> =
        Some(HistoryRow { name: "tangential spring", odd: [true, true, true, false], fourth_is_free: true });
    const HAS_SPRING: bool = true;
    const HAS_DASHPOT: bool = true;
    const PROJECTS: bool = true;

    fn between(pair: &MaterialPair, _keys: &NoKeys, _damped_at_touch: bool) -> Result<Self, Missing> {
        Ok(Self::new(pair.get(&property::FRICTION)?))
    }

    #[inline(always)]
    fn force<N: Number>(
        law: History<N>,
        contact: &Contact<N>,
        normal: &NormalForce<N>,
        history: [N; 4],
        step: N,
    ) -> Friction<N> {
        let response = &normal.response;
        let grown = Vector::of_row(history) + contact.slip * step;
        let spring = grown - contact.normal * grown.dot(contact.normal);
        let limit = normal.seen.abs() * law.friction;
        let stiffness = response.tangential_stiffness;
        let square = stiffness * stiffness * spring.dot(spring);
        let sliding = square.greater(limit * limit);
        // Root and division are dear, and most contacts of a packing stick.
        let mut kept = N::splat(1.0);
        if N::any(sliding) {
            kept = N::select(sliding, limit / square.sqrt(), kept);
        }
        let damping = N::select(sliding, N::zero(), response.tangential_damping);
        let spring = spring * kept;
        let force = -(spring * response.tangential_stiffness) - contact.slip * damping;
        Friction { force, history: spring.row_with(history[3]), sliding }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::Response;
    use crate::laws::contact::fixtures::{contact, normal_force, response};

    /// Force and spring after `step`; µ = ¼, k_t = 8 N/m, γ_t = 2 kg/s, slip (3, 4, 0) m/s, normal z.
    fn force(pressure: f64, spring: Vector, step: f64) -> (Vector, Vector, bool) {
        // A pull presses as much as a push.
        let normal = NormalForce { seen: -pressure, ..normal_force() };
        let found = History::force(History::new(0.25), &contact(), &normal, spring.row_with(0.0), step);
        (found.force, Vector::of_row(found.history), found.sliding)
    }

    #[test]
    fn spring_grows_by_the_slip() {
        assert_eq!(force(1e3, Vector::new(1.0, 0.0, 0.0), 0.5).1, Vector::new(2.5, 2.0, 0.0));
    }

    #[test]
    fn spring_is_projected_on_the_tangent_plane_without_regaining_its_length() {
        assert_eq!(force(1e3, Vector::new(3.0, 0.0, 4.0), 0.0).1, Vector::new(3.0, 0.0, 0.0));
    }

    #[test]
    fn sticks_with_spring_and_dashpot() {
        // −8 · (1, 0, 0) − 2 · (3, 4, 0)
        assert_eq!(force(1e3, Vector::new(1.0, 0.0, 0.0), 0.0).0, Vector::new(-14.0, -8.0, 0.0));
    }

    #[test]
    fn limit_is_put_to_the_spring_alone() {
        // spring 8 N, limit 9 N, spring and dashpot together 16.1 N
        assert!(force(36.0, Vector::new(1.0, 0.0, 0.0), 0.0).0.length() > 9.0);
    }

    #[test]
    fn slides_at_the_limit_along_the_spring_without_the_dashpot() {
        // spring 40 N, limit 10 N
        assert_eq!(force(40.0, Vector::new(3.0, -4.0, 0.0), 0.0).0, Vector::new(-6.0, 8.0, 0.0));
    }

    #[test]
    fn says_whether_it_slides() {
        assert!(force(40.0, Vector::new(3.0, -4.0, 0.0), 0.0).2);
        assert!(!force(1e3, Vector::new(3.0, -4.0, 0.0), 0.0).2);
    }

    #[test]
    fn sliding_shortens_the_spring_to_the_limit() {
        assert_eq!(force(40.0, Vector::new(3.0, -4.0, 0.0), 0.0).1, Vector::new(0.75, -1.0, 0.0));
    }

    #[test]
    fn loses_the_spring_where_the_normal_force_passes_zero() {
        let (force, spring, _) = force(0.0, Vector::new(3.0, -4.0, 0.0), 0.0);
        assert_eq!([force.length(), spring.length()], [0.0, 0.0]);
    }

    #[test]
    fn is_at_rest_without_spring_slip_stiffness_or_pressure() {
        let still = Contact { slip: Vector::zero(), ..contact() };
        let nothing = Response { tangential_stiffness: 0.0, tangential_damping: 0.0, ..response() };
        for response in [response(), nothing] {
            let normal = NormalForce { response, force: 0.0, seen: 0.0 };
            let found = History::force(History::new(0.0), &still, &normal, [0.0; 4], 1.0);
            assert_eq!([found.force.length(), Vector::of_row(found.history).length()], [0.0, 0.0]);
        }
    }
}
