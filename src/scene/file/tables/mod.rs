//! The scene as it is written: one type for each table, single values checked as they are read.

mod body;
mod boundary;
#[cfg(test)]
mod documented;
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

use crate::base::document::keys;
use crate::base::quantity::{Fraction, NonNegative, PoissonsRatio, Positive, Safety};
use crate::laws::contact::{Properties, Scheme};
use crate::scene::exchange::Outside;
use crate::scene::{Accuracy, MotionPlane, ParticleShape};
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

keys! {
    /// `[run]`
    #[derive(Debug, Default)]
    pub(in crate::scene::file) struct RunTable {
        /// End of `cograin run`, and stop time of the unit's default experiment \[s\].
        pub(in crate::scene::file) end: Option<Positive> = "none",
        /// Longest time step \[s\], > 0; `"auto"`: the longest with this `accuracy`.
        pub(in crate::scene::file) step: Option<StepKey> = "`\"auto\"`",
        /// A fixed fraction of the stable step instead.
        pub(in crate::scene::file) safety: Option<Safety> = "none",
        /// The largest mean error of restitution, and of amplitudes of bonded bodies, that the automatic step allows
        /// ([stability.md](stability.md#the-step-that-follows-the-moment)), > 0 and < 1; `"standard"`: 0.01; `"high"`: 0.001, and the
        /// scheme `predicted`.
        pub(in crate::scene::file) accuracy: Option<Accuracy> = "`\"standard\"`",
        /// How springs and dashpots are integrated in time ([physics.md](physics.md), section 7): `"engine"`, as LIGGGHTS and LAMMPS
        /// do; `"predicted_normal"`, dashpots along the normal of second order; `"midway"`, springs of second order;
        /// `"predicted"`, springs and dashpots of second order.
        pub(in crate::scene::file) scheme: Option<Scheme> = "`\"predicted_normal\"`; `\"predicted\"` with `accuracy = \"high\"`",
        /// Whether a given step above the stable one runs on ([stability.md](stability.md)).
        pub(in crate::scene::file) allow_unstable: Option<bool> = "`false`",
        /// Whether a given step above the stable one stops the run instead of being divided; not with `allow_unstable`.
        pub(in crate::scene::file) strict_step: Option<bool> = "`false`; `true` beside bonds that need the very step",
        /// Number of threads, of which one works on fewer than 2000 particles; results do not depend on it.
        pub(in crate::scene::file) threads: Option<NonZeroU32> = "those of the machine",
        /// Seed of everything random (ChaCha8), 0 to 18446744073709551615.
        pub(in crate::scene::file) seed: Option<u64> = "1",
        /// Distance beyond touch up to which neighbours are searched \[m\].
        pub(in crate::scene::file) skin: Option<Positive> = "a tenth of the mean radius at first, then by motion and near pairs",
        /// Unbalanced force over the mean contact force (bond force, if nothing touches) at which `cograin settle` is done.
        pub(in crate::scene::file) settle_tolerance: Option<Positive> = "1e-4",
        /// Cundall damping that `cograin settle` adds to particles without any.
        pub(in crate::scene::file) settle_damping: Option<Fraction> = "0.2; 0.7 with bonds",
        /// Largest overlap accepted at the start, over the smaller radius.
        pub(in crate::scene::file) max_overlap: Option<NonNegative> = "0.05",
        /// The plane in which all particles stay, see below: `"xz"`.
        pub(in crate::scene::file) plane: Option<MotionPlane> = "three dimensions",
        /// `"spheres"`, or `"discs"` 1 m thick (mass πr²ρ · 1 m, moment of inertia ½mr²).
        pub(in crate::scene::file) plane_particles: Option<ParticleShape> = "`\"spheres\"`",
        /// Whether [derivatives](fmu.md#derivatives) are differences of both sides.
        pub(in crate::scene::file) central_derivatives: Option<bool> = "`false`",
        /// How far derivatives displace inputs, over what the program chooses.
        pub(in crate::scene::file) derivative_displacement: Option<Positive> = "1",
    }
}

