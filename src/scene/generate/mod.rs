//! Particles that no file lists: lattices and random packings.

mod dense;
mod lattice;
mod packing;
mod region;

pub(super) use lattice::lattice;
pub(super) use packing::packing;

/// Centre and radius \[m\].
pub(super) type Sphere = ([f64; 3], f64);

/// How many spheres one set may have, so that a slip in a length does not fill the memory.
const MOST: usize = 50_000_000;
