//! How Cundall's damping changes what loads do to particles.

use super::Fields;
use crate::dual::Slopes;
use crate::state::Particles;

impl Fields {
    /// Weight and applied force on a particle, by its slot \[N\].
    pub(crate) fn weight_of(&self, particles: &Particles, slot: usize) -> [f64; 3] {
        self.loads(particles.velocity[slot][3], particles.id[slot])
    }

    /// Damps the slopes of forces and torques on free particles, whose loads are those behind the damping: a fraction of a load
    /// that works is taken away, of one that is worked against added.
    pub(crate) fn damp_slopes(&self, particles: &Particles, force: &mut [[Slopes; 3]], torque: &mut [[Slopes; 3]]) {
        for slot in (0..particles.len()).filter(|&slot| particles.owner[slot] == 0 && self.damps()) {
            let (damped, id) = (self.damped(particles.id[slot]), particles.id[slot]);
            let (velocity, spin) = (particles.velocity[slot], particles.angular_velocity[slot]);
            let (_, after) = self.split(velocity[3], id, damped);
            for axis in 0..3 {
                let along = (particles.force[slot][axis] - after[axis]) * velocity[axis];
                let about = particles.torque[slot][axis] * spin[axis];
                let keep = |fraction: f64, power: f64| if power >= 0.0 { 1.0 - fraction } else { 1.0 + fraction };
                let [linear, angular] = [keep(damped.linear, along), keep(damped.angular, about)];
                force[slot][axis] = force[slot][axis].map(|slope| linear * slope);
                torque[slot][axis] = torque[slot][axis].map(|slope| angular * slope);
            }
        }
    }
}
