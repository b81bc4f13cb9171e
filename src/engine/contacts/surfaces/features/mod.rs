//! A surface of features: where it is touched is found anew in each step.
//!
//! A particle touches several features at once, in a corner or a bend, and other ones in the next step. Its feet are found from
//! the parts that are near ([`crate::laws::surface::Features`]) and become entries of a batch, with their weights and shares of
//! friction as columns. What a contact remembers goes with its feature, and from one feature to the next where the foot rolls
//! over a bend. A law that holds bodies together beyond touch does so where there was a contact before.

mod at_feet;
mod columns;
mod held;
mod on_planes;
mod standing;
mod through;
mod together;
mod told;

use super::history::{CurrentContacts, PreviousContacts, source, taken};
use super::nodes::Held;
use super::sphere::{Load, ParticleLoads};
use super::traces::TouchedFeatures;
use super::{AtSurface, Range, Work};
use crate::base::lanes::Width;
use crate::base::number::Vector;
use crate::engine::boundaries::passing::Passed;
use crate::engine::contacts::batches::Entries;
use crate::engine::state::{IMAGE, WallContacts};
use crate::laws::surface::{Feet, Foot, NO_PLANE, Saddle, TOGETHER};
use at_feet::AtFeet;
use columns::finish;
pub(super) use columns::{ColumnBuffer, FeatureContacts, replace};
pub(super) use standing::MovingSurface;
use standing::SphereOnSurface;

/// The parts that are near a listed particle.
fn parts(list: &WallContacts, place: usize) -> &[u32] {
    let [from, to] = [place, place + 1].map(|place| list.near.starts.get(place).map_or(0, |&start| start as usize));
    &list.near.parts[from..to.max(from)]
}

/// The pair constant of a particle that is near.
fn constant(list: &WallContacts, place: usize) -> f64 {
    list.pair_constant.get(place).copied().unwrap_or(0.0)
}

impl AtSurface {
    /// What the particles in a range of slots do to a surface of features.
    pub(super) fn piece_at_features(&self, work: &Work, slots: Range<usize>, contacts: &mut FeatureContacts) -> Load {
        let boundary = work.walls[self.index].boundary as usize;
        let nodes = work.nodes.iter().find(|nodes| nodes.boundary as usize == boundary);
        let evaluate = |at: MovingSurface| {
            let warm = work.heat.1.iter().find(|nodes| nodes.boundary as usize == boundary);
            let warm = warm.map_or(&[][..], |nodes| &nodes.each);
            self.piece_at(MovingSurface { warm, ..at }, work, slots, contacts)
        };
        MovingSurface::with(self, (&work.boundaries[boundary], nodes), evaluate).unwrap_or_default()
    }

    /// The same where it stands.
    fn piece_at(&self, at: MovingSurface, work: &Work, slots: Range<usize>, contacts: &mut FeatureContacts) -> Load {
        let list = &work.walls[self.index];
        let [from, to] =
            [slots.start, slots.end].map(|end| list.particle.partition_point(|&slot| (slot as usize) < end));
        let entries = work.entries[self.index].from(from, &mut []);
        let past = PreviousContacts { particle: &list.particle[from..to], feature: &list.feature[from..to], entries };
        // Triangles lie all over the memory; those that were touched are most of what is looked at first.
        at.features.prefetch(past.feature);
        contacts.clear(self.kept_rows);
        self.find(&at, list, &work.particles, (slots.clone(), work.context.width), &past, contacts);
        contacts.complete(&past, from..to, self.kept_rows);
        if contacts.kept.is_none() {
            self.remember(&at, &past, contacts);
            if let Some(row) = self.law.law.history_places().held {
                held::hand_on(row, &past, contacts, &work.particles);
            }
        }
        let behind = self.came_through(&at, work, slots, contacts);
        let FeatureContacts { particle, feature, number, foot, weight, pair_constant, held, traces, .. } = contacts;
        let (count, particles) = (particle.len(), work.particles);
        let entries = match contacts.kept {
            Some(_) => entries.from(0, pair_constant),
            None => {
                Entries::of(&mut contacts.flags, contacts.history.rows(), contacts.history.all_mut(), pair_constant)
            }
        };
        // SAFETY: the entries are those of this piece.
        unsafe { entries.flags.part(0, count) }.fill(0);
        let held = at.moving.map(|_| held.columns());
        let (material, share_of_heat, level) = (self.material, self.share_of_heat, work.level(list.boundary));
        let bodies = AtFeet { at, particle, number, foot, weight, held, material, share_of_heat, level, particles };
        let load = self.run(&self.batches(bodies, entries, work), 0..count, traces);
        if self.follower.is_some() {
            let touched = TouchedFeatures { at: &at, particle, feature, foot, weight, particles };
            self.trace_features(&touched, (&past, entries), work.context.step, traces);
        }
        // SAFETY: as above.
        finish(unsafe { entries.flags.part(0, count) }, weight);
        Load { behind, ..load }
    }

