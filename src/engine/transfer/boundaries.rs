//! Temperatures of boundaries: as they are given, or as they take up heat.

use crate::engine::state::Heat;
use crate::engine::state::heat::BoundaryHeat;
use crate::laws::motion::{InputCourse, Progress};
use crate::scene::{Boundary, BoundaryTemperature, Scene};

/// Whether heat flows into a boundary: it has a temperature, or its particles do.
pub(crate) fn takes_heat(boundary: &Boundary) -> bool {
    boundary.temperature != BoundaryTemperature::None || !boundary.shape.members().is_empty()
}

/// Begins a communication step of this length \[s\]: inputs now know where they go.
pub(crate) fn begin(heat: Option<&mut Heat>, interval: f64) {
    for boundary in heat.into_iter().flat_map(Heat::surfaces_mut) {
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
        for boundary in heat.into_iter().flat_map(Heat::surfaces_mut) {
            boundary.mean_flow = boundary.present / elapsed;
        }
    }
}

/// A time step on the way of inputs through a communication step.
#[derive(Clone, Copy)]
pub(super) struct Ramp {
    /// Its length \[s\].
    pub(super) step: f64,
    /// The share of the way at its beginning and at its end.
    shares: [f64; 2],
}

impl Ramp {
    /// A time step as the engine makes it.
    pub(super) fn of(progress: &Progress) -> Self {
        let end = if progress.is_last() { 1.0 } else { progress.share(InputCourse::Ramp) };
        Self { step: progress.step, shares: [progress.share_before(InputCourse::Ramp), end] }
    }

    /// One of so many equal parts of it, with so many before it.
    pub(super) fn part(&self, before: u64, parts: u64) -> Self {
        let [start, end] = self.shares;
        let at = |done: u64| if done == parts { end } else { start + (end - start) * (done as f64 / parts as f64) };
        Self { step: self.step / parts as f64, shares: [at(before), at(before + 1)] }
    }

    /// The share of the way at this share of the time step.
    fn share(&self, reached: f64) -> f64 {
        let [start, end] = self.shares;
        if reached == 1.0 { end } else { start + (end - start) * reached }
    }

    /// Heat from the outside into a boundary with a capacity from the beginning to this share of the time step \[J\].
    fn applied(&self, moved: &BoundaryHeat, reached: f64) -> f64 {
        let [start, end] = moved.course;
        self.step * reached * (start + (end - start) * (0.5 * (self.shares[0] + self.share(reached))))
    }

    /// By how much a boundary is warmer than when counting began at this share of the time step, of which the particles have given so much
    /// more \[J\] since its beginning \[K\].
    pub(super) fn rise(&self, is_driven: bool, moved: &BoundaryHeat, given: f64, reached: f64) -> f64 {
        let [start, end] = moved.course;
        if moved.capacity > 0.0 {
            (moved.heat() + given + (moved.applied + self.applied(moved, reached))) / moved.capacity
        } else if is_driven {
            // Small differences are not to drown in the temperature.
            (end - moved.initial) + (start - end) * (1.0 - self.share(reached))
        } else {
            moved.rise
        }
    }

    /// Brings the temperature of a boundary to the end of the time step.
    pub(super) fn advance(&self, is_driven: bool, moved: &mut BoundaryHeat) {
        moved.rise = self.rise(is_driven, moved, 0.0, 1.0);
        if moved.capacity > 0.0 {
            moved.applied += self.applied(moved, 1.0);
        }
    }
}

/// Whether the outside gives the temperature of a boundary.
pub(super) fn is_driven(boundary: &Boundary) -> bool {
    matches!(boundary.temperature, BoundaryTemperature::Driven(_))
}

/// Brings all temperatures to the end of a time step.
pub(super) fn advance(scene: &Scene, heat: &mut Heat, ramp: &Ramp) {
    let Heat { boundaries, nodes, .. } = heat;
    for (boundary, moved) in scene.boundaries.iter().zip(boundaries) {
        ramp.advance(is_driven(boundary), moved);
    }
    nodes.iter_mut().flat_map(|nodes| &mut nodes.each).for_each(|node| ramp.advance(true, node));
}

/// Takes the inputs of other boundaries and nodes at the start: a temperature is there at once. Returns whether anything changed.
pub(crate) fn put(scene: &Scene, heat: Option<&mut Heat>, given: Option<&Heat>) -> bool {
    let (Some(heat), Some(given)) = (heat, given) else { return false };
    let mut changed = false;
    let driven: Vec<bool> = scene.boundaries.iter().map(is_driven).collect();
    let driven = driven.into_iter().chain(std::iter::repeat(true));
    for ((is_driven, moved), given) in driven.zip(heat.surfaces_mut()).zip(given.surfaces()) {
        changed |= moved.target != given.target;
        (moved.target, moved.target_rate) = (given.target, given.target_rate);
        moved.course = [moved.target; 2];
        if is_driven {
            (moved.initial, moved.rise) = (moved.target, 0.0);
        }
    }
    changed
}
