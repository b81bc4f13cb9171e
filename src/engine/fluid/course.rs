//! The velocity of the fluid and the gradient of its pressure in time.

use super::porosity::LEAST;
use crate::engine::state::FluidState;
use crate::engine::state::fluid::{Coming, Course, EXCHANGED};
use crate::laws::motion::{InputCourse, Progress};
use crate::scene::{Fluid, Scene};

/// The fluid of a scene at time 0, if it has one, with cells that are empty.
pub(crate) fn begun(scene: &Scene) -> Option<FluidState> {
    let fluid = scene.fluid.as_ref()?;
    let cells = fluid.cells(&scene.grids);
    let mut velocity = Course::at_rest(cells, fluid.velocity.at_start());
    let rows = if fluid.pressure.is_some() { EXCHANGED } else { 1 };
    let porosity = fluid.porosity.unwrap_or(1.0).max(LEAST);
    velocity.now.iter_mut().for_each(|row| row[3] = porosity);
    Some(FluidState {
        velocity,
        pressure_gradient: fluid
            .gradient_at_start(scene.gravity)
            .map_or_else(Course::default, |gradient| Course::at_rest(cells, gradient)),
        porosity: vec![1.0; if fluid.grid.is_some() { cells } else { 0 }],
        temperature: fluid
            .heat
            .map_or_else(Course::default, |heat| Course::at_rest(cells, [heat.temperature, 0.0, 0.0])),
        heat: vec![[0.0; 4]; if fluid.heat.is_some() { cells } else { 0 }],
        mean_heat: vec![[0.0; 4]; if fluid.heat.is_some() { cells } else { 0 }],
        acceleration: vec![[0.0; 4]; if fluid.added_mass.is_some() { cells } else { 0 }],
        exchanged: vec![[0.0; 4]; rows * cells],
        mean: vec![[0.0; 4]; rows * cells],
        coming: Coming { rows: vec![[0.0; 4]; rows * cells], ..Coming::default() },
        ..FluidState::default()
    })
}

/// Begins a communication step of this length \[s\]: what is driven now knows where it goes.
pub(crate) fn begin(fluid: Option<&mut FluidState>, interval: f64) {
    let Some(fluid) = fluid else { return };
    fluid.velocity.begin(interval);
    fluid.pressure_gradient.begin(interval);
    fluid.temperature.begin(interval);
    fluid.exchanged.fill([0.0; 4]);
    fluid.heat.fill([0.0; 4]);
}

/// Ends a communication step after this time \[s\].
pub(crate) fn end(fluid: Option<&mut FluidState>, elapsed: f64) {
    if let Some(fluid) = fluid.filter(|_| elapsed > 0.0) {
        let means = fluid.mean.iter_mut().chain(&mut fluid.mean_heat);
        for (mean, sum) in means.zip(fluid.exchanged.iter().chain(&fluid.heat)) {
            *mean = sum.map(|part| part / elapsed);
        }
    }
}

/// Brings velocity and gradient to the end of a time step. The velocity goes on a ramp; the gradient is that of its input throughout a
/// communication step, as its mean is what continuity demands of that step.
pub(crate) fn advance(fluid: &Fluid, state: &mut FluidState, progress: &Progress) {
    let left = || if progress.is_last() { 0.0 } else { 1.0 - progress.share(InputCourse::Ramp) };
    if fluid.velocity.is_driven() {
        state.velocity.advance(left());
    } else if fluid.velocity.changes() {
        state.velocity.fill(fluid.velocity.at(progress.time).unwrap_or_default());
    }
    if fluid.pressure.is_some() {
        state.pressure_gradient.advance(0.0);
    }
    if fluid.heat.is_some_and(|heat| heat.is_driven) {
        state.temperature.advance(left());
    }
}

/// Takes the inputs of another state at the start: all is there at once. Returns whether anything changed.
pub(crate) fn put(scene: &Scene, fluid: Option<&mut FluidState>, given: Option<&FluidState>) -> bool {
    let driven = scene.fluid.as_ref().is_some_and(|fluid| fluid.velocity.is_driven());
    let (Some(fluid), Some(given)) = (fluid, given) else { return false };
    let pushed = fluid.pressure_gradient.put(&given.pressure_gradient);
    let warmed = fluid.temperature.put(&given.temperature);
    (driven && fluid.velocity.put(&given.velocity)) || pushed || warmed
}
