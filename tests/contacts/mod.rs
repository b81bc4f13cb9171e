//! Contacts: their laws, what laws of other crates bring, and what is told of single ones.

mod coefficients;
mod deepest;
pub(crate) mod every_law;
mod own_properties;
mod schemes;
mod told_forces;
mod traces;
