//! The scene as it is written: one type for each table, single values checked as they are read.

use super::InputCourse;
use crate::quantity::{Finite, Fraction, NonNegative, PoissonsRatio, Positive};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;
use std::num::NonZeroU32;

/// The tables that a scene may have.
pub(super) const TABLES: [&str; 11] =
    ["run", "gravity", "material", "pair", "contact", "particles", "boundary", "damping", "force", "domain", "output"];

/// Three finite numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Triple(pub(super) [f64; 3]);

impl<'de> Deserialize<'de> for Triple {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let list: Vec<Finite> = deserializer.deserialize_seq(Numbers)?;
        match list[..] {
            [x, y, z] => Ok(Self([x.get(), y.get(), z.get()])),
            _ => Err(D::Error::custom(format!("{} numbers found; [x, y, z] is right", list.len()))),
        }
    }
}

/// Reads a list of numbers.
struct Numbers;

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

/// Two corners, the second above the first along each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corners(pub(super) [[f64; 3]; 2]);

impl<'de> Deserialize<'de> for Corners {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let corners = Vec::<Triple>::deserialize(deserializer)?;
        let [Triple(lower), Triple(upper)] = corners[..] else {
            let found = corners.len();
            return Err(D::Error::custom(format!("{found} corners found; [[x, y, z], [x, y, z]] is right")));
        };
        match (0..3).find(|axis| lower[*axis] >= upper[*axis]) {
            None => Ok(Self([lower, upper])),
            Some(axis) => Err(D::Error::custom(format!(
                "{:?} to {:?} along {} found; the lower corner before the upper one is right",
                lower[axis],
                upper[axis],
                ["x", "y", "z"][axis]
            ))),
        }
    }
}

/// `[run]`
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RunTable {
    /// End \[s\].
    pub(super) end: Option<Positive>,
    /// Time step \[s\] or `"auto"`.
    pub(super) step: Option<StepKey>,
    /// Fraction of the stable step.
    pub(super) safety: Option<Safety>,
    /// Threads.
    pub(super) threads: Option<NonZeroU32>,
    /// Seed of everything random.
    pub(super) seed: Option<u64>,
    /// Search distance beyond touch \[m\].
    pub(super) skin: Option<Positive>,
    /// Unbalanced force over mean contact force at which settling ends.
    pub(super) settle_tolerance: Option<Positive>,
    /// Damping coefficient while settling.
    pub(super) settle_damping: Option<Fraction>,
    /// Largest overlap at the start over the smaller radius.
    pub(super) max_overlap: Option<NonNegative>,
}

/// `step` of `[run]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StepKey {
    /// A number \[s\].
    Given(f64),
    /// `"auto"`
    Automatic,
}

impl<'de> Deserialize<'de> for StepKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a number or a word.
        struct NumberOrWord;
        /// What is right.
        const RIGHT: &str = "a number above 0, in seconds, or \"auto\"";
        impl Visitor<'_> for NumberOrWord {
            type Value = StepKey;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(RIGHT)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<StepKey, E> {
                match Positive::new(value) {
                    Some(step) => Ok(StepKey::Given(step.get())),
                    None => Err(E::custom(format!("{value:?} found; {RIGHT} is right"))),
                }
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<StepKey, E> {
                self.visit_f64(value as f64)
            }
            fn visit_str<E: Error>(self, word: &str) -> Result<StepKey, E> {
                match word {
                    "auto" => Ok(StepKey::Automatic),
                    _ => Err(E::custom(format!("{word:?} found; {RIGHT} is right"))),
                }
            }
        }
        deserializer.deserialize_any(NumberOrWord)
    }
}

/// A number above 0 and below 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Safety(pub(super) f64);

impl<'de> Deserialize<'de> for Safety {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = f64::deserialize(deserializer)?;
        if value > 0.0 && value < 1.0 {
            return Ok(Self(value));
        }
        Err(D::Error::custom(format!("{value:?} found; a number above 0 and below 1 is right")))
    }
}

