//! Interactions: what particles, surfaces and bonds do to each other, pass by pass over the lists.

mod ahead;
mod batch;
pub(crate) mod bonds;
pub(crate) mod coefficients;
pub(crate) mod contacts;
mod listed;
mod pass;
mod records;
mod sphere_geometry;
pub(crate) mod suppression;
mod surface_history;
pub(crate) mod surfaces;
pub(crate) mod wall_bonds;
pub(crate) mod walls;

pub(crate) use ahead::{Ahead, FASTER, Kind, Link};
pub(crate) use batch::BatchLaw;
pub(crate) use coefficients::CoefficientTable;
pub(crate) use pass::Pass;
pub use records::{BondRecord, ContactRecord, PlacedSpring};