    /// Finds the contacts of the particles in a range of slots.
    fn find(
        &self,
        at: &MovingSurface,
        list: &WallContacts,
        particles: &ParticleLoads,
        (slots, width): (Range<usize>, Width),
        past: &PreviousContacts,
        contacts: &mut FeatureContacts,
    ) {
        // Where contacts have no more than a foot.
        let law = &self.law.law;
        let is_plain = !law.holds_beyond_touch() && !law.has_pair_constant() && at.moving.is_none();
        let near = &list.near.particle;
        let [mut first, last] = [slots.start, slots.end].map(|end| near.partition_point(|&slot| (slot as usize) < end));
        let (mut feet, mut entry) = (std::mem::take(&mut contacts.feet), 0);
        while first < last {
            let together = if is_plain { TOGETHER.min(last - first) } else { last - first };
            let places = first..first + together;
            let on_planes = list.near.plane[places.clone()].iter().fold(false, |any, &plane| any | (plane != NO_PLANE));
            if is_plain && on_planes {
                let found = (&mut *contacts, &mut feet);
                entry = self.find_together(at, (list, places), (particles, width), (past, entry), found);
            } else {
                places.for_each(|place| self.find_at(at, (list, place), particles, past, (contacts, &mut feet)));
            }
            first += together;
        }
        contacts.feet = feet;
    }

    /// Finds the contacts of one particle, whose place in the list is this one, from all parts that are near.
    fn find_at(
        &self,
        at: &MovingSurface,
        (list, place): (&WallContacts, usize),
        particles: &ParticleLoads,
        past: &PreviousContacts,
        (contacts, feet): (&mut FeatureContacts, &mut Feet),
    ) {
        let (slot, constant) = (list.near.particle[place], constant(list, place));
        let (position, sticks) = (particles.position[slot as usize], self.law.law.holds_beyond_touch());
        let centre = at.frame.inside(Vector::from(position));
        feet.clear();
        at.features.feet(centre, position[3] + if sticks { constant } else { 0.0 }, parts(list, place), feet);
        if feet.are_deep(position[3]) {
            contacts.deep.push(slot);
        }
        if sticks {
            self.keep_touched(at, (slot, position[3]), past, feet);
        }
        let here = SphereContacts { at, particles, slot, constant, feet };
        feet.list.iter().for_each(|foot| self.add(&here, foot, contacts));
        contacts.saddles.extend(feet.saddles.iter().map(|saddle| (slot, *saddle)));
    }

    /// The first particle of a range of slots whose centre came through the surface in the present time step, if one did.
    fn came_through(
        &self,
        at: &MovingSurface,
        work: &Work,
        slots: Range<usize>,
        contacts: &FeatureContacts,
    ) -> Option<u32> {
        let (boundary, passing) = (work.walls[self.index].boundary as usize, &work.passing);
        if work.context.step == 0.0 || contacts.deep.is_empty() && !work.far {
            return None;
        }
        let moved = work.particles.moved(work.context.step);
        let way = |slot: usize| passing.way((boundary, work.boundaries), moved, slot);
        let surface = match &at.moving {
            Some(moving) => Passed::Nodes(moving.shape, moving.nodes),
            None => Passed::Features(at.features),
        };
        if work.far {
            let touches = |slot: &usize| {
                ![boundary as u32 + 1, IMAGE].contains(&moved.owner[*slot])
                    && passing.meet(work.particles.material[*slot], self.material)
            };
            let over = |slot: &usize| surface.is_over(way(*slot), moved.position[*slot][3]);
            return slots.filter(touches).find(over).map(|slot| slot as u32);
        }
        contacts.deep.iter().copied().find(|slot| surface.is_through(way(*slot as usize)))
    }

