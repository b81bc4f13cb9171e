//! What boundaries feel in a time step: loads, and the impulses and the work that follow from them.

use super::course::BoundaryTravel;
use crate::engine::bodies::loads::on_members;
use crate::engine::state::{BoundaryState, State};
use crate::laws::motion::{InputCourse, Progress};
use crate::scene::Scene;

/// What a boundary felt at the beginning of a time step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundaryLoads {
    /// Force \[N\].
    force: [f64; 3],
    /// Moment \[N m\].
    moment: [f64; 3],
    /// Power of a surface that runs in itself \[W\].
    conveying_power: f64,
}

/// Sets the loads of all boundaries to zero, and notes what they were.
pub(crate) fn clear(state: &mut State, before: &mut Vec<BoundaryLoads>) {
    before.clear();
    for BoundaryState { force, moment, conveying_power, force_before, moment_before, .. } in &mut state.boundaries {
        before.push(BoundaryLoads { force: *force, moment: *moment, conveying_power: *conveying_power });
        (*force_before, *moment_before) = (*force, *moment);
        (*force, *moment, *conveying_power) = ([0.0; 3], [0.0; 3], 0.0);
    }
}

/// Sums the loads of the particles in groups, as the passes left them, onto their boundary.
pub(crate) fn sum_groups(scene: &Scene, state: &mut State) {
    let State { boundaries, particles, cell, .. } = state;
    for (boundary, moved) in scene.boundaries.iter().zip(boundaries) {
        let members = boundary.shape.members();
        if members.is_empty() {
            continue;
        }
        let [force, moment] = on_members(members, moved.pivot.into(), particles, cell.as_ref());
        moved.force = force.to_array();
        moved.moment = moment.to_array();
    }
}

/// Books impulse and work of a time step: the kicks of both its halves, times the way. Free axes do no work, and what
/// crosses them stays inside.
pub(crate) fn book(
    scene: &Scene,
    state: &mut State,
    before: &[BoundaryLoads],
    travels: &[BoundaryTravel],
    progress: &Progress,
) {
    let step = progress.step;
    let moves = before.iter().zip(travels).zip(&scene.boundaries);
    for (moved, ((loads, travel), boundary)) in state.boundaries.iter_mut().zip(moves) {
        let BoundaryLoads { force, moment, conveying_power } = loads;
        moved.work += 0.5 * step * (conveying_power + moved.conveying_power);
        for axis in 0..3 {
            let impulse = 0.5 * step * (force[axis] + moved.force[axis]);
            moved.impulse[axis] += impulse;
            if boundary.input == InputCourse::Quadratic {
                moved.first_moment[axis] += impulse * progress.since_the_middle();
            }
            if !boundary.axes[axis].is_free() {
                moved.total_impulse[axis] += impulse;
            }
            moved.angular_impulse[axis] += 0.5 * step * (moment[axis] + moved.moment[axis]);
            moved.work -= 0.5 * (force[axis] + moved.force[axis]) * travel.led[axis];
            moved.work -= 0.5 * (moment[axis] + moved.moment[axis]) * travel.led[3 + axis];
        }
    }
}
