//! Velocity Verlet: half a kick, a drift, forces, half a kick.

use super::lanes::Shared;
use super::pass::{CHUNK, Context};
use crate::bond::Quaternion;
use crate::state::{Particles, Row};

/// Moves free particles by half a kick and a drift of `step` \[s\]. Returns the largest speed \[m/s\].
pub(super) fn kick_and_drift(particles: &mut Particles, step: f64, turning: bool, context: &Context) -> f64 {
    let rows = Rows::of(particles);
    let speeds = context.collect(rows.pieces(), |piece| {
        let mut fastest = 0.0_f64;
        rows.each_free(piece, |body| {
            kick(body.velocity, body.force, 0.5 * step / body.velocity[3]);
            let mut square = 0.0;
            for axis in 0..3 {
                body.position[axis] += step * body.velocity[axis];
                square += body.velocity[axis] * body.velocity[axis];
            }
            if turning {
                kick(body.spin, body.torque, 0.5 * step / body.spin[3]);
            }
            fastest = if square > fastest { square } else { fastest };
        });
        fastest
    });
    speeds.into_iter().fold(0.0_f64, f64::max).sqrt()
}

/// Turns the attitudes by a drift of `step` \[s\], where particles have one.
pub(super) fn turn(particles: &mut Particles, step: f64, context: &Context) {
    let attitude = Shared::new(&mut particles.attitude);
    let (count, spin) = (attitude.length(), &particles.angular_velocity);
    context.each(count.div_ceil(CHUNK), |piece| {
        for slot in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
            // SAFETY: pieces do not overlap.
            let row = unsafe { attitude.at(slot) };
            *row = Quaternion::from_row(*row).turned(spin[slot].into(), step).to_row();
        }
    });
}

/// Moves free particles by the second half of the kick. Returns the largest speed at the middle of the next step,
/// or something that is not finite where a force or velocity is not \[m/s\].
pub(super) fn kick_again(particles: &mut Particles, step: f64, turning: bool, context: &Context) -> f64 {
    let rows = Rows::of(particles);
    let speeds = context.collect(rows.pieces(), |piece| {
        let mut fastest = 0.0_f64;
        let mut sum = 0.0;
        rows.each_free(piece, |body| {
            let factor = 0.5 * step / body.velocity[3];
            kick(body.velocity, body.force, factor);
            let mut square = 0.0;
            for axis in 0..3 {
                let next = body.velocity[axis] + factor * body.force[axis];
                square += next * next;
            }
            if turning {
                kick(body.spin, body.torque, 0.5 * step / body.spin[3]);
                sum += body.spin[0] * 0.0 + body.spin[1] * 0.0 + body.spin[2] * 0.0;
            }
            sum += square * 0.0;
            fastest = if square > fastest { square } else { fastest };
        });
        fastest + sum
    });
    speeds.into_iter().fold(0.0_f64, |most, speed| if speed > most || speed.is_nan() { speed } else { most }).sqrt()
}

/// Adds a multiple of a load to a velocity.
#[inline(always)]
fn kick(velocity: &mut Row, load: &Row, factor: f64) {
    for axis in 0..3 {
        velocity[axis] += factor * load[axis];
    }
}

/// The rows that integration reads and writes.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    /// Positions.
    position: Shared<Row>,
    /// Velocities and masses.
    velocity: Shared<Row>,
    /// Angular velocities and moments of inertia.
    spin: Shared<Row>,
    /// Forces.
    force: Shared<Row>,
    /// Torques.
    torque: Shared<Row>,
    /// What moves each particle.
    owner: &'a [u32],
}

/// One particle's rows.
pub(super) struct Body<'a> {
    /// Position and radius.
    pub position: &'a mut Row,
    /// Velocity and mass.
    pub velocity: &'a mut Row,
    /// Angular velocity and moment of inertia.
    pub spin: &'a mut Row,
    /// Force.
    pub force: &'a mut Row,
    /// Torque.
    pub torque: &'a mut Row,
    /// Its slot.
    pub slot: usize,
}

impl<'a> Rows<'a> {
    /// The rows of these particles.
    pub(super) fn of(particles: &'a mut Particles) -> Self {
        Self {
            position: Shared::new(&mut particles.position),
            velocity: Shared::new(&mut particles.velocity),
            spin: Shared::new(&mut particles.angular_velocity),
            force: Shared::new(&mut particles.force),
            torque: Shared::new(&mut particles.torque),
            owner: &particles.owner,
        }
    }

    /// How many pieces of work there are.
    pub(super) fn pieces(&self) -> usize {
        self.owner.len().div_ceil(CHUNK)
    }

    /// Hands out the particles of one piece that move by the forces on them. Each piece is for one thread only.
    #[inline(always)]
    pub(super) fn each_free(&self, piece: usize, mut hand: impl FnMut(Body)) {
        let to = ((piece + 1) * CHUNK).min(self.owner.len());
        for slot in piece * CHUNK..to {
            if self.owner[slot] != 0 {
                continue;
            }
            // SAFETY: pieces do not overlap, and each is worked on by one thread.
            hand(unsafe {
                Body {
                    position: self.position.at(slot),
                    velocity: self.velocity.at(slot),
                    spin: self.spin.at(slot),
                    force: self.force.at(slot),
                    torque: self.torque.at(slot),
                    slot,
                }
            });
        }
    }
}

/// Sets forces, and torques where there are any, to zero.
pub(super) fn clear_loads(particles: &mut Particles, turning: bool, context: &Context) {
    let (force, torque) = (Shared::new(&mut particles.force), Shared::new(&mut particles.torque));
    let count = force.length();
    context.each(count.div_ceil(CHUNK), |piece| {
        let (from, to) = (piece * CHUNK, ((piece + 1) * CHUNK).min(count));
        // SAFETY: pieces do not overlap.
        unsafe {
            force.part(from, to).fill([0.0; 4]);
            if turning {
                torque.part(from, to).fill([0.0; 4]);
            }
        }
    });
}
