//! No friction.

use crate::base::number::{Number, Vector};
use crate::laws::contact::{Contact, Friction, MaterialPair, Missing, NoKeys, NormalForce, Tangential, coefficients};

coefficients! {
    /// Smooth bodies: no force in the tangent plane, nothing tangential evaluated.
    pub struct None {}
}

impl Tangential for None {
    const NAME: &'static str = "none";
    type Keys = NoKeys;
    const ACTIVE: bool = false;
    const HAS_SPRING: bool = false;
    const HAS_DASHPOT: bool = false;

    fn between(_pair: &MaterialPair, _keys: &NoKeys, _damped_at_touch: bool) -> Result<Self, Missing> {
        Ok(Self::new())
    }

    #[inline(always)]
    fn force<N: Number>(
        _law: None<N>,
        _contact: &Contact<N>,
        _normal: &NormalForce<N>,
        history: [N; 4],
        _step: N,
    ) -> Friction<N> {
        Friction { force: Vector::zero(), history, sliding: N::zero().greater(N::zero()) }
    }
}
