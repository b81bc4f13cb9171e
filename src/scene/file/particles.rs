//! `[particles.<name>]`

use super::values::{Counts, Radii};
use crate::quantity::{Corners, Fraction, Positive, Triple};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::num::NonZeroU32;

/// `[particles.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct ParticlesTable {
    /// Material of those that name none.
    pub(in crate::scene) material: Option<String>,
    /// Material of each type or material that the file names.
    #[serde(default)]
    pub(in crate::scene) materials: BTreeMap<String, String>,
    /// Density of those that have none of their own \[kg/m³\].
    pub(in crate::scene) density: Option<Positive>,
    /// Velocity of those that have none of their own \[m/s\].
    pub(in crate::scene) velocity: Option<Triple>,
    /// Angular velocity of those that have none of their own \[rad/s\].
    pub(in crate::scene) angular_velocity: Option<Triple>,
    /// The particles, one by one.
    pub(in crate::scene) list: Option<Vec<ListEntry>>,
    /// A file of particles.
    pub(in crate::scene) file: Option<String>,
    /// What the file is, where its name does not say.
    pub(in crate::scene) format: Option<Format>,
    /// The file's units.
    pub(in crate::scene) units: Option<Units>,
    /// The snapshot of a dump file; absent: the last.
    pub(in crate::scene) timestep: Option<u64>,
    /// A regular order.
    pub(in crate::scene) lattice: Option<LatticeTable>,
    /// A random packing.
    pub(in crate::scene) packing: Option<PackingTable>,
}

/// `lattice = { kind, radius, ... }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct LatticeTable {
    /// Which order.
    pub(in crate::scene) kind: LatticeKind,
    /// Radius of each \[m\].
    pub(in crate::scene) radius: Positive,
    /// Distance of nearest centres \[m\]; absent: they touch.
    pub(in crate::scene) spacing: Option<Positive>,
    /// The box to fill \[m\].
    #[serde(rename = "box")]
    pub(in crate::scene) corners: Option<Corners>,
    /// Centre of the first, with counts \[m\].
    pub(in crate::scene) origin: Option<Triple>,
    /// Cells along each axis.
    pub(in crate::scene) counts: Option<Counts>,
}

/// Regular orders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::scene) enum LatticeKind {
    /// One sphere in a cubic cell.
    SimpleCubic,
    /// Two.
    BodyCentredCubic,
    /// Four: close packed.
    FaceCentredCubic,
    /// Four in a right-angled cell: the other close packing.
    HexagonalClosePacked,
}

/// `packing = { box or cylinder, count or solid_fraction, radius }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct PackingTable {
    /// The box that holds every sphere whole \[m\].
    #[serde(rename = "box")]
    pub(in crate::scene) corners: Option<Corners>,
    /// The cylinder that holds every sphere whole.
    pub(in crate::scene) cylinder: Option<CylinderTable>,
    /// How many.
    pub(in crate::scene) count: Option<NonZeroU32>,
    /// Volume of the spheres over that of the region; they are pushed apart until they fit.
    pub(in crate::scene) solid_fraction: Option<Fraction>,
    /// Radius, or least and largest \[m\].
    pub(in crate::scene) radius: Radii,
}

/// `cylinder = { from, to, radius }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct CylinderTable {
    /// Centre of one end \[m\].
    pub(in crate::scene) from: Triple,
    /// Centre of the other \[m\].
    pub(in crate::scene) to: Triple,
    /// Radius \[m\].
    pub(in crate::scene) radius: Positive,
}

/// Formats of particle files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::scene) enum Format {
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
pub(in crate::scene) enum Units {
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
    pub(in crate::scene) fn named(name: &str) -> Option<Self> {
        [("si", Self::Si), ("cgs", Self::Cgs), ("micro", Self::Micro), ("nano", Self::Nano)]
            .into_iter()
            .find_map(|(known, units)| (known == name).then_some(units))
    }

    /// Length \[m\], mass \[kg\] and time \[s\] of one.
    pub(in crate::scene) fn sizes(self) -> [f64; 3] {
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
pub(in crate::scene) struct ListEntry {
    /// Position of the centre \[m\].
    pub(in crate::scene) position: Triple,
    /// Radius \[m\].
    pub(in crate::scene) radius: Positive,
    /// Its number.
    pub(in crate::scene) id: Option<u32>,
    /// Its material.
    pub(in crate::scene) material: Option<String>,
    /// Its density \[kg/m³\].
    pub(in crate::scene) density: Option<Positive>,
    /// Its velocity \[m/s\].
    pub(in crate::scene) velocity: Option<Triple>,
    /// Its angular velocity \[rad/s\].
    pub(in crate::scene) angular_velocity: Option<Triple>,
}
