//! Reading a simulation without touching it.

use super::Simulation;
use crate::base::number::Vector;
use crate::base::threads::Context;
use crate::engine::bodies;
use crate::engine::cell::Fabric;
use crate::engine::contacts::{BondRecord, ContactRecord, SLIGHT};
use crate::engine::energy;
use crate::engine::state::State;
use crate::engine::state::contacts::{TOUCHING, is_resting, is_suppressed, is_told};
use crate::engine::state::exchange::NetExchange;
use crate::engine::state::ledger::Source;
use crate::laws::bond::BondLoads;
use crate::laws::surface;
use crate::scene::Scene;

/// Elastic energy of a simulation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElasticEnergy {
    /// Of contacts and bonds \[J\].
    pub all: f64,
    /// Of bonds alone \[J\].
    pub bonds: f64,
}

impl Simulation {
    /// Kinetic energy of the particles and bodies that move by the forces on them \[J\].
    pub fn kinetic_energy(&self) -> f64 {
        energy::kinetic(&self.state, &self.bodies, &self.quiet())
    }

    /// Contacts between particles and of particles with planes.
    pub fn contact_count(&self) -> usize {
        let touching = |flags: &Vec<u8>| flags.iter().filter(|flags| is_told(**flags)).count();
        let pairs = self.state.contacts.iter().map(|list| touching(&list.flags)).sum::<usize>();
        pairs + self.state.walls.iter().map(|list| touching(&list.flags)).sum::<usize>()
    }

    /// How many contacts, of pairs of particles and at planes, are near a switch: they would begin or end to slide in the next time
    /// step if their overlap were a ten-thousandth larger or smaller, or touch or miss by less than that share of the mean overlap.
    /// A derivative holds for changes that take none of them over its switch.
    pub fn contacts_near_switch(&self) -> u64 {
        let margin = SLIGHT * self.mean_overlap().unwrap_or(0.0);
        self.passes.iter().map(|pass| pass.near_switch(&self.state, self.state.clock.last_step, margin)).sum()
    }

    /// Every contact at work, between particles first, then at planes. Where the scene writes contacts or boundaries, probes a contact
    /// or has regions, dashpots are shown exactly as the last evaluation saw them; elsewhere with the velocity of mid-step, which they see with the
    /// scheme `engine`.
    pub fn contacts(&self) -> Vec<ContactRecord> {
        let mut records = Vec::new();
        self.each_contact(&mut |record| records.push(record));
        records
    }

    /// Tells the same contacts one by one.
    pub(crate) fn each_contact(&self, tell: &mut dyn FnMut(ContactRecord)) {
        self.passes.iter().for_each(|pass| pass.contacts(&self.state, self.state.clock.last_step, tell));
    }

    /// Every living bond, law by law.
    pub fn bonds(&self) -> Vec<BondRecord> {
        let mut records = Vec::new();
        self.each_bond(&mut |record| records.push(record));
        records
    }

    /// Tells the same bonds one by one.
    pub(crate) fn each_bond(&self, tell: &mut dyn FnMut(BondRecord)) {
        self.passes.iter().for_each(|pass| pass.bonds(&self.state, tell));
    }

    /// Largest overlap over the smaller radius of the two (the particle's, at a plane), of contacts that no bond suppresses. From
    /// positions alone: rows of a history ask for it often.
    pub fn largest_overlap(&self) -> f64 {
        let mut largest: f64 = 0.0;
        each_overlap(&self.state, &self.scene, &mut |flags, overlap, radius| {
            if !is_suppressed(flags) {
                largest = largest.max(overlap / radius);
            }
        });
        self.passes.iter().fold(largest, |most, pass| most.max(pass.largest_overlap(&self.state)))
    }

