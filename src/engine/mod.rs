//! The state, and how a time step changes it.

pub mod averages;
pub(crate) mod bodies;
pub(crate) mod bonds;
pub(crate) mod boundaries;
pub(crate) mod cell;
pub(crate) mod columns;
pub(crate) mod contacts;
pub(crate) mod energy;
pub(crate) mod flow;
pub(crate) mod fluid;
pub(crate) mod integration;
pub(crate) mod neighbours;
pub(crate) mod run_error;
pub mod simulation;
pub(crate) mod stability;
pub mod state;
pub mod statics;
pub(crate) mod traces;
pub(crate) mod transfer;
