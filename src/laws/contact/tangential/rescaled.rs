//! Friction with a tangential spring whose force shrinks with the contact and does not grow with it.

use crate::base::number::{Number, Vector};
use crate::laws::contact::{
    Contact, Friction, HistoryRow, MaterialPair, Missing, NoKeys, NormalForce, Tangential, coefficients, property,
};

coefficients! {
    /// Coulomb friction with a tangential spring that makes no energy when the overlap changes.
    ///
    /// ```text
    /// r = min(1, k before/k)
    /// s ← r s + ½ (1 + r) v_t Δt,  then  s ← s − (s·n) n
    /// k |s| > µ N:   F_t = −µ N s/|s|,   s ← −F_t/k           (sliding)
    /// else:          F_t = −k s − γ_t v_t                      (sticking)
    /// ```
    ///
    /// | symbol   | meaning                            | unit    | comes from       |
    /// |----------|------------------------------------|---------|------------------|
    /// | s        | tangential spring, F/k             | m       | the history      |
    /// | v_t, n   | slip velocity, unit normal         | m/s, 1  | the contact      |
    /// | k, γ_t   | tangential stiffness and damping   | N/m, kg/s | the normal model |
    /// | N        | magnitude of the normal force seen | N       | the law          |
    /// | µ        | coefficient of friction            | 1       | `friction`       |
    ///
    /// While k grows the force of the spring is kept and gains ∫ k ds; while k shrinks it shrinks with k. A closed loop of shear and pressure
    /// loses, whichever comes first; `history` gains where it is sheared under little and released under more. Where k does not
    /// depend on the overlap both are the same but for half of the first increment.
    ///
    /// Source: C. Thornton, S. J. Cummins & P. W. Cleary, *Powder Technol.* 233 (2013) 30–46.
    pub struct Rescaled {
        /// µ.
        friction,
    }
}

impl Tangential for Rescaled {
    const NAME: &'static str = "rescaled";
    type Keys = NoKeys;
    const ACTIVE: bool = true;
    const HISTORY: Option<HistoryRow> = Some(HistoryRow {
        name: "tangential spring, its stiffness before",
        odd: [true, true, true, false],
        fourth_is_free: false,
    });
    const HAS_SPRING: bool = true;
    const HAS_DASHPOT: bool = true;
    const KEEPS_STIFFNESS: bool = true;
    const PROJECTS: bool = true;

    fn between(pair: &MaterialPair, _keys: &NoKeys, _damped_at_touch: bool) -> Result<Self, Missing> {
        Ok(Self::new(pair.get(&property::FRICTION)?))
    }

    #[inline(always)]
    fn force<N: Number>(
        law: Rescaled<N>,
        contact: &Contact<N>,
        normal: &NormalForce<N>,
        history: [N; 4],
        step: N,
    ) -> Friction<N> {
        let (zero, one) = (N::zero(), N::splat(1.0));
        let stiffness = normal.response.tangential_stiffness;
        let grows = stiffness.greater(history[3]);
        let ratio = N::select(grows, history[3] / N::select(grows, stiffness, one), one);
        let grown = Vector::of_row(history) * ratio + contact.slip * (N::splat(0.5) * (one + ratio) * step);
        let spring = grown - contact.normal * grown.dot(contact.normal);
        let limit = law.friction * normal.seen.abs();
        let square = stiffness * stiffness * spring.dot(spring);
        let sliding = square.greater(limit * limit);
        let kept = N::select(sliding, limit / N::select(sliding, square, one).sqrt(), one);
        let damping = N::select(sliding, zero, normal.response.tangential_damping);
        let spring = spring * kept;
        let force = -(spring * stiffness) - contact.slip * damping;
        Friction { force, history: spring.row_with(stiffness), sliding }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::number::Row;
    use crate::laws::contact::fixtures::{contact, normal_force};

    /// Force and history after `step`; µ = ¼, k = 8 N/m, γ_t = 2 kg/s, slip (3, 4, 0) m/s, normal z.
    fn force(pressure: f64, history: Row, step: f64) -> Friction {
        let normal = NormalForce { seen: pressure, ..normal_force() };
        Rescaled::force(Rescaled::new(0.25), &contact(), &normal, history, step)
    }

    #[test]
    fn keeps_its_force_where_the_contact_grew_and_shortens_it_where_it_shrank() {
        // k s = 2 N/m · 4 m = 8 N/m · 1 m
        assert_eq!(force(1e3, [4.0, 0.0, 0.0, 2.0], 0.0).history, [1.0, 0.0, 0.0, 8.0]);
        assert_eq!(force(1e3, [4.0, 0.0, 0.0, 32.0], 0.0).history, [4.0, 0.0, 0.0, 8.0]);
    }

    #[test]
    fn grows_by_the_mean_stiffness() {
        // ½ (1 + 2/8) of (3, 4, 0) m/s · ½ s
        assert_eq!(force(1e3, [0.0, 0.0, 0.0, 2.0], 0.5).history, [0.9375, 1.25, 0.0, 8.0]);
        assert_eq!(force(1e3, [0.0, 0.0, 0.0, 8.0], 0.5).history, [1.5, 2.0, 0.0, 8.0]);
    }

    #[test]
    fn sticks_with_the_dashpot_and_slides_without() {
        assert_eq!(force(1e3, [1.0, 0.0, 0.0, 8.0], 0.0).force, Vector::new(-14.0, -8.0, 0.0));
        let found = force(40.0, [3.0, -4.0, 0.0, 8.0], 0.0);
        assert_eq!((found.force, found.sliding), (Vector::new(-6.0, 8.0, 0.0), true));
    }

    #[test]
    fn a_closed_loop_of_shear_and_pressure_loses_whichever_comes_first() {
        /// The force of the spring where k goes through these stiffnesses with this shear before each.
        fn work(path: &[(f64, f64)]) -> f64 {
            let (mut history, mut work, mut before) = ([0.0; 4], 0.0, 0.0);
            for &(stiffness, shear) in path {
                // In small parts, so that the work is that of the mean force.
                for _ in 0..1000 {
                    let mut normal = NormalForce { seen: 1e9, ..normal_force() };
                    (normal.response.tangential_stiffness, normal.response.tangential_damping) = (stiffness, 0.0);
                    let contact = Contact { slip: Vector::new(1e-3 * shear, 0.0, 0.0), ..contact() };
                    let found = Rescaled::force(Rescaled::new(1.0), &contact, &normal, history, 1.0);
                    (work, history) = (work + 0.5e-3 * shear * (before - found.force.x), found.history);
                    before = -found.force.x;
                }
            }
            work
        }
        assert!(work(&[(1.0, 1.0), (2.0, 0.0), (2.0, -0.5), (1.0, 0.0)]) > 0.0);
        assert!(work(&[(2.0, 1.0), (1.0, 0.0), (1.0, -1.0), (2.0, 0.0)]) > 0.0);
    }
}