    /// Mean overlap of the contacts that touch \[m\], if any do.
    pub fn mean_overlap(&self) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0_usize);
        each_overlap(&self.state, &self.scene, &mut |_, overlap, _| {
            sum += overlap;
            count += 1;
        });
        (count > 0).then(|| sum / count as f64)
    }

    /// Elastic energy of contacts and bonds \[J\]: of contacts that of normal force and tangential spring, not the
    /// potential of an attraction.
    pub fn elastic_energy(&self) -> f64 {
        self.elastic_energies().all
    }

    /// Elastic energy of bonds alone \[J\].
    pub fn bond_elastic_energy(&self) -> f64 {
        let bonds = self.passes.iter().filter(|pass| pass.source() == Source::Bonds);
        bonds.map(|pass| pass.elastic_energy(&self.state)).sum()
    }

    /// Elastic energy of the contacts without what their springs hold, of laws whose normal force remembers nothing \[J\].
    pub fn pressing_energy(&self) -> f64 {
        let mut state = self.state.clone();
        let contacts = state.contacts.iter_mut().map(|list| &mut list.history);
        for history in contacts.chain(state.walls.iter_mut().map(|list| &mut list.history)) {
            history.all_mut().fill([0.0; 4]);
        }
        let touching = self.passes.iter().filter(|pass| pass.source() != Source::Bonds);
        touching.map(|pass| pass.elastic_energy(&state)).sum()
    }

    /// Both at once.
    pub fn elastic_energies(&self) -> ElasticEnergy {
        let mut sum = ElasticEnergy::default();
        for pass in &self.passes {
            let energy = pass.elastic_energy(&self.state);
            sum.all += energy;
            if pass.source() == Source::Bonds {
                sum.bonds += energy;
            }
        }
        sum
    }

    /// Mean unbalanced force of the free particles and bodies over the mean normal force of the contacts, or, where no
    /// contact presses, over the mean force of the bonds; infinite where there is neither.
    pub fn unbalanced_force(&self) -> f64 {
        let particles = &self.state.particles;
        let free = (0..particles.len()).filter(|&slot| particles.owner[slot] == 0);
        let (mut sum, mut count) = (0.0, 0_usize);
        for slot in free {
            sum += Vector::from(particles.force[slot]).length();
            count += 1;
        }
        for body in bodies::each(&self.bodies, &self.state).filter(|body| body.moves != [false; 3]) {
            sum += body.rigid.force.length();
            count += 1;
        }
        match self.mean_interaction() {
            Some(mean) if count > 0 => sum / count as f64 / mean,
            _ => f64::INFINITY,
        }
    }

    /// The same with the forces as they are without global damping. Changes nothing.
    pub fn undamped_unbalanced_force(&mut self) -> f64 {
        let kept = self.state.clone();
        let damped = self.fields.without_damping();
        let context = self.standing();
        // What an evaluation finds wrong the next time step finds, too.
        let ratio = self.evaluate(&context).map_or(f64::INFINITY, |()| self.unbalanced_force());
        self.fields.damp_as(damped);
        self.state = kept;
        ratio
    }

    /// The fastest of the particles that forces move: its index, its speed \[m/s\] and its radius \[m\].
    pub fn fastest(&self) -> Option<(u32, f64, f64)> {
        let particles = &self.state.particles;
        let moves = |slot: &usize| self.state.is_loose(*slot);
        let free = (0..particles.len()).filter(moves);
        let speed = |slot: usize| Vector::from(particles.velocity[slot]).length();
        let slot = free.reduce(|most, next| if speed(next) > speed(most) { next } else { most })?;
        Some((particles.id[slot], speed(slot), particles.position[slot][3]))
    }

    /// Mean normal force of the contacts, or, where no contact presses, mean force of the bonds \[N\]; none without either.
    pub fn mean_interaction(&self) -> Option<f64> {
        let contacts: Vec<f64> = self.contacts().iter().map(|contact| contact.normal_force.abs()).collect();
        let bonds = || -> Vec<f64> {
            let force = |BondLoads { axis, normal, shear, .. }| Vector::from(axis) * normal + Vector::from(shear);
            self.bonds().iter().map(|bond| force(bond.carried).length()).collect()
        };
        let mean = |forces: Vec<f64>| forces.iter().sum::<f64>() / forces.len().max(1) as f64;
        Some(mean(contacts)).filter(|mean| *mean > 0.0).or_else(|| Some(mean(bonds())).filter(|mean| *mean > 0.0))
    }

    /// Potential energy of gravity is not counted: this is the sum over the energy book of what was not accounted
    /// for \[J\]; `None` where the scene keeps no book.
    pub fn energy_residual(&self) -> Option<f64> {
        self.state.ledger.as_ref()?;
        self.energy_residual_beside(self.kinetic_energy())
    }

    /// The same, where the kinetic energy is known \[J\].
    pub fn energy_residual_beside(&self, kinetic: f64) -> Option<f64> {
        let ledger = self.state.ledger.as_ref()?;
        Some(kinetic - ledger.initial_kinetic - ledger.total() - self.exchanged().kinetic)
    }

    /// Energy that contacts, bonds and global damping took in since the book was opened and do not hold as elastic
    /// energy \[J\]; `None` where the scene keeps no book.
    ///
    /// The difference of what boundaries put into the particles and what the forces gave back to them as work, less
    /// the growth of the elastic energy. It holds the error of the time stepping, of the second order in the step.
    pub fn dissipated_energy(&self) -> Option<f64> {
        self.state.ledger.as_ref()?;
        self.dissipated_energy_beside(self.elastic_energy())
    }

    /// The same, where the elastic energy is known \[J\].
    pub fn dissipated_energy_beside(&self, elastic: f64) -> Option<f64> {
        let ledger = self.state.ledger.as_ref()?;
        let given: f64 = self.state.works().sum();
        // What the streaming motion of a cell did to velocities went through no force.
        let kinds = [Source::Contacts, Source::Bonds, Source::Walls, Source::Damping, Source::Cell];
        let returned: f64 = kinds.into_iter().map(|kind| ledger.work_of(kind)).sum();
        Some(given - returned - (elastic - ledger.initial_elastic - self.exchanged().elastic))
    }

    /// What came less what went.
    pub fn exchanged(&self) -> NetExchange {
        self.state.exchange.as_ref().map_or_else(NetExchange::default, |exchange| exchange.net)
    }

    /// Cauchy stress of the periodic cell at the present time, tension positive: xx, yy, zz, xy, xz, yz \[Pa\]; zeros without a cell.
    pub fn cell_stress(&self) -> [f64; 6] {
        self.cell.as_ref().map_or([0.0; 6], |cell| cell.stress(&self.state))
    }

    /// Volume of the periodic cell \[m³\]; 0 without one.
    pub fn cell_volume(&self) -> f64 {
        self.cell.as_ref().map_or(0.0, |cell| cell.volume(&self.state))
    }

    /// Part of the periodic cell that no particle fills, what they overlap counted twice.
    pub fn cell_porosity(&self) -> f64 {
        self.cell.as_ref().map_or(0.0, |cell| cell.porosity(&self.state))
    }

    /// Contacts between the particles of a periodic cell.
    pub fn cell_fabric(&self) -> Fabric {
        let mut normals = Vec::new();
        self.each_contact(&mut |record| normals.extend(record.second.map(|_| record.normal)));
        Fabric::of(normals.into_iter(), self.state.particles.slots().count())
    }

    /// Threads at work.
    pub fn threads(&self) -> usize {
        self.workers.count()
    }

    /// A context for reading.
    pub(crate) fn quiet(&self) -> Context<'static> {
        Context { step: 0.0, width: self.width, threads: None, watch: None }
    }
}

