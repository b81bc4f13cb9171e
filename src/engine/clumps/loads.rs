//! What acts on clumps: the loads on their spheres, weight, applied forces and damping.

use super::ClumpBodies;
use crate::base::lanes::Shared;
use crate::base::number::Vector;
use crate::base::threads::Context;
use crate::engine::integration::Fields;
use crate::engine::integration::Load;
use crate::engine::state::{Particles, State};
use crate::scene::Scene;

impl ClumpBodies {
    /// Puts the whole load on each clump: that of its spheres as passes left it, weight, applied forces, and damping in its place. Returns
    /// the sum of the damping forces \[N\].
    pub(crate) fn load(&self, fields: &Fields, state: &mut State, context: &Context) -> [f64; 3] {
        let State { particles, clumps, .. } = state;
        let braked = if fields.damps() { self.count() } else { 0 };
        clumps.braking.resize(braked, [[0.0; 4]; 2]);
        let (force, moment) = (Shared::new(&mut clumps.force), Shared::new(&mut clumps.moment));
        let braking = Shared::new(&mut clumps.braking);
        let (position, velocity, spin) = (&clumps.position, &clumps.velocity, &clumps.angular_velocity);
        let of_piece = |piece: usize| {
            let mut sum = Vector::zero();
            for clump in self.piece(piece) {
                let mut load = self.of_spheres(clump, Vector::from(position[clump]), particles);
                let weight = [Vector::from(fields.weight(velocity[clump][3])), Vector::zero()];
                if braked == 0 && !fields.applies() {
                    load[0] += weight[0];
                } else {
                    let applied = self.applied(clump, Vector::from(position[clump]), (fields, particles));
                    let motion = [velocity[clump], spin[clump]];
                    let braking_load = fields.complete(&mut load, (weight, applied), motion, self.starts[clump]);
                    sum += braking_load[0];
                    if braked > 0 {
                        // SAFETY: each clump is worked on by one thread.
                        unsafe { *braking.at(clump) = braking_load.map(|part| part.row_with(0.0)) };
                    }
                }
                // SAFETY: as above.
                unsafe {
                    *force.at(clump) = load[0].row_with(0.0);
                    *moment.at(clump) = load[1].row_with(0.0);
                }
            }
            sum
        };
        context.fold(self.pieces(), of_piece, Vector::zero(), |sum, part| sum + part).to_array()
    }

    /// Force and moment about the mass centre of the loads on the spheres of a clump.
    #[inline(always)]
    pub(super) fn of_spheres(&self, clump: usize, centre: Vector, particles: &Particles) -> Load {
        let (first, arms) = self.spheres(clump);
        let (mut force, mut moment) = (Vector::zero(), Vector::zero());
        for &slot in &particles.slot[first..first + arms.len()] {
            let slot = slot as usize;
            let (load, arm) = (Vector::from(particles.force[slot]), Vector::from(particles.position[slot]) - centre);
            force += load;
            moment += arm.cross(load) + Vector::from(particles.torque[slot]);
        }
        [force, moment]
    }

    /// The forces that the scene applies to the spheres of a clump.
    pub(super) fn applied(&self, clump: usize, centre: Vector, (fields, particles): (&Fields, &Particles)) -> Load {
        let (mut force, mut moment) = (Vector::zero(), Vector::zero());
        if fields.applies() {
            let (first, arms) = self.spheres(clump);
            for index in first..first + arms.len() {
                let part = Vector::from(fields.applied(index as u32));
                force += part;
                moment += (Vector::from(particles.position[particles.slot[index] as usize]) - centre).cross(part);
            }
        }
        [force, moment]
    }

    /// By which factors damping makes loads on a clump larger, at most.
    pub(crate) fn amplification(&self, clump: usize, fields: &Fields) -> [f64; 2] {
        fields.amplification(self.starts[clump])
    }
}

/// Force of contacts and bonds on a sphere of a clump, and force on any other particle \[N\]: among the rows of particles stands the weight
/// of the mass that laws see, which is that of the clump.
pub(crate) fn force_on(scene: &Scene, particles: &Particles, slot: usize) -> [f64; 3] {
    let [x, y, z, _] = particles.force[slot];
    let Some(group) = particles.group(slot).filter(|group| *group >= scene.boundaries.len()) else { return [x, y, z] };
    let mass = scene.clumps[group - scene.boundaries.len()].mass;
    let weight = scene.gravity.map(|part| mass * part);
    [x - weight[0], y - weight[1], z - weight[2]]
}

/// Mass of a particle \[kg\]: of a sphere of a clump its share of the clump's.
pub(crate) fn mass_of(scene: &Scene, particles: &Particles, slot: usize) -> f64 {
    let own = particles.group(slot).filter(|group| *group >= scene.boundaries.len());
    match own.and_then(|_| scene.particles.get(particles.id[slot] as usize)) {
        Some(sphere) => sphere.mass(),
        None => particles.velocity[slot][3],
    }
}
