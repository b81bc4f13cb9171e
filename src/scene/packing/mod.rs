//! Particles that the program places itself: lattices and random packings.

mod dense;
pub(crate) mod generator;
mod keys;
mod lattice;
pub(crate) mod made;
pub(crate) mod overlaps;
mod radii;
mod random;
mod region;
mod relaxation;

pub(crate) use keys::{LatticeTable, PackingTable};
pub(crate) use lattice::lattice;
pub use made::Packings;
pub(crate) use random::packing;

use crate::base::memory;

/// Progress of a random packing; reported many times a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PackingProgress<'a> {
    /// Spheres are placed at free positions one after the other.
    Placing {
        /// The particle set.
        set: &'a str,
        /// How many have been placed.
        placed: usize,
        /// How many there are to be.
        count: usize,
    },
    /// Spheres are pushed apart.
    Pushing {
        /// The particle set.
        set: &'a str,
        /// Rounds of pushes so far.
        rounds: usize,
        /// Largest overlap over the smaller radius; below 1e-4 the packing is done.
        overlap: f64,
    },
}

/// Centre and radius \[m\].
pub(crate) type Sphere = ([f64; 3], f64);

/// How many spheres one set may have, so that a slip in a length does not fill the memory.
const MOST: usize = 50_000_000;

/// What was expected instead of so many spheres; nothing if there is memory for them.
pub(crate) fn too_many(count: f64) -> Option<String> {
    let room = memory::available().map_or(MOST, |free| MOST.min((free / memory::SPHERE) as usize));
    match room {
        _ if count > MOST as f64 => Some(format!("at most {MOST} spheres")),
        room if count > room as f64 => Some(format!("at most {room} spheres, for which there is memory")),
        _ => None,
    }
}
