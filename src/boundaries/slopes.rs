//! How boundaries, and the particles of groups, change with a few inputs.

use super::{RigidBody, Turning};
use crate::dual::{Dual, Slopes};
use crate::geometry::Quaternion;
use crate::motion::{InputCourse, Progress, Way};
use crate::number::Vector;
use crate::scene::{Boundary, Scene};
use crate::state::{BoundaryState, State};
use crate::tangent::{BoundarySlopes, Tangent, alone, rotation, row_of, vector_of};

/// Follows an input, an axis of a boundary, through a communication step of this length \[s\].
pub(crate) fn begin(boundary: &Boundary, moved: &BoundaryState, slopes: &mut BoundarySlopes, axis: usize, length: f64) {
    slopes.end[axis] = [if boundary.axes[axis].takes_velocity() { length } else { 1.0 }];
    if boundary.axes[axis].takes_load() {
        slopes.load[axis] = [1.0];
    }
    let driven = || (0..3).filter(|about| boundary.axes[3 + about].is_driven());
    if axis < 3 || boundary.axes[axis].takes_velocity() || driven().count() == 1 {
        if axis >= 3 {
            slopes.turn[axis - 3] = slopes.end[axis];
        }
        return;
    }
    let mut target = [0.0; 3];
    for about in driven() {
        target[about] = moved.target[3 + about] + moved.target_rate[3 + about] * length;
    }
    let [.., a, b, c] = slopes.end;
    let from = Quaternion::from(moved.orientation).to_row().map(Dual::constant);
    let to = rotation::orientation(Dual::vector(target.into(), [a, b, c]));
    slopes.turn = rotation::between(Quaternion::from_row(from), to).slopes();
}

/// Moves every boundary, and the particles of groups with it, to the end of the present time step, where those of the state
/// stand already. Loads begin anew.
pub(crate) fn advance(
    scene: &Scene,
    bodies: &[Option<RigidBody>],
    state: &State,
    tangent: &mut Tangent,
    progress: &Progress,
) {
    for (index, (boundary, body)) in scene.boundaries.iter().zip(bodies).enumerate() {
        let (moved, slopes) = (&state.boundaries[index], &mut tangent.boundaries[index]);
        if let Some(body) = body.as_ref().filter(|body| body.is_free()) {
            kick(body, moved, slopes, progress.step);
        }
        for axis in 0..3 {
            lead(boundary, slopes, axis, progress);
        }
        if body.as_ref().is_some_and(|body| body.turning == Turning::Led) {
            turn(boundary, moved, slopes, progress);
        }
        (slopes.force, slopes.moment) = ([[0.0]; 3], [[0.0]; 3]);
        if slopes.is_moved() {
            carry(scene, (boundary, index), state, tangent);
        }
    }
}

/// An axis goes on its way: in proportion to where it is to be at the end, or by its velocity.
fn lead(boundary: &Boundary, slopes: &mut BoundarySlopes, axis: usize, progress: &Progress) {
    let motion = &boundary.axes[axis];
    let ([target], [before], [velocity]) = (slopes.end[axis], slopes.displacement[axis], slopes.velocity[axis]);
    if motion.is_driven() {
        let way = Way { start: 0.0, target, before, course: boundary.input, acceleration: 0.0 };
        if let Some([displacement, velocity]) = motion.lead(&way, progress) {
            (slopes.displacement[axis], slopes.velocity[axis]) = ([displacement], [velocity]);
        }
    } else if motion.is_free() {
        slopes.displacement[axis] = [before + progress.step * velocity];
    }
}

/// A boundary that the outside turns goes on its way.
fn turn(boundary: &Boundary, moved: &BoundaryState, slopes: &mut BoundarySlopes, progress: &Progress) {
    let whole = Dual::vector(moved.turn.into(), slopes.turn);
    let course = boundary.input;
    let (before, share) = (progress.share_before(course), progress.share(course));
    let from = Quaternion::from(moved.start_orientation).to_row().map(Dual::constant);
    let on_the_way = rotation::orientation(whole * Dual::constant(share)) * Quaternion::from_row(from);
    slopes.orientation = row_of(on_the_way.to_row());
    let rate = match course {
        InputCourse::Ramp => 1.0 / progress.length,
        InputCourse::Smooth | InputCourse::Quadratic => (share - before) / progress.step,
        InputCourse::Hold => 0.0,
    };
    slopes.angular_velocity = slopes.turn.map(|turn| turn.times(rate));
}

