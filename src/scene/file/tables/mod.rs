//! The scene as it is written: one type for each table, single values checked as they are read.

mod body;
mod boundary;
mod fluid;
mod heat;
mod particles;
mod values;

pub(super) use crate::base::quantity::{Corners, Triple};
pub(super) use crate::laws::surface::Selection;
pub(in crate::scene) use body::Inertia;
pub(super) use body::{Supports, is_positive_definite};
pub(super) use boundary::BoundaryTable;
pub(super) use fluid::{FluidTable, VelocityKey};
pub(super) use heat::{HeatSourceTable, HeatTable, TemperatureKey};
pub(super) use particles::{ListEntry, ParticlesTable, WrittenColumn};
pub(super) use values::{MaterialPairs, StepKey};

use crate::base::quantity::{Fraction, NonNegative, PoissonsRatio, Positive, Safety};
use crate::laws::contact::{Properties, Scheme};
use crate::scene::exchange::Outside;
use crate::scene::{Accuracy, MotionPlane, ParticleShape};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeMap;
use std::num::NonZeroU32;

/// The tables that a scene may have.
pub(in crate::scene::file) const TABLES: [&str; 25] = [
    "about",
    "run",
    "gravity",
    "material",
    "pair",
    "contact",
    "bond",
    "clump",
    "particles",
    "boundary",
    "damping",
    "force",
    "heat",
    "heat_source",
    "fluid",
    "region",
    "grid",
    "insertion",
    "outlet",
    "flow_meter",
    "domain",
    "cell",
    "output",
    "probe",
    "derived",
];

/// `[run]`
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct RunTable {
    /// End \[s\].
    pub(in crate::scene::file) end: Option<Positive>,
    /// Time step \[s\] or `"auto"`.
    pub(in crate::scene::file) step: Option<StepKey>,
    /// Fraction of the stable step.
    pub(in crate::scene::file) safety: Option<Safety>,
    /// How accurate.
    pub(in crate::scene::file) accuracy: Option<Accuracy>,
    /// How springs and dashpots of contacts are integrated in time.
    pub(in crate::scene::file) scheme: Option<Scheme>,
    /// Whether a given step above the stable one may run on.
    pub(in crate::scene::file) allow_unstable: Option<bool>,
    /// Whether a run stops where the stable step falls below a given one.
    pub(in crate::scene::file) strict_step: Option<bool>,
    /// Threads.
    pub(in crate::scene::file) threads: Option<NonZeroU32>,
    /// Seed of everything random.
    pub(in crate::scene::file) seed: Option<u64>,
    /// Search distance beyond touch \[m\].
    pub(in crate::scene::file) skin: Option<Positive>,
    /// Unbalanced force over mean contact force at which settling ends.
    pub(in crate::scene::file) settle_tolerance: Option<Positive>,
    /// Damping coefficient while settling.
    pub(in crate::scene::file) settle_damping: Option<Fraction>,
    /// Largest overlap at the start over the smaller radius.
    pub(in crate::scene::file) max_overlap: Option<NonNegative>,
    /// The plane in which all particles stay.
    pub(in crate::scene::file) plane: Option<MotionPlane>,
    /// What they are in it.
    pub(in crate::scene::file) plane_particles: Option<ParticleShape>,
    /// Whether derivatives are differences of both sides.
    pub(in crate::scene::file) central_derivatives: Option<bool>,
    /// How far derivatives displace inputs, over what the program chooses.
    pub(in crate::scene::file) derivative_displacement: Option<Positive>,
}

/// `[material.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct MaterialTable {
    /// Density \[kg/m³\].
    pub(in crate::scene::file) density: Positive,
    /// Young's modulus \[Pa\].
    pub(in crate::scene::file) youngs_modulus: Option<Positive>,
    /// Poisson's ratio.
    pub(in crate::scene::file) poissons_ratio: Option<PoissonsRatio>,
    /// Conductivity \[W/(m K)\].
    pub(in crate::scene::file) conductivity: Option<Positive>,
    /// Specific heat \[J/(kg K)\].
    pub(in crate::scene::file) specific_heat: Option<Positive>,
    /// Young's modulus of the real bodies \[Pa\].
    pub(in crate::scene::file) real_youngs_modulus: Option<Positive>,
    /// Properties that laws declare.
    #[serde(skip)]
    pub(in crate::scene::file) properties: Properties,
}

/// `[contact.<name>]`, without its sub-models.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct ContactTable {
    /// The pairs of materials; absent: all.
    pub(in crate::scene::file) between: Option<MaterialPairs>,
    /// Whether the normal force is limited so that it never pulls.
    #[serde(default)]
    pub(in crate::scene::file) limit_force: bool,
    /// Whether the tangential dashpot acts.
    pub(in crate::scene::file) tangential_damping: Option<bool>,
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
    /// Read on its own.
    #[serde(rename = "heat")]
    _heat: Option<IgnoredAny>,
}

/// `[damping.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct DampingTable {
    /// The particles; absent: all.
    pub(in crate::scene::file) particles: Option<Selection>,
    /// Fraction of the force.
    pub(in crate::scene::file) linear: Fraction,
    /// Fraction of the torque.
    pub(in crate::scene::file) angular: Fraction,
    /// Factor on both, particle by particle.
    pub(in crate::scene::file) scale: Option<ScaleTable>,
    /// Whether gravity is damped.
    pub(in crate::scene::file) gravity_damped: Option<bool>,
    /// Whether applied forces are damped.
    pub(in crate::scene::file) applied_forces_damped: Option<bool>,
}

/// `scale` of a damping: one of these.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct ScaleTable {
    /// By material; 1 for those not named.
    pub(in crate::scene::file) material: Option<BTreeMap<String, NonNegative>>,
    /// Radius over this length \[m\].
    pub(in crate::scene::file) radius_divisor: Option<Positive>,
    /// A column of the particles' files.
    pub(in crate::scene::file) column: Option<String>,
}

/// `[force.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct ForceTable {
    /// The particles.
    pub(in crate::scene::file) particles: Selection,
    /// Force on each \[N\].
    pub(in crate::scene::file) force: Triple,
}

/// `[domain]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct DomainTable {
    /// Its corners \[m\].
    #[serde(rename = "box")]
    pub(in crate::scene::file) corners: Corners,
    /// What happens to particles outside of it.
    pub(in crate::scene::file) outside: Option<Outside>,
}
