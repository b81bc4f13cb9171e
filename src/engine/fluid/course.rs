//! The velocity of the fluid in time.

use crate::engine::state::fluid::FluidState;
use crate::laws::motion::{InputCourse, Progress};
use crate::scene::{Fluid, Scene};

/// The fluid of a scene at time 0, if it has one.
pub(crate) fn begun(scene: &Scene) -> Option<FluidState> {
    let velocity = scene.fluid.as_ref()?.velocity.at_start();
    Some(FluidState { velocity, target: velocity, course: [velocity; 2], ..FluidState::default() })
}

/// Begins a communication step of this length \[s\]: a driven velocity now knows where it goes.
pub(crate) fn begin(fluid: Option<&mut FluidState>, interval: f64) {
    let Some(fluid) = fluid else { return };
    for axis in 0..3 {
        fluid.target[axis] += fluid.target_rate[axis] * interval;
    }
    fluid.course = [fluid.velocity, fluid.target];
    (fluid.target_rate, fluid.impulse) = ([0.0; 3], [0.0; 3]);
}

/// Ends a communication step after this time \[s\].
pub(crate) fn end(fluid: Option<&mut FluidState>, elapsed: f64) {
    if let Some(fluid) = fluid.filter(|_| elapsed > 0.0) {
        fluid.mean_drag = fluid.impulse.map(|part| part / elapsed);
    }
}

/// Brings the velocity to the end of a time step.
pub(crate) fn advance(fluid: &Fluid, state: &mut FluidState, progress: &Progress) {
    state.velocity = fluid.velocity.at(progress.time).unwrap_or_else(|| {
        let [start, end] = state.course;
        let left = if progress.is_last() { 0.0 } else { 1.0 - progress.share(InputCourse::Ramp) };
        [0, 1, 2].map(|axis| end[axis] + (start[axis] - end[axis]) * left)
    });
}

/// Takes the input of another state at the start: the velocity is there at once. Returns whether anything changed.
pub(crate) fn put(scene: &Scene, fluid: Option<&mut FluidState>, given: Option<&FluidState>) -> bool {
    let driven = scene.fluid.as_ref().is_some_and(|fluid| fluid.velocity.is_driven());
    let (Some(fluid), Some(given), true) = (fluid, given, driven) else { return false };
    let changed = fluid.velocity != given.target;
    (fluid.target, fluid.target_rate) = (given.target, given.target_rate);
    (fluid.velocity, fluid.course) = (given.target, [given.target; 2]);
    changed
}
