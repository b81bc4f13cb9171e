//! What scheme and time step a scene takes where it names neither.

use crate::laws::contact::Scheme;
use serde::Deserialize;

/// Fraction of the stable step that an automatic time step takes if the scene names none.
pub(super) const SAFETY: f64 = 0.2;

/// The same with `accuracy = "high"`.
const HIGH_SAFETY: f64 = 0.05;

/// `[run] accuracy`: what scheme and time step are chosen for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Accuracy {
    /// Many contacts in a given time.
    #[default]
    Standard,
    /// Impacts whose restitution and rebound velocity are right to some thousandths.
    High,
}

impl Accuracy {
    /// The word in the scene.
    pub fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::High => "high",
        }
    }

    /// The scheme that it takes.
    pub fn scheme(self) -> Scheme {
        match self {
            Self::Standard => Scheme::default(),
            Self::High => Scheme::Predicted,
        }
    }

    /// The fraction of the stable step that it takes.
    pub fn safety(self) -> f64 {
        match self {
            Self::Standard => SAFETY,
            Self::High => HIGH_SAFETY,
        }
    }
}
