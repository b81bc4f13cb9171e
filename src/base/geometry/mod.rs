//! Geometry of single bodies (one at a time, not in lanes): orientations and rotation vectors.

mod frame;
pub mod orientation;
pub(crate) mod rotation;

pub(crate) use frame::Frame;
pub use orientation::Quaternion;
