//! How the loads on bodies change with their displacements: differences of evaluations.

use super::network::Network;
use crate::engine::run_error::RunError;
use crate::engine::simulation::{Displacement, Probe, ProbeBody};
use crate::engine::state::State;
use nalgebra::Matrix6;

/// Six freedoms of a body by six of another; of the first three alone where nothing turns.
pub(super) type Block = Matrix6<f64>;

/// −J in blocks, body by body.
pub(super) struct Columns {
    /// How many freedoms each body has.
    each: usize,
    /// For each body: those that feel it when it moves, with how they do.
    blocks: Vec<Vec<(u32, Block)>>,
}

/// What changes for each metre of a displacement.
pub(super) struct Difference {
    /// Loads on the bodies, freedom by freedom \[N/m\].
    pub(super) loads: Vec<f64>,
    /// Force on each boundary \[N/m\].
    pub(super) boundaries: Vec<[f64; 3]>,
    /// Stress of the cell, where there is one \[Pa/m\].
    pub(super) stress: [f64; 6],
}

/// The loads on the bodies, torques over radii \[N\].
pub(super) fn loads<'a>(state: &'a State, network: &'a Network) -> impl Iterator<Item = f64> + 'a {
    network.bodies.iter().zip(&network.radii).flat_map(move |(body, radius)| {
        let (force, torque) = match *body {
            ProbeBody::Boundary(boundary) => {
                let inertial = &state.boundaries[boundary.index()].inertial;
                (inertial.load, inertial.couple)
            }
            ProbeBody::Particle(slot) => {
                let rows = [&state.particles.force, &state.particles.torque].map(|rows| rows[slot as usize]);
                (rows[0][..3].try_into().unwrap_or_default(), rows[1][..3].try_into().unwrap_or_default())
            }
            ProbeBody::Clump(clump) => {
                let rows = [&state.clumps.force, &state.clumps.moment].map(|rows| rows[clump as usize]);
                (rows[0][..3].try_into().unwrap_or_default(), rows[1][..3].try_into().unwrap_or_default())
            }
            ProbeBody::Cell => ([0.0; 3], [0.0; 3]),
        };
        let all = [force[0], force[1], force[2], torque[0] / radius, torque[1] / radius, torque[2] / radius];
        all.into_iter().take(network.each)
    })
}

/// The difference of loads between displacements there and back, over the way \[m\].
pub(super) fn difference(
    probe: &mut Probe,
    network: &Network,
    way: f64,
    displacements: impl Fn(f64) -> Vec<Displacement>,
) -> Result<Difference, RunError> {
    let there = probe.displaced(displacements(way).into_iter())?;
    let mut found = Difference {
        loads: loads(there, network).collect(),
        boundaries: there.boundaries.iter().map(|boundary| boundary.force).collect(),
        stress: [0.0; 6],
    };
    let stress = probe.stress();
    let back = probe.displaced(displacements(-way).into_iter())?;
    for (there, back) in found.loads.iter_mut().zip(loads(back, network)) {
        *there = (*there - back) / (2.0 * way);
    }
    for (there, back) in found.boundaries.iter_mut().zip(&back.boundaries) {
        for (there, back) in there.iter_mut().zip(back.force) {
            *there = (*there - back) / (2.0 * way);
        }
    }
    for ((found, there), back) in found.stress.iter_mut().zip(stress).zip(probe.stress()) {
        *found = (there - back) / (2.0 * way);
    }
    Ok(found)
}

impl Columns {
    /// Displaces every body along and about every axis, those at once that act on no common body.
    pub(super) fn of(probe: &mut Probe, network: &Network, way: f64) -> Result<Self, RunError> {
        let each = network.each;
        let empty = |list: &Vec<u32>| list.iter().map(|&other| (other, Block::zeros())).collect();
        let mut blocks: Vec<Vec<(u32, Block)>> = network.near.iter().map(empty).collect();
        for set in &network.sets {
            for axis in 0..each {
                let all = |amount| set.iter().map(|&body| network.displacement(body, axis, amount)).collect();
                let found = difference(probe, network, way, all)?;
                for &body in set {
                    for (other, block) in &mut blocks[body as usize] {
                        let first = *other as usize * each;
                        for (part, load) in block.column_mut(axis).iter_mut().zip(&found.loads[first..first + each]) {
                            *part = -load;
                        }
                    }
                }
            }
        }
        Ok(Self { each, blocks })
    }

    /// How many freedoms each body has.
    pub(super) fn each(&self) -> usize {
        self.each
    }

    /// How each body feels its own motion.
    pub(super) fn own_blocks(&self) -> impl Iterator<Item = Block> {
        (0..self.blocks.len() as u32).map(|body| self.block(body, body).copied().unwrap_or_default())
    }

    /// How many freedoms there are.
    pub(super) fn freedoms(&self) -> usize {
        self.each * self.blocks.len()
    }

    /// Mean of the entries on the diagonal that belong to translations \[N/m\].
    pub(super) fn mean_stiffness(&self) -> f64 {
        let own = |body: usize| {
            self.block(body as u32, body as u32).map_or(0.0, |own| own[(0, 0)] + own[(1, 1)] + own[(2, 2)])
        };
        (0..self.blocks.len()).map(own).sum::<f64>() / (3 * self.blocks.len()).max(1) as f64
    }

    /// Each body that feels the motion of one, with how it does, and how that one feels its motion.
    pub(super) fn each_pair(&self, see: &mut dyn FnMut([u32; 2], &Block, &Block)) {
        for (moving, list) in self.blocks.iter().enumerate() {
            for (body, block) in list {
                if let Some(mirrored) = self.block(moving as u32, *body) {
                    see([*body, moving as u32], block, mirrored);
                }
            }
        }
    }

    /// How one body feels the motion of another.
    fn block(&self, body: u32, moving: u32) -> Option<&Block> {
        let list = &self.blocks[moving as usize];
        list.binary_search_by_key(&body, |(other, _)| *other).ok().map(|place| &list[place].1)
    }

    /// Largest difference of two mirrored entries over the largest entry.
    pub(super) fn asymmetry(&self) -> f64 {
        let (mut difference, mut largest) = (0.0_f64, 0.0_f64);
        for (moving, list) in self.blocks.iter().enumerate() {
            for (body, block) in list {
                let Some(mirrored) = self.block(moving as u32, *body) else { continue };
                for (row, column) in (0..self.each).flat_map(|row| (0..self.each).map(move |column| (row, column))) {
                    difference = difference.max((block[(row, column)] - mirrored[(column, row)]).abs());
                    largest = largest.max(block[(row, column)].abs());
                }
            }
        }
        if largest > 0.0 { difference / largest } else { 0.0 }
    }

    /// −J times displacements.
    pub(super) fn times(&self, displacements: &[f64]) -> Vec<f64> {
        let mut loads = vec![0.0; displacements.len()];
        for (moving, list) in self.blocks.iter().enumerate() {
            let ways = &displacements[moving * self.each..(moving + 1) * self.each];
            for (body, block) in list {
                let loads = &mut loads[*body as usize * self.each..(*body as usize + 1) * self.each];
                for (load, row) in loads.iter_mut().zip(block.row_iter()) {
                    *load += row.iter().zip(ways).map(|(entry, way)| entry * way).sum::<f64>();
                }
            }
        }
        loads
    }
}
