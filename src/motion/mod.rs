//! How boundaries move: courses that are given, and rigid bodies that forces move.

pub(crate) mod course;
pub(crate) mod rigid_body;

pub(crate) use course::Progress;
pub(crate) use rigid_body::{RigidBody, Turning};
