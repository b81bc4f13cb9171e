//! The particles of groups: where their body puts them, and with which motion.

use super::{RigidBody, Turning};
use crate::base::geometry::Quaternion;
use crate::base::number::{Vector, larger};
use crate::engine::bodies::loads::came_to;
use crate::engine::state::{BoundaryState, CellState, Particles, State};
use crate::scene::{Boundary, Scene};

/// Where it stands if it has come there \[m\].
fn in_cell(cell: Option<&CellState>, member: u32, place: Vector) -> Vector {
    cell.map_or(place, |cell| place - cell.displacement(member).into())
}

/// Puts the particles of groups where their boundary stands, with the motion that it has.
pub(crate) fn place_groups(scene: &Scene, bodies: &[Option<RigidBody>], state: &mut State) {
    let State { boundaries, particles, cell, .. } = state;
    for ((boundary, body), moved) in scene.boundaries.iter().zip(bodies).zip(boundaries) {
        moved.pivot = (Vector::from(boundary.reference) + moved.displacement.into()).to_array();
        let members = boundary.shape.members();
        if body.as_ref().is_some_and(|body| body.turning != Turning::Still) {
            place_turned(scene, (boundary, moved), members, (particles, cell.as_ref()));
            continue;
        }
        for &member in members {
            let slot = particles.slot[member as usize] as usize;
            let home = Vector::from(scene.particles[member as usize].position);
            let place = in_cell(cell.as_ref(), member, home + moved.displacement.into());
            particles.position[slot][..3].copy_from_slice(&place.to_array());
        }
        give_velocity(moved, members, particles);
    }
}

/// Gives the particles of a group that does not turn the velocity of their boundary.
fn give_velocity(moved: &BoundaryState, members: &[u32], particles: &mut Particles) {
    for &member in members {
        let slot = particles.slot[member as usize] as usize;
        particles.velocity[slot][..3].copy_from_slice(&moved.velocity);
    }
}

/// Puts the particles of a group that turns where it stands.
fn place_turned(
    scene: &Scene,
    (boundary, moved): (&Boundary, &BoundaryState),
    members: &[u32],
    (particles, cell): (&mut Particles, Option<&CellState>),
) {
    let orientation = Quaternion::from(moved.orientation);
    for &member in members {
        let slot = particles.slot[member as usize] as usize;
        let home = Vector::from(scene.particles[member as usize].position) - boundary.reference.into();
        let place = in_cell(cell, member, Vector::from(moved.pivot) + orientation.turn(home));
        particles.position[slot][..3].copy_from_slice(&place.to_array());
        if let Some(row) = particles.orientation.get_mut(slot) {
            *row = moved.orientation.0;
        }
    }
    give_motion(moved, members, (particles, cell));
}

/// Gives the particles of a group the motion of their body, about where its reference point stands.
fn give_motion(moved: &BoundaryState, members: &[u32], (particles, cell): (&mut Particles, Option<&CellState>)) {
    let (velocity, spin) = (Vector::from(moved.velocity), Vector::from(moved.angular_velocity));
    for &member in members {
        let slot = particles.slot[member as usize] as usize;
        let arm = came_to(cell, member, Vector::from(particles.position[slot])) - moved.pivot.into();
        particles.velocity[slot][..3].copy_from_slice(&(velocity + spin.cross(arm)).to_array());
        particles.angular_velocity[slot][..3].copy_from_slice(&spin.to_array());
    }
}

/// The second half of the kick to all free axes. Returns the largest speed of a sphere of theirs at the middle of the
/// next step \[m/s\]; NaN if a load is NaN.
pub(crate) fn kick_again(bodies: &[Option<RigidBody>], state: &mut State, step: f64) -> f64 {
    let mut fastest = 0.0;
    for (index, body) in bodies.iter().enumerate() {
        let Some(body) = body.as_ref().filter(|body| body.is_free()) else { continue };
        let State { boundaries, particles, cell, .. } = &mut *state;
        let moved = &mut boundaries[index];
        body.kick(moved, step);
        fastest = larger(fastest, body.kicked(moved, step).after.fastest(body.farthest));
        give_free_motion(body, moved, (particles, cell.as_ref()));
    }
    fastest
}

/// Gives the spheres of a group the motion that it has after a kick.
fn give_free_motion(body: &RigidBody, moved: &BoundaryState, (particles, cell): (&mut Particles, Option<&CellState>)) {
    if body.turning != Turning::Still {
        return give_motion(moved, &body.members, (particles, cell));
    }
    give_velocity(moved, &body.members, particles);
}
