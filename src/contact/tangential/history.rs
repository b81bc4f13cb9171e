//! Friction with a tangential spring that remembers.

use crate::contact::{Contact, MaterialPair, Missing, NoKeys, Response, Tangential, coefficients};
use crate::number::{Number, Vector};

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
    /// The limit is put to the spring alone: while the contact sticks, spring and dashpot together may exceed
    /// µ N. k_t is the present one and s is not rescaled on unloading, so that a contact which shrinks while
    /// sheared can gain energy (Elata & Berryman, *Mech. Mater.* 24 (1996) 229–240).
    ///
    /// Source: L. E. Silbert et al., *Phys. Rev. E* 64 (2001) 051302.
    pub struct History {
        /// µ.
        friction,
    }
}

impl Tangential for History {
    type Keys = NoKeys;
    const ACTIVE: bool = true;
    const HAS_SPRING: bool = true;

    fn between(pair: &MaterialPair, _keys: &NoKeys) -> Result<Self, Missing> {
        Ok(Self::new(pair.friction()?))
    }

    #[inline(always)]
    fn force<N: Number>(
        law: History<N>,
        contact: &Contact<N>,
        response: &Response<N>,
        pressure: N,
        spring: Vector<N>,
        step: N,
    ) -> (Vector<N>, Vector<N>, N::Mask) {
        let grown = spring + contact.slip * step;
        let spring = grown - contact.normal * grown.dot(contact.normal);
        let elastic = response.tangential_stiffness * spring.length();
        let limit = law.friction * pressure;
        let sliding = elastic.greater(limit);
        let kept = N::select(sliding, limit / elastic, N::splat(1.0));
        let damping = N::select(sliding, N::zero(), response.tangential_damping);
        let spring = spring * kept;
        let force = -(spring * response.tangential_stiffness) - contact.slip * damping;
        (force, spring, sliding)
    }
}
