//! A state that one simulation has reached, as the start of another.

use super::{RunError, Simulation, assemble};
use crate::scene::{AxisMotion, Scene};
use crate::state::{BoundaryState, State};
use std::sync::Arc;

impl Simulation {
    /// The scene at time 0 with particles, contacts, springs and bonds as in a state that was reached before:
    /// boundaries stand where the scene has them, along free axes where they have come to; every count and book begins
    /// anew, forces are evaluated.
    pub fn settled(scene: Arc<Scene>, reached: State) -> Result<Self, RunError> {
        let State { particles, mut neighbours, contacts, hidden, walls, mut bonds, .. } = reached;
        neighbours.made_at = 0;
        for list in &mut bonds {
            (list.made, list.broken) = (list.first.len() as u64, 0);
            (list.relaxed, list.released) = (0.0, 0.0);
        }
        let mut state = State { particles, neighbours, contacts, hidden, walls, bonds, ..assemble::state(&scene) };
        for ((boundary, begun), ended) in scene.boundaries.iter().zip(&mut state.boundaries).zip(&reached.boundaries) {
            stay(&boundary.axes, begun, ended);
        }
        let mut simulation = Self::resume(scene, state);
        simulation.state.clock.speed = reached.clock.speed;
        simulation.start()?;
        Ok(simulation)
    }
}

/// Leaves the free axes of a boundary where they have come to, and as fast as they are.
fn stay(axes: &[AxisMotion; 6], begun: &mut BoundaryState, ended: &BoundaryState) {
    let is_free = |axis: usize| axes[axis].is_free();
    for axis in (0..3).filter(|&axis| is_free(axis)) {
        begun.displacement[axis] = ended.displacement[axis];
        begun.velocity[axis] = ended.velocity[axis];
        begun.pivot[axis] = ended.pivot[axis];
    }
    if (3..6).any(is_free) {
        begun.rotation = ended.rotation;
        begun.angular_velocity = ended.angular_velocity;
        begun.attitude = ended.attitude;
        begun.start_attitude = ended.attitude;
        begun.inertial.angular_momentum = ended.inertial.angular_momentum;
    }
}
