//! Particles with bonded and cohesive contacts, run alone or exported as FMI 2.0 co-simulation units.
//!
//! Data flows in one direction: scene file → [`scene::Scene`] → [`state::State`] and passes →
//! [`step::Simulation::advance`] → interface and outputs → unit and command line.
//!
//! A sphere falls for a tenth of a second:
//!
//! ```
//! use cograin::scene::Scene;
//! use cograin::step::Simulation;
//! use std::sync::Arc;
//!
//! let text = r#"
//! gravity = [0.0, 0.0, -9.81]
//! [run]
//! step = 1.0e-4
//! [material.glass]
//! density = 2500.0
//! [particles.marble]
//! material = "glass"
//! list = [{ position = [0.0, 0.0, 1.0], radius = 0.01 }]
//! "#;
//! let scene: Scene = text.parse()?;
//! let mut simulation = Simulation::new(Arc::new(scene))?;
//! simulation.advance(0.1)?;
//! let height = simulation.state().particles.position[0][2];
//! assert!((height - (1.0 - 0.5 * 9.81 * 0.1 * 0.1)).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

pub mod averages;
mod batches;
pub mod bond;
mod bond_passes;
mod books;
mod boundaries;
mod coefficients;
pub mod contact;
mod document;
pub mod exchange;
pub mod export;
mod flow;
pub mod geometry;
mod import;
mod integration;
mod interactions;
pub mod interface;
pub mod lanes;
pub mod memory;
pub mod motion;
mod neighbours;
pub mod number;
mod packing;
mod parameters;
pub mod quantity;
pub mod region;
pub mod report;
pub mod results;
pub mod run;
mod run_error;
pub mod scene;
mod scene_file;
mod stability;
pub mod state;
pub mod statics;
pub mod step;
pub mod surface;
mod threads;
mod vtk_reader;
