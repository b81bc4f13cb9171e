//! Breakage by distance.

use super::{Breakage, Loaded, Strength};
use crate::base::document::keys;
use crate::base::number::Number;
use crate::base::quantity::Positive;
use crate::laws::bond::formulation::FormulationChoice;

keys! {
    /// Those of [`Distance`], in `[bond.<name>.breakage]`.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Keys {
        /// Largest distance of the centres, at a plane of centre and foot of the bond \[m\].
        pub max_distance: Positive = "∞",
    }
}

/// Breaks where the centres (at a plane: centre and foot) are further apart than `max_distance`, as the engine does without
/// `stressBreak`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// `max_distance` \[m\].
    pub most: f64,
}

impl Breakage for Distance {
    const NAME: &'static str = "distance";
    type Keys = Keys;
    const FLAT_KEYS: &'static [&'static str] = &["max_distance"];
    const LIMITS: &'static [&'static str] = Self::FLAT_KEYS;
    const CAUSES: &'static [&'static str] = &["distance"];
    const IS_THE_ENGINES: bool = true;

    fn of(keys: &Keys, _formulation: FormulationChoice) -> Self {
        Self { most: keys.max_distance.get() }
    }

    fn strengths(keys: &mut Keys) -> Vec<Strength<'_>> {
        vec![Strength { key: "max_distance", unit: "m", value: &mut keys.max_distance }]
    }

    #[inline(always)]
    fn judge<N: Number>(&self, loaded: &Loaded<N>) -> N {
        N::select(loaded.distance.greater(N::splat(self.most)), N::splat(1.0), N::zero())
    }
}
