//! Lattices and random packings as a scene writes them.

use crate::base::quantity::{Corners, Counts, Fraction, Numbers, Positive, Triple};
use crate::scene::sizes::SizesKeys;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::num::NonZeroU32;

/// `lattice = { kind, radius, ... }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LatticeTable {
    /// Which order.
    pub(crate) kind: LatticeKind,
    /// Radius of each \[m\].
    pub(crate) radius: Positive,
    /// Distance of nearest centres \[m\]; absent: they touch.
    pub(crate) spacing: Option<Positive>,
    /// The box to fill \[m\].
    #[serde(rename = "box")]
    pub(crate) corners: Option<Corners>,
    /// Centre of the first, with counts \[m\].
    pub(crate) origin: Option<Triple>,
    /// Cells along each axis.
    pub(crate) counts: Option<Counts>,
}

/// Regular orders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum LatticeKind {
    /// One sphere in a cubic cell.
    SimpleCubic,
    /// Two.
    BodyCentredCubic,
    /// Four: close packed.
    FaceCentredCubic,
    /// Four in a right-angled cell: the other close packing.
    HexagonalClosePacked,
}

/// `packing = { box or cylinder, count or solid_fraction, radius or sizes }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PackingTable {
    /// The box that holds every sphere whole \[m\].
    #[serde(rename = "box")]
    pub(crate) corners: Option<Corners>,
    /// The cylinder that holds every sphere whole.
    pub(crate) cylinder: Option<CylinderTable>,
    /// How many.
    pub(crate) count: Option<NonZeroU32>,
    /// Volume of the spheres over that of the region; they are pushed apart until they fit.
    pub(crate) solid_fraction: Option<Fraction>,
    /// Radius, or least and largest \[m\].
    pub(crate) radius: Option<Radii>,
    /// How radii are distributed, instead of `radius`.
    pub(crate) sizes: Option<SizesKeys>,
}

/// `cylinder = { from, to, radius }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CylinderTable {
    /// Centre of one end \[m\].
    pub(crate) from: Triple,
    /// Centre of the other \[m\].
    pub(crate) to: Triple,
    /// Radius \[m\].
    pub(crate) radius: Positive,
}

/// Least and largest radius \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Radii(pub(crate) [f64; 2]);

impl<'de> Deserialize<'de> for Radii {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a number or a list.
        struct OneOrTwo;
        /// What is expected.
        const EXPECTED: &str = "a number above 0, or [least, largest]";
        impl<'de> Visitor<'de> for OneOrTwo {
            type Value = Radii;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(EXPECTED)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Radii, E> {
                let refused = || E::custom(format!("expected {EXPECTED}, found {value:?}"));
                Positive::new(value).map(|radius| Radii([radius.get(); 2])).ok_or_else(refused)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Radii, E> {
                self.visit_f64(value as f64)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Radii, A::Error> {
                let radii = Numbers.visit_seq(list)?;
                match radii.iter().map(|radius| radius.get()).collect::<Vec<_>>()[..] {
                    [least, most] if least > 0.0 && least <= most => Ok(Radii([least, most])),
                    ref found => Err(A::Error::custom(format!("expected {EXPECTED}, found {found:?}"))),
                }
            }
        }
        deserializer.deserialize_any(OneOrTwo)
    }
}
