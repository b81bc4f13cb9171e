//! Breakage by distance.

use super::BreakageKeys;
use super::{Breakage, Loaded, flat_keys};
use crate::base::number::Number;
use crate::base::quantity::Positive;
use crate::laws::bond::formulation::FormulationChoice;
use crate::laws::bond::key_error::KeyError;

flat_keys! {
    /// Those of [`Distance`].
    {
        /// Distance of the centres beyond which the bond breaks \[m\].
        max_distance: Positive ["m"],
    }
}

/// Breaks where the centres (at a plane: centre and foot) are further apart than `max_distance`, as the engine does without
/// `stressBreak`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// That distance \[m\].
    pub most: f64,
}

impl Breakage for Distance {
    type Keys = Keys;
    const LIMITS: &'static [&'static str] = &["max_distance"];
    const CAUSES: &'static [&'static str] = &["distance"];

    fn of(own: &Keys, _formulation: FormulationChoice) -> Option<Self> {
        own.max_distance.map(|most| Self { most: most.get() })
    }

    fn check(_own: &Keys, _all: &BreakageKeys, _formulation: FormulationChoice, _wrong: &mut Vec<KeyError>) {}

    #[inline(always)]
    fn judge<N: Number>(&self, loaded: &Loaded<N>) -> N {
        N::select(loaded.distance.greater(N::splat(self.most)), N::splat(1.0), N::zero())
    }
}
