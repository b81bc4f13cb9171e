//! Contacts between particles: one pass for each contact law.
//!
//! Slabs of even and odd number share no particles among themselves; one of odd number waits until both its neighbours are
//! done. The order in which a particle gets its loads is thus always the same.

use super::ahead::{Frame, Link, Meeting, SearchLimits};
use super::followed::{self, FollowedPairs, SlabRoom};
use super::listed::{self, ContactEntries, CurrentContact, ListColumns};
use super::pairs::Pairs;
use super::pass::{Pass, Stiffness, Telling};
use super::records::{ContactRecord, Motion};
use crate::base::lanes::Shared;
use crate::base::threads::Context;
use crate::engine::contacts::batches::SpherePair;
use crate::engine::contacts::batches::{BatchLaw, Batches, ContactGeometry, DeepestSearch, Entries, Lost};
use crate::engine::contacts::coefficients::{CoefficientTable, MaterialRow};
use crate::engine::contacts::encounters::{self, Encounters};
use crate::engine::run_error::RunError;
use crate::engine::state::ledger::Source;
use crate::engine::state::{ContactList, Deepest, Named, Particles, Row, State, StateFault};
use crate::laws::contact::{Contact, Law};
use crate::scene::Scene;
use std::sync::{Mutex, PoisonError};

/// The pass of one contact law.
pub(crate) struct ContactPass {
    /// Which list of the state is its own.
    pub index: usize,
    /// Rows that are kept of each contact.
    pub kept_rows: usize,
    /// Its coefficients.
    pub table: CoefficientTable,
    /// The law.
    pub law: BatchLaw,
    /// Room for what each slab lost.
    pub lost: Mutex<Vec<Lost>>,
    /// Who follows its contacts one by one, if anybody does.
    pub followed: Option<FollowedPairs>,
}

impl Pass for ContactPass {
    fn apply(&self, state: &mut State, context: &Context) -> Result<(), RunError> {
        let deepest = DeepestSearch::beyond(state.deepest.overlap);
        match &self.followed {
            None => self.evaluate(state, context, &deepest, None),
            Some(followed) => {
                let slabs = state.contacts[self.index].slabs.len().saturating_sub(1);
                followed
                    .with(state, slabs, |state, room| self.evaluate(state, context, &deepest, Some((followed, room))));
            }
        }
        if let Some(found) = deepest.found() {
            let [particle, partner] = [found.first, found.second].map(|slot| Named::at(&state.particles, slot));
            let (overlap, time) = (found.overlap, state.clock.time);
            state.deepest.take(Deepest { overlap, time, particle, partner: Some(partner), boundary: None });
        }
        Ok(())
    }

    fn check(&self, state: &State) -> Result<(), StateFault> {
        state.contacts[self.index].check_columns(self.kept_rows, self.law.law.has_pair_constant())
    }

    fn has_torque(&self) -> bool {
        self.law.needs.torque
    }

    fn source(&self) -> Source {
        Source::Contacts
    }

    fn take_coefficients(&mut self, state: &State) {
        self.table.take(&state.coefficients[self.index]);
    }

    fn let_go(&self, state: &mut State, goes: &[bool], _step: f64) -> f64 {
        if let Some(followed) = &self.followed {
            followed.let_go((&self.law.law, self.index), state, goes);
        }
        0.0
    }

    fn prepare(&self, state: &mut State) {
        let list = &mut state.contacts[self.index];
        let law = &self.law.law;
        list.pair_constant.clear();
        if law.has_pair_constant() {
            let particles = &state.particles;
            list.pair_constant.extend(list.first.iter().zip(&list.second).map(|(&i, &j)| {
                let (radius, mass) = effective(particles, i, j);
                let row = self.table.row(particles.material[i as usize], particles.material[j as usize]);
                law.pair_constant(row, radius, mass)
            }));
        }
    }
}

impl Stiffness for ContactPass {
    fn stiffness(&self, state: &State, ahead: &SearchLimits, context: &Context, tell: &mut dyn FnMut(Link)) {
        listed::stiffness(self, state, ahead, context, tell);
    }

    fn impacts(&self, _state: &State, meeting: &Meeting, tell: &mut dyn FnMut(Option<u32>, [Frame; 2])) {
        if let (first, Some(second)) = meeting.materials {
            let found = self.table.impact(&self.law.law, [first, second], meeting);
            found.into_iter().for_each(|parts| tell(None, parts));
        }
    }

    fn rows(&self, scene: &Scene, tell: &mut dyn FnMut(MaterialRow)) {
        let present = scene.present();
        let here = || (0..present.len()).filter(|&material| present[material]).map(|material| material as u32);
        for a in here() {
            for b in here().filter(|&b| b >= a) {
                self.table.material_row(self.index as u32, &self.law.law, [a, b]).into_iter().for_each(&mut *tell);
            }
        }
    }

    fn encounters(&self, state: &State, found: &mut Encounters) {
        encounters::of_list(self, state, found);
    }
}

impl Telling for ContactPass {
    fn contacts(&self, state: &State, step: f64, tell: &mut dyn FnMut(ContactRecord)) {
        listed::records(self, state, step, tell);
    }

    fn near_switch(&self, state: &State, step: f64, margin: f64) -> u64 {
        listed::near_switch(self, state, step, margin)
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        listed::elastic_energy(self, state)
    }

