//! `[insertion.<name>]`, `[outlet.<name>]`, `[flow_meter.<name>]` as a scene writes them.

use super::Polygon;
use crate::base::document::{Forms, Mistake, keys, several_forms};
use crate::base::quantity::{NonNegative, Positive, Triple};
use crate::laws::surface::direction;
use crate::scene::clump::OrientationKey;
use crate::scene::sizes::SizesKeys;
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess};
use std::collections::BTreeMap;

/// The key that is wrong, and why.
type Wrong = (&'static str, Mistake);

/// Amount, velocity \[m/s\] and scatter \[m/s\] of what comes.
type Read = (Amount, [f64; 3], f64);

/// What happens to a particle outside the domain, or that came through a boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outside {
    /// The run stops.
    #[default]
    Stop,
    /// The particle is taken away.
    Remove,
}

/// How much comes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// Mass in each second \[kg/s\].
    MassRate(f64),
    /// Number in each second \[1/s\].
    CountRate(f64),
    /// Mass in all, as soon as there is room \[kg\].
    Mass(f64),
}

keys! {
    /// `[insertion.<name>]`
    #[derive(Clone, Debug)]
    pub(crate) struct InsertionKeys {
        /// Name of a `[region.<name>]`: every new sphere, or the one that bounds a clump, lies whole inside it, all places equally likely.
        pub(crate) region: String = "required",
        /// Name of a material; its density is that of the spheres.
        pub(crate) material: Option<String> = "that of the clumps",
        /// What comes, and how radii are distributed, see below \[m\].
        pub(crate) sizes: SizesKeys = "required",
        /// How clumps are turned, as in a set.
        pub(crate) orientation: Option<OrientationKey> = "`\"random\"`",
        /// Mass that comes in each second \[kg/s\].
        mass_rate: Option<NonNegative> = "one of these three",
        /// Number, of clumps as such, that comes in each second \[1/s\].
        count_rate: Option<NonNegative> = "one of these three",
        /// Mass that comes in all, as soon as there is room \[kg\].
        mass: Option<Positive> = "one of these three",
        /// Velocity with which a sphere begins \[m/s\].
        velocity: Option<Triple> = "0",
        /// By how much each component of it differs at most, all values equally likely \[m/s\].
        scatter: Option<NonNegative> = "0",
    } beside {
        /// What it says of declared columns, each read by its name.
        #[serde(skip)]
        pub(crate) columns: BTreeMap<&'static str, f64>,
    }
}

impl InsertionKeys {
    /// Amount, velocity and scatter; otherwise the key that is wrong.
    pub(crate) fn read(&self) -> Result<Read, Wrong> {
        let amount = match (self.mass_rate, self.count_rate, self.mass) {
            (Some(rate), None, None) => Amount::MassRate(rate.get()),
            (None, Some(rate), None) => Amount::CountRate(rate.get()),
            (None, None, Some(mass)) => Amount::Mass(mass.get()),
            (None, None, None) => {
                let expected = "one of mass_rate, count_rate, mass says how much comes".to_owned();
                return Err(("", Mistake::Missing { expected }));
            }
            _ => {
                let found = "several".to_owned();
                let expected = "one of mass_rate, count_rate and mass".to_owned();
                return Err(("", Mistake::Unexpected { found, expected }));
            }
        };
        let velocity = self.velocity.map_or([0.0; 3], |velocity| velocity.0);
        Ok((amount, velocity, self.scatter.map_or(0.0, NonNegative::get)))
    }
}

keys! {
    /// `[outlet.<name>]`
    #[derive(Clone, Debug)]
    pub(crate) struct OutletKeys {
        /// Name of a `[region.<name>]`.
        pub(crate) region: Option<String> = "one of the two",
        /// `{ point = [x, y, z], normal = [x, y, z] }`: behind this plane \[m\]; the normal points to what stays. A name: behind this
        /// boundary, a plane that does not turn; what gets through it goes, instead of stopping the run.
        pub(crate) beyond: Option<BeyondKeys> = "one of the two",
    }
}

/// `beyond = "<boundary>"`, or a plane.
#[derive(Clone, Debug)]
pub(crate) enum BeyondKeys {
    /// The far side of the boundary of this name.
    Boundary(String),
    /// The far side of a plane.
    Plane(PlaneKeys),
}

impl Forms for BeyondKeys {
    const EXPECTED: &'static str = "the name of a boundary, or { point, normal }";

    fn word<E: Error>(name: &str) -> Result<Self, E> {
        Ok(Self::Boundary(name.to_owned()))
    }

    fn table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        PlaneKeys::deserialize(MapAccessDeserializer::new(map)).map(Self::Plane)
    }
}
several_forms!(BeyondKeys);

/// `beyond = { point, normal }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlaneKeys {
    /// A point on the plane \[m\].
    point: Triple,
    /// Towards what stays, of any length but 0.
    normal: Triple,
}

impl PlaneKeys {
    /// Point \[m\] and unit normal; otherwise the key that is wrong.
    pub(crate) fn plane(&self) -> Result<[[f64; 3]; 2], Wrong> {
        let normal = direction(self.normal.0).ok_or_else(|| {
            let (found, expected) =
                ("one of length 0".to_owned(), "a normal that points towards what stays".to_owned());
            ("beyond.normal", Mistake::Unexpected { found, expected })
        });
        Ok([self.point.0, normal?])
    }
}

keys! {
    /// `[flow_meter.<name>]`
    #[derive(Clone, Debug)]
    pub(crate) struct MeterKeys {
        /// Three or more corners of a plane polygon, counter-clockwise as seen from its front \[m\].
        polygon: Vec<Triple> = "required",
    }
}

impl MeterKeys {
    /// The polygon; otherwise the key that is wrong.
    pub(crate) fn polygon(&self) -> Result<Polygon, Wrong> {
        let corners = self.polygon.iter().map(|corner| corner.0).collect();
        let expected = "at least three corners, in one plane and not on one line".to_owned();
        Polygon::new(corners).map_err(|found| ("polygon", Mistake::Unexpected { found, expected }))
    }
}
