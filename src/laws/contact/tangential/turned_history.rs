//! Friction with a tangential spring that turns with the contact.

use crate::base::document::keys;
use crate::base::number::{Number, Vector};
use crate::laws::contact::{
    Contact, Friction, HistoryRow, MaterialPair, Missing, NormalForce, Tangential, coefficients, property,
};

coefficients! {
    /// Coulomb friction with a spring that turns with the contact, and a limit on spring and dashpot together.
    ///
    /// ```text
    /// k < k before:  s ← s k/(k before)                    (with `rescale`)
    /// s ← s − (s·n) n, lengthened to its former |s|
    /// s ← s + v_t Δt
    /// F_t = −k s − γ_t v_t
    /// |F_t| > µ N:   F_t ← F_t µ N/|F_t|,  s ← −(F_t + γ_t v_t)/k      (s = 0: F_t = 0)
    ///                without `backward_spring`: s ← s less its part along F_t where that points as F_t does
    /// ```
    ///
    /// | symbol   | meaning                            | unit      | comes from       |
    /// |----------|------------------------------------|-----------|------------------|
    /// | s        | tangential spring                  | m         | the history      |
    /// | v_t, n   | slip velocity, unit normal         | m/s, 1    | the contact      |
    /// | k        | k_t of the normal model, or with `given_stiffness` | N/m | the normal model, or `tangential_stiffness` |
    /// | γ_t      | tangential damping                 | kg/s      | the normal model |
    /// | N        | magnitude of the normal force seen | N         | the law          |
    /// | µ        | coefficient of friction            | 1         | `friction`       |
    ///
    /// Against `history`: turned before it grows, its length kept; and while it slides, spring and dashpot together stand
    /// at the limit. The spring is left as it is while its part along n is below 1e-10 µ N/k. With `rescale`, a contact
    /// that shrinks while sheared gains no energy.
    ///
    /// Where the dashpot alone exceeds the limit, as it does at first touch, the engine stretches the spring backwards, to
    /// (µ N − γ_t v_t)/k. This has no bound as k goes to 0 with the overlap. Later the spring pushes the way the bodies
    /// slip, by an amount that depends on the depth at which the first time step finds the contact. Without
    /// `backward_spring` the dashpot takes friction to its limit and the spring stays at rest until the dashpot falls below
    /// it.
    ///
    /// Source: S. Luding, *Granul. Matter* 10 (2008) 235–246; C. Thornton, S. J. Cummins & P. W. Cleary, *Powder
    /// Technol.* 233 (2013) 30–46 (`rescale`); LAMMPS manual, `pair_style granular`: `linear_history`, `mindlin`,
    /// `mindlin_rescale`.
    pub struct TurnedHistory {
        /// µ.
        friction,
        /// 1 where k is the normal model's, otherwise 0.
        of_normal_model,
        /// k where it is given, otherwise 0 \[N/m\].
        given_stiffness,
        /// 1 with `rescale`, otherwise 0.
        rescale,
        /// 1 with `backward_spring`, otherwise 0.
        backward,
    }
}

keys! {
    /// `[contact.<law>.tangential.turned_history]`
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Keys {
        /// Whether the spring shortens with its stiffness when a contact shrinks.
        #[serde(default)]
        pub rescale: bool = "`false`",
        /// Whether the stiffness is `tangential_stiffness` \[N/m\], not the normal model's.
        #[serde(default)]
        pub given_stiffness: bool = "`false`",
        /// Whether a dashpot beyond the limit of friction stretches the spring backwards, as LAMMPS does; not with `eepa`.
        pub backward_spring: Option<bool> = "`true`; with `eepa` `false`",
    }
}

impl Tangential for TurnedHistory {
    const NAME: &'static str = "turned_history";
    type Keys = Keys;
    const ACTIVE: bool = true;
    const HISTORY: Option<HistoryRow> = Some(HistoryRow {
        name: "tangential spring, its stiffness before",
        odd: [true, true, true, false],
        fourth_is_free: false,
    });
    const HAS_SPRING: bool = true;
    const HAS_DASHPOT: bool = true;
    const KEEPS_STIFFNESS: bool = true;
    const LIMITS_DASHPOT: bool = true;

    fn between(pair: &MaterialPair, keys: &Keys, damped_at_touch: bool) -> Result<Self, Missing> {
        let friction = pair.get(&property::FRICTION)?;
        let number = |yes: bool| if yes { 1.0 } else { 0.0 };
        let given = if keys.given_stiffness { pair.get(&property::TANGENTIAL_STIFFNESS)? } else { 0.0 };
        let of_normal_model = number(!keys.given_stiffness);
        Ok(Self::new(
            friction,
            of_normal_model,
            given,
            number(keys.rescale),
            number(Self::stretches_backwards(keys, damped_at_touch)),
        ))
    }

    fn stretches_backwards(keys: &Keys, damped_at_touch: bool) -> bool {
        keys.backward_spring.unwrap_or(!damped_at_touch)
    }

    fn stiffness(&self, from_normal_model: f64) -> f64 {
        self.of_normal_model * from_normal_model + self.given_stiffness
    }

