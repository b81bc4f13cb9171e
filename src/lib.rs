//! Particles with bonded and cohesive contacts, run alone or exported as FMI 2.0 co-simulation units.
//!
//! Data flows in one direction: scene file → [`scene::Scene`] → [`state::State`] and passes →
//! [`simulation::Simulation::advance`] → interface and outputs → unit and command line.
//!
//! The source has six floors, and each uses those below it only: `base`, `laws`, `scene`, `engine`, `interface`, `output`. What this
//! page names is all that other crates are promised.
//!
//! A sphere falls for a tenth of a second:
//!
//! ```
//! use cograin::scene::Scene;
//! use cograin::simulation::Simulation;
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

mod base;
mod engine;
pub mod interface;
mod laws;
mod output;
pub mod scene;

pub use base::{geometry, lanes, memory, number, powers, quantity, words};
pub use engine::{averages, simulation, state, statics};
pub use laws::{bond, column, contact, convection, drag, lift, motion, region, surface, wear};
pub use output::{export, report, results, run};
pub use scene::exchange;
