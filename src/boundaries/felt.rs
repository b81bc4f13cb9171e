//! What boundaries feel in a time step: loads, and the impulses and the work that follow from them.

use super::course::Way;
use crate::bond::damping::split::Impulse;
use crate::motion::{InputCourse, Progress};
use crate::number::Vector;
use crate::scene::Scene;
use crate::state::plane_rows::ParticleMotion;
use crate::state::{BoundaryState, State};

/// What a boundary felt at the beginning of a time step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Felt {
    /// Force \[N\].
    force: [f64; 3],
    /// Moment \[N m\].
    moment: [f64; 3],
    /// Power of a surface that runs in itself \[W\].
    conveying_power: f64,
}

/// What a sweep over dashpots that are integrated by themselves does to a boundary: impulses, or loads where it stands for them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Swept {
    /// Impulse \[N s\] or force \[N\].
    push: Vector,
    /// Angular impulse \[N m s\] or moment \[N m\] about the moved reference point.
    twist: Vector,
    /// Energy that the boundary got \[J\].
    pub(crate) energy: f64,
}

impl Default for Swept {
    fn default() -> Self {
        Self { push: Vector::zero(), twist: Vector::zero(), energy: 0.0 }
    }
}

impl Swept {
    /// By the first or second body of a bond (0 or 1), at this arm from the reference point \[m\], which is led with this velocity
    /// \[m/s\] and angular velocity \[rad/s\].
    pub(crate) fn at(impulse: &Impulse, body: usize, arm: Vector, [velocity, spin]: [Vector; 2]) -> Self {
        let push = if body == 0 { impulse.push } else { -impulse.push };
        let own = impulse.twists[body];
        Self { push, twist: own + arm.cross(push), energy: push.dot(velocity) + own.dot(spin) }
    }

    /// Adds another.
    pub(crate) fn add(&mut self, other: &Self) {
        self.push += other.push;
        self.twist += other.twist;
        self.energy += other.energy;
    }
}

/// Books impulse and work of a sweep, this long after the middle of the communication step \[s\].
pub(crate) fn book_sweep(scene: &Scene, state: &mut State, swept: &[Swept], since_the_middle: f64) {
    for ((boundary, moved), swept) in scene.boundaries.iter().zip(&mut state.boundaries).zip(swept) {
        let (push, twist) = (swept.push.to_array(), swept.twist.to_array());
        for axis in 0..3 {
            moved.impulse[axis] += push[axis];
            moved.angular_impulse[axis] += twist[axis];
            moved.total_impulse[axis] += push[axis];
            if boundary.input == InputCourse::Quadratic {
                moved.first_moment[axis] += push[axis] * since_the_middle;
            }
        }
        moved.work -= swept.energy;
    }
}

/// Lets boundaries feel the present loads of dashpots that are integrated by themselves. The next time step takes them away again.
pub(crate) fn show_swept(state: &mut State, loads: &[Swept]) {
    for (moved, load) in state.boundaries.iter_mut().zip(loads) {
        let present = [load.push.to_array(), load.twist.to_array()];
        for axis in 0..3 {
            moved.force[axis] += present[0][axis] - moved.swept[0][axis];
            moved.moment[axis] += present[1][axis] - moved.swept[1][axis];
        }
        moved.swept = present;
    }
}

/// Sets the loads of all boundaries to zero, and notes what they were, without those of dashpots that are integrated by themselves.
pub(crate) fn clear_loads(state: &mut State, before: &mut Vec<Felt>) {
    before.clear();
    for moved in &mut state.boundaries {
        let BoundaryState { force, moment, swept, conveying_power, force_before, moment_before, .. } = moved;
        for axis in 0..3 {
            force[axis] -= swept[0][axis];
            moment[axis] -= swept[1][axis];
        }
        (*force_before, *moment_before) = (*force, *moment);
        before.push(Felt { force: *force, moment: *moment, conveying_power: *conveying_power });
        (*force, *moment, *swept, *conveying_power) = ([0.0; 3], [0.0; 3], [[0.0; 3]; 2], 0.0);
    }
}

/// Sums the loads of the particles in groups, as the passes left them, onto their boundary.
pub(crate) fn sum_groups(scene: &Scene, state: &mut State) {
    for (boundary, moved) in scene.boundaries.iter().zip(&mut state.boundaries) {
        let members = boundary.shape.members();
        if members.is_empty() {
            continue;
        }
        let (mut force, mut moment) = (Vector::zero(), Vector::zero());
        for &member in members {
            let slot = state.particles.slot[member as usize] as usize;
            let ParticleMotion { force: load, torque, .. } = state.particles.motion(slot);
            let (load, arm) = (Vector::from(load), Vector::from(state.particles.position[slot]) - moved.pivot.into());
            force += load;
            moment += arm.cross(load) + Vector::from(torque);
        }
        moved.force = force.to_array();
        moved.moment = moment.to_array();
    }
}

/// Books impulse and work of a time step: the kicks of both its halves, times the way. Free axes do no work, and what
/// crosses them stays inside.
pub(crate) fn book(scene: &Scene, state: &mut State, before: &[Felt], ways: &[Way], progress: &Progress) {
    let step = progress.step;
    let moves = before.iter().zip(ways).zip(&scene.boundaries);
    for (moved, ((felt, way), boundary)) in state.boundaries.iter_mut().zip(moves) {
        let Felt { force, moment, conveying_power } = felt;
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
            moved.work -= 0.5 * (force[axis] + moved.force[axis]) * way.led[axis];
            moved.work -= 0.5 * (moment[axis] + moved.moment[axis]) * way.led[3 + axis];
        }
    }
}
