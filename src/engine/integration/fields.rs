//! Gravity, applied forces and Cundall's global damping.

use super::Rows;
use super::braking::{Damped, brake, taken};
use crate::base::lanes::Shared;
use crate::base::number::Vector;
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::{Loss, Particles, Row, State};
use crate::scene::Scene;

/// Force \[N\] and moment about the reference point of a group \[N m\].
pub(crate) type Load = [Vector; 2];

/// What acts on each particle by itself.
pub(crate) struct Fields {
    /// Acceleration of gravity \[m/s²\].
    gravity: [f64; 3],
    /// Applied force of each of the scene's own particles \[N\]; empty where there is none.
    applied: Vec<[f64; 3]>,
    /// Damping of each of the scene's own particles; empty where there is none.
    pub(super) damping: Vec<Damped>,
    /// Whether anything is damped.
    pub(super) damps: bool,
    /// Damping of particles that come later.
    pub(super) newcomers: Damped,
    /// Damping of surfaces that forces move.
    pub(super) surfaces: Damped,
    /// Whether the particles are in a fluid: its dashpots resist weight, too.
    in_fluid: bool,
}

impl Fields {
    /// Reads them from the scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        let count = scene.particles.len();
        let mut applied = vec![[0.0; 3]; if scene.forces.is_empty() { 0 } else { count }];
        for force in &scene.forces {
            for &member in &force.members {
                for (sum, part) in applied[member as usize].iter_mut().zip(force.force) {
                    *sum += part;
                }
            }
        }
        let mut damping = vec![Damped::default(); if scene.damping.is_empty() { 0 } else { count }];
        for set in &scene.damping {
            for (index, damped) in damping.iter_mut().enumerate() {
                if set.linear[index] != 0.0 || set.angular[index] != 0.0 {
                    *damped = Damped {
                        linear: set.linear[index],
                        angular: set.angular[index],
                        gravity: set.gravity_damped,
                        applied: set.applied_forces_damped,
                    };
                }
            }
        }
        let mut newcomers = Damped::default();
        for set in scene.damping.iter().filter(|set| set.newcomers != [0.0; 2]) {
            let [linear, angular] = set.newcomers;
            newcomers = Damped { linear, angular, gravity: set.gravity_damped, applied: set.applied_forces_damped };
        }
        let damps = !scene.damping.is_empty();
        let (surfaces, in_fluid) = (Damped::default(), scene.fluid.is_some());
        Self { gravity: scene.gravity, applied, damping, damps, newcomers, surfaces, in_fluid }
    }

    /// By which factors Cundall's damping makes force and torque on a particle of the scene larger, at most: where the motion
    /// changes its sign in every step, which is the mode that grows first, every load acts on the way out.
    pub(crate) fn amplification(&self, id: u32) -> [f64; 2] {
        let damped = self.damped(id);
        [1.0 + damped.linear, 1.0 + damped.angular]
    }

    /// These factors of a body of these particles; of none where it is a surface.
    pub(crate) fn amplification_of(&self, members: &[u32]) -> [f64; 2] {
        let damped = self.of_body(members);
        [1.0 + damped.linear, 1.0 + damped.angular]
    }

    /// Damping of a body: the spheres of one are damped alike.
    pub(crate) fn of_body(&self, members: &[u32]) -> Damped {
        members.first().map_or(self.surfaces, |&member| self.damped(member))
    }

    /// Largest acceleration that gravity and applied forces give a particle \[m/s²\].
    pub(crate) fn acceleration(&self, particles: &Particles) -> f64 {
        let gravity = Vector::from(self.gravity).length();
        let applied = |(id, force): (usize, &[f64; 3])| {
            let slot = particles.slot_of(id as u32)?;
            Some(Vector::from(*force).length() / particles.velocity[slot][3])
        };
        gravity + self.applied.iter().enumerate().filter_map(applied).fold(0.0, f64::max)
    }

    /// Gravity \[m/s²\], if nothing else acts: it is then added by the kick that follows.
    pub(crate) fn weight_alone(&self) -> Option<[f64; 3]> {
        let alone = !self.act_beside_weight();
        (alone && self.gravity != [0.0; 3]).then_some(self.gravity)
    }

    /// Whether they add anything to the forces.
    pub(crate) fn act(&self) -> bool {
        self.damps || self.applies() || self.gravity != [0.0; 3]
    }

    /// Whether weight is among the forces before the kick.
    pub(crate) fn act_beside_weight(&self) -> bool {
        self.damps || self.applies() || self.in_fluid
    }

    /// Adds everything to the forces, damping in its place. Returns the sum of the damping forces \[N\].
    pub(crate) fn apply(&self, state: &mut State, context: &Context) -> [f64; 3] {
        if !self.damps && self.applied.is_empty() {
            self.weigh(state, context);
            return [0.0; 3];
        }
        for (slot, force) in state.particles.force.iter_mut().enumerate() {
            if state.particles.owner[slot] != 0 {
                let load = self.loads(state.particles.velocity[slot][3], state.particles.id[slot]);
                add(force, load);
            }
        }
        let ids = std::mem::take(&mut state.particles.id);
        let (rows, books) = (Rows::of(&mut state.particles), state.losses.is_some());
        let of_piece = |piece| {
            let mut sum = [0.0; 6];
            rows.each_free(piece, |body| {
                let id = ids[body.slot];
                if !self.damps {
                    add(body.force, self.loads(body.velocity[3], id));
                    return;
                }
                let damped = self.damped(id);
                let (before, after) = self.split(body.velocity[3], id, damped);
                let (velocity, spin, mut force, mut torque) = (*body.velocity, *body.spin, *body.force, *body.torque);
                add(&mut force, before);
                let (mut losses, mut turns) = ([0.0; 3], [0.0; 3]);
                for axis in 0..3 {
                    losses[axis] = brake(damped.linear, force[axis], velocity[axis]);
                    force[axis] -= losses[axis];
                    sum[axis] -= losses[axis];
                    turns[axis] = brake(damped.angular, torque[axis], spin[axis]);
                    torque[axis] -= turns[axis];
                }
                add(&mut force, after);
                (*body.force, *body.torque) = (force, torque);
                if books {
                    let moved = taken(losses, &velocity, &force, context.step);
                    let turned = taken(turns, &spin, &torque, context.step);
                    for kind in 0..3 {
                        sum[3 + kind] += moved[kind] + turned[kind];
                    }
                }
            });
            sum
        };
        let plus = |mut sum: [f64; 6], part: [f64; 6]| {
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
            sum
        };
        let [x, y, z, now, power, growth] = context.fold(rows.pieces(), of_piece, [0.0; 6], plus);
        state.particles.id = ids;
        if let Some(losses) = &mut state.losses {
            losses.add(Loss::GlobalDamping, now);
            losses.braking = [power, growth];
        }
        [x, y, z]
    }

    /// Adds gravity, where nothing else acts.
    fn weigh(&self, state: &mut State, context: &Context) {
        if self.gravity == [0.0; 3] {
            return;
        }
        let (force, velocity) = (Shared::new(&mut state.particles.force), &state.particles.velocity);
        context.each(velocity.len().div_ceil(CHUNK), |piece| {
            let slots = piece * CHUNK..((piece + 1) * CHUNK).min(velocity.len());
            // SAFETY: pieces do not overlap.
            let forces = unsafe { force.part(slots.start, slots.end) };
            for (force, velocity) in forces.iter_mut().zip(&velocity[slots]) {
                add(force, self.weight(velocity[3]));
            }
        });
    }

    /// Applied force on a particle of the scene \[N\].
    pub(crate) fn applied(&self, id: u32) -> [f64; 3] {
        self.applied.get(id as usize).copied().unwrap_or_default()
    }

    /// Whether a force is applied to any particle.
    pub(crate) fn applies(&self) -> bool {
        !self.applied.is_empty()
    }

    /// Weight of a mass \[N\].
    pub(crate) fn weight(&self, mass: f64) -> [f64; 3] {
        self.gravity.map(|part| mass * part)
    }

    /// Weight and applied force \[N\].
    pub(crate) fn loads(&self, mass: f64, id: u32) -> [f64; 3] {
        let (weight, applied) = (self.weight(mass), self.applied(id));
        [weight[0] + applied[0], weight[1] + applied[1], weight[2] + applied[2]]
    }

    /// What comes before the damping, and what after it \[N\].
    pub(super) fn split(&self, mass: f64, id: u32, damped: Damped) -> ([f64; 3], [f64; 3]) {
        let (mut before, mut after) = ([0.0; 3], [0.0; 3]);
        let (weight, applied) = (self.weight(mass), self.applied(id));
        for axis in 0..3 {
            *(if damped.gravity { &mut before[axis] } else { &mut after[axis] }) += weight[axis];
            *(if damped.applied { &mut before[axis] } else { &mut after[axis] }) += applied[axis];
        }
        (before, after)
    }
}

/// Adds a load to a row.
#[inline(always)]
fn add(row: &mut Row, load: [f64; 3]) {
    for axis in 0..3 {
        row[axis] += load[axis];
    }
}
