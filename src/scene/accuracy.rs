//! How accurate impacts are to be: what scheme and time step a scene takes where it names neither.

use crate::base::document::{Forms, several_forms};
use crate::laws::contact::Scheme;
use serde::de::{Error, Unexpected};
use std::fmt;

/// `[run] accuracy`: the largest error of the coefficient of restitution that the automatic time step allows in impacts of two bodies,
/// averaged by energy over what is in contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Accuracy {
    /// `"standard"`
    #[default]
    Standard,
    /// `"high"`: springs and dashpots of second order, too.
    High,
    /// This error, above 0 and below 1.
    Within(f64),
}

impl Accuracy {
    /// The scheme that it takes.
    pub fn scheme(self) -> Scheme {
        match self {
            Self::Standard | Self::Within(_) => Scheme::default(),
            Self::High => Scheme::Predicted,
        }
    }

    /// The largest error of the coefficient of restitution.
    pub fn error(self) -> f64 {
        match self {
            Self::Standard => 1e-2,
            Self::High => 1e-3,
            Self::Within(error) => error,
        }
    }
}

impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Standard => f.write_str("standard"),
            Self::High => f.write_str("high"),
            Self::Within(error) => write!(f, "{error}"),
        }
    }
}

impl Forms for Accuracy {
    const EXPECTED: &'static str = "a number above 0 and below 1, \"standard\" or \"high\"";

    fn number<E: Error>(value: f64, _written: Unexpected) -> Result<Self, E> {
        match value > 0.0 && value < 1.0 {
            true => Ok(Self::Within(value)),
            false => Err(Self::refused(value)),
        }
    }

    fn word<E: Error>(word: &str) -> Result<Self, E> {
        match word {
            "standard" => Ok(Self::Standard),
            "high" => Ok(Self::High),
            _ => Err(E::unknown_variant(word, &["standard", "high"])),
        }
    }
}
several_forms!(Accuracy);
