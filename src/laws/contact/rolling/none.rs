//! No resistance against rolling.

use crate::base::number::{Number, Vector};
use crate::laws::contact::{Contact, MaterialPair, Missing, Needs, NoKeys, NormalForce, Rolling, coefficients};

coefficients! {
    /// Bodies roll freely: no torque, nothing evaluated.
    pub struct None {}
}

impl Rolling for None {
    const NAME: &'static str = "none";
    type Keys = NoKeys;
    const ACTIVE: bool = false;
    const NEEDS: Needs = Needs::NONE;

    fn between(_pair: &MaterialPair, _keys: &NoKeys) -> Result<Self, Missing> {
        Ok(Self::new())
    }

    #[inline(always)]
    fn torque<N: Number>(
        _law: None<N>,
        _contact: &Contact<N>,
        _normal: &NormalForce<N>,
        history: [N; 4],
        _step: N,
    ) -> (Vector<N>, [N; 4]) {
        (Vector::zero(), history)
    }
}