/// `[material.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    /// Density \[kg/m³\].
    pub(super) density: Positive,
    /// Young's modulus \[Pa\].
    pub(super) youngs_modulus: Option<Positive>,
    /// Poisson's ratio.
    pub(super) poissons_ratio: Option<PoissonsRatio>,
}

/// `[contact.<name>]`, without its sub-models.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ContactTable {
    /// For whom; absent: for all.
    pub(super) between: Option<Between>,
    /// Whether the normal force is kept from pulling.
    #[serde(default)]
    pub(super) limit_force: bool,
    /// Whether the tangential dashpot acts.
    pub(super) tangential_damping: Option<bool>,
    /// Read on its own.
    #[serde(rename = "normal")]
    _normal: Option<IgnoredAny>,
    /// Read on its own.
    #[serde(rename = "tangential")]
    _tangential: Option<IgnoredAny>,
    /// Read on its own.
    #[serde(rename = "rolling")]
    _rolling: Option<IgnoredAny>,
    /// Read on its own.
    #[serde(rename = "cohesion")]
    _cohesion: Option<IgnoredAny>,
}

/// Pairs of material names.
#[derive(Clone, Debug)]
pub(super) struct Between(pub(super) Vec<[String; 2]>);

impl<'de> Deserialize<'de> for Between {
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
        /// What is right.
        const RIGHT: &str = "[\"a\", \"b\"] or a list of such pairs";
        let parts = Vec::<Part>::deserialize(deserializer)?;
        let pair = |names: &[String]| match names {
            [a, b] => Ok([a.clone(), b.clone()]),
            names => Err(D::Error::custom(format!("{} names found; {RIGHT} is right", names.len()))),
        };
        if parts.iter().all(|part| !part.1) {
            let names: Vec<String> = parts.into_iter().flat_map(|part| part.0).collect();
            return pair(&names).map(|pair| Self(vec![pair]));
        }
        if parts.iter().any(|part| !part.1) {
            return Err(D::Error::custom(format!("names beside pairs found; {RIGHT} is right")));
        }
        parts.iter().map(|part| pair(&part.0)).collect::<Result<_, _>>().map(Self)
    }
}

/// `[particles.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParticlesTable {
    /// Material of those that name none.
    pub(super) material: Option<String>,
    /// Material of each type or material that the file names.
    #[serde(default)]
    pub(super) materials: BTreeMap<String, String>,
    /// Density of those that have none of their own \[kg/m³\].
    pub(super) density: Option<Positive>,
    /// Velocity of those that have none of their own \[m/s\].
    pub(super) velocity: Option<Triple>,
    /// Angular velocity of those that have none of their own \[rad/s\].
    pub(super) angular_velocity: Option<Triple>,
    /// The particles, one by one.
    pub(super) list: Option<Vec<ListEntry>>,
    /// A file of particles.
    pub(super) file: Option<String>,
    /// What the file is, where its name does not say.
    pub(super) format: Option<Format>,
    /// The file's units.
    pub(super) units: Option<Units>,
    /// The snapshot of a dump file; absent: the last.
    pub(super) timestep: Option<u64>,
    /// A regular order.
    pub(super) lattice: Option<LatticeTable>,
    /// A random packing.
    pub(super) packing: Option<PackingTable>,
}

/// `lattice = { kind, radius, ... }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LatticeTable {
    /// Which order.
    pub(super) kind: LatticeKind,
    /// Radius of each \[m\].
    pub(super) radius: Positive,
    /// Distance of nearest centres \[m\]; absent: they touch.
    pub(super) spacing: Option<Positive>,
    /// The box to fill \[m\].
    #[serde(rename = "box")]
    pub(super) corners: Option<Corners>,
    /// Centre of the first, with counts \[m\].
    pub(super) origin: Option<Triple>,
    /// Cells along each axis.
    pub(super) counts: Option<Counts>,
}

