//! Values that are more than one plain number.

use crate::base::quantity::Positive;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// `step` of `[run]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::scene::file) enum StepKey {
    /// A number \[s\].
    Given(f64),
    /// `"auto"`
    Automatic,
}

impl<'de> Deserialize<'de> for StepKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a number or a word.
        struct NumberOrWord;
        /// What is expected.
        const EXPECTED: &str = "a number above 0, in seconds, or \"auto\"";
        impl Visitor<'_> for NumberOrWord {
            type Value = StepKey;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(EXPECTED)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<StepKey, E> {
                match Positive::new(value) {
                    Some(step) => Ok(StepKey::Given(step.get())),
                    None => Err(E::custom(format!("expected {EXPECTED}, found {value:?}"))),
                }
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<StepKey, E> {
                self.visit_f64(value as f64)
            }
            fn visit_str<E: Error>(self, word: &str) -> Result<StepKey, E> {
                match word {
                    "auto" => Ok(StepKey::Automatic),
                    _ => Err(E::custom(format!("expected {EXPECTED}, found {word:?}"))),
                }
            }
        }
        deserializer.deserialize_any(NumberOrWord)
    }
}

/// Pairs of material names.
#[derive(Clone, Debug)]
pub(in crate::scene::file) struct MaterialPairs(pub(in crate::scene::file) Vec<[String; 2]>);

impl<'de> Deserialize<'de> for MaterialPairs {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// A name or a pair of names.
        struct Part(Vec<String>, bool);
        impl<'de> Deserialize<'de> for Part {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                /// Takes a name or a list of names.
                struct NameOrNames;
                impl<'de> Visitor<'de> for NameOrNames {
                    type Value = Part;
                    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                        f.write_str("a material's name or a pair of them")
                    }
                    fn visit_str<E: Error>(self, name: &str) -> Result<Part, E> {
                        Ok(Part(vec![name.to_owned()], false))
                    }
                    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Part, A::Error> {
                        let mut names = Vec::new();
                        while let Some(name) = list.next_element()? {
                            names.push(name);
                        }
                        Ok(Part(names, true))
                    }
                }
                deserializer.deserialize_any(NameOrNames)
            }
        }
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
