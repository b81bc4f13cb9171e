//! The contacts with features that an evaluation finds, each a column.

use super::together::Together;
use crate::base::number::Vector;
use crate::engine::contacts::surfaces::history::{CurrentContacts, PreviousContacts};
use crate::engine::contacts::surfaces::nodes::Held;
use crate::engine::contacts::surfaces::traces::TraceRoom;
use crate::engine::state::contacts::{SLIDING, TOUCHING};
use crate::engine::state::{History, Row, WallContacts};
use crate::laws::surface::{Feet, Foot, Saddle};
use std::ops::Range;

/// Contacts of a piece of the particles with the features of a surface, each a column; kept from one step to the next for its
/// room.
#[derive(Default)]
pub(in crate::engine::contacts::surfaces) struct FeatureContacts {
    /// The particle of each (slot).
    pub(super) particle: Vec<u32>,
    /// Its feature.
    pub(super) feature: Vec<u32>,
    /// Where these same contacts, particles and features, stand in the list already: then the list stores what the law
    /// remembers of them, and otherwise the next two.
    pub(super) kept: Option<Range<usize>>,
    /// Its bits.
    pub(super) flags: Vec<u8>,
    /// What the law remembers of it.
    pub(super) history: History,
    /// Its pair constant; empty where the law has none.
    pub(super) pair_constant: Vec<f64>,
    /// Its number: 0, 1, 2, …
    pub(super) number: Vec<u32>,
    /// Normal and distance of its foot \[m\].
    pub(super) foot: Vec<Row>,
    /// How often its normal force counts, its share of friction, and how often its energy counts; empty where each counts once.
    pub(super) weight: Vec<[f64; 3]>,
    /// Particles (slots) that may just have come through the surface.
    pub(super) deep: Vec<u32>,
    /// The saddles, each with its particle.
    pub(super) saddles: Vec<(u32, Saddle)>,
    /// What it has beside where nodes move one by one.
    pub(super) held: Held,
    /// What the present particle touches.
    pub(super) feet: Feet,
    /// What contacts leave behind, where they are followed: also those of a plane.
    pub(super) traces: TraceRoom,
    /// Room for particles over planes, where there were any.
    pub(super) together: Option<Box<Together>>,
}

impl FeatureContacts {
    /// Forgets all contacts, of which so many rows are stored.
    pub(super) fn clear(&mut self, rows: usize) {
        self.particle.clear();
        self.feature.clear();
        self.flags.clear();
        self.history.clear(rows);
        self.pair_constant.clear();
        self.foot.clear();
        self.weight.clear();
        self.deep.clear();
        self.saddles.clear();
        self.held.clear();
    }

    /// Adds a contact but for what is remembered of it: the foot of a particle (slot), the normal there in global axes, and the
    /// share of friction.
    #[inline]
    pub(super) fn push(&mut self, slot: u32, foot: &Foot, normal: Vector, share: f64) {
        let weight = foot.weight * foot.slope;
        if weight != 1.0 || share != 1.0 || !self.weight.is_empty() {
            self.weigh([weight, share, foot.weight]);
        }
        self.particle.push(slot);
        self.feature.push(foot.feature);
        self.foot.push(normal.row_with(foot.distance));
    }

    /// Adds the first of the contacts that were found of particles together, but for what is remembered of them. Each counts once.
    pub(super) fn push_together(&mut self, found: &Together, count: usize) {
        if !self.weight.is_empty() {
            self.weight.resize(self.particle.len() + count, [1.0; 3]);
        }
        self.particle.extend_from_slice(&found.slot[..count]);
        self.feature.extend_from_slice(&found.spheres.feature[..count]);
        self.foot.extend_from_slice(&found.spheres.foot[..count]);
    }

    /// Gives weights to the contact that is added next.
    #[inline(never)]
    fn weigh(&mut self, weights: [f64; 3]) {
        self.weight.resize(self.particle.len(), [1.0; 3]);
        self.weight.push(weights);
    }

