//! Time steps of particles in plane rows ([`crate::state::plane_rows`]).

use super::{Rows, plus};
use crate::lanes::{self, Kernel, Lane};
use crate::state::{Particles, Row, plane_rows};
use crate::threads::Context;

/// Makes plane rows of the rows of all particles.
pub(crate) fn to_plane(particles: &mut Particles, context: &Context) {
    particles.plane_rows = true;
    let rows = Rows::of(particles);
    context.each(rows.pieces(), |piece| {
        rows.each(piece, |body, free| {
            body.velocity[1] = body.spin[1];
            (body.force[1], body.force[3]) = (body.torque[1], body.spin[3]);
            *body.torque = [0.0; 4];
            if free {
                // Zeros that are negative become positive, as in the first step of three dimensions.
                body.position[1] += 0.0;
                (body.spin[0], body.spin[2]) = (0.0, 0.0);
            }
        });
    });
}

/// Makes rows of plane ones, what was marked among them. The motion of groups is to be given to their particles after that.
pub(crate) fn to_space(particles: &mut Particles, context: &Context) {
    particles.plane_rows = false;
    let rows = Rows::of(particles);
    context.each(rows.pieces(), |piece| {
        rows.each(piece, |body, _| {
            let [force, torque] = plane_rows::loads(*body.force, *body.torque);
            (*body.force, *body.torque) = (force, torque);
            (body.spin[1], body.velocity[1]) = (body.velocity[1], 0.0);
        });
    });
}

/// Half a step \[s\] over what each number of a plane row of velocity resists with: mass, moment of inertia, mass; the fourth
/// number stays. Divided as a row, since divisions one by one would take longer than all the rest.
#[inline(always)]
fn factors(half: f64, mass: f64, inertia: f64) -> Row {
    [mass, inertia, mass, f64::INFINITY].map(|divisor| half / divisor)
}

/// A row plus another one, each number by a factor of its own.
#[inline(always)]
fn plus_each(row: Row, other: Row, factors: Row) -> Row {
    [0, 1, 2, 3].map(|k| row[k] + factors[k] * other[k])
}

/// [`super::kick_and_drift`] of plane rows.
pub(crate) fn kick_and_drift(particles: &mut Particles, step: f64, context: &Context) -> f64 {
    let rows = Rows::of(particles);
    let square = |piece| {
        let mut fastest = 0.0;
        lanes::run(context.width, First { rows, piece, step, fastest: &mut fastest });
        fastest
    };
    context.fold(rows.pieces(), square, 0.0, f64::max).sqrt()
}

/// The first half of a kick and the drift, on one piece.
struct First<'a, 'b> {
    /// The particles.
    rows: Rows<'a>,
    /// Which piece.
    piece: usize,
    /// The time step \[s\].
    step: f64,
    /// Largest squared speed \[m²/s²\].
    fastest: &'b mut f64,
}

impl Kernel for First<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { rows, piece, step, fastest } = self;
        let (half, mut most) = (0.5 * step, 0.0);
        for slot in rows.slots(piece) {
            // SAFETY: pieces do not overlap, and each is worked on by one thread.
            let body = unsafe { rows.body(slot) };
            let (velocity, force) = (*body.velocity, *body.force);
            if rows.owner[slot] == 0 {
                let v = plus_each(velocity, force, factors(half, velocity[3], force[3]));
                *body.velocity = v;
                *body.position = plus_each(*body.position, v, [step, 0.0, step, 0.0]);
                let square = v[0] * v[0] + v[2] * v[2];
                most = if square > most { square } else { most };
            }
            *body.force = [0.0, 0.0, 0.0, force[3]];
        }
        *fastest = most;
    }
}

/// [`super::kick_again`] of plane rows.
pub(crate) fn kick_again(particles: &mut Particles, gravity: Option<[f64; 3]>, step: f64, context: &Context) -> f64 {
    let rows = Rows::of(particles);
    let square = |piece| {
        let mut fastest = 0.0;
        lanes::run(context.width, Second { rows, piece, gravity, step, fastest: &mut fastest });
        fastest
    };
    let larger = |most: f64, one: f64| if one > most || one.is_nan() { one } else { most };
    context.fold(rows.pieces(), square, 0.0, larger).sqrt()
}

/// The second half of a kick, on one piece.
struct Second<'a, 'b> {
    /// The particles.
    rows: Rows<'a>,
    /// Which piece.
    piece: usize,
    /// Gravity that is not yet among the forces \[m/s²\].
    gravity: Option<[f64; 3]>,
    /// The time step \[s\].
    step: f64,
    /// Largest squared speed at the middle of the next step; NaN if any velocity or force is NaN \[m²/s²\].
    fastest: &'b mut f64,
}

impl Kernel for Second<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { rows, piece, gravity, step, fastest } = self;
        let (half, mut most) = (0.5 * step, 0.0);
        // Zero times what is finite is zero; times anything else it is not a number.
        let mut sums = [0.0; 4];
        for slot in rows.slots(piece) {
            // SAFETY: pieces do not overlap, and each is worked on by one thread.
            let body = unsafe { rows.body(slot) };
            let (velocity, mut force) = (*body.velocity, *body.force);
            if let Some([x, _, z]) = gravity {
                force = plus(force, [x, 0.0, z, 0.0], velocity[3]);
                *body.force = force;
            }
            if rows.owner[slot] != 0 {
                continue;
            }
            let factors = factors(half, velocity[3], force[3]);
            let v = plus_each(velocity, force, factors);
            *body.velocity = v;
            let next = plus_each(v, force, factors);
            sums = plus(sums, next, 0.0);
            let square = next[0] * next[0] + next[2] * next[2];
            most = if square > most { square } else { most };
        }
        *fastest = most + (sums[0] + sums[1] + sums[2] + sums[3]);
    }
}
