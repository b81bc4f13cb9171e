//! `[particles.<name>]`

use crate::base::quantity::{Positive, Triple};
use crate::scene::clump::OrientationKey;
use crate::scene::import::{Format, Units};
use crate::scene::packing::{LatticeTable, PackingTable};
use serde::Deserialize;
use std::collections::BTreeMap;

/// `[particles.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct ParticlesTable {
    /// What it says of declared columns, each read by its name.
    #[serde(skip)]
    pub(in crate::scene::file) columns: BTreeMap<&'static str, WrittenColumn>,
    /// Material of those that name none.
    pub(in crate::scene::file) material: Option<String>,
    /// Material of each type or material that the file names.
    #[serde(default)]
    pub(in crate::scene::file) materials: BTreeMap<String, String>,
    /// Density of those that have none of their own \[kg/m³\].
    pub(in crate::scene::file) density: Option<Positive>,
    /// Velocity of those that have none of their own \[m/s\].
    pub(in crate::scene::file) velocity: Option<Triple>,
    /// Angular velocity of those that have none of their own \[rad/s\].
    pub(in crate::scene::file) angular_velocity: Option<Triple>,
    /// The clump that each of them is; absent: spheres.
    pub(in crate::scene::file) clump: Option<String>,
    /// How the clumps are turned that have no orientation of their own.
    pub(in crate::scene::file) orientation: Option<OrientationKey>,
    /// The particles, one by one.
    pub(in crate::scene::file) list: Option<Vec<ListEntry>>,
    /// A file of particles.
    pub(in crate::scene::file) file: Option<String>,
    /// What the file is, where its name does not say.
    pub(in crate::scene::file) format: Option<Format>,
    /// The file's units.
    pub(in crate::scene::file) units: Option<Units>,
    /// The snapshot of a dump file; absent: the last.
    pub(in crate::scene::file) timestep: Option<u64>,
    /// A regular order.
    pub(in crate::scene::file) lattice: Option<LatticeTable>,
    /// A random packing.
    pub(in crate::scene::file) packing: Option<PackingTable>,
}

/// What a table says of a declared column.
#[derive(Debug, Default)]
pub(in crate::scene::file) struct WrittenColumn {
    /// Value of those that have none of their own.
    pub(in crate::scene::file) all: Option<f64>,
    /// Value of each particle of the list that has its own.
    pub(in crate::scene::file) listed: Vec<Option<f64>>,
}

/// A particle in a list.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct ListEntry {
    /// Position of the centre, of clumps of the mass centre \[m\].
    pub(in crate::scene::file) position: Triple,
    /// Radius, of clumps that of the bounding sphere about the mass centre \[m\].
    pub(in crate::scene::file) radius: Option<Positive>,
    /// All lengths of a clump over those of its table.
    pub(in crate::scene::file) scale: Option<Positive>,
    /// How a clump is turned.
    pub(in crate::scene::file) orientation: Option<OrientationKey>,
    /// Its number.
    pub(in crate::scene::file) id: Option<u32>,
    /// Its material.
    pub(in crate::scene::file) material: Option<String>,
    /// Its density \[kg/m³\].
    pub(in crate::scene::file) density: Option<Positive>,
    /// Its velocity \[m/s\].
    pub(in crate::scene::file) velocity: Option<Triple>,
    /// Its angular velocity \[rad/s\].
    pub(in crate::scene::file) angular_velocity: Option<Triple>,
}
