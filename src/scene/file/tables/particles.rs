//! `[particles.<name>]`

use crate::base::document::keys;
use crate::base::quantity::{Positive, Triple};
use crate::scene::clump::OrientationKey;
use crate::scene::import::{Format, Units};
use crate::scene::packing::{LatticeTable, PackingTable};
use std::collections::BTreeMap;

keys! {
    /// `[particles.<name>]`
    #[derive(Debug)]
    pub(in crate::scene::file) struct ParticlesTable {
        /// Material of particles that name none of their own.
        pub(in crate::scene::file) material: Option<String> = "none",
        /// The same of density \[kg/m³\].
        pub(in crate::scene::file) density: Option<Positive> = "that of the material",
        /// The same of velocity \[m/s\].
        pub(in crate::scene::file) velocity: Option<Triple> = "`[0, 0, 0]`",
        /// The same of angular velocity \[rad/s\].
        pub(in crate::scene::file) angular_velocity: Option<Triple> = "`[0, 0, 0]`",
        /// The [clump](#clumpname) that each of them is.
        pub(in crate::scene::file) clump: Option<String> = "spheres",
        /// How clumps are turned that have no orientation of their own.
        pub(in crate::scene::file) orientation: Option<OrientationKey> = "`[1, 0, 0, 0]`",
        /// The particles, one by one.
        pub(in crate::scene::file) list: Option<Vec<ListEntry>> = "one of four",
        /// A file with particles; paths count from the folder of the scene.
        pub(in crate::scene::file) file: Option<String> = "one of four",
        /// Format of the file: `csv`, `vtu`, `data`, `dump`.
        pub(in crate::scene::file) format: Option<Format> = "by the name of the file",
        /// Units of the file: `si`, `cgs`, `micro`, `nano`.
        pub(in crate::scene::file) units: Option<Units> = "see below",
        /// Which snapshot of a dump.
        pub(in crate::scene::file) timestep: Option<u64> = "the last",
        /// Material of each type or name in the file: `{ 1 = "glass" }`.
        #[serde(default)]
        pub(in crate::scene::file) materials: BTreeMap<String, String> = "names as they are",
        /// A regular arrangement of spheres.
        pub(in crate::scene::file) lattice: Option<LatticeTable> = "one of four",
        /// A random packing.
        pub(in crate::scene::file) packing: Option<PackingTable> = "one of four",
    } beside {
        /// What it says of declared columns, each read by its name.
        #[serde(skip)]
        pub(in crate::scene::file) columns: BTreeMap<&'static str, WrittenColumn>,
    }
}

/// What a table says of a declared column.
#[derive(Debug, Default)]
pub(in crate::scene::file) struct WrittenColumn {
    /// Value of those that have none of their own.
    pub(in crate::scene::file) all: Option<f64>,
    /// Value of each particle of the list that has its own.
    pub(in crate::scene::file) listed: Vec<Option<f64>>,
}

keys! {
    /// A particle in a list.
    #[derive(Clone, Debug)]
    pub(in crate::scene::file) struct ListEntry {
        /// Position of the centre, of clumps of the mass centre \[m\].
        pub(in crate::scene::file) position: Triple = "required",
        /// Radius, of clumps that of the bounding sphere about the mass centre \[m\].
        pub(in crate::scene::file) radius: Option<Positive> = "required but for clumps",
        /// All lengths of a clump over those of its table.
        pub(in crate::scene::file) scale: Option<Positive> = "1",
        /// How a clump is turned.
        pub(in crate::scene::file) orientation: Option<OrientationKey> = "that of the set",
        /// Its number, 0 to 4294967295.
        pub(in crate::scene::file) id: Option<u32> = "the next",
        /// Its material.
        pub(in crate::scene::file) material: Option<String> = "that of the set",
        /// Its density \[kg/m³\].
        pub(in crate::scene::file) density: Option<Positive> = "that of the set",
        /// Its velocity \[m/s\].
        pub(in crate::scene::file) velocity: Option<Triple> = "that of the set",
        /// Its angular velocity \[rad/s\].
        pub(in crate::scene::file) angular_velocity: Option<Triple> = "that of the set",
    }
}
