//! The scene as it is written: one type for each table, single values checked as they are read.

mod boundary;
mod particles;
mod values;

pub(super) use crate::quantity::{Corners, Triple};
pub(super) use crate::surface::Selection;
pub(super) use boundary::BoundaryTable;
pub(super) use particles::{
    CylinderTable, Format, LatticeKind, LatticeTable, ListEntry, PackingTable, ParticlesTable, Units,
};
pub(super) use values::{Between, Safety, StepKey};
#[cfg(test)]
pub(super) use values::{Counts, Radii};

use crate::quantity::{Fraction, NonNegative, PoissonsRatio, Positive};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeMap;
use std::num::NonZeroU32;

/// The tables that a scene may have.
pub(in crate::scene) const TABLES: [&str; 12] = [
    "run",
    "gravity",
    "material",
    "pair",
    "contact",
    "bond",
    "particles",
    "boundary",
    "damping",
    "force",
    "domain",
    "output",
];

/// `[run]`
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct RunTable {
    /// End \[s\].
    pub(in crate::scene) end: Option<Positive>,
    /// Time step \[s\] or `"auto"`.
    pub(in crate::scene) step: Option<StepKey>,
    /// Fraction of the stable step.
    pub(in crate::scene) safety: Option<Safety>,
    /// Whether a given step above the stable one may run on.
    pub(in crate::scene) allow_unstable: Option<bool>,
    /// Threads.
    pub(in crate::scene) threads: Option<NonZeroU32>,
    /// Seed of everything random.
    pub(in crate::scene) seed: Option<u64>,
    /// Search distance beyond touch \[m\].
    pub(in crate::scene) skin: Option<Positive>,
    /// Unbalanced force over mean contact force at which settling ends.
    pub(in crate::scene) settle_tolerance: Option<Positive>,
    /// Damping coefficient while settling.
    pub(in crate::scene) settle_damping: Option<Fraction>,
    /// Largest overlap at the start over the smaller radius.
    pub(in crate::scene) max_overlap: Option<NonNegative>,
}

/// `[material.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct MaterialTable {
    /// Density \[kg/m³\].
    pub(in crate::scene) density: Positive,
    /// Young's modulus \[Pa\].
    pub(in crate::scene) youngs_modulus: Option<Positive>,
    /// Poisson's ratio.
    pub(in crate::scene) poissons_ratio: Option<PoissonsRatio>,
}

/// `[contact.<name>]`, without its sub-models.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct ContactTable {
    /// For whom; absent: for all.
    pub(in crate::scene) between: Option<Between>,
    /// Whether the normal force is kept from pulling.
    #[serde(default)]
    pub(in crate::scene) limit_force: bool,
    /// Whether the tangential dashpot acts.
    pub(in crate::scene) tangential_damping: Option<bool>,
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

/// `[damping.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct DampingTable {
    /// Whom; absent: all.
    pub(in crate::scene) particles: Option<Selection>,
    /// Fraction of the force.
    pub(in crate::scene) linear: Fraction,
    /// Fraction of the torque.
    pub(in crate::scene) angular: Fraction,
    /// Factor on both, particle by particle.
    pub(in crate::scene) scale: Option<ScaleTable>,
    /// Whether gravity is damped.
    pub(in crate::scene) gravity_damped: Option<bool>,
    /// Whether applied forces are damped.
    pub(in crate::scene) applied_forces_damped: Option<bool>,
}

/// `scale` of a damping: one of these.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct ScaleTable {
    /// By material; 1 for those not named.
    pub(in crate::scene) material: Option<BTreeMap<String, NonNegative>>,
    /// Radius over this length \[m\].
    pub(in crate::scene) radius_divisor: Option<Positive>,
    /// A column of the particles' files.
    pub(in crate::scene) column: Option<String>,
}

/// `[force.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct ForceTable {
    /// On whom.
    pub(in crate::scene) particles: Selection,
    /// On each \[N\].
    pub(in crate::scene) force: Triple,
}

/// `[domain]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct DomainTable {
    /// Its corners \[m\].
    #[serde(rename = "box")]
    pub(in crate::scene) corners: Corners,
}

/// `[output]`
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct OutputTable {
    /// Time between rows of the history \[s\].
    pub(in crate::scene) history_interval: Option<Positive>,
    /// Time between frames \[s\].
    pub(in crate::scene) frame_interval: Option<Positive>,
    /// Whether frames have contacts.
    #[serde(default)]
    pub(in crate::scene) contacts: bool,
    /// Whether the energy book is kept.
    #[serde(default)]
    pub(in crate::scene) energy: bool,
    /// Time between checkpoints \[s\].
    pub(in crate::scene) checkpoint_interval: Option<Positive>,
}
