//! Particles with bonded and cohesive contacts, run alone or exported as FMI 2.0 co-simulation units.
//!
//! Data flows in one direction: scene file → [`scene::Scene`] → [`state::State`] and passes →
//! [`step::Simulation::advance`] → interface and outputs → unit and command line.

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
