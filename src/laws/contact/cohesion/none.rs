//! No cohesion.

use crate::base::number::Number;
use crate::laws::contact::{Cohesion, CohesionForm, Contact, MaterialPair, Missing, Needs, NoKeys, coefficients};

coefficients! {
    /// Dry bodies: no attraction, nothing evaluated.
    pub struct None {}
}

impl Cohesion for None {
    const NAME: &'static str = "none";
    type Keys = NoKeys;
    type Form = Self;

    fn between(_pair: &MaterialPair, _keys: &NoKeys) -> Result<Self, Missing> {
        Ok(Self::new())
    }
}

impl CohesionForm for None {
    const ACTIVE: bool = false;
    const NEEDS: Needs = Needs::NONE;

    #[inline(always)]
    fn force<N: Number>(_law: None<N>, _contact: &Contact<N>) -> N {
        N::zero()
    }
}
