//! What passes through polygons.

use crate::base::number::Vector;
use crate::engine::cell::near::Place;
use crate::engine::state::{Row, State};
use crate::scene::Scene;

/// Counts the centres that passed each flow meter in the time step just made, of this length \[s\], of clumps their mass centres.
/// Spheres of groups are not counted: boundaries move, they do not flow.
pub(super) fn count(scene: &Scene, state: &mut State, step: f64) {
    let places: Vec<Place> = scene.meters.iter().map(|meter| Place::of(scene, state, meter.polygon.bounds())).collect();
    let State { exchange: Some(exchange), particles, clumps, cell, .. } = state else { return };
    let streaming = cell.as_ref().filter(|cell| cell.streams());
    for ((meter, place), passed) in scene.meters.iter().zip(&places).zip(&mut exchange.meters) {
        // Nothing goes further in a time step than by its radius. What is far away is not looked at closely.
        let each = |position: &Row, velocity: &Row, reach: f64, count: &mut dyn FnMut(bool)| {
            place.meets(Vector::from(*position), reach, |to| {
                let streaming = streaming.map(|cell| Vector::from(cell.streaming_at(to.row_with(0.0))));
                // Where it was before it drifted, to rounding.
                let from = to - streaming.map_or(Vector::from(*velocity), |it| it + (*velocity).into()) * step;
                meter.polygon.is_passed(from, to).into_iter().for_each(&mut *count);
            });
        };
        for (slot, velocity) in particles.velocity.iter().enumerate().filter(|(slot, _)| particles.owner[*slot] == 0) {
            let position = &particles.position[slot];
            each(position, velocity, position[3], &mut |forward| passed.add(forward, None, velocity[3]));
        }
        for (clump, velocity) in clumps.velocity.iter().enumerate() {
            let spheres = clumps.spheres_of(clump);
            let reach = spheres.iter().map(|&sphere| particles.position[particles.slot[sphere as usize] as usize][3]);
            let (position, reach) = (&clumps.position[clump], reach.fold(0.0, f64::max));
            each(position, velocity, reach, &mut |forward| passed.add(forward, Some(spheres.len()), velocity[3]));
        }
    }
}
