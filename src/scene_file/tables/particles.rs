//! `[particles.<name>]`

use crate::import::{Format, Units};
use crate::packing::{LatticeTable, PackingTable};
use crate::quantity::{Positive, Triple};
use serde::Deserialize;
use std::collections::BTreeMap;

/// `[particles.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene_file) struct ParticlesTable {
    /// Material of those that name none.
    pub(in crate::scene_file) material: Option<String>,
    /// Material of each type or material that the file names.
    #[serde(default)]
    pub(in crate::scene_file) materials: BTreeMap<String, String>,
    /// Density of those that have none of their own \[kg/m³\].
    pub(in crate::scene_file) density: Option<Positive>,
    /// Velocity of those that have none of their own \[m/s\].
    pub(in crate::scene_file) velocity: Option<Triple>,
    /// Angular velocity of those that have none of their own \[rad/s\].
    pub(in crate::scene_file) angular_velocity: Option<Triple>,
    /// The particles, one by one.
    pub(in crate::scene_file) list: Option<Vec<ListEntry>>,
    /// A file of particles.
    pub(in crate::scene_file) file: Option<String>,
    /// What the file is, where its name does not say.
    pub(in crate::scene_file) format: Option<Format>,
    /// The file's units.
    pub(in crate::scene_file) units: Option<Units>,
    /// The snapshot of a dump file; absent: the last.
    pub(in crate::scene_file) timestep: Option<u64>,
    /// A regular order.
    pub(in crate::scene_file) lattice: Option<LatticeTable>,
    /// A random packing.
    pub(in crate::scene_file) packing: Option<PackingTable>,
}

/// A particle in a list.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene_file) struct ListEntry {
    /// Position of the centre \[m\].
    pub(in crate::scene_file) position: Triple,
    /// Radius \[m\].
    pub(in crate::scene_file) radius: Positive,
    /// Its number.
    pub(in crate::scene_file) id: Option<u32>,
    /// Its material.
    pub(in crate::scene_file) material: Option<String>,
    /// Its density \[kg/m³\].
    pub(in crate::scene_file) density: Option<Positive>,
    /// Its velocity \[m/s\].
    pub(in crate::scene_file) velocity: Option<Triple>,
    /// Its angular velocity \[rad/s\].
    pub(in crate::scene_file) angular_velocity: Option<Triple>,
}
