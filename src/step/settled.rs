//! A state that one simulation has reached, as the start of another.

use super::{RunError, Simulation, assemble};
use crate::scene::Scene;
use crate::state::State;
use std::sync::Arc;

impl Simulation {
    /// The scene at time 0 with particles, contacts, springs and bonds as in a state that was reached before:
    /// boundaries stand where the scene has them, every count and book begins anew, forces are evaluated.
    pub fn settled(scene: Arc<Scene>, reached: State) -> Result<Self, RunError> {
        let State { particles, neighbours, contacts, walls, mut bonds, .. } = reached;
        for list in &mut bonds {
            (list.made, list.broken) = (list.first.len() as u64, 0);
            (list.relaxed, list.released) = (0.0, 0.0);
        }
        let state = State { particles, neighbours, contacts, walls, bonds, ..assemble::state(&scene) };
        let mut simulation = Self::resume(scene, state);
        simulation.state.clock.speed = reached.clock.speed;
        simulation.start()?;
        Ok(simulation)
    }
}
