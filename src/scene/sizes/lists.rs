//! Lists in `sizes`.

use crate::base::document::{Forms, several_forms};
use crate::base::quantity::{Numbers, Positive};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};

/// One name or several.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Names(pub(in crate::scene) Vec<String>);

impl Forms for Names {
    const EXPECTED: &'static str = "the name of a clump, or a list of such names";

    fn word<E: Error>(name: &str) -> Result<Self, E> {
        Ok(Self(vec![name.to_owned()]))
    }

    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let names = Vec::<String>::deserialize(SeqAccessDeserializer::new(list))?;
        if names.is_empty() { Err(Self::refused(&names)) } else { Ok(Self(names)) }
    }
}
several_forms!(Names);

/// One radius or several \[m\].
#[derive(Clone, Debug)]
pub(in crate::scene) struct Radii(pub(in crate::scene) Vec<f64>);

impl Forms for Radii {
    const EXPECTED: &'static str = "a number above 0, or a list of such numbers";

    fn number<E: Error>(value: f64, _written: Unexpected) -> Result<Self, E> {
        Positive::new(value).map(|radius| Self(vec![radius.get()])).ok_or_else(|| Self::refused(value))
    }

    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let radii: Vec<f64> = Numbers.visit_seq(list)?.iter().map(|radius| radius.get()).collect();
        if radii.is_empty() || radii.iter().any(|radius| *radius <= 0.0) {
            return Err(Self::refused(radii));
        }
        Ok(Self(radii))
    }
}
several_forms!(Radii);

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
