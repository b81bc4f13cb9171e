//! Velocity Verlet: half a step of velocity (a kick), a step of position (the drift), forces, the other half of the kick.

mod braking;
mod damped;
mod fields;

pub(crate) use fields::{Fields, Load};

use crate::base::geometry::Quaternion;
use crate::base::lanes::{self, Kernel, Lane, Shared};
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::{Particles, Row};

/// Moves free particles by half a kick and a drift of `step` \[s\] and sets all loads to zero. Returns the largest
/// speed \[m/s\].
pub(crate) fn kick_and_drift(particles: &mut Particles, step: f64, turning: bool, context: &Context) -> f64 {
    let rows = Rows::of(particles);
    let square = |piece| {
        let mut fastest = 0.0;
        lanes::run(context.width, First { rows, piece, step, turning, fastest: &mut fastest });
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
    /// Whether particles turn.
    turning: bool,
    /// Largest squared speed \[m²/s²\].
    fastest: &'b mut f64,
}

impl Kernel for First<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { rows, piece, step, turning, fastest } = self;
        let half = 0.5 * step;
        let mut most = 0.0;
        for slot in rows.slots(piece) {
            // SAFETY: pieces do not overlap, and each is worked on by one thread.
            let body = unsafe { rows.body(slot) };
            if rows.owner[slot] == 0 {
                let (velocity, force) = (*body.velocity, *body.force);
                let v = plus(velocity, force, half / velocity[3]);
                *body.velocity = v;
                *body.position = plus(*body.position, [v[0], v[1], v[2], 0.0], step);
                if turning {
                    let (spin, torque) = (*body.spin, *body.torque);
                    *body.spin = plus(spin, torque, half / spin[3]);
                }
                let square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
                most = if square > most { square } else { most };
            }
            *body.force = [0.0; 4];
            if turning {
                *body.torque = [0.0; 4];
            }
        }
        *fastest = most;
    }
}

/// Turns the orientations by a drift of `step` \[s\], where particles have one.
pub(crate) fn turn(particles: &mut Particles, step: f64, context: &Context) {
    let orientation = Shared::new(&mut particles.orientation);
    let (count, spin) = (orientation.length(), &particles.angular_velocity);
    context.each(count.div_ceil(CHUNK), |piece| {
        for slot in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
            // SAFETY: pieces do not overlap.
            let row = unsafe { orientation.at(slot) };
            *row = Quaternion::from_row(*row).turned(spin[slot].into(), step).to_row();
        }
    });
}

/// Adds the weight, where gravity \[m/s²\] is given, and moves free particles by the second half of the kick. Returns
/// the largest speed at the middle of the next step, or something that is not finite where a force or velocity is not
/// \[m/s\].
pub(crate) fn kick_again(
    particles: &mut Particles,
    gravity: Option<[f64; 3]>,
    step: f64,
    turning: bool,
    context: &Context,
) -> f64 {
    let rows = Rows::of(particles);
    let square = |piece| {
        let mut fastest = 0.0;
        lanes::run(context.width, Second { rows, piece, gravity, step, turning, fastest: &mut fastest });
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
    /// Whether particles turn.
    turning: bool,
    /// Largest squared speed at the middle of the next step; NaN if any velocity or force is NaN \[m²/s²\].
    fastest: &'b mut f64,
}

impl Kernel for Second<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { rows, piece, gravity, step, turning, fastest } = self;
        let half = 0.5 * step;
        let mut most = 0.0;
        // Zero times what is finite is zero; times anything else it is not a number.
        let mut sums = [[0.0; 4]; 2];
        for slot in rows.slots(piece) {
            // SAFETY: pieces do not overlap, and each is worked on by one thread.
            let body = unsafe { rows.body(slot) };
            let (velocity, mut force) = (*body.velocity, *body.force);
            if let Some([x, y, z]) = gravity {
                force = plus(force, [x, y, z, 0.0], velocity[3]);
                *body.force = force;
            }
            if rows.owner[slot] != 0 {
                continue;
            }
            let factor = half / velocity[3];
            let v = plus(velocity, force, factor);
            *body.velocity = v;
            let next = plus(v, force, factor);
            let square = next[0] * next[0] + next[1] * next[1] + next[2] * next[2];
            sums[0] = plus(sums[0], next, 0.0);
            most = if square > most { square } else { most };
            if turning {
                let (spin, torque) = (*body.spin, *body.torque);
                let w = plus(spin, torque, half / spin[3]);
                *body.spin = w;
                sums[1] = plus(sums[1], w, 0.0);
            }
        }
        let sum = plus(sums[0], sums[1], 1.0);
        *fastest = most + (sum[0] + sum[1] + sum[2] + sum[3]);
    }
}

/// Largest speed of a free particle at the middle of a step of this length \[s\], from rest or not \[m/s\].
pub(crate) fn coming_speed(particles: &Particles, step: f64) -> f64 {
    let free = (0..particles.len()).filter(|&slot| particles.owner[slot] == 0);
    let squares = free.map(|slot| {
        let velocity = particles.velocity[slot];
        let next = plus(velocity, particles.force[slot], 0.5 * step / velocity[3]);
        next[0] * next[0] + next[1] * next[1] + next[2] * next[2]
    });
    squares.fold(0.0, f64::max).sqrt()
}

/// A row plus a multiple of another. The fourth number of a load is 0: that of a velocity stays.
#[inline(always)]
fn plus(row: Row, other: Row, factor: f64) -> Row {
    [row[0] + factor * other[0], row[1] + factor * other[1], row[2] + factor * other[2], row[3] + factor * other[3]]
}

/// The rows that integration reads and writes.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'a> {
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
pub(crate) struct ParticleRows<'a> {
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
    pub(crate) fn of(particles: &'a mut Particles) -> Self {
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
    pub(crate) fn pieces(&self) -> usize {
        self.owner.len().div_ceil(CHUNK)
    }

    /// The slots of one piece.
    #[inline(always)]
    pub(crate) fn slots(&self, piece: usize) -> std::ops::Range<usize> {
        piece * CHUNK..((piece + 1) * CHUNK).min(self.owner.len())
    }

    /// One particle's rows.
    ///
    /// # Safety
    /// `slot` is a particle, and no other thread reads or writes its rows meanwhile.
    #[inline(always)]
    pub(crate) unsafe fn body(&self, slot: usize) -> ParticleRows<'a> {
        // SAFETY: the caller's promise.
        unsafe {
            ParticleRows {
                position: self.position.at(slot),
                velocity: self.velocity.at(slot),
                spin: self.spin.at(slot),
                force: self.force.at(slot),
                torque: self.torque.at(slot),
                slot,
            }
        }
    }

    /// Hands out the particles of one piece, and whether each moves by the forces on it. Each piece is for one thread only.
    #[inline(always)]
    pub(crate) fn each(&self, piece: usize, mut hand: impl FnMut(ParticleRows, bool)) {
        for slot in self.slots(piece) {
            // SAFETY: pieces do not overlap, and each is worked on by one thread.
            hand(unsafe { self.body(slot) }, self.owner[slot] == 0);
        }
    }

    /// Hands out the particles of one piece that move by the forces on them. Each piece is for one thread only.
    #[inline(always)]
    pub(crate) fn each_free(&self, piece: usize, mut hand: impl FnMut(ParticleRows)) {
        self.each(piece, |body, free| {
            if free {
                hand(body);
            }
        });
    }
}

/// Sets all loads to zero.
pub(crate) fn clear_loads(particles: &mut Particles) {
    particles.force.fill([0.0; 4]);
    particles.torque.fill([0.0; 4]);
}
