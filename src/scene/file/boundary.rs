//! `[boundary.<name>]`

use super::particles::Selection;
use super::values::Triple;
use crate::quantity::Finite;
use crate::scene::InputCourse;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;

/// `[boundary.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct BoundaryTable {
    /// A plane.
    pub(in crate::scene) plane: Option<PlaneTable>,
    /// A group of particles.
    pub(in crate::scene) particles: Option<Selection>,
    /// Material of a plane.
    pub(in crate::scene) material: Option<String>,
    /// How it moves.
    #[serde(default)]
    pub(in crate::scene) motion: Motion,
    /// How driven axes go to their new value.
    pub(in crate::scene) input: Option<InputCourse>,
    /// Point of reference of the moment \[m\].
    pub(in crate::scene) reference: Option<Triple>,
}

/// `plane = { point, normal }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct PlaneTable {
    /// A point on it \[m\].
    pub(in crate::scene) point: Triple,
    /// Towards the particles, of any length but 0.
    pub(in crate::scene) normal: Triple,
}

/// A way to move: along a coordinate axis, or about one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::scene) enum Axis {
    /// x
    X,
    /// y
    Y,
    /// z
    Z,
    /// Rotation about x
    #[serde(rename = "rotation.x")]
    RotationX,
    /// Rotation about y
    #[serde(rename = "rotation.y")]
    RotationY,
    /// Rotation about z
    #[serde(rename = "rotation.z")]
    RotationZ,
}

/// `motion` of a boundary; an axis not named is fixed.
#[derive(Clone, Debug, Default)]
pub(in crate::scene) struct Motion(pub(in crate::scene) MotionTable);

/// The axes by what they do.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct MotionTable {
    /// Those that stay.
    #[serde(default)]
    pub(in crate::scene) fixed: Vec<Axis>,
    /// Those that follow an input.
    #[serde(default)]
    pub(in crate::scene) driven: Vec<Axis>,
    /// Those with a constant velocity \[m/s\] or angular velocity \[rad/s\].
    #[serde(default)]
    pub(in crate::scene) prescribed: BTreeMap<Axis, Finite>,
    /// Those that move by the forces on the boundary.
    #[serde(default)]
    pub(in crate::scene) free: Vec<Axis>,
}

impl<'de> Deserialize<'de> for Motion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes `"fixed"` or a table.
        struct WordOrTable;
        /// What is right.
        const RIGHT: &str = "\"fixed\" or a table of driven, prescribed and free axes";
        impl<'de> Visitor<'de> for WordOrTable {
            type Value = Motion;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(RIGHT)
            }
            fn visit_str<E: Error>(self, word: &str) -> Result<Motion, E> {
                match word {
                    "fixed" => Ok(Motion::default()),
                    _ => Err(E::custom(format!("{word:?} found; {RIGHT} is right"))),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Motion, A::Error> {
                MotionTable::deserialize(MapAccessDeserializer::new(map)).map(Motion)
            }
        }
        deserializer.deserialize_any(WordOrTable)
    }
}