    /// Adds a contact.
    #[inline]
    fn add(&self, here: &SphereContacts, foot: &Foot, contacts: &mut FeatureContacts) {
        let normal = here.at.frame.outside(foot.normal);
        let share = match foot.weight > 0.0 {
            true if here.feet.saddles.is_empty() => foot.weight,
            true => self.friction(here, foot),
            false => 0.0,
        };
        if self.law.law.has_pair_constant() {
            contacts.pair_constant.push(here.constant);
        }
        if here.at.moving.is_some() {
            here.hold(foot, normal, &mut contacts.held);
        }
        contacts.push(here.slot, foot, normal, share);
    }

    /// Keeps those feet of a particle (slot, radius \[m\]) that are touched: beyond touch, where there was a contact before.
    #[inline(never)]
    fn keep_touched(&self, at: &MovingSurface, (slot, radius): (u32, f64), past: &PreviousContacts, feet: &mut Feet) {
        if feet.list.iter().all(|foot| foot.distance <= radius) {
            return;
        }
        let entries = past.of(slot, past.particle.partition_point(|&other| other < slot));
        let mut features = std::mem::take(&mut feet.room[0]);
        features.clear();
        features.extend(feet.list.iter().map(|foot| foot.feature));
        let saddles: Vec<(u32, Saddle)> = feet.saddles.iter().map(|saddle| (slot, *saddle)).collect();
        let present = CurrentContacts { features: &features, saddles: &saddles };
        feet.list.retain(|foot| {
            let known = || source((foot.feature, foot.weight), present, (past, &entries), at.features, &self.law.law);
            foot.distance <= radius || known().is_some()
        });
        feet.room[0] = features;
    }

    /// Gives all contacts what is remembered of them.
    #[inline(never)]
    fn remember(&self, at: &MovingSurface, past: &PreviousContacts, contacts: &mut FeatureContacts) {
        let (law, mut history) = (&self.law.law, std::mem::take(&mut contacts.history));
        let (mut first, mut entries) = (0, 0..0);
        while let Some(&slot) = contacts.particle.get(first) {
            let end = first + contacts.particle[first..].iter().take_while(|&&other| other == slot).count();
            entries = past.of(slot, entries.end);
            let present = contacts.present(first..end);
            for contact in first..end {
                let feature = contacts.feature[contact];
                let touched = (feature, contacts.weight(contact));
                let known = source(touched, present, (past, &entries), at.features, law);
                let moved = known != past.entry(&entries, feature);
                let normal = Vector::from(contacts.foot[contact]);
                history.push((0..history.rows()).map(|row| {
                    let kept = known.map_or([0.0; 4], |entry| past.row(entry, row));
                    let memory = law.history().get(row).filter(|_| moved);
                    memory.map_or(kept, |memory| taken(kept, memory, normal))
                }));
            }
            first = end;
        }
        contacts.flags.resize(contacts.particle.len(), 0);
        contacts.history = history;
    }

    /// The share of friction that a foot beside a saddle has.
    #[inline(never)]
    fn friction(&self, here: &SphereContacts, foot: &Foot) -> f64 {
        let (slot, particles) = (here.slot as usize, here.particles);
        let body = particles.body(slot);
        let row = self.table.row(particles.material[slot], self.material);
        SphereOnSurface { at: here.at, body, row, constant: here.constant }.friction(&self.law.law, foot, here.feet)
    }
}

/// What a particle touches. What few contacts need is found from it, out of line.
struct SphereContacts<'a> {
    /// The surface.
    at: &'a MovingSurface<'a>,
    /// The particles.
    particles: &'a ParticleLoads<'a>,
    /// Which particle (slot).
    slot: u32,
    /// Its pair constant.
    constant: f64,
    /// Its feet.
    feet: &'a Feet,
}

impl SphereContacts<'_> {
    /// Adds what a contact has beside where nodes move one by one.
    #[inline(never)]
    fn hold(&self, foot: &Foot, normal: Vector, held: &mut Held) {
        if let Some(moving) = &self.at.moving {
            let position = self.particles.position[self.slot as usize];
            let centre = self.at.frame.inside(Vector::from(position));
            held.push((moving, self.at.warm), (foot, normal), centre, position[3]);
        }
    }
}
