//! Plane rows: how the particles of a plane scene stand in their rows while time steps are made.
//!
//! Nothing moves along y there and nothing turns about x or z. The y number of a velocity is then the angular velocity about y, the y number of
//! a force the torque about y, and the fourth number of a force the moment of inertia: a time step reads and writes three
//! rows of a particle instead of five. Each number is computed as in three dimensions, to the bit. The rows of torques
//! are zero meanwhile, but for marks of what would take a particle out of the plane ([`mark`]).

use super::{Rows, plus};
use crate::lanes::{self, Kernel, Lane};
use crate::state::{Particles, Row};
use crate::threads::Context;

/// Motion and loads of a particle in three dimensions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ParticleMotion {
    /// Velocity \[m/s\] and mass \[kg\].
    pub velocity: Row,
    /// Angular velocity \[rad/s\] and moment of inertia \[kg m²\].
    pub spin: Row,
    /// Force \[N\].
    pub force: Row,
    /// Torque \[N m\].
    pub torque: Row,
}

impl ParticleMotion {
    /// That of the particle in a slot, whose rows are plane ones or not.
    pub(crate) fn of(particles: &Particles, slot: usize, plane_rows: bool) -> Self {
        let (velocity, spin) = (particles.velocity[slot], particles.angular_velocity[slot]);
        let (force, torque) = (particles.force[slot], particles.torque[slot]);
        let rows = Self { velocity, spin, force, torque };
        if plane_rows { rows.in_space() } else { rows }
    }

    /// What stands in these plane rows.
    #[inline(always)]
    fn in_space(self) -> Self {
        let Self { velocity, spin, force, torque: marked } = self;
        Self {
            velocity: [velocity[0], 0.0, velocity[2], velocity[3]],
            spin: [0.0, velocity[1], 0.0, spin[3]],
            force: [force[0], marked[1], force[2], 0.0],
            torque: [marked[0], force[1], marked[2], 0.0],
        }
    }
}

/// Makes plane rows of the rows of free particles.
pub(crate) fn to_plane(particles: &mut Particles, context: &Context) {
    let rows = Rows::of(particles);
    context.each(rows.pieces(), |piece| {
        rows.each_free(piece, |body| {
            body.velocity[1] = body.spin[1];
            // A zero that is negative becomes positive, as in the first step of three dimensions.
            body.position[1] += 0.0;
            (body.force[1], body.force[3]) = (body.torque[1], body.spin[3]);
            *body.torque = [0.0; 4];
        });
    });
}

/// Makes rows of plane ones, what was marked among them.
pub(crate) fn to_space(particles: &mut Particles, context: &Context) {
    let rows = Rows::of(particles);
    context.each(rows.pieces(), |piece| {
        rows.each_free(piece, |body| {
            let (velocity, spin, force, torque) = (*body.velocity, *body.spin, *body.force, *body.torque);
            let motion = ParticleMotion { velocity, spin, force, torque }.in_space();
            (*body.velocity, *body.spin) = (motion.velocity, motion.spin);
            (*body.force, *body.torque) = (motion.force, motion.torque);
        });
    });
}

/// Velocity and angular velocity in lanes, from plane rows of velocity.
#[inline(always)]
pub(crate) fn part<N: Lane>([u, w, v, mass]: [N; 4]) -> [[N; 4]; 2] {
    let zero = N::zero();
    [[u, zero, v, mass], [zero, w, zero, zero]]
}

/// A force and a torque as they are added to a plane row of force.
#[inline(always)]
pub(crate) fn load(force: Row, torque: Row) -> Row {
    [force[0], torque[1], force[2], force[3]]
}

/// Whether any of some loads would take its particle out of the plane.
#[derive(Default)]
pub(crate) struct Leave(u64);

impl Leave {
    /// Looks at a force and at what turns the particle.
    #[inline(always)]
    pub(crate) fn look(&mut self, force: &Row, turning: &Row) {
        self.0 |= (force[1].to_bits() | turning[0].to_bits() | turning[2].to_bits()) << 1;
    }

    /// Whether one does: a number other than zero, whatever its sign.
    pub(crate) fn is_any(&self) -> bool {
        self.0 != 0
    }
}

/// Marks in the row of torque of a particle what would take it out of the plane: a force along y, a torque about x or z. The first of
/// each stays.
#[cold]
pub(crate) fn mark(marked: &mut Row, force: Row, torque: Row) {
    for (kept, part) in marked.iter_mut().zip([torque[0], force[1], torque[2]]) {
        if *kept == 0.0 {
            *kept = part;
        }
    }
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
        rows.each_free(piece, |body| {
            let (velocity, force) = (*body.velocity, *body.force);
            let v = plus_each(velocity, force, factors(half, velocity[3], force[3]));
            *body.velocity = v;
            *body.position = plus_each(*body.position, v, [step, 0.0, step, 0.0]);
            *body.force = [0.0, 0.0, 0.0, force[3]];
            let square = v[0] * v[0] + v[2] * v[2];
            most = if square > most { square } else { most };
        });
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
        rows.each_free(piece, |body| {
            let (velocity, mut force) = (*body.velocity, *body.force);
            if let Some([x, _, z]) = gravity {
                force = plus(force, [x, 0.0, z, 0.0], velocity[3]);
                *body.force = force;
            }
            let factors = factors(half, velocity[3], force[3]);
            let v = plus_each(velocity, force, factors);
            *body.velocity = v;
            let next = plus_each(v, force, factors);
            sums = plus(sums, next, 0.0);
            let square = next[0] * next[0] + next[2] * next[2];
            most = if square > most { square } else { most };
        });
        *fastest = most + (sums[0] + sums[1] + sums[2] + sums[3]);
    }
}
