//! `motion` of a boundary as the scene writes it.

use super::{AxisMotion, Schedule};
use crate::quantity::Finite;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;

/// A way to move: along a coordinate axis, or about one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Axis {
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
pub(crate) struct Keys(Table);

/// A constant velocity \[m/s\] or angular velocity \[rad/s\], or a schedule.
#[derive(Clone, Copy, Debug)]
struct Prescribed(AxisMotion);

impl<'de> Deserialize<'de> for Prescribed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a number or a table.
        struct NumberOrTable;
        /// What is right.
        const RIGHT: &str =
            "a velocity, { sine = { amplitude, frequency } } or { trapezoid = { distance, speed, acceleration } }";
        impl<'de> Visitor<'de> for NumberOrTable {
            type Value = Prescribed;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(RIGHT)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Prescribed, E> {
                let velocity = Finite::new(value).map(|velocity| Prescribed(AxisMotion::Prescribed(velocity.get())));
                velocity.ok_or_else(|| E::custom(format!("{value:?} found; a finite number is right")))
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Prescribed, E> {
                self.visit_f64(value as f64)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Prescribed, A::Error> {
                let schedule = Schedule::deserialize(MapAccessDeserializer::new(map));
                schedule.map(|schedule| Prescribed(AxisMotion::Scheduled(schedule)))
            }
        }
        deserializer.deserialize_any(NumberOrTable)
    }
}

/// The axes by what they do.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    /// Those that stay.
    #[serde(default)]
    fixed: Vec<Axis>,
    /// Those that follow an input.
    #[serde(default)]
    driven: Vec<Axis>,
    /// Those that move as the scene says.
    #[serde(default)]
    prescribed: BTreeMap<Axis, Prescribed>,
    /// Those that move by the forces on the boundary.
    #[serde(default)]
    free: Vec<Axis>,
    /// Those that move by the forces on the boundary and a given one.
    #[serde(default)]
    loaded: Loads,
}

/// Axes with a load: a list, or a table of what each load starts with \[N, N m\].
#[derive(Clone, Debug, Default)]
struct Loads(BTreeMap<Axis, Finite>);

impl<'de> Deserialize<'de> for Loads {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a list or a table.
        struct ListOrTable;
        impl<'de> Visitor<'de> for ListOrTable {
            type Value = Loads;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a list of axes, or a table of axes and the load [N, N m] that each starts with")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Loads, A::Error> {
                let axes = Vec::<Axis>::deserialize(SeqAccessDeserializer::new(list))?;
                let mut loads = BTreeMap::new();
                for axis in axes {
                    if loads.insert(axis, Finite::default()).is_some() {
                        let axis = AxisMotion::WORDS[axis as usize];
                        return Err(A::Error::custom(format!("axis {axis} found twice; once is right")));
                    }
                }
                Ok(Loads(loads))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Loads, A::Error> {
                BTreeMap::deserialize(MapAccessDeserializer::new(map)).map(Loads)
            }
        }
        deserializer.deserialize_any(ListOrTable)
    }
}

impl Keys {
    /// What each axis does, and those that are named twice.
    pub(crate) fn axes(&self) -> ([AxisMotion; 6], Vec<usize>) {
        let Table { fixed, driven, prescribed, free, loaded } = &self.0;
        let named = (fixed.iter().map(|axis| (*axis, AxisMotion::Fixed)))
            .chain(driven.iter().map(|axis| (*axis, AxisMotion::Driven)))
            .chain(prescribed.iter().map(|(axis, motion)| (*axis, motion.0)))
            .chain(free.iter().map(|axis| (*axis, AxisMotion::Free)))
            .chain(loaded.0.iter().map(|(axis, start)| (*axis, AxisMotion::Loaded(start.get()))));
        let (mut axes, mut twice) = ([None; 6], Vec::new());
        for (axis, motion) in named {
            if axes[axis as usize].replace(motion).is_some() {
                twice.push(axis as usize);
            }
        }
        (axes.map(|motion| motion.unwrap_or(AxisMotion::Fixed)), twice)
    }
}

impl<'de> Deserialize<'de> for Keys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes `"fixed"` or a table.
        struct WordOrTable;
        /// What is right.
        const RIGHT: &str = "\"fixed\" or a table of driven, prescribed, free and loaded axes";
        impl<'de> Visitor<'de> for WordOrTable {
            type Value = Keys;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(RIGHT)
            }
            fn visit_str<E: Error>(self, word: &str) -> Result<Keys, E> {
                match word {
                    "fixed" => Ok(Keys::default()),
                    _ => Err(E::custom(format!("{word:?} found; {RIGHT} is right"))),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Keys, A::Error> {
                Table::deserialize(MapAccessDeserializer::new(map)).map(Keys)
            }
        }
        deserializer.deserialize_any(WordOrTable)
    }
}
