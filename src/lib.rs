//! Particles with bonded and cohesive contacts, run alone or exported as FMI 2.0 co-simulation units.
//!
//! Data goes one way: scene file → [`scene::Scene`] → [`state::State`] and passes →
//! [`step::Simulation::advance`] → interface and outputs → unit and command line.

pub mod bond;
mod choices;
pub mod contact;
pub mod export;
pub mod interface;
pub mod memory;
pub mod number;
pub mod output;
pub mod quantity;
pub mod scene;
pub mod state;
pub mod step;
pub mod verify;