    fn held_energy(&self, state: &State) -> [f64; 3] {
        listed::held_energy(self, state)
    }
}

impl ContactPass {
    /// Evaluates the law on all contacts, which somebody may follow.
    fn evaluate(
        &self,
        state: &mut State,
        context: &Context,
        deepest: &DeepestSearch,
        followed: Option<(&FollowedPairs, SlabRoom)>,
    ) {
        let list = &mut state.contacts[self.index];
        let particles = &mut state.particles;
        let (heat, present): (&mut [f64], &mut [Row]) =
            state.heat.as_mut().map_or((&mut [], &mut []), |heat| (&mut heat.of_losses, &mut heat.slots));
        let conducting = self.law.conducting(self.table.uniform_entry()).filter(|_| !present.is_empty());
        let batches = Batches {
            bodies: Pairs {
                first: &list.first,
                second: &list.second,
                position: &particles.position,
                velocity: &particles.velocity,
                angular_velocity: &particles.angular_velocity,
                material: &particles.material,
                force: Shared::new(&mut particles.force),
                torque: Shared::new(&mut particles.torque),
                heat: Shared::new(heat),
                present: Shared::new(present),
            },
            entries: Entries::of(&mut list.flags, list.history.rows(), list.history.all_mut(), &mut list.pair_constant),
            law: &self.law,
            table: &self.table,
            uniform: self.table.uniform(),
            step: context.step,
            width: context.width,
            deepest,
            follows: followed.is_some(),
            conducting,
        };
        let owners = followed::Bodies { material: &particles.material, owner: &particles.owner };
        let (ends, slots) = (&list.slabs, &state.neighbours.slabs);
        let slabs = ends.len().saturating_sub(1);
        let piece = |slab: usize| {
            // Where slabs follow each other, an even one and then the odd one before it, these are the next to be needed.
            let next = slab + if slab.is_multiple_of(2) { 2 } else { 4 };
            let ahead = slots.get(next..next + 2).map_or(0..0, |ends| ends[0] as usize..ends[1] as usize);
            (ends[slab] as usize, ends[slab + 1] as usize, ahead)
        };
        let Some(losses) = &mut state.losses else {
            context.slabs(slabs, |slab| {
                let (from, to, ahead) = piece(slab);
                batches.run(from, to, ahead);
            });
            return;
        };
        let mut lost = self.lost.lock().unwrap_or_else(PoisonError::into_inner);
        lost.clear();
        lost.resize(slabs, Lost::default());
        let places = Shared::new(&mut lost);
        context.slabs(slabs, |slab| {
            let (from, to, ahead) = piece(slab);
            // SAFETY: each slab is done once, and has a place of its own.
            unsafe {
                *places.at(slab) = match &followed {
                    None => batches.run_booked(from, to, ahead).1,
                    Some((pairs, room)) => {
                        let room = room.at(slab);
                        let lost = batches.run_followed(from, to, ahead, &mut room.0).1;
                        pairs.follow((&self.law.law, context.step), &batches.entries, owners, room);
                        lost
                    }
                };
            }
        });
        lost.iter().for_each(|lost| lost.book(&self.law.law, losses));
    }
}

/// Effective radius \[m\] and mass \[kg\] of two particles.
pub(crate) fn effective(particles: &Particles, i: u32, j: u32) -> (f64, f64) {
    let (i, j) = (i as usize, j as usize);
    let (r, s) = (particles.position[i][3], particles.position[j][3]);
    let (m, n) = (particles.velocity[i][3], particles.velocity[j][3]);
    (r * s / (r + s), m * n / (m + n))
}

impl ContactEntries for ContactPass {
    fn law(&self) -> &Law {
        &self.law.law
    }

    fn kept<'a>(&self, state: &'a State) -> ListColumns<'a> {
        let ContactList { flags, history, pair_constant, .. } = &state.contacts[self.index];
        ListColumns { flags, history, pair_constant }
    }

    fn bodies(&self, state: &State, entry: usize) -> listed::Bodies {
        let list = &state.contacts[self.index];
        (list.first[entry], Some(list.second[entry]), None)
    }

    fn meet(&self, state: &State, entry: usize, gap: f64, motion: Motion) -> Option<CurrentContact<'_>> {
        let (list, kept) = (&state.contacts[self.index], self.kept(state));
        let Particles { position, material, .. } = &state.particles;
        let (i, j) = (list.first[entry], list.second[entry]);
        let spheres = SpherePair::of([position[i as usize], position[j as usize]]);
        let beyond = kept.reach(self.law(), entry, gap);
        if !spheres.overlap((beyond > 0.0).then_some(beyond)) {
            return None;
        }
        let ((v, w), (u, z)) = (motion.of(state, i), motion.of(state, j));
        let geometry = spheres.meet([v, u], [w, z], kept.constant(entry));
        let ContactGeometry { contact, first_arm, second_arm } = geometry;
        let row = self.table.row(material[i as usize], material[j as usize]);
        Some(CurrentContact { contact, arms: [first_arm, second_arm], row })
    }

    fn deepest(&self, state: &State, ahead: &SearchLimits, entry: usize, met: &CurrentContact) -> Option<Contact> {
        let list = &state.contacts[self.index];
        let slots = [list.first[entry], list.second[entry]];
        ahead.between(self.law(), met.row, &met.contact, &state.particles, slots)
    }
}
