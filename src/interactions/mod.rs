//! Interactions: forces between particles and surfaces, pass by pass over the lists, and what all passes have in common.

mod ahead;
pub(crate) mod contacts;
mod listed;
mod pairs;
mod pass;
mod records;
pub(crate) mod suppression;
pub(crate) mod surfaces;

pub(crate) use ahead::{Ahead, FASTER, Kind, Link};
pub(crate) use listed::SLIGHT;
pub(crate) use pass::Pass;
pub use records::{BondRecord, ContactRecord, PlacedSpring};