/// The particles of a group go with their boundary.
fn carry(scene: &Scene, (boundary, index): (&Boundary, usize), state: &State, tangent: &mut Tangent) {
    let (moved, slopes) = (&state.boundaries[index], &tangent.boundaries[index]);
    let particles = &mut tangent.particles;
    let orientation = Quaternion::from_row(alone(Quaternion::from(moved.orientation).to_row(), &slopes.orientation));
    let (pivot, velocity) = (Dual::vector(moved.pivot.into(), slopes.displacement), slopes.velocity);
    let velocity = Dual::vector(moved.velocity.into(), velocity);
    let spin = Dual::vector(moved.angular_velocity.into(), slopes.angular_velocity);
    for &member in boundary.shape.members() {
        let slot = state.particles.slot[member as usize] as usize;
        let home = Vector::from(scene.particles[member as usize].position) - boundary.reference.into();
        let place = pivot + orientation.turn(Dual::vector(home, [[0.0]; 3]));
        particles.position[slot] = vector_of(place);
        particles.velocity[slot] = vector_of(velocity + spin.cross(place - pivot));
        particles.spin[slot] = vector_of(spin);
        if let Some(row) = particles.orientation.get_mut(slot) {
            *row = slopes.orientation;
        }
        particles.is_reached[slot] = true;
    }
}

/// Loads on the particles of groups are loads on their boundaries. `weight` says what is among the forces on a particle, by
/// its slot, that no pass gave \[N\].
pub(crate) fn sum_groups(scene: &Scene, state: &State, tangent: &mut Tangent, weight: impl Fn(usize) -> [f64; 3]) {
    let particles = &tangent.particles;
    for ((boundary, moved), slopes) in scene.boundaries.iter().zip(&state.boundaries).zip(&mut tangent.boundaries) {
        let pivot = Dual::vector(moved.pivot.into(), slopes.displacement);
        for &member in boundary.shape.members() {
            let slot = state.particles.slot[member as usize] as usize;
            if !particles.is_reached[slot] {
                continue;
            }
            let force = Vector::from(state.particles.force[slot]) - weight(slot).into();
            let force = Vector::of_row(alone(force.row_with(0.0), &particles.force[slot]));
            let place = Vector::of_row(alone(state.particles.position[slot], &particles.position[slot]));
            let torque = Vector::of_row(alone([0.0; 4], &particles.torque[slot]));
            let moment = (place - pivot).cross(force) + torque;
            slopes.add_load(force.slopes(), moment.slopes());
        }
    }
}

/// The whole load on boundaries that forces move, and the second half of their kick.
pub(crate) fn kick_again(bodies: &[Option<RigidBody>], state: &State, tangent: &mut Tangent, step: f64) {
    for ((body, moved), slopes) in bodies.iter().zip(&state.boundaries).zip(&mut tangent.boundaries) {
        let Some(body) = body.as_ref().filter(|body| body.is_free()) else { continue };
        for axis in 0..3 {
            let [stiffness, damping] = body.ground(axis);
            let given = if body.moves[axis] { slopes.end[axis][0] } else { 0.0 };
            let held = stiffness * slopes.displacement[axis][0] + damping * slopes.velocity[axis][0];
            slopes.load[axis] = [slopes.force[axis][0] + given - held];
        }
        kick(body, moved, slopes, step);
    }
}

/// Half a kick.
fn kick(body: &RigidBody, moved: &BoundaryState, slopes: &mut BoundarySlopes, step: f64) {
    let shift = body.shift(moved, slopes.load.map(|[load]| load), step);
    for ([velocity], shift) in slopes.velocity.iter_mut().zip(shift) {
        *velocity += shift;
    }
}