keys! {
    /// `[material.<name>]`
    #[derive(Debug)]
    pub(in crate::scene::file) struct MaterialTable {
        /// Density of particles that have none of their own \[kg/m³\].
        pub(in crate::scene::file) density: Positive = "required",
        /// Young's modulus E \[Pa\].
        pub(in crate::scene::file) youngs_modulus: Option<Positive> = "not needed if no law uses it",
        /// Poisson's ratio ν.
        pub(in crate::scene::file) poissons_ratio: Option<PoissonsRatio> = "not needed if no law uses it",
        /// Conductivity k \[W/(m K)\].
        pub(in crate::scene::file) conductivity: Option<Positive> = "not needed if no heat model uses it",
        /// Specific heat c \[J/(kg K)\].
        pub(in crate::scene::file) specific_heat: Option<Positive> = "not needed where no heat flows",
        /// Young's modulus of the real bodies, whose area of contact conducts \[Pa\].
        pub(in crate::scene::file) real_youngs_modulus: Option<Positive> = "that of the springs",
    } beside {
        /// Properties that laws declare.
        #[serde(skip)]
        pub(in crate::scene::file) properties: Properties,
    }
}

keys! {
    /// `[contact.<name>]`, without its sub-models.
    #[derive(Debug)]
    pub(in crate::scene::file) struct ContactTable {
        /// `["a", "b"]` or a list of such pairs of materials.
        pub(in crate::scene::file) between: Option<MaterialPairs> = "all materials",
        /// Whether the normal force (without cohesion) is limited so that it never pulls.
        #[serde(default)]
        pub(in crate::scene::file) limit_force: bool = "`false`",
        /// Whether the tangential dashpot acts.
        pub(in crate::scene::file) tangential_damping: Option<bool> = "`true`",
    } beside {
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
}

keys! {
    /// `[damping.<name>]`
    #[derive(Debug)]
    pub(in crate::scene::file) struct DampingTable {
        /// A choice of particles.
        pub(in crate::scene::file) particles: Option<Selection> = "all, those that come later included",
        /// Fraction of the unbalanced force.
        pub(in crate::scene::file) linear: Fraction = "required",
        /// Fraction of the unbalanced torque.
        pub(in crate::scene::file) angular: Fraction = "required",
        /// A factor on both, particle by particle, see below.
        pub(in crate::scene::file) scale: Option<ScaleTable> = "1",
        /// Whether gravity is part of the damped force.
        pub(in crate::scene::file) gravity_damped: Option<bool> = "required if there is gravity",
        /// Whether applied forces are part of it.
        pub(in crate::scene::file) applied_forces_damped: Option<bool> = "required if there is a `[force]`",
    }
}

keys! {
    /// `scale` of a damping: one of these.
    #[derive(Clone, Debug)]
    pub(in crate::scene::file) struct ScaleTable {
        /// A factor for each material, 1 for those not named: `{ steel = 0.5 }`.
        pub(in crate::scene::file) material: Option<BTreeMap<String, NonNegative>> = "one of these",
        /// The factor is the radius over this length \[m\].
        pub(in crate::scene::file) radius_divisor: Option<Positive> = "one of these",
        /// Name of a column of the sets' files.
        pub(in crate::scene::file) column: Option<String> = "one of these",
    }
}

keys! {
    /// `[force.<name>]`
    #[derive(Debug)]
    pub(in crate::scene::file) struct ForceTable {
        /// A choice of particles.
        pub(in crate::scene::file) particles: Selection = "required",
        /// Force on each of them, `[x, y, z]` \[N\].
        pub(in crate::scene::file) force: Triple = "required",
    }
}

keys! {
    /// `[domain]`
    #[derive(Debug)]
    pub(in crate::scene::file) struct DomainTable {
        /// Lower and upper corner \[m\].
        pub(in crate::scene::file) r#box: Corners = "required",
        /// What happens to a particle outside: `"stop"` refuses the scene or stops the run; `"remove"` takes it away, as an outlet does.
        pub(in crate::scene::file) outside: Option<Outside> = "`\"stop\"`",
    }
}
