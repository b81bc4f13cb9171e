//! No cohesion.

use crate::contact::{Cohesion, CohesionForm, Contact, MaterialPair, Missing, Needs, NoKeys, coefficients};
use crate::number::Number;

coefficients! {
    /// Dry bodies: no attraction, nothing evaluated.
    pub struct None {}
}

impl Cohesion for None {
    type Keys = NoKeys;
    type Form = Self;

    fn between(_pair: &MaterialPair, _keys: &NoKeys) -> Result<Self, Missing> {
        Ok(Self::new())
    }

    fn reduces_friction(_keys: &NoKeys) -> bool {
        false
    }
}

impl CohesionForm for None {
    const ACTIVE: bool = false;
    const NEEDS: Needs = Needs::NONE;

    #[inline(always)]
    fn force<N: Number>(_law: None<N>, _contact: &Contact<N>) -> N {
        N::zero()
    }

    #[inline(always)]
    fn seen_by_friction<N: Number>(_law: None<N>, _force: N) -> N {
        N::zero()
    }
}
