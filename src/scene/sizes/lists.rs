//! Lists in `sizes`.

use crate::base::quantity::{Numbers, Positive};
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// One name or several.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Names(pub(in crate::scene) Vec<String>);

impl<'de> Deserialize<'de> for Names {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a word or a list.
        struct OneOrMore;
        /// What is expected.
        const EXPECTED: &str = "the name of a clump, or a list of such names";
        impl<'de> Visitor<'de> for OneOrMore {
            type Value = Names;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(EXPECTED)
            }
            fn visit_str<E: Error>(self, name: &str) -> Result<Names, E> {
                Ok(Names(vec![name.to_owned()]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Names, A::Error> {
                let mut names = Vec::new();
                while let Some(name) = list.next_element()? {
                    names.push(name);
                }
                if names.is_empty() {
                    return Err(A::Error::custom(format!("expected {EXPECTED}, found []")));
                }
                Ok(Names(names))
            }
        }
        deserializer.deserialize_any(OneOrMore)
    }
}

/// One radius or several \[m\].
#[derive(Clone, Debug)]
pub(in crate::scene) struct Radii(pub(in crate::scene) Vec<f64>);

impl<'de> Deserialize<'de> for Radii {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a number or a list.
        struct OneOrMore;
        /// What is expected.
        const EXPECTED: &str = "a number above 0, or a list of such numbers";
        impl<'de> Visitor<'de> for OneOrMore {
            type Value = Radii;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(EXPECTED)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Radii, E> {
                let refused = || E::custom(format!("expected {EXPECTED}, found {value:?}"));
                Positive::new(value).map(|radius| Radii(vec![radius.get()])).ok_or_else(refused)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Radii, E> {
                self.visit_f64(value as f64)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Radii, A::Error> {
                let radii: Vec<f64> = Numbers.visit_seq(list)?.iter().map(|radius| radius.get()).collect();
                if radii.is_empty() || radii.iter().any(|radius| *radius <= 0.0) {
                    return Err(A::Error::custom(format!("expected {EXPECTED}, found {radii:?}")));
                }
                Ok(Radii(radii))
            }
        }
        deserializer.deserialize_any(OneOrMore)
    }
}

/// Shares of classes, of any sum above 0.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Shares(pub(in crate::scene) Vec<f64>);

impl<'de> Deserialize<'de> for Shares {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let shares: Vec<f64> = deserializer.deserialize_seq(Numbers)?.iter().map(|share| share.get()).collect();
        let sum: f64 = shares.iter().sum();
        if shares.iter().all(|share| *share >= 0.0) && sum.is_normal() {
            return Ok(Self(shares));
        }
        Err(D::Error::custom(format!("expected shares of 0 or above, not all of them 0, found {shares:?}")))
    }
}

/// Least and largest radius \[m\].
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Bounds(pub(in crate::scene) [f64; 2]);

impl<'de> Deserialize<'de> for Bounds {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let bounds: Vec<f64> = deserializer.deserialize_seq(Numbers)?.iter().map(|radius| radius.get()).collect();
        match bounds[..] {
            [least, most] if least > 0.0 && least <= most => Ok(Self([least, most])),
            _ => Err(D::Error::custom(format!("expected [least, largest] above 0, found {bounds:?}"))),
        }
    }
}
