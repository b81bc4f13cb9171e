//! Kinetic energy, and the energy books for the scenes that ask for them.

mod between;
pub(crate) mod losses;
pub(crate) mod work;

pub(crate) use between::PendingWork;

use crate::base::threads::{CHUNK, Context};
use crate::engine::bodies::{self, RigidBody};
use crate::engine::state::{Particles, Row, State};

/// Kinetic energy of the particles and bodies that move by the forces on them \[J\].
pub(crate) fn kinetic(state: &State, bodies: &[Option<RigidBody>], context: &Context) -> f64 {
    of_particles(&state.particles, context) + bodies::kinetic(bodies, state)
}

/// Kinetic energy of the particles that move by the forces on them \[J\].
fn of_particles(particles: &Particles, context: &Context) -> f64 {
    let count = particles.len();
    let of_piece = |piece: usize| {
        let mut sum = 0.0;
        for slot in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
            if particles.owner[slot] == 0 {
                let (v, w) = (&particles.velocity[slot], &particles.angular_velocity[slot]);
                sum += 0.5 * v[3] * dot(v, v) + 0.5 * w[3] * dot(w, w);
            }
        }
        sum
    };
    context.fold(count.div_ceil(CHUNK), of_piece, 0.0, |sum, part| sum + part)
}

/// Scalar product of the first three numbers of two rows.
#[inline(always)]
fn dot(a: &Row, b: &Row) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A row plus a multiple of another.
#[inline(always)]
fn plus(row: &Row, other: &Row, factor: f64) -> Row {
    [0, 1, 2, 3].map(|axis| row[axis] + other[axis] * factor)
}

/// Three numbers as a row.
fn row([x, y, z]: [f64; 3]) -> Row {
    [x, y, z, 0.0]
}

/// Adds to sums the products of force and torque with velocities and with accelerations.
#[inline(always)]
fn multiply(sums: &mut [Row; 2], [force, torque]: [&Row; 2], motion: [[&Row; 2]; 2]) {
    for (sum, [along, about]) in sums.iter_mut().zip(motion) {
        for axis in 0..4 {
            sum[axis] += force[axis] * along[axis] + torque[axis] * about[axis];
        }
    }
}
