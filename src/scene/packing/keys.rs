//! Lattices and random packings as a scene writes them.

use crate::base::document::{Forms, keys, several_forms};
use crate::base::quantity::{Corners, Counts, Fraction, Numbers, Positive, Triple};
use crate::scene::sizes::SizesKeys;
use serde::Deserialize;
use serde::de::{Error, SeqAccess, Unexpected, Visitor};
use std::num::NonZeroU32;

keys! {
    /// `lattice = { kind, radius, ... }`
    #[derive(Clone, Debug)]
    pub(crate) struct LatticeTable {
        /// `simple_cubic`, `body_centred_cubic`, `face_centred_cubic`, `hexagonal_close_packed`.
        pub(crate) kind: LatticeKind = "required",
        /// Radius of each sphere \[m\].
        pub(crate) radius: Positive = "required",
        /// Distance of nearest centres \[m\].
        pub(crate) spacing: Option<Positive> = "2 `radius`: neighbours touch",
        /// Lower and upper corner \[m\]; filled with whole spheres, the first cell at the lower corner.
        pub(crate) r#box: Option<Corners> = "this or `counts`",
        /// Centre of the first sphere, with `counts` \[m\].
        pub(crate) origin: Option<Triple> = "`[0, 0, 0]`",
        /// Cells along x, y, z, each ≥ 1.
        pub(crate) counts: Option<Counts> = "this or `box`",
    }
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

keys! {
    /// `packing = { box or cylinder, count or solid_fraction, radius or sizes }`
    #[derive(Clone, Debug)]
    pub(crate) struct PackingTable {
        /// Lower and upper corner of the region \[m\]; it holds every sphere whole.
        pub(crate) r#box: Option<Corners> = "fills the [cell](#cell) through its faces",
        /// `{ from = [x, y, z], to = [x, y, z], radius = r }`: the same between two points \[m\].
        pub(crate) cylinder: Option<CylinderTable> = "as `box`",
        /// Number of spheres, put at random places.
        pub(crate) count: Option<NonZeroU32> = "this or `solid_fraction`",
        /// Volume of the spheres over that of the region: equal spheres end at 0.74.
        pub(crate) solid_fraction: Option<Fraction> = "this or `count`",
        /// One radius, or `[least, largest]` of an even distribution \[m\].
        pub(crate) radius: Option<Radii> = "this or `sizes`",
        /// A distribution of radii, as [insertions](#insertionname) have it: sieve curve, log-normal, classes; even a few hundred spheres
        /// have its shares.
        pub(crate) sizes: Option<SizesKeys> = "this or `radius`",
    }
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

impl Forms for Radii {
    const EXPECTED: &'static str = "a number above 0, or [least, largest]";

    fn number<E: Error>(value: f64, _written: Unexpected) -> Result<Self, E> {
        Positive::new(value).map(|radius| Self([radius.get(); 2])).ok_or_else(|| Self::refused(value))
    }

    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let radii = Numbers.visit_seq(list)?;
        match radii.iter().map(|radius| radius.get()).collect::<Vec<_>>()[..] {
            [least, most] if least > 0.0 && least <= most => Ok(Self([least, most])),
            ref found => Err(Self::refused(found)),
        }
    }
}
several_forms!(Radii);
