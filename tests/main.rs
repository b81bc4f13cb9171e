//! The tests of the library from outside, as one program: each room is a subject.
//!
//! Tests that need a process of their own stand in programs of their own (`Cargo.toml`).

mod averages;
mod bodies;
mod bonds;
mod boundaries;
mod cell;
mod contacts;
mod energy;
mod exchange;
mod floors;
mod fluid;
mod heat;
mod physics;
mod scene;
mod state;
mod statics;
mod step;
mod support;
mod surfaces;