/// Regular orders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum LatticeKind {
    /// One sphere in a cubic cell.
    SimpleCubic,
    /// Two.
    BodyCentredCubic,
    /// Four: close packed.
    FaceCentredCubic,
    /// Four in a right-angled cell: the other close packing.
    HexagonalClosePacked,
}

/// Cells along each axis, each at least 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Counts(pub(super) [u32; 3]);

impl<'de> Deserialize<'de> for Counts {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let counts = Vec::<NonZeroU32>::deserialize(deserializer)?;
        match counts[..] {
            [x, y, z] => Ok(Self([x.get(), y.get(), z.get()])),
            _ => Err(D::Error::custom(format!("{} numbers found; [nx, ny, nz] is right", counts.len()))),
        }
    }
}

/// `packing = { box, count, radius }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PackingTable {
    /// The box that holds every sphere whole \[m\].
    #[serde(rename = "box")]
    pub(super) corners: Corners,
    /// How many.
    pub(super) count: NonZeroU32,
    /// Radius, or least and largest \[m\].
    pub(super) radius: Radii,
}

/// Least and largest radius \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Radii(pub(super) [f64; 2]);

impl<'de> Deserialize<'de> for Radii {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a number or a list.
        struct OneOrTwo;
        /// What is right.
        const RIGHT: &str = "a number above 0, or [least, largest]";
        impl<'de> Visitor<'de> for OneOrTwo {
            type Value = Radii;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(RIGHT)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Radii, E> {
                let refused = || E::custom(format!("{value:?} found; {RIGHT} is right"));
                Positive::new(value).map(|radius| Radii([radius.get(); 2])).ok_or_else(refused)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Radii, E> {
                self.visit_f64(value as f64)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Radii, A::Error> {
                let radii = Numbers.visit_seq(list)?;
                match radii.iter().map(|radius| radius.get()).collect::<Vec<_>>()[..] {
                    [least, most] if least > 0.0 && least <= most => Ok(Radii([least, most])),
                    ref found => Err(A::Error::custom(format!("{found:?} found; {RIGHT} is right"))),
                }
            }
        }
        deserializer.deserialize_any(OneOrTwo)
    }
}

/// Formats of particle files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Format {
    /// Comma-separated columns.
    Csv,
    /// VTK's XML unstructured grid.
    Vtu,
    /// Data file of LIGGGHTS or LAMMPS.
    Data,
    /// Dump file of LIGGGHTS or LAMMPS.
    Dump,
}

/// Units of particle files, by the names that LIGGGHTS and LAMMPS have for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Units {
    /// Metre, kilogram, second.
    Si,
    /// Centimetre, gram, second.
    Cgs,
    /// Micrometre, picogram, microsecond.
    Micro,
    /// Nanometre, attogram, nanosecond.
    Nano,
}

impl Units {
    /// The units of this name.
    pub(super) fn named(name: &str) -> Option<Self> {
        [("si", Self::Si), ("cgs", Self::Cgs), ("micro", Self::Micro), ("nano", Self::Nano)]
            .into_iter()
            .find_map(|(known, units)| (known == name).then_some(units))
    }

    /// Length \[m\], mass \[kg\] and time \[s\] of one.
    pub(super) fn sizes(self) -> [f64; 3] {
        match self {
            Self::Si => [1.0, 1.0, 1.0],
            Self::Cgs => [1e-2, 1e-3, 1.0],
            Self::Micro => [1e-6, 1e-15, 1e-6],
            Self::Nano => [1e-9, 1e-21, 1e-9],
        }
    }
}

/// A particle in a list.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ListEntry {
    /// Position of the centre \[m\].
    pub(super) position: Triple,
    /// Radius \[m\].
    pub(super) radius: Positive,
    /// Its number.
    pub(super) id: Option<u32>,
    /// Its material.
    pub(super) material: Option<String>,
    /// Its density \[kg/m³\].
    pub(super) density: Option<Positive>,
    /// Its velocity \[m/s\].
    pub(super) velocity: Option<Triple>,
    /// Its angular velocity \[rad/s\].
    pub(super) angular_velocity: Option<Triple>,
}

