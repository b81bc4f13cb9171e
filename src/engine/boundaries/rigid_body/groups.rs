//! The particles of groups: where their body puts them, and with which motion.

use super::{RigidBody, Turning};
use crate::base::geometry::Quaternion;
use crate::base::number::{Vector, larger};
use crate::engine::state::{BoundaryState, Particles, State};
use crate::scene::{Boundary, Scene};

/// Puts the particles of groups where their boundary stands, with the motion that it has.
pub(crate) fn place_groups(scene: &Scene, bodies: &[Option<RigidBody>], state: &mut State) {
    let State { boundaries, particles, .. } = state;
    for ((boundary, body), moved) in scene.boundaries.iter().zip(bodies).zip(boundaries) {
        moved.pivot = (Vector::from(boundary.reference) + moved.displacement.into()).to_array();
        let members = boundary.shape.members();
        if body.as_ref().is_some_and(|body| body.turning != Turning::Still) {
            place_turned(scene, boundary, moved, members, particles);
            continue;
        }
        for &member in members {
            let slot = particles.slot[member as usize] as usize;
            let home = scene.particles[member as usize].position;
            for axis in 0..3 {
                particles.position[slot][axis] = home[axis] + moved.displacement[axis];
            }
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
fn place_turned(scene: &Scene, boundary: &Boundary, moved: &BoundaryState, members: &[u32], particles: &mut Particles) {
    let orientation = Quaternion::from(moved.orientation);
    for &member in members {
        let slot = particles.slot[member as usize] as usize;
        let home = Vector::from(scene.particles[member as usize].position) - boundary.reference.into();
        let place = Vector::from(moved.pivot) + orientation.turn(home);
        particles.position[slot][..3].copy_from_slice(&place.to_array());
        if let Some(row) = particles.orientation.get_mut(slot) {
            *row = moved.orientation.0;
        }
    }
    give_motion(moved, members, particles);
}

/// Gives the particles of a group the motion of their body, about where its reference point stands.
fn give_motion(moved: &BoundaryState, members: &[u32], particles: &mut Particles) {
    let (velocity, spin) = (Vector::from(moved.velocity), Vector::from(moved.angular_velocity));
    for &member in members {
        let slot = particles.slot[member as usize] as usize;
        let arm = Vector::from(particles.position[slot]) - moved.pivot.into();
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
        let moved = &mut state.boundaries[index];
        body.kick(moved, step);
        fastest = larger(fastest, body.coming_speed(moved, step));
        give_free_motion(body, moved, &mut state.particles);
    }
    fastest
}

/// Largest speed of a sphere of a free group at the middle of a step of this length \[m/s\].
pub(crate) fn coming_speed(bodies: &[Option<RigidBody>], state: &State, step: f64) -> f64 {
    let free = bodies.iter().zip(&state.boundaries).filter_map(|(body, moved)| Some((body.as_ref()?, moved)));
    free.fold(0.0, |most, (body, moved)| larger(most, body.coming_speed(moved, step)))
}

/// Gives the spheres of a group the motion that it has after a kick.
fn give_free_motion(body: &RigidBody, moved: &BoundaryState, particles: &mut Particles) {
    if body.turning != Turning::Still {
        return give_motion(moved, &body.members, particles);
    }
    give_velocity(moved, &body.members, particles);
}
