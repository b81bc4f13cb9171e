//! How particles come and go, as a scene writes it: what comes, how much of it, polygons that are passed.
//!
//! Pure functions and keys. Who comes where and when is found in [`crate::engine::flow`].

mod keys;
mod kinds;
pub(crate) mod parts;
mod polygon;

pub use keys::{Amount, Outside};
pub(crate) use keys::{BeyondKeys, InsertionKeys, MeterKeys, OutletKeys};
pub(crate) use kinds::widest;
pub use kinds::{InsertedClump, Kind};
pub use polygon::Polygon;