    #[inline(always)]
    fn force<N: Number>(
        law: TurnedHistory<N>,
        contact: &Contact<N>,
        normal: &NormalForce<N>,
        history: [N; 4],
        step: N,
    ) -> Friction<N> {
        /// Part of the limit below which the force of the spring along the normal is left.
        const LEFT: f64 = 1e-10;
        let (zero, one) = (N::zero(), N::splat(1.0));
        let stiffness = law.of_normal_model * normal.response.tangential_stiffness + law.given_stiffness;
        let limit = law.friction * normal.seen.abs();
        let (spring, before) = (Vector::of_row(history), history[3]);
        let shrunk = N::both(law.rescale.greater(N::splat(0.5)), before.greater(stiffness));
        let spring = spring * N::select(shrunk, stiffness / before, one);
        let along = spring.dot(contact.normal);
        let flat = spring - contact.normal * along;
        let squares = [spring.dot(spring), flat.dot(flat)];
        let longer = N::select(squares[1].greater(zero), (squares[0] / squares[1]).sqrt(), zero);
        let leaning = (along.abs() * stiffness).greater(N::splat(LEFT) * limit);
        let spring = Vector::select(leaning, flat * longer, spring) + contact.slip * step;
        let dashpot = contact.slip * normal.response.tangential_damping;
        let whole = -(spring * stiffness) - dashpot;
        let square = whole.dot(whole);
        let sliding = square.greater(limit * limit);
        let held = N::both(spring.dot(spring).greater(zero), stiffness.greater(zero));
        let kept = N::select(sliding, N::select(held, limit / square.sqrt(), zero), one);
        let force = whole * kept;
        let mut pull = force + dashpot;
        let rests = N::both(sliding, N::splat(0.5).greater(law.backward));
        if N::any(rests) {
            let along = pull.dot(whole);
            let released = N::both(rests, zero.greater(along));
            pull = Vector::select(released, pull - whole * (along / square), pull);
        }
        let at_limit = -pull * (one / stiffness);
        let spring = Vector::select(N::both(sliding, held), at_limit, spring);
        Friction { force, history: spring.row_with(stiffness), sliding }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::number::Row;
    use crate::laws::contact::fixtures::{assert_close, contact, normal_force};

    /// Force and history after `step`; µ = ¼, k = 8 N/m, γ_t = 2 kg/s, slip (3, 4, 0) m/s, normal z.
    fn force(law: TurnedHistory, pressure: f64, history: Row, step: f64) -> Friction {
        TurnedHistory::force(law, &contact(), &NormalForce { seen: pressure, ..normal_force() }, history, step)
    }

    /// With the stiffness of the normal model.
    fn law(rescale: f64) -> TurnedHistory {
        TurnedHistory::new(0.25, 1.0, 0.0, rescale, 1.0)
    }

    #[test]
    fn turns_and_keeps_its_length_before_it_grows() {
        let found = force(law(0.0), 1e4, [3.0, 0.0, 4.0, 0.0], 0.5);
        assert_eq!(found.history, [5.0 + 1.5, 2.0, 0.0, 8.0]);
    }

    #[test]
    fn limit_is_put_to_spring_and_dashpot_together() {
        // −8 (1, 0, 0) − 2 (3, 4, 0) = (−14, −8, 0); limit 8 N
        let found = force(law(0.0), 32.0, [1.0, 0.0, 0.0, 8.0], 0.0);
        let share = 8.0 / (14.0_f64 * 14.0 + 8.0 * 8.0).sqrt();
        assert!(found.sliding);
        assert_close(found.force.x, -14.0 * share, 1e-15);
        assert_close(found.history[0], -(found.force.x + 6.0) / 8.0, 1e-15);
        assert_close(found.history[1], -(found.force.y + 8.0) / 8.0, 1e-15);
    }

    #[test]
    fn a_dashpot_alone_beyond_the_limit_gives_nothing() {
        let found = force(law(0.0), 4.0, [0.0; 4], 0.0);
        assert_eq!((found.force.length(), found.history), (0.0, [0.0, 0.0, 0.0, 8.0]));
    }

    #[test]
    fn shortens_with_its_stiffness_where_asked() {
        let of = |rescale| force(law(rescale), 1e4, [1.0, 0.0, 0.0, 32.0], 0.0).history[0];
        assert_eq!([of(0.0), of(1.0)], [1.0, 0.25]);
        assert_eq!(force(law(1.0), 1e4, [1.0, 0.0, 0.0, 2.0], 0.0).history[0], 1.0, "it does not grow again");
    }

    #[test]
    fn a_dashpot_beyond_the_limit_does_not_stretch_the_spring_backwards_unless_asked() {
        // −8 (0.1, 0, 0) − 2 (3, 4, 0) = (−6.8, −8, 0); limit 2 N, and the dashpot alone has 10 N
        let of = |backward| force(TurnedHistory { backward, ..law(0.0) }, 8.0, [0.1, 0.0, 0.0, 8.0], 0.0);
        let [engine, at_rest] = [of(1.0), of(0.0)];
        assert_eq!(engine.force, at_rest.force);
        let stretched = |found: &Friction| Vector::of_row(found.history).dot(found.force);
        assert!(stretched(&engine) > 0.1, "against the slip");
        assert!(stretched(&at_rest).abs() < 1e-15, "{:e}", stretched(&at_rest));
        // Where the spring leads, nothing is taken from it: −80 − 2 · 3, −2 · 4; limit 60 N
        let of = |backward| force(TurnedHistory { backward, ..law(0.0) }, 240.0, [10.0, 0.0, 0.0, 8.0], 0.0).history;
        assert_eq!(of(1.0), of(0.0));
    }

    #[test]
    fn takes_a_given_stiffness() {
        let given = TurnedHistory::new(0.25, 0.0, 100.0, 0.0, 1.0);
        assert_eq!(force(given, 1e4, [1.0, 0.0, 0.0, 0.0], 0.0).force.x, -106.0);
        assert_eq!([given.stiffness(8.0), law(0.0).stiffness(8.0)], [100.0, 8.0]);
    }
}