/// Hands out the flags of each contact between particles and at planes, its overlap and the smaller radius of the two bodies (the
/// particle's, at a plane) \[m\]. From positions alone.
pub(super) fn each_overlap(state: &State, scene: &Scene, hand: &mut dyn FnMut(u8, f64, f64)) {
    let State { particles, contacts, walls, boundaries, .. } = state;
    let position = |slot: u32| particles.position[slot as usize];
    let touches = |flags: &[u8], place: usize| flags[place] & TOUCHING != 0 || is_resting(flags[place]);
    let mut hand = |flags: u8, overlap: f64, radius: f64| {
        if !is_resting(flags) || overlap > 0.0 {
            hand(flags, overlap, radius);
        }
    };
    for list in contacts {
        for place in (0..list.flags.len()).filter(|&place| touches(&list.flags, place)) {
            let (a, b) = (position(list.first[place]), position(list.second[place]));
            let distance = (Vector::from(a) - Vector::from(b)).length();
            hand(list.flags[place], a[3] + b[3] - distance, a[3].min(b[3]));
        }
    }
    for list in walls {
        let boundary = list.boundary as usize;
        let Some(surface::Plane { point, normal, .. }) = scene.boundaries[boundary].shifting_plane() else { continue };
        let point = Vector::from(point) + Vector::from(boundaries[boundary].displacement);
        for place in (0..list.flags.len()).filter(|&place| touches(&list.flags, place)) {
            let particle = position(list.particle[place]);
            let distance = (Vector::from(particle) - point).dot(normal.into());
            hand(list.flags[place], particle[3] - distance, particle[3]);
        }
    }
}
