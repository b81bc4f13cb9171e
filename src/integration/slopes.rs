//! How Cundall's damping changes what loads do to particles.

use super::Fields;
use crate::state::{Particles, Row};

impl Fields {
    /// Weight and applied force on a particle, by its slot \[N\].
    pub(crate) fn weight_of(&self, particles: &Particles, slot: usize) -> [f64; 3] {
        self.loads(particles.velocity[slot][3], particles.id[slot])
    }

    /// Damps the slopes of forces and torques on free particles, whose loads are those behind the damping: a fraction of a load
    /// that works is taken away, of one that is worked against added.
    pub(crate) fn damp_slopes(&self, particles: &Particles, force: &mut [Row], torque: &mut [Row]) {
        if !self.damps() {
            return;
        }
        for slot in (0..particles.len()).filter(|&slot| particles.owner[slot] == 0) {
            let (damped, id) = (self.damped(particles.id[slot]), particles.id[slot]);
            let (velocity, spin) = (particles.velocity[slot], particles.angular_velocity[slot]);
            let (_, after) = self.split(velocity[3], id, damped);
            let keep = |fraction: f64, power: f64| if power >= 0.0 { 1.0 - fraction } else { 1.0 + fraction };
            let damp = |row: &Row, factors: [f64; 3]| {
                let [x, y, z] = [0, 1, 2].map(|axis| row[axis] * factors[axis]);
                [x, y, z, 0.0]
            };
            let along = |axis: usize| (particles.force[slot][axis] - after[axis]) * velocity[axis];
            force[slot] = damp(&force[slot], [0, 1, 2].map(|axis| keep(damped.linear, along(axis))));
            let about = |axis: usize| particles.torque[slot][axis] * spin[axis];
            torque[slot] = damp(&torque[slot], [0, 1, 2].map(|axis| keep(damped.angular, about(axis))));
        }
    }
}
