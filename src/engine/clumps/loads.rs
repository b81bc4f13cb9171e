//! What acts on clumps: the loads on their spheres, weight, applied forces and damping.

use super::{piece, pieces};
use crate::base::lanes::Shared;
use crate::base::number::Vector;
use crate::base::threads::Context;
use crate::engine::integration::Fields;
use crate::engine::integration::Load;
use crate::engine::state::{Clumps, Particles, State};
use crate::scene::Scene;

/// Puts the whole load on each clump: that of its spheres as passes left it, weight, applied forces, and damping in its place. Returns
/// the sum of the damping forces \[N\].
pub(crate) fn load(fields: &Fields, state: &mut State, context: &Context) -> [f64; 3] {
    let State { particles, clumps, .. } = state;
    let count = clumps.len();
    let braked = if fields.damps() { count } else { 0 };
    clumps.braking.resize(braked, [[0.0; 4]; 2]);
    // What is written is lent out of the clumps meanwhile.
    let [mut forces, mut moments] = [&mut clumps.force, &mut clumps.moment].map(std::mem::take);
    let mut brakings = std::mem::take(&mut clumps.braking);
    let (force, moment) = (Shared::new(&mut forces), Shared::new(&mut moments));
    let (braking, bodies) = (Shared::new(&mut brakings), &*clumps);
    let of_piece = |number: usize| {
        let mut sum = Vector::zero();
        for clump in piece(number, count) {
            let mut load = of_spheres(bodies, clump, particles);
            let weight = [Vector::from(fields.weight(bodies.velocity[clump][3])), Vector::zero()];
            if braked == 0 && !fields.applies() {
                load[0] += weight[0];
            } else {
                let applied = applied(bodies, clump, (fields, particles));
                let motion = [bodies.velocity[clump], bodies.angular_velocity[clump]];
                let first = bodies.spheres_of(clump)[0];
                let braking_load = fields.complete(&mut load, (weight, applied), motion, first);
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
    let sum = context.fold(pieces(count), of_piece, Vector::zero(), |sum, part| sum + part);
    (clumps.force, clumps.moment, clumps.braking) = (forces, moments, brakings);
    sum.to_array()
}

/// Force and moment about the mass centre of the loads on the spheres of a clump.
#[inline(always)]
pub(super) fn of_spheres(clumps: &Clumps, clump: usize, particles: &Particles) -> Load {
    let (centre, mut force, mut moment) = (Vector::from(clumps.position[clump]), Vector::zero(), Vector::zero());
    for &sphere in clumps.spheres_of(clump) {
        let slot = particles.slot[sphere as usize] as usize;
        let (load, arm) = (Vector::from(particles.force[slot]), Vector::from(particles.position[slot]) - centre);
        force += load;
        moment += arm.cross(load) + Vector::from(particles.torque[slot]);
    }
    [force, moment]
}

/// The forces that the scene applies to the spheres of a clump.
pub(super) fn applied(clumps: &Clumps, clump: usize, (fields, particles): (&Fields, &Particles)) -> Load {
    let (centre, mut force, mut moment) = (Vector::from(clumps.position[clump]), Vector::zero(), Vector::zero());
    if fields.applies() {
        for &sphere in clumps.spheres_of(clump) {
            let part = Vector::from(fields.applied(sphere));
            force += part;
            moment += (Vector::from(particles.position[particles.slot[sphere as usize] as usize]) - centre).cross(part);
        }
    }
    [force, moment]
}

/// By which factors damping makes loads on a clump larger, at most.
pub(crate) fn amplification(clumps: &Clumps, clump: usize, fields: &Fields) -> [f64; 2] {
    fields.amplification(clumps.spheres_of(clump)[0])
}

/// Force of contacts and bonds on a sphere of a clump, and force on any other particle \[N\]: among the rows of particles stands the weight
/// of the mass that laws see, which is that of the clump.
pub(crate) fn force_on(scene: &Scene, particles: &Particles, slot: usize) -> [f64; 3] {
    let [x, y, z, _] = particles.force[slot];
    if particles.group(slot).is_none_or(|group| group < scene.boundaries.len()) {
        return [x, y, z];
    }
    let mass = particles.velocity[slot][3];
    let weight = scene.gravity.map(|part| mass * part);
    [x - weight[0], y - weight[1], z - weight[2]]
}

/// Mass of a particle \[kg\]: of a sphere of a clump its share of the clump's.
pub(crate) fn mass_of(scene: &Scene, (particles, clumps): (&Particles, &Clumps), slot: usize) -> f64 {
    let mass = particles.velocity[slot][3];
    let Some(clump) = particles.group(slot).and_then(|group| group.checked_sub(scene.boundaries.len())) else {
        return mass;
    };
    if let Some(sphere) = scene.particles.get(particles.id[slot] as usize) {
        return sphere.mass();
    }
    let cube = |slot: usize| particles.position[slot][3].powi(3);
    let all = clumps.spheres_of(clump).iter().map(|&sphere| cube(particles.slot[sphere as usize] as usize));
    mass * (cube(slot) / all.sum::<f64>())
}
