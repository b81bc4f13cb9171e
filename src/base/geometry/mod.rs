//! Geometry of single bodies (one at a time, not in lanes): orientations and rotation vectors.

mod frame;
pub mod lattice;
pub mod orientation;
pub(crate) mod principal;
pub(crate) mod rotation;

pub(crate) use frame::Frame;
pub use lattice::Lattice;
pub use orientation::Quaternion;
