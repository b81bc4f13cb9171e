//! How boundaries move, and what they feel.

use crate::number::Vector;
use crate::scene::{AxisMotion, InputCourse, Scene, Shape};
use crate::state::{BoundaryState, State};

/// Begins a communication step of `interval` \[s\]: driven axes now know where they go.
pub(super) fn begin(state: &mut State, interval: f64) {
    for boundary in &mut state.boundaries {
        boundary.start = boundary.displacement;
        for axis in 0..3 {
            boundary.target[axis] += boundary.target_rate[axis] * interval;
        }
        boundary.target_rate = [0.0; 3];
        boundary.impulse = [0.0; 3];
        boundary.angular_impulse = [0.0; 3];
    }
}

/// Ends a communication step after `elapsed` \[s\].
pub(super) fn end(state: &mut State, elapsed: f64) {
    if elapsed <= 0.0 {
        return;
    }
    for boundary in &mut state.boundaries {
        boundary.mean_force = boundary.impulse.map(|impulse| impulse / elapsed);
        boundary.mean_moment = boundary.angular_impulse.map(|impulse| impulse / elapsed);
    }
}

/// Where a communication step stands: the time steps done with the present one, of how many.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    /// Time steps done, the present one included.
    pub done: u64,
    /// Time steps in all.
    pub count: u64,
    /// Length of each \[s\].
    pub step: f64,
    /// Time at the end of the present one \[s\].
    pub time: f64,
}

/// Moves every boundary to where it stands at the end of the present time step. Returns the way of each \[m\].
pub(super) fn advance(scene: &Scene, state: &mut State, progress: Progress) -> Vec<[f64; 3]> {
    let mut ways = Vec::with_capacity(state.boundaries.len());
    for (boundary, moved) in scene.boundaries.iter().zip(&mut state.boundaries) {
        let before = moved.displacement;
        for axis in 0..3 {
            match boundary.axes[axis] {
                AxisMotion::Fixed => {}
                AxisMotion::Prescribed(velocity) => {
                    moved.displacement[axis] = velocity * progress.time;
                    moved.velocity[axis] = velocity;
                }
                AxisMotion::Driven => drive(moved, axis, boundary.input, progress),
            }
        }
        ways.push([0, 1, 2].map(|axis| moved.displacement[axis] - before[axis]));
    }
    ways
}

/// Moves a driven axis.
fn drive(moved: &mut BoundaryState, axis: usize, course: InputCourse, progress: Progress) {
    let (start, target) = (moved.start[axis], moved.target[axis]);
    let before = moved.displacement[axis];
    let share = progress.done as f64 / progress.count as f64;
    let share = match course {
        InputCourse::Ramp => share,
        InputCourse::Smooth => share * share * (3.0 - 2.0 * share),
        InputCourse::Hold => 1.0,
    };
    moved.displacement[axis] = if progress.done == progress.count { target } else { start + (target - start) * share };
    moved.velocity[axis] = match course {
        InputCourse::Ramp => (target - start) / (progress.count as f64 * progress.step),
        InputCourse::Smooth => (moved.displacement[axis] - before) / progress.step,
        InputCourse::Hold => 0.0,
    };
}

/// Puts the particles of groups where their boundary stands.
pub(super) fn place_groups(scene: &Scene, state: &mut State) {
    for (boundary, moved) in scene.boundaries.iter().zip(&state.boundaries) {
        let Shape::Particles { members } = &boundary.shape else { continue };
        for &member in members {
            let slot = state.particles.slot[member as usize] as usize;
            let home = scene.particles[member as usize].position;
            for axis in 0..3 {
                state.particles.position[slot][axis] = home[axis] + moved.displacement[axis];
                state.particles.velocity[slot][axis] = moved.velocity[axis];
            }
        }
    }
}

/// Largest speed of a boundary that carries particles \[m/s\].
pub(super) fn fastest_group(scene: &Scene, state: &State) -> f64 {
    let groups = scene.boundaries.iter().zip(&state.boundaries);
    let speeds = groups.filter(|(boundary, _)| matches!(boundary.shape, Shape::Particles { .. })).map(|(_, moved)| {
        let [x, y, z] = moved.velocity;
        x * x + y * y + z * z
    });
    speeds.fold(0.0, f64::max).sqrt()
}

/// Sets the loads of all boundaries to zero. Returns what they were: force and moment of each.
pub(super) fn clear_loads(state: &mut State) -> Vec<[[f64; 3]; 2]> {
    let before = state.boundaries.iter().map(|boundary| [boundary.force, boundary.moment]).collect();
    for boundary in &mut state.boundaries {
        boundary.force = [0.0; 3];
        boundary.moment = [0.0; 3];
    }
    before
}

/// Sums the loads of the particles in groups, as the passes left them, onto their boundary.
pub(super) fn sum_groups(scene: &Scene, state: &mut State) {
    for (boundary, moved) in scene.boundaries.iter().zip(&mut state.boundaries) {
        let Shape::Particles { members } = &boundary.shape else { continue };
        let reference = Vector::from(boundary.reference) + moved.displacement.into();
        let (mut force, mut moment) = (Vector::zero(), Vector::zero());
        for &member in members {
            let slot = state.particles.slot[member as usize] as usize;
            let load = Vector::from(state.particles.force[slot]);
            let arm = Vector::from(state.particles.position[slot]) - reference;
            force += load;
            moment += arm.cross(load) + Vector::from(state.particles.torque[slot]);
        }
        moved.force = force.to_array();
        moved.moment = moment.to_array();
    }
}

/// Books impulse and work of a time step: the kicks of both its halves, times the way.
pub(super) fn book(state: &mut State, before: &[[[f64; 3]; 2]], ways: &[[f64; 3]], step: f64) {
    for ((boundary, [force, moment]), way) in state.boundaries.iter_mut().zip(before).zip(ways) {
        for axis in 0..3 {
            let impulse = 0.5 * step * (force[axis] + boundary.force[axis]);
            boundary.impulse[axis] += impulse;
            boundary.total_impulse[axis] += impulse;
            boundary.angular_impulse[axis] += 0.5 * step * (moment[axis] + boundary.moment[axis]);
            boundary.work -= 0.5 * (force[axis] + boundary.force[axis]) * way[axis];
        }
    }
}
