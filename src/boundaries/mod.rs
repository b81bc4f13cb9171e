//! How boundaries go through a time step: led by their motion, or as rigid bodies that forces move; and what they feel.

pub(crate) mod course;
pub(crate) mod felt;
pub(crate) mod implicit;
mod inertia;
pub(crate) mod placing;
pub(crate) mod rigid_body;

pub(crate) use inertia::sphere_inertia;
pub(crate) use rigid_body::{RigidBody, Turning};
