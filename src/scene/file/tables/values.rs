//! Values that are more than one plain number.

use crate::base::document::{Forms, several_forms};
use crate::base::quantity::Positive;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Unexpected};
use serde::{Deserialize, Deserializer};

/// `step` of `[run]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::scene::file) enum StepKey {
    /// A number \[s\].
    Given(f64),
    /// `"auto"`
    Automatic,
}

impl Forms for StepKey {
    const EXPECTED: &'static str = "a number above 0, in seconds, or \"auto\"";

    fn number<E: Error>(value: f64, _written: Unexpected) -> Result<Self, E> {
        match Positive::new(value) {
            Some(step) => Ok(Self::Given(step.get())),
            None => Err(Self::refused(value)),
        }
    }

    fn word<E: Error>(word: &str) -> Result<Self, E> {
        match word {
            "auto" => Ok(Self::Automatic),
            _ => Err(Self::refused(word)),
        }
    }
}
several_forms!(StepKey);

/// Pairs of material names.
#[derive(Clone, Debug)]
pub(in crate::scene::file) struct MaterialPairs(pub(in crate::scene::file) Vec<[String; 2]>);

impl<'de> Deserialize<'de> for MaterialPairs {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// A name or a pair of names.
        struct Part(Vec<String>, bool);
        impl Forms for Part {
            const EXPECTED: &'static str = "a material's name or a pair of them";

            fn word<E: Error>(name: &str) -> Result<Self, E> {
                Ok(Self(vec![name.to_owned()], false))
            }

            fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(|names| Self(names, true))
            }
        }
        several_forms!(Part);
        /// What is expected.
        const EXPECTED: &str = "[\"a\", \"b\"] or a list of such pairs";
        let parts = Vec::<Part>::deserialize(deserializer)?;
        let pair = |names: &[String]| match names {
            [a, b] => Ok([a.clone(), b.clone()]),
            names => Err(D::Error::custom(format!("expected {EXPECTED}, found {} names", names.len()))),
        };
        if parts.iter().all(|part| !part.1) {
            let names: Vec<String> = parts.into_iter().flat_map(|part| part.0).collect();
            return pair(&names).map(|pair| Self(vec![pair]));
        }
        if parts.iter().any(|part| !part.1) {
            return Err(D::Error::custom(format!("expected {EXPECTED}, found names beside pairs")));
        }
        parts.iter().map(|part| pair(&part.0)).collect::<Result<_, _>>().map(Self)
    }
}
