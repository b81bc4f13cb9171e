//! What passes through polygons.

use crate::base::number::Vector;
use crate::engine::cell::near::Place;
use crate::engine::state::State;
use crate::scene::Scene;

/// Counts the centres that passed each flow meter in the time step just made, of this length \[s\]. Spheres of groups are not
/// counted: boundaries move, they do not flow.
pub(super) fn count(scene: &Scene, state: &mut State, step: f64) {
    let places: Vec<Place> = scene.meters.iter().map(|meter| Place::of(scene, state, meter.polygon.bounds())).collect();
    let State { exchange: Some(exchange), particles, cell, .. } = state else { return };
    let streaming = cell.as_ref().filter(|cell| cell.streams());
    for ((meter, place), passed) in scene.meters.iter().zip(&places).zip(&mut exchange.meters) {
        for (slot, velocity) in particles.velocity.iter().enumerate() {
            let to = Vector::from(particles.position[slot]);
            let mut count = |forward: bool| {
                passed.counts[usize::from(!forward)] += 1;
                passed.mass += if forward { velocity[3] } else { -velocity[3] };
            };
            // Nothing goes further in a time step than by its radius. What is far away is not looked at closely.
            place.meets(to, particles.position[slot][3], |to| {
                let streaming = streaming.map(|cell| Vector::from(cell.streaming_at(to.row_with(0.0))));
                // Where it was before it drifted, to rounding.
                let from = to - streaming.map_or(Vector::from(*velocity), |it| it + (*velocity).into()) * step;
                let forward = meter.polygon.is_passed(from, to).filter(|_| particles.owner[slot] == 0);
                forward.into_iter().for_each(&mut count);
            });
        }
    }
}
