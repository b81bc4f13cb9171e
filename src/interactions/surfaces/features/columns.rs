//! The contacts with features that an evaluation finds, each a column.

use super::super::nodes::Held;
use crate::number::Vector;
use crate::state::contacts::{REVERSE, SLIDING, TOUCHING};
use crate::state::{Row, WallContacts};
use crate::surface::{Feet, Foot};

/// Contacts of a piece of the particles with the features of a surface, each a column; kept from one step to the next for its
/// room.
#[derive(Default)]
pub(in super::super) struct FeatureContacts {
    /// The particle of each (slot).
    pub(super) particle: Vec<u32>,
    /// Its feature.
    feature: Vec<u32>,
    /// Its bits.
    pub(super) flags: Vec<u8>,
    /// What the law remembers of it, row by row.
    pub(super) history: Vec<Vec<Row>>,
    /// Its pair constant; empty where the law has none.
    pub(super) pair_constant: Vec<f64>,
    /// Its number: 0, 1, 2, …
    pub(super) number: Vec<u32>,
    /// Normal and distance of its foot \[m\].
    pub(super) foot: Vec<Row>,
    /// How often its normal force counts, and its share of friction; empty where each counts once.
    pub(super) weight: Vec<[f64; 2]>,
    /// The contacts whose particles have their centres behind the face.
    behind: Vec<u32>,
    /// What it has beside where nodes move one by one.
    pub(super) held: Held,
    /// What the present particle touches.
    pub(super) feet: Feet,
}

impl FeatureContacts {
    /// Forgets all contacts, of which so many rows are kept.
    pub(super) fn clear(&mut self, rows: usize) {
        self.particle.clear();
        self.feature.clear();
        self.flags.clear();
        self.history.resize(rows, Vec::new());
        self.history.iter_mut().for_each(Vec::clear);
        self.pair_constant.clear();
        self.foot.clear();
        self.weight.clear();
        self.behind.clear();
        self.held.clear();
    }

    /// Adds a contact but for what is remembered of it: the foot of a particle (slot), the normal there in global axes, and the
    /// share of friction.
    #[inline]
    pub(super) fn push(&mut self, slot: u32, foot: &Foot, normal: Vector, share: f64) {
        if foot.behind {
            self.behind.push(self.particle.len() as u32);
        }
        if foot.weight != 1.0 || share != 1.0 || !self.weight.is_empty() {
            self.weight.resize(self.particle.len(), [1.0; 2]);
            self.weight.push([foot.weight, share]);
        }
        self.particle.push(slot);
        self.feature.push(foot.feature);
        self.foot.push(normal.row_with(foot.distance));
    }

    /// Ends the search: all contacts have their numbers, and no bits yet. Returns how many there are.
    pub(super) fn complete(&mut self) -> usize {
        let count = self.particle.len();
        self.flags.resize(count, 0);
        self.number.extend(self.number.len() as u32..count as u32);
        count
    }

    /// What the contacts have beside where nodes move one by one.
    pub(in super::super) fn held(&self) -> &Held {
        &self.held
    }

    /// Writes the bits of all contacts when the law has acted: a saddle is not a contact of its own.
    pub(super) fn finish(&mut self) {
        self.flags.iter_mut().for_each(|flags| *flags &= TOUCHING | SLIDING);
        for (flags, _) in self.flags.iter_mut().zip(&self.weight).filter(|(_, [weight, _])| *weight <= 0.0) {
            *flags = 0;
        }
        for &entry in &self.behind {
            self.flags[entry as usize] |= REVERSE;
        }
    }
}

/// Puts the contacts that the pieces found, of each of which so many rows are kept, in the place of a list's.
pub(in super::super) fn replace<'a>(
    list: &mut WallContacts,
    rows: usize,
    pieces: impl Iterator<Item = &'a FeatureContacts>,
) {
    list.particle.clear();
    list.feature.clear();
    list.flags.clear();
    list.history.resize(rows, Vec::new());
    list.history.iter_mut().for_each(Vec::clear);
    for piece in pieces {
        list.particle.extend_from_slice(&piece.particle);
        list.feature.extend_from_slice(&piece.feature);
        list.flags.extend_from_slice(&piece.flags);
        for (all, rows) in list.history.iter_mut().zip(&piece.history) {
            all.extend_from_slice(rows);
        }
    }
}
