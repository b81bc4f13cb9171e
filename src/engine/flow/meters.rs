//! What passes through polygons.

use crate::base::number::Vector;
use crate::engine::state::{Row, State};
use crate::scene::Scene;

/// Counts the centres that passed each flow meter in the time step just made, of this length \[s\], of clumps their mass centres.
/// Spheres of groups are not counted: boundaries move, they do not flow.
pub(super) fn count(scene: &Scene, state: &mut State, step: f64) {
    let Some(exchange) = &mut state.exchange else { return };
    let (particles, clumps) = (&state.particles, &state.clumps);
    for (meter, passed) in scene.meters.iter().zip(&mut exchange.meters) {
        // Where it was before it drifted, to rounding. What is far away is not looked at closely.
        let direction = |position: &Row, velocity: &Row| {
            let to = Vector::from(*position);
            meter.polygon.is_passed(to - Vector::from(*velocity) * step, to)
        };
        for (slot, velocity) in particles.velocity.iter().enumerate() {
            let Some(forward) = direction(&particles.position[slot], velocity) else { continue };
            if particles.owner[slot] == 0 {
                passed.add(forward, None, velocity[3]);
            }
        }
        for (clump, velocity) in clumps.velocity.iter().enumerate() {
            let Some(forward) = direction(&clumps.position[clump], velocity) else { continue };
            passed.add(forward, Some(clumps.spheres_of(clump).len()), velocity[3]);
        }
    }
}
