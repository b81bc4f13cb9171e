//! Numbers that are checked as they are read, and indices that cannot be mixed up.

use serde::de::value::{Error as ReadError, F64Deserializer};
use serde::de::{DeserializeOwned, Error, IntoDeserializer, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;
use std::num::NonZeroU32;

/// The least number above 0 that has all its digits.
const ABOVE_ZERO: Option<f64> = Some(f64::MIN_POSITIVE);
/// The largest number below 1.
const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

/// A type of numbers.
pub trait Checked: DeserializeOwned {
    /// Those that it takes.
    const RANGE: Range;
}

/// Declares a checked `f64`: its name, what it must satisfy, the words for that in a message, the least and the largest.
macro_rules! checked {
    ($(#[$doc:meta])* $name:ident, $value:ident => $test:expr, $words:literal, $least:expr, $most:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
        #[serde(transparent)]
        pub struct $name(f64);

        impl $name {
            /// The value, if it is permitted.
            pub fn new($value: f64) -> Option<Self> {
                ($value.is_finite() && $test).then_some(Self($value))
            }
            /// The plain number.
            #[inline]
            pub fn get(self) -> f64 {
                self.0
            }
        }

        impl Checked for $name {
            const RANGE: Range = Range::of::<Self>($least, $most);
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let value = f64::deserialize(deserializer)?;
                Self::new(value).ok_or_else(|| D::Error::custom(format!("expected {}, found {value:?}", $words)))
            }
        }
    };
}

checked!(/// Any finite number.
    Finite, value => value.is_finite(), "a finite number", None, None);
checked!(/// A number above 0.
    Positive, value => value > 0.0, "a number above 0", ABOVE_ZERO, None);
checked!(/// A number of 0 or above.
    NonNegative, value => value >= 0.0, "a number of 0 or above", Some(0.0), None);
checked!(/// A number of 1 or above.
    AtLeastOne, value => value >= 1.0, "a number of 1 or above", Some(1.0), None);
checked!(/// A number above 0 and at most 1.
    Restitution, value => value > 0.0 && value <= 1.0, "a number above 0 and at most 1", ABOVE_ZERO, Some(1.0));
checked!(/// Part of space that is not filled: above 0 and at most 1.
    Porosity, value => value > 0.0 && value <= 1.0, "a number above 0 and at most 1", ABOVE_ZERO, Some(1.0));
checked!(/// A number from 0 to 1.
    Fraction, value => (0.0..=1.0).contains(&value), "a number from 0 to 1", Some(0.0), Some(1.0));
checked!(/// A number above 0 and below 1: how much of the stable step an automatic time step takes.
    Safety, value => value > 0.0 && value < 1.0, "a number above 0 and below 1", ABOVE_ZERO, Some(BELOW_ONE));
checked!(/// A number from 0 to below 1.
    BelowOne, value => (0.0..1.0).contains(&value), "a number from 0 to below 1", Some(0.0), Some(BELOW_ONE));
checked!(/// Poisson's ratio of an isotropic material: from 0 to ½.
    PoissonsRatio, value => (0.0..=0.5).contains(&value), "a number from 0 to 0.5", Some(0.0), Some(0.5));

/// Which numbers a key takes.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// The least, where there is one.
    pub minimum: Option<f64>,
    /// The largest, where there is one.
    pub maximum: Option<f64>,
    /// What the type that reads the key says of a number, if it refuses it.
    check: fn(f64) -> Result<(), String>,
}

impl Range {
    /// Above 0.
    pub const POSITIVE: Self = Positive::RANGE;
    /// 0 or above.
    pub const NON_NEGATIVE: Self = NonNegative::RANGE;
    /// A whole number of 0 or above.
    pub(crate) const COUNT: Self = Self::of::<NonNegative>(Some(0.0), Some(65535.0));
    /// 0 for no, 1 for yes.
    pub(crate) const SWITCH: Self = Self::of::<NonNegative>(Some(0.0), Some(1.0));
    /// 1 or above.
    pub const AT_LEAST_ONE: Self = AtLeastOne::RANGE;
    /// Above 0, at most 1.
    pub const RESTITUTION: Self = Restitution::RANGE;
    /// From 0 to 1.
    pub const FRACTION: Self = Fraction::RANGE;
    /// From 0 to ½.
    pub const POISSONS_RATIO: Self = PoissonsRatio::RANGE;
    /// Above 0 and below 1.
    pub(crate) const PART: Self = Safety::RANGE;
    /// From 0 to below 1.
    pub(crate) const PART_OR_NONE: Self = BelowOne::RANGE;

