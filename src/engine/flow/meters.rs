//! What passes through polygons.

use crate::base::number::Vector;
use crate::engine::state::State;
use crate::scene::Scene;

/// Counts the centres that passed each flow meter in the time step just made, of this length \[s\]. Spheres of groups are not
/// counted: boundaries move, they do not flow.
pub(super) fn count(scene: &Scene, state: &mut State, step: f64) {
    let Some(exchange) = &mut state.exchange else { return };
    let particles = &state.particles;
    for (meter, passed) in scene.meters.iter().zip(&mut exchange.meters) {
        for (slot, velocity) in particles.velocity.iter().enumerate() {
            let to = Vector::from(particles.position[slot]);
            // Where it was before it drifted, to rounding. What is far away is not looked at closely.
            let from = to - Vector::from(*velocity) * step;
            let Some(forward) = meter.polygon.is_passed(from, to) else { continue };
            if particles.owner[slot] != 0 {
                continue;
            }
            passed.counts[usize::from(!forward)] += 1;
            passed.mass += if forward { velocity[3] } else { -velocity[3] };
        }
    }
}
