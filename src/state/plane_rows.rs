//! Plane rows: how the particles of a plane scene stand in their rows while time steps are made.
//!
//! Nothing moves along y there and nothing turns about x or z. The y number of a velocity is then the angular velocity about y, the y number of
//! a force the torque about y, and the fourth number of a force the moment of inertia: a time step reads and writes three
//! rows of a particle instead of five. Each number is computed as in three dimensions, to the bit. The rows of torques
//! are zero meanwhile, but for marks of what would take a particle out of the plane ([`mark`]). Outside of a communication step rows are
//! always those of three dimensions.

use super::{Particles, Row};

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

impl Particles {
    /// Velocity and angular velocity of the particle in a slot, whatever its rows are.
    #[inline(always)]
    pub(crate) fn velocities(&self, slot: usize) -> [Row; 2] {
        let rows = [self.velocity[slot], self.angular_velocity[slot]];
        if self.plane_rows { motion(rows[0], rows[1]) } else { rows }
    }

    /// Motion and loads of the particle in a slot, whatever its rows are.
    #[inline(always)]
    pub(crate) fn motion(&self, slot: usize) -> ParticleMotion {
        if self.plane_rows { self.motion_in::<true>(slot) } else { self.motion_in::<false>(slot) }
    }

    /// The same for loops that ask once whether rows are plane ones.
    #[inline(always)]
    pub(crate) fn motion_in<const PLANE: bool>(&self, slot: usize) -> ParticleMotion {
        let (velocity, spin) = (self.velocity[slot], self.angular_velocity[slot]);
        ParticleMotion { velocity, spin, force: self.force[slot], torque: self.torque[slot] }.of_rows(PLANE)
    }
}

impl ParticleMotion {
    /// What stands in these rows, which are plane ones or not.
    #[inline(always)]
    pub(crate) fn of_rows(self, plane_rows: bool) -> Self {
        if !plane_rows {
            return self;
        }
        let Self { velocity, spin, force, torque } = self;
        let ([velocity, spin], [force, torque]) = (motion(velocity, spin), loads(force, torque));
        Self { velocity, spin, force, torque }
    }
}

/// Velocity and angular velocity from a plane row of velocity and the row of angular velocity beside it.
#[inline(always)]
pub(crate) fn motion(velocity: Row, spin: Row) -> [Row; 2] {
    [[velocity[0], 0.0, velocity[2], velocity[3]], [0.0, velocity[1], 0.0, spin[3]]]
}

/// Force and torque from the plane rows of both.
#[inline(always)]
pub(crate) fn loads(force: Row, marked: Row) -> [Row; 2] {
    [[force[0], marked[1], force[2], 0.0], [marked[0], force[1], marked[2], 0.0]]
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

/// Marks a force and a torque ([`mark`]) where they would take the particle out of the plane.
#[inline(always)]
pub(crate) fn mark_any(marked: &mut Row, force: &Row, torque: &Row) {
    let mut leave = Leave::default();
    leave.look(force, torque);
    if leave.is_any() {
        mark(marked, *force, *torque);
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