/// Which particles: those for which everything given here holds.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Selection {
    /// Of this set.
    pub(super) set: Option<String>,
    /// Of these sets.
    pub(super) sets: Option<Vec<String>>,
    /// Centre in this box, its faces included \[m\].
    #[serde(rename = "box")]
    pub(super) corners: Option<Corners>,
    /// With these numbers.
    pub(super) ids: Option<Vec<u32>>,
}

/// `[boundary.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BoundaryTable {
    /// A plane.
    pub(super) plane: Option<PlaneTable>,
    /// A group of particles.
    pub(super) particles: Option<Selection>,
    /// Material of a plane.
    pub(super) material: Option<String>,
    /// How it moves.
    #[serde(default)]
    pub(super) motion: Motion,
    /// How driven axes go to their new value.
    pub(super) input: Option<InputCourse>,
    /// Point of reference of the moment \[m\].
    pub(super) reference: Option<Triple>,
}

/// `plane = { point, normal }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlaneTable {
    /// A point on it \[m\].
    pub(super) point: Triple,
    /// Towards the particles, of any length but 0.
    pub(super) normal: Triple,
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Axis {
    /// x
    X,
    /// y
    Y,
    /// z
    Z,
}

/// `motion` of a boundary; an axis not named is fixed.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion(pub(super) MotionTable);

/// The axes by what they do.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MotionTable {
    /// Those that stay.
    #[serde(default)]
    pub(super) fixed: Vec<Axis>,
    /// Those that follow an input.
    #[serde(default)]
    pub(super) driven: Vec<Axis>,
    /// Those with a constant velocity \[m/s\].
    #[serde(default)]
    pub(super) prescribed: BTreeMap<Axis, Finite>,
}

impl<'de> Deserialize<'de> for Motion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes `"fixed"` or a table.
        struct WordOrTable;
        /// What is right.
        const RIGHT: &str = "\"fixed\" or a table of driven and prescribed axes";
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

/// `[damping.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DampingTable {
    /// Whom; absent: all.
    pub(super) particles: Option<Selection>,
    /// Fraction of the force.
    pub(super) linear: Fraction,
    /// Fraction of the torque.
    pub(super) angular: Fraction,
    /// Factor on both, particle by particle.
    pub(super) scale: Option<ScaleTable>,
    /// Whether gravity is damped.
    pub(super) gravity_damped: Option<bool>,
    /// Whether applied forces are damped.
    pub(super) applied_forces_damped: Option<bool>,
}

/// `scale` of a damping: one of these.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScaleTable {
    /// By material; 1 for those not named.
    pub(super) material: Option<BTreeMap<String, NonNegative>>,
    /// Radius over this length \[m\].
    pub(super) radius_divisor: Option<Positive>,
    /// A column of the particles' files.
    pub(super) column: Option<String>,
}

/// `[force.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ForceTable {
    /// On whom.
    pub(super) particles: Selection,
    /// On each \[N\].
    pub(super) force: Triple,
}

/// `[domain]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DomainTable {
    /// Its corners \[m\].
    #[serde(rename = "box")]
    pub(super) corners: Corners,
}

/// `[output]`
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputTable {
    /// Time between rows of the history \[s\].
    pub(super) history_interval: Option<Positive>,
    /// Time between frames \[s\].
    pub(super) frame_interval: Option<Positive>,
    /// Whether frames have contacts.
    #[serde(default)]
    pub(super) contacts: bool,
    /// Whether the energy book is kept.
    #[serde(default)]
    pub(super) energy: bool,
    /// Time between checkpoints \[s\].
    pub(super) checkpoint_interval: Option<Positive>,
}
