//! What is scalar in space: orientations and rotation vectors.

pub mod orientation;
pub(crate) mod rotation;

pub use orientation::Quaternion;
