//! What contacts offer to the surfaces that forces move: the stiffness and damping that are added to their inertia.

use super::System;
use crate::base::number::Vector;
use crate::engine::boundaries::implicit;
use crate::engine::contacts::SearchLimits;
use crate::engine::state::contacts::TOUCHING;
use crate::engine::state::{State, boundaries::Inertial};
use nalgebra::Matrix6;

/// Stiffness and damping that a surface feels in its six freedoms.
type Blocks = [Matrix6<f64>; 2];

impl System<'_> {
    /// Stiffness and damping of all springs and dashpots at each surface that forces move, as they may get; none of other
    /// boundaries.
    pub(crate) fn blocks(&self, ahead: &SearchLimits) -> Vec<Option<Blocks>> {
        let implicit = |body: &&crate::engine::boundaries::RigidBody| body.is_implicit();
        let mut blocks: Vec<Option<Blocks>> =
            self.bodies.iter().map(|body| Some(body.as_ref().filter(implicit)?.supports())).collect();
        if blocks.iter().all(Option::is_none) {
            return blocks;
        }
        for pass in self.passes {
            pass.stiffness(self.state, ahead, &mut |link| {
                let Some(boundary) = link.boundary.map(|boundary| boundary as usize) else { return };
                let Some([stiffness, damping]) = &mut blocks[boundary] else { return };
                let centre = Vector::from(self.state.particles.position[link.first as usize]);
                let arm = centre - link.normal * link.arms[0] - self.state.boundaries[boundary].pivot.into();
                implicit::add(stiffness, link.normal, arm, link.stiffness);
                implicit::add(damping, link.normal, arm, link.damping);
            });
        }
        let more = self.fields.amplification_of_surfaces();
        for block in blocks.iter_mut().flatten().flatten() {
            *block *= more;
        }
        blocks
    }
}

impl System<'_> {
    /// The mechanical impedance of what touches each boundary with a servo, along x, y, z \[kg/s\]: that of a chain of the
    /// touching particles' masses and the springs of their contacts, √(k m), at least what the dashpots do; summed over contacts and
    /// bonds. Zeros for other boundaries.
    pub(crate) fn impedances(&self) -> Vec<[f64; 3]> {
        let served =
            |boundary: usize| self.scene.boundaries[boundary].axes.iter().any(|motion| motion.servo().is_some());
        let mut impedances = vec![[0.0; 3]; self.scene.boundaries.len()];
        let particles = &self.state.particles;
        let owner = |slot: u32| (particles.owner[slot as usize] as usize).checked_sub(1);
        for pass in self.passes {
            pass.stiffness(self.state, &SearchLimits::default(), &mut |link| {
                let second = link.boundary.map(|boundary| boundary as usize).or(link.second.and_then(owner));
                let sides = [(owner(link.first), link.second), (second, Some(link.first))];
                if sides[0].0 == sides[1].0 {
                    return;
                }
                for (boundary, other) in sides {
                    let (Some(boundary), Some(other)) = (boundary.filter(|boundary| served(*boundary)), other) else {
                        continue;
                    };
                    let mass = particles.velocity[other as usize][3];
                    for (sum, part) in impedances[boundary].iter_mut().zip(link.normal.to_array()) {
                        let along = |[normal, across, ..]: [f64; 4]| across + (normal - across) * part * part;
                        let damping = along(link.damping);
                        *sum += (along(link.stiffness) * mass + damping * damping).sqrt();
                    }
                }
            });
        }
        impedances
    }
}

/// Contacts at a boundary.
fn contacts(state: &State, boundary: usize) -> u64 {
    let lists = state.walls.iter().filter(|list| list.boundary as usize == boundary);
    lists.map(|list| list.flags.iter().filter(|flags| **flags & TOUCHING != 0).count() as u64).sum()
}

/// Puts what was found in its place.
pub(crate) fn put_blocks(state: &mut State, blocks: Vec<Option<Blocks>>) {
    for (boundary, block) in blocks.into_iter().enumerate() {
        let Some([stiffness, damping]) = block else { continue };
        let contacts = contacts(state, boundary);
        let inertial = &mut state.boundaries[boundary].inertial;
        *inertial = Inertial { stiffness: stiffness.into(), damping: damping.into(), contacts, ..*inertial };
    }
}

/// Whether a surface that forces move has more contacts than when its blocks were found.
pub(crate) fn has_more_contacts(state: &State, boundary: usize) -> bool {
    contacts(state, boundary) > state.boundaries[boundary].inertial.contacts
}
