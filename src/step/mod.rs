//! One time step: the passes, in their order, over the state.

mod error;

pub use error::RunError;

use crate::quantity::BoundaryIndex;
use crate::scene::Scene;
use crate::state::State;
use std::sync::Arc;

/// A scene in motion: its state and the passes composed for it.
pub struct Simulation {
    /// What is simulated.
    scene: Arc<Scene>,
    /// Everything that changes.
    state: State,
}

impl Simulation {
    /// The scene at time 0, forces evaluated, springs and bonds unmoved.
    pub fn new(_scene: Arc<Scene>) -> Result<Self, RunError> {
        unreachable!("the engine is being built")
    }

    /// The scene in a state saved earlier. The state must be of this scene ([`State::from_bytes`] sees to it).
    pub fn resume(_scene: Arc<Scene>, _state: State) -> Self {
        unreachable!("the engine is being built")
    }

    /// Puts back a state of this simulation; it continues from there bit for bit.
    pub fn restore(&mut self, state: &State) {
        self.state.clone_from(state);
    }

    /// What is simulated.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Everything that changes, at the present time.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The present time \[s\].
    pub fn time(&self) -> f64 {
        self.state.clock.time
    }

    /// Where a driven axis (0 to 2) is to be at the end of the next interval \[m\].
    pub fn set_displacement(&mut self, boundary: BoundaryIndex, axis: usize, displacement: f64) {
        let boundary = &mut self.state.boundaries[boundary.index()];
        boundary.target[axis] = displacement;
        boundary.target_rate[axis] = 0.0;
    }

    /// The rate of that value over the next interval: it then ends at the value plus rate × interval \[m/s\].
    pub fn set_displacement_rate(&mut self, boundary: BoundaryIndex, axis: usize, rate: f64) {
        self.state.boundaries[boundary.index()].target_rate[axis] = rate;
    }

    /// Runs one communication step of `interval` \[s\]: driven axes arrive at its end.
    ///
    /// On an error the state is that of the last good time step, at [`Simulation::time`].
    pub fn advance(&mut self, _interval: f64) -> Result<(), RunError> {
        unreachable!("the engine is being built")
    }
}
