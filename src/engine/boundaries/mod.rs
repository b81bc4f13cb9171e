//! Boundaries during a time step: their motion, prescribed or as rigid bodies that forces move; and the loads on them.

pub(crate) mod course;
pub(crate) mod loads;
pub(crate) mod nodes;
pub(crate) mod passing;
pub(crate) mod placing;
