//! A surface of features: where it is touched is found anew in each step.
//!
//! A particle touches several features at once, in a corner or a bend, and other ones in the next step. Its feet are found from
//! the parts that are near ([`crate::surface::Features`]) and become entries of a batch, with their weights and shares of
//! friction as columns. What a contact remembers goes with its feature, and from one feature to the next where the foot rolls
//! over a bend. A law that holds bodies together beyond touch does so where there was a contact before.

mod at_feet;
mod columns;
mod standing;
mod told;

use super::history::{Past, source, taken};
use super::nodes::Held;
use super::sphere::{Load, Loaded};
use super::{AtSurface, Range, Work};
use crate::batches::Entries;
use crate::number::Vector;
use crate::state::WallContacts;
use crate::surface::{Feet, Foot};
use at_feet::AtFeet;
pub(super) use columns::{FeatureContacts, replace};
use standing::{Stand, Standing};

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
        let evaluate = |at: Standing| self.piece_at(at, work, slots, contacts);
        Standing::with(self, (&work.boundaries[boundary], nodes), evaluate).unwrap_or_default()
    }

    /// The same where it stands.
    fn piece_at(&self, at: Standing, work: &Work, slots: Range<usize>, contacts: &mut FeatureContacts) -> Load {
        let list = &work.walls[self.index];
        contacts.clear(self.kept_rows);
        let through = self.find(&at, list, &work.particles, slots, contacts);
        let count = contacts.complete();
        let FeatureContacts { particle, number, foot, weight, flags, history, pair_constant, held, .. } = contacts;
        let (particles, held) = (work.particles, at.moving.map(|_| held.columns()));
        let bodies = AtFeet { at, particle, number, foot, weight, held, material: self.material, particles };
        let entries = Entries::of(flags, history, pair_constant);
        let load = self.run(&self.batches(bodies, entries, work.context), 0..count);
        contacts.finish();
        Load { behind: through, ..load }
    }

    /// Finds the contacts of the particles in a range of slots. Returns a particle that went through the surface.
    fn find(
        &self,
        at: &Standing,
        list: &WallContacts,
        particles: &Loaded,
        slots: Range<usize>,
        contacts: &mut FeatureContacts,
    ) -> Option<u32> {
        let sticks = self.law.law.holds_beyond_touch();
        let near = &list.near.particle;
        let [first, last] = [slots.start, slots.end].map(|end| near.partition_point(|&slot| (slot as usize) < end));
        let mut past = list.particle.partition_point(|&slot| (slot as usize) < slots.start);
        let (mut through, mut feet) = (None, std::mem::take(&mut contacts.feet));
        for (place, &slot) in (first..last).zip(&near[first..last]) {
            let position = particles.position[slot as usize];
            let constant = constant(list, place);
            let beyond = if sticks { constant } else { 0.0 };
            feet.clear();
            let centre = at.frame.inside(Vector::from(position));
            at.features.feet(centre, position[3] + beyond, parts(list, place), &mut feet);
            if feet.list.is_empty() {
                continue;
            }
            while list.particle.get(past).is_some_and(|&other| other < slot) {
                past += 1;
            }
            let count = list.particle[past..].iter().take_while(|&&other| other == slot).count();
            let past = Past::of(list, past..past + count);
            let here = Here { at, particles, slot, constant, feet: &feet };
            let went = self.add_feet(&here, &past, contacts);
            through = through.or(went.then_some(slot));
        }
        contacts.feet = feet;
        through
    }

    /// Adds the contacts of one particle. Returns whether it went through the surface.
    #[inline]
    fn add_feet(&self, here: &Here, past: &Past, contacts: &mut FeatureContacts) -> bool {
        let Here { at, particles, slot, constant, feet } = *here;
        let (law, mut through) = (&self.law.law, false);
        for foot in &feet.list {
            let own = past.entry(foot.feature);
            let known = source(foot, own, feet, past, at.features, law);
            if foot.distance > particles.position[slot as usize][3] && known.is_none() {
                continue;
            }
            let normal = at.frame.outside(foot.normal);
            for (row, rows) in contacts.history.iter_mut().enumerate() {
                let kept = known.map_or([0.0; 4], |entry| past.row(entry, row));
                let moved = if known == own { None } else { law.history().get(row) };
                rows.push(moved.map_or(kept, |memory| taken(kept, memory, normal)));
            }
            let share = match foot.weight > 0.0 {
                true if feet.saddles.is_empty() => foot.weight,
                true => self.friction(here, foot),
                false => 0.0,
            };
            if law.has_pair_constant() {
                contacts.pair_constant.push(constant);
            }
            if at.moving.is_some() {
                here.hold(foot, normal, &mut contacts.held);
            }
            contacts.push(slot, foot, normal, share);
            through |= own.is_some_and(|entry| past.was_behind(entry) != foot.behind);
        }
        through
    }

    /// The share of friction that a foot beside a saddle has.
    #[inline(never)]
    fn friction(&self, here: &Here, foot: &Foot) -> f64 {
        let (slot, particles) = (here.slot as usize, here.particles);
        let body = [particles.position[slot], particles.velocity[slot], particles.angular_velocity[slot]];
        let row = self.table.row(particles.material[slot], self.material);
        Stand { at: here.at, body, row, constant: here.constant }.friction(&self.law.law, foot, here.feet)
    }
}

/// What a particle touches. What few contacts need is found from it, out of line.
struct Here<'a> {
    /// The surface.
    at: &'a Standing<'a>,
    /// The particles.
    particles: &'a Loaded<'a>,
    /// Which particle (slot).
    slot: u32,
    /// Its pair constant.
    constant: f64,
    /// Its feet.
    feet: &'a Feet,
}

impl Here<'_> {
    /// Adds what a contact has beside where nodes move one by one.
    #[inline(never)]
    fn hold(&self, foot: &Foot, normal: Vector, held: &mut Held) {
        if let Some(moving) = &self.at.moving {
            let position = self.particles.position[self.slot as usize];
            held.push(moving, (foot, normal), self.at.frame.inside(Vector::from(position)), position[3]);
        }
    }
}
