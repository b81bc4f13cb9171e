//! Temperatures of boundaries: as they are given, or as they take up heat.

use crate::engine::state::Heat;
use crate::laws::motion::{InputCourse, Progress};
use crate::scene::{Boundary, BoundaryTemperature, Scene};

/// Whether heat flows into a boundary: it has a temperature, or its particles do.
pub(crate) fn takes_heat(boundary: &Boundary) -> bool {
    boundary.temperature != BoundaryTemperature::None || !boundary.shape.members().is_empty()
}

/// Begins a communication step of this length \[s\]: inputs now know where they go.
pub(crate) fn begin(heat: Option<&mut Heat>, interval: f64) {
    for boundary in heat.into_iter().flat_map(|heat| &mut heat.boundaries) {
        // A step that ended early left the temperature on its way.
        let arrived = boundary.rise == boundary.course[1] - boundary.initial;
        let from = if arrived { boundary.course[1] } else { boundary.temperature() };
        boundary.target += boundary.target_rate * interval;
        // A heat flow from the outside acts at once, a temperature is reached at the end.
        let start = if boundary.capacity > 0.0 { boundary.target - boundary.target_rate * interval } else { from };
        boundary.course = [start, boundary.target];
        boundary.target_rate = 0.0;
        boundary.before += std::mem::take(&mut boundary.present);
    }
}

/// Ends a communication step after this time \[s\].
pub(crate) fn end(heat: Option<&mut Heat>, elapsed: f64) {
    if elapsed > 0.0 {
        for boundary in heat.into_iter().flat_map(|heat| &mut heat.boundaries) {
            boundary.mean_flow = boundary.present / elapsed;
        }
    }
}

/// Brings temperatures to the end of a time step.
pub(super) fn advance(scene: &Scene, heat: &mut Heat, progress: &Progress) {
    for (boundary, moved) in scene.boundaries.iter().zip(&mut heat.boundaries) {
        let [start, end] = moved.course;
        let share = progress.share(InputCourse::Ramp);
        if moved.capacity > 0.0 {
            let middle = 0.5 * (progress.share_before(InputCourse::Ramp) + share);
            moved.applied += progress.step * (start + (end - start) * middle);
            moved.rise = (moved.heat() + moved.applied) / moved.capacity;
        } else if let BoundaryTemperature::Driven(_) = boundary.temperature {
            // Small differences are not to drown in the temperature.
            let left = if progress.is_last() { 0.0 } else { (start - end) * (1.0 - share) };
            moved.rise = (end - moved.initial) + left;
        }
    }
}

/// Takes the inputs of other boundaries at the start: a temperature is there at once. Returns whether anything changed.
pub(crate) fn put(scene: &Scene, heat: Option<&mut Heat>, given: Option<&Heat>) -> bool {
    let (Some(heat), Some(given)) = (heat, given) else { return false };
    let mut changed = false;
    for ((boundary, moved), given) in scene.boundaries.iter().zip(&mut heat.boundaries).zip(&given.boundaries) {
        changed |= moved.target != given.target;
        (moved.target, moved.target_rate) = (given.target, given.target_rate);
        moved.course = [moved.target; 2];
        if let BoundaryTemperature::Driven(_) = boundary.temperature {
            (moved.initial, moved.rise) = (moved.target, 0.0);
        }
    }
    changed
}
