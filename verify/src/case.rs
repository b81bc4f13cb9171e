//! `case.json` as it is written.

use super::defaults::{cundall, none, off, on, one, overlap, plane, switch};
use super::error::VerifyError;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A case, as written; fields that only inform the reader are left out.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Case {
    /// Acceleration of gravity \[m/s²\].
    #[serde(default)]
    pub(super) gravity: [f64; 3],
    /// Time step \[s\].
    pub(super) dt: f64,
    /// Number of steps.
    pub(super) steps: u64,
    /// Steps between samples.
    #[serde(default = "one")]
    pub(super) sample_every: u64,
    /// Materials by type, from 1.
    pub(super) materials: Vec<Material>,
    /// Properties of pairs of types, square matrices; a number that has no types is kept as it is.
    #[serde(default)]
    pub(super) pair_properties: BTreeMap<String, serde_json::Value>,
    /// Numbers of the whole case.
    #[serde(default)]
    pub(super) scalar_properties: BTreeMap<String, f64>,
    /// The contact law.
    pub(super) model: Model,
    /// The spheres.
    pub(super) particles: Vec<Particle>,
    /// The planes.
    #[serde(default)]
    pub(super) walls: Vec<Wall>,
    /// Cundall damping.
    #[serde(default)]
    pub(super) global_damping: Option<GlobalDamping>,
    /// Constant forces.
    #[serde(default)]
    pub(super) external_forces: Vec<ExternalForce>,
    /// Particles that do not move by forces.
    #[serde(default)]
    pub(super) prescribed_motion: Vec<PrescribedMotion>,
    /// Whether heat flows while nothing moves.
    #[serde(default)]
    pub(super) frozen: bool,
    /// Particles that are held at a temperature.
    #[serde(default)]
    pub(super) held_temperatures: Vec<HeldTemperature>,
    /// What warms particles.
    #[serde(default)]
    pub(super) heat_sources: Vec<CaseHeatSource>,
    /// How far an independent integration of the same equations is from the samples.
    #[serde(default)]
    pub(super) reproducible: Reproducible,
    /// How far the other engine's own samples move when its inputs change by 1e-13, relative.
    #[serde(default, rename = "sensitivity_to_1e-13_input_perturbation")]
    pub(super) sensitivity: Option<Sensitivity>,
}

/// How well the trajectory of a case of bonds can be repeated.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Reproducible {
    /// Largest relative deviation from a sample to the next.
    pub(super) window_deviation: Option<f64>,
    /// The step to which a run from the start stays within 1e-9; beyond it rounding decides.
    pub(super) free_run_1e9_until_step: Option<u64>,
}

/// A material.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) struct Material {
    /// \[Pa\]
    pub(super) youngs_modulus: Option<f64>,
    /// \[1\]
    pub(super) poissons_ratio: Option<f64>,
    /// \[W/(m K)\]
    pub(super) conductivity: Option<f64>,
    /// \[J/(kg K)\]
    pub(super) specific_heat: Option<f64>,
    /// Young's modulus of the real bodies \[Pa\].
    pub(super) real_youngs_modulus: Option<f64>,
}

/// The sub-models and flags, in the words of the other engine.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Model {
    /// Normal sub-model.
    pub(super) normal: String,
    /// Tangential sub-model.
    #[serde(default = "off")]
    pub(super) tangential: String,
    /// Rolling sub-model.
    #[serde(default = "off")]
    pub(super) rolling_friction: String,
    /// Cohesion sub-model.
    #[serde(default = "off")]
    pub(super) cohesion: String,
    /// Whether slip is damped.
    #[serde(default = "on", deserialize_with = "switch")]
    pub(super) tangential_damping: bool,
    /// Whether damping is given whatever the masses.
    #[serde(default, deserialize_with = "switch")]
    pub(super) absolute_damping: bool,
    /// Whether damping follows the Stokes number.
    #[serde(default, deserialize_with = "switch")]
    pub(super) viscous: bool,
    /// Whether friction sees cohesion.
    #[serde(default, deserialize_with = "switch")]
    pub(super) tangential_reduce: bool,
    /// Whether an attractive normal force is cut off.
    #[serde(default, deserialize_with = "switch")]
    pub(super) limit_force: bool,
    /// Whether a rolling spring resists spin about the normal.
    #[serde(default, deserialize_with = "switch")]
    pub(super) torsion_torque: bool,
    /// Whether the adhesion stiffness of `edinburgh` is fixed.
    #[serde(default, deserialize_with = "switch")]
    pub(super) fix_kc: bool,
    /// What the damping of `jkr` and `dmt` follows.
    pub(super) damping: Option<String>,
    /// `lammps` where properties of unlike materials are mixed from those of like ones.
    #[serde(default = "none")]
    pub(super) mixing: String,
    /// `lammps` where slip has the arms of the undeformed spheres, otherwise `overlap`.
    #[serde(default = "overlap")]
    pub(super) arms: String,
    /// The combination in the old notation; informs the reader.
    #[serde(default, rename = "seed_style")]
    pub(super) _seed_style: Option<String>,
    /// Heat sub-model, by our name.
    pub(super) heat: Option<String>,
    /// The area of `overlap_area`, where it is not that of intersection.
    pub(super) heat_area: Option<Conducted>,
    /// Flags that are not known here.
    #[serde(flatten)]
    pub(super) others: BTreeMap<String, serde_json::Value>,
}

/// An area: a number \[m²\], or the name of one.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum Conducted {
    /// As given.
    Given(f64),
    /// `projection`
    Named(String),
}