    /// How often the normal force of a contact counts.
    pub(super) fn weight(&self, contact: usize) -> f64 {
        self.weight.get(contact).map_or(1.0, |[weight, ..]| *weight)
    }

    /// Ends the search: all contacts have their numbers. Looks whether they are those of the last evaluation, which stood
    /// there in the list.
    pub(super) fn complete(&mut self, past: &PreviousContacts, range: Range<usize>, rows: usize) {
        let count = self.particle.len();
        self.number.extend(self.number.len() as u32..count as u32);
        let same = past.particle == self.particle && past.feature == self.feature && past.entries.rows() == rows;
        self.kept = same.then_some(range);
    }

    /// What a particle touches whose contacts are these.
    pub(super) fn present(&self, contacts: Range<usize>) -> CurrentContacts<'_> {
        let saddles = &self.saddles[..];
        let [from, to] = match contacts.clone().next() {
            Some(contact) if !saddles.is_empty() => {
                let slot = self.particle[contact];
                [
                    saddles.partition_point(|(other, _)| *other < slot),
                    saddles.partition_point(|(other, _)| *other <= slot),
                ]
            }
            _ => [0; 2],
        };
        CurrentContacts { features: &self.feature[contacts], saddles: &saddles[from..to] }
    }

    /// What contacts leave behind.
    pub(in crate::engine::contacts::surfaces) fn traces(&self) -> &TraceRoom {
        &self.traces
    }

    /// The same, to be filled.
    pub(in crate::engine::contacts::surfaces) fn traces_mut(&mut self) -> &mut TraceRoom {
        &mut self.traces
    }

    /// What the contacts have beside where nodes move one by one.
    pub(in crate::engine::contacts::surfaces) fn held(&self) -> &Held {
        &self.held
    }
}

/// Writes the bits of all contacts when the law has acted: a saddle is not a contact of its own.
pub(super) fn finish(flags: &mut [u8], weight: &[[f64; 3]]) {
    flags.iter_mut().for_each(|flags| *flags &= TOUCHING | SLIDING);
    for (flags, _) in flags.iter_mut().zip(weight).filter(|(_, [weight, ..])| *weight < 0.0) {
        *flags = 0;
    }
}

/// The columns of a list of contacts with features.
#[derive(Default)]
pub(in crate::engine::contacts::surfaces) struct ColumnBuffer {
    /// Particles.
    particle: Vec<u32>,
    /// Features.
    feature: Vec<u32>,
    /// Bits.
    flags: Vec<u8>,
    /// What is stored.
    history: History,
}

/// Puts the contacts that the pieces found, of each of which so many rows are stored, in the place of a list's, whose room is
/// the spare one of the next time. Nothing changes where all are there already.
pub(in crate::engine::contacts::surfaces) fn replace<'a>(
    list: &mut WallContacts,
    rows: usize,
    spare: &mut ColumnBuffer,
    pieces: impl Iterator<Item = &'a FeatureContacts> + Clone,
) {
    if pieces.clone().all(|piece| piece.kept.is_some()) {
        return;
    }
    spare.particle.clear();
    spare.feature.clear();
    spare.flags.clear();
    spare.history.clear(rows);
    for piece in pieces {
        spare.particle.extend_from_slice(&piece.particle);
        spare.feature.extend_from_slice(&piece.feature);
        let (flags, history, range) = match &piece.kept {
            Some(range) => (&list.flags, &list.history, range.clone()),
            None => (&piece.flags, &piece.history, 0..piece.flags.len()),
        };
        spare.flags.extend_from_slice(&flags[range.clone()]);
        spare.history.append(history, range);
    }
    std::mem::swap(&mut list.particle, &mut spare.particle);
    std::mem::swap(&mut list.feature, &mut spare.feature);
    std::mem::swap(&mut list.flags, &mut spare.flags);
    std::mem::swap(&mut list.history, &mut spare.history);
}