    /// The numbers that a type takes, from the least to the largest.
    pub const fn of<T: DeserializeOwned>(minimum: Option<f64>, maximum: Option<f64>) -> Self {
        let check = |value: f64| {
            let reader: F64Deserializer<ReadError> = value.into_deserializer();
            T::deserialize(reader).map(drop).map_err(|error| error.to_string())
        };
        Self { minimum, maximum, check }
    }

    /// Those that the type of this name takes, if it is a type of numbers.
    pub(crate) fn of_type(name: &str) -> Option<Self> {
        Some(match name {
            "Positive" => Self::POSITIVE,
            "NonNegative" => Self::NON_NEGATIVE,
            "AtLeastOne" | "NonZeroU32" => Self::AT_LEAST_ONE,
            "Restitution" | "Porosity" => Self::RESTITUTION,
            "Fraction" => Self::FRACTION,
            "Safety" => Self::PART,
            "PoissonsRatio" => Self::POISSONS_RATIO,
            _ => return None,
        })
    }

    /// What they are, in the words of the documentation.
    #[cfg(test)]
    pub(crate) fn words(&self) -> String {
        let from = |least| if Some(least) == ABOVE_ZERO { "> 0".to_owned() } else { format!("≥ {least}") };
        let to = |most| if most == BELOW_ONE { "< 1".to_owned() } else { format!("≤ {most}") };
        match (self.minimum, self.maximum) {
            (Some(least), Some(most)) if self.minimum != ABOVE_ZERO && most != BELOW_ONE => {
                format!("{least} to {most}")
            }
            (least, most) => least.map(from).into_iter().chain(most.map(to)).collect::<Vec<_>>().join(" and "),
        }
    }

    /// Whether a number is one of them; otherwise the refusal, in the words of a scene's mistakes.
    pub fn check(&self, value: f64) -> Result<(), String> {
        (self.check)(value)?;
        match self.maximum.filter(|&most| value > most) {
            Some(most) => Err(format!("expected at most {most:?}, found {value:?}")),
            None => Ok(()),
        }
    }
}

/// Declares an index into one kind of list.
macro_rules! index {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// As an index of a slice.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

impl Default for Finite {
    /// 0.
    fn default() -> Self {
        Self(0.0)
    }
}

index!(/// The number a particle carries in the scene, its files and its outputs; never changes.
    ParticleId);
index!(/// Where a material stands in the scene.
    MaterialIndex);
index!(/// Where a particle set stands in the scene.
    SetIndex);
index!(/// Where a boundary stands in the scene.
    BoundaryIndex);

/// Three finite numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Triple(pub(crate) [f64; 3]);

impl Triple {
    /// The numbers.
    pub fn get(self) -> [f64; 3] {
        self.0
    }
}

impl<'de> Deserialize<'de> for Triple {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let list: Vec<Finite> = deserializer.deserialize_seq(Numbers)?;
        match list[..] {
            [x, y, z] => Ok(Self([x.get(), y.get(), z.get()])),
            _ => Err(D::Error::custom(format!("expected [x, y, z], found {} numbers", list.len()))),
        }
    }
}

/// Reads a list of numbers.
pub(crate) struct Numbers;

impl<'de> Visitor<'de> for Numbers {
    type Value = Vec<Finite>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list of numbers")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Vec<Finite>, A::Error> {
        let mut numbers = Vec::new();
        while let Some(number) = list.next_element()? {
            numbers.push(number);
        }
        Ok(numbers)
    }
}

/// Cells along each axis, each at least 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Counts(pub(crate) [u32; 3]);

impl<'de> Deserialize<'de> for Counts {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let counts = Vec::<NonZeroU32>::deserialize(deserializer)?;
        match counts[..] {
            [x, y, z] => Ok(Self([x.get(), y.get(), z.get()])),
            _ => Err(D::Error::custom(format!("expected [nx, ny, nz], found {} numbers", counts.len()))),
        }
    }
}

/// Two corners, the second above the first along each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corners(pub(crate) [[f64; 3]; 2]);

impl<'de> Deserialize<'de> for Corners {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let corners = Vec::<Triple>::deserialize(deserializer)?;
        let [Triple(lower), Triple(upper)] = corners[..] else {
            let found = corners.len();
            return Err(D::Error::custom(format!("expected [[x, y, z], [x, y, z]], found {found} corners")));
        };
        match (0..3).find(|axis| lower[*axis] >= upper[*axis]) {
            None => Ok(Self([lower, upper])),
            Some(axis) => Err(D::Error::custom(format!(
                "expected the lower corner before the upper one, found {:?} to {:?} along {}",
                lower[axis],
                upper[axis],
                ["x", "y", "z"][axis]
            ))),
        }
    }
}