/// Particles that are held at a temperature.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct HeldTemperature {
    /// These.
    pub(super) ids: Vec<u32>,
    /// \[K\]
    pub(super) temperature: f64,
}

/// What warms particles.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct CaseHeatSource {
    /// These.
    pub(super) ids: Vec<u32>,
    /// Heat flow into each \[W\].
    #[serde(default)]
    pub(super) power: f64,
    /// Temperature of the surroundings \[K\] and conductance to each \[W/K\].
    pub(super) ambient: Option<[f64; 2]>,
}

/// A sphere.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) struct Particle {
    /// Its number.
    pub(super) id: u32,
    /// Its material, from 1.
    #[serde(rename = "type")]
    pub(super) kind: usize,
    /// \[m\]
    pub(super) radius: f64,
    /// \[kg/m³\]
    pub(super) density: f64,
    /// \[m\]
    pub(super) position: [f64; 3],
    /// \[m/s\]
    #[serde(default)]
    pub(super) velocity: [f64; 3],
    /// \[rad/s\]
    #[serde(default)]
    pub(super) omega: [f64; 3],
    /// \[K\]
    pub(super) temperature: Option<f64>,
}

/// An axis: by its name, or a direction along it.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum Axis {
    /// `"x"`, `"y"` or `"z"`
    Name(String),
    /// Any.
    Direction([f64; 3]),
}

/// A motion of a wall.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub(super) enum WallMotion {
    /// At constant velocity.
    Linear {
        /// \[m/s\]
        velocity: [f64; 3],
    },
    /// About an axis, as the right hand does.
    Rotate {
        /// A point on it \[m\].
        point: [f64; 3],
        /// Its direction.
        axis: [f64; 3],
        /// Time of a turn \[s\].
        period: f64,
    },
}

/// A wall.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Wall {
    /// What it is.
    #[serde(default = "plane")]
    pub(super) kind: String,
    /// A point on it \[m\].
    pub(super) point: Option<[f64; 3]>,
    /// The axis that a plane stands across, instead of a point; the direction of a cylinder's.
    pub(super) axis: Option<Axis>,
    /// Where on that axis \[m\].
    pub(super) position: Option<f64>,
    /// Normal of a plane, towards the particles.
    #[serde(default)]
    pub(super) normal: [f64; 3],
    /// Radius of a cylinder \[m\].
    pub(super) radius: Option<f64>,
    /// File of a mesh, beside the case.
    pub(super) file: Option<String>,
    /// Files of other meshes that are one surface with it.
    #[serde(default)]
    pub(super) joined_with: Vec<String>,
    /// How it moves.
    pub(super) motion: Option<WallMotion>,
    /// Temperature at which it is held \[K\].
    pub(super) temperature: Option<f64>,
    /// Its material, from 1.
    #[serde(rename = "type")]
    pub(super) material: usize,
}

/// Cundall damping.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct GlobalDamping {
    /// Its kind.
    #[serde(rename = "type", default = "cundall")]
    pub(super) kind: String,
    /// Fraction of the force.
    pub(super) gamma_l: f64,
    /// Fraction of the torque.
    pub(super) gamma_a: f64,
    /// What both are scaled by.
    #[serde(default)]
    pub(super) scale: Option<Scale>,
    /// Whether gravity is damped.
    pub(super) gravity_damped: Option<bool>,
    /// Whether constant forces are damped.
    pub(super) external_forces_damped: Option<bool>,
}

/// What damping is scaled by.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Scale {
    /// `type` or `variable`.
    pub(super) kind: String,
    /// By type: the factors; types that are not named have 1.
    #[serde(default)]
    pub(super) values: BTreeMap<String, f64>,
    /// By variable: the factor is the radius over this \[m\].
    pub(super) divisor: Option<f64>,
}

/// A constant force on some particles.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct ExternalForce {
    /// On these.
    pub(super) ids: Vec<u32>,
    /// On each \[N\].
    pub(super) force: [f64; 3],
}

/// A constant velocity of some particles.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct PrescribedMotion {
    /// Of these.
    pub(super) ids: Vec<u32>,
    /// `constant_velocity`
    pub(super) kind: String,
    /// \[m/s\]
    pub(super) velocity: [f64; 3],
}

/// Relative change of each quantity.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Sensitivity {
    /// Of position.
    pub(super) position: f64,
    /// Of velocity.
    pub(super) velocity: f64,
    /// Of angular velocity.
    pub(super) omega: f64,
    /// Of force.
    pub(super) force: f64,
    /// Of torque.
    pub(super) torque: f64,
}

impl Sensitivity {
    /// In the order of the columns.
    pub(super) fn to_array(self) -> [f64; 5] {
        [self.position, self.velocity, self.omega, self.force, self.torque]
    }
}

impl Case {
    /// Reads a case.
    pub(super) fn read(path: &Path) -> Result<Self, VerifyError> {
        let text = fs::read_to_string(path).map_err(|cause| VerifyError::file(path, &cause))?;
        serde_json::from_str(&text).map_err(|cause| VerifyError::Case {
            path: path.to_path_buf(),
            place: format!("line {}", cause.line()),
            message: cause.to_string(),
        })
    }

    /// Whether it has bonds.
    pub(super) fn bonds(&self) -> bool {
        self.model.cohesion == "bond"
    }

    /// Indices of the particles, by ascending id: the order that a scene has.
    pub(super) fn by_id(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.particles.len()).collect();
        order.sort_by_key(|index| self.particles[*index].id);
        order
    }
}
