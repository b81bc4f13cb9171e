//! Interactions: forces between particles and surfaces, pass by pass over the lists, and what all passes have in common.

mod ahead;
pub(crate) mod batches;
pub(crate) mod coefficients;
mod encounters;
pub(crate) mod followed;
mod listed;
mod pairs;
pub(crate) mod particles;
mod pass;
mod records;
pub(crate) mod suppression;
pub(crate) mod surfaces;

pub(crate) use ahead::{FASTER, Frame, Kind, Link, Meeting, SearchLimits};
pub(crate) use encounters::Encounters;
pub(crate) use listed::SLIGHT;
pub(crate) use pass::{Pass, Stiffness, SurfaceTouch, Telling};
pub use records::{BondRecord, ContactRecord, PlacedSpring};
