//! A cohesion sub-model in a crate of its own: liquid bridges between wet spheres.
//!
//! [`bridge`] is the law. This file adds it to the sub-models of the program and makes the library of units; `main.rs` is the
//! program, which checks, runs and exports scenes that name it (`scene.toml`).

pub mod bridge;

use cograin::scene::Models;

/// The sub-models of the program, and liquid bridges.
pub fn models() -> Models {
    Models::standard().with_cohesion::<bridge::LiquidBridge>()
}

cograin_unit::unit!(crate::models());
