//! What is scalar in space: orientations and rotation vectors.

mod frame;
pub mod orientation;
pub(crate) mod rotation;

pub(crate) use frame::Frame;
pub use orientation::Quaternion;
