//! The fluid around the particles.

use super::check::all_finite;
use super::in_place::clone_in_place;
use super::{StateFault, demand};
use serde::{Deserialize, Serialize};

/// How the fluid of a scene moves, and what it exchanged with the particles.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FluidState {
    /// Velocity at the present time \[m/s\].
    pub velocity: [f64; 3],
    /// The last input: velocity at the end of the communication step \[m/s\].
    pub target: [f64; 3],
    /// Its rate at the start of the communication step; 0 where none was given \[m/s²\].
    pub target_rate: [f64; 3],
    /// Velocity where the present communication step began, and what it is to be at its end \[m/s\].
    pub course: [[f64; 3]; 2],
    /// Length of the time step at whose end the present loads were found; 0 before the first \[s\].
    pub step: f64,
    /// Impulse of the drag of the particles on it in the present communication step \[N s\].
    pub impulse: [f64; 3],
    /// Drag of the particles on it, mean over the last communication step \[N\].
    pub mean_drag: [f64; 3],
    /// Work of the fluid since counting began: drag along its own velocity, and buoyancy along those of the particles \[J\].
    pub work: f64,
}

clone_in_place!(FluidState { velocity, target, target_rate, course, step, impulse, mean_drag, work });

impl FluidState {
    /// Counts from here.
    pub(super) fn begin_counting(&mut self) {
        self.work = 0.0;
    }

    /// Whether it can be one.
    pub(super) fn check(&self) -> Result<(), StateFault> {
        let Self { velocity, target, target_rate, course, step, impulse, mean_drag, work } = self;
        let [start, end] = course;
        [velocity, target, target_rate, start, end, impulse, mean_drag]
            .into_iter()
            .try_for_each(|numbers| all_finite(numbers, "fluid"))?;
        all_finite(&[*step, *work], "fluid")?;
        demand(*step >= 0.0, "fluid", 0, "a step of 0 or above")
    }
}
