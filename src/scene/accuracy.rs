//! How accurate impacts are to be: what scheme and time step a scene takes where it names neither.

use crate::laws::contact::Scheme;
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};
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

impl<'de> Deserialize<'de> for Accuracy {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a number or a word.
        struct NumberOrWord;
        /// What is expected.
        const EXPECTED: &str = "a number above 0 and below 1, \"standard\" or \"high\"";
        impl Visitor<'_> for NumberOrWord {
            type Value = Accuracy;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(EXPECTED)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Accuracy, E> {
                match value > 0.0 && value < 1.0 {
                    true => Ok(Accuracy::Within(value)),
                    false => Err(E::custom(format!("expected {EXPECTED}, found {value:?}"))),
                }
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Accuracy, E> {
                self.visit_f64(value as f64)
            }
            fn visit_str<E: Error>(self, word: &str) -> Result<Accuracy, E> {
                match word {
                    "standard" => Ok(Accuracy::Standard),
                    "high" => Ok(Accuracy::High),
                    _ => Err(E::unknown_variant(word, &["standard", "high"])),
                }
            }
        }
        deserializer.deserialize_any(NumberOrWord)
    }
}
