//! What a contact with a feature remembers, and how it goes from one feature to the next.

use crate::base::number::{Row, Vector};
use crate::engine::contacts::batches::Entries;
use crate::laws::contact::{HistoryRow, Law};
use crate::laws::surface::{Features, Saddle};
use std::ops::Range;

/// The contacts of a piece of the particles with the features of a surface, as they were in the last evaluation.
pub(super) struct PreviousContacts<'a> {
    /// The particle of each (slot).
    pub(super) particle: &'a [u32],
    /// Its feature.
    pub(super) feature: &'a [u32],
    /// What is stored of it.
    pub(super) entries: Entries,
}

/// What a particle touches now.
#[derive(Clone, Copy)]
pub(super) struct CurrentContacts<'a> {
    /// The features.
    pub(super) features: &'a [u32],
    /// The saddles among them, each with its particle.
    pub(super) saddles: &'a [(u32, Saddle)],
}

impl PreviousContacts<'_> {
    /// The entries of a particle (slot), and of none before `from`.
    #[inline]
    pub(super) fn of(&self, slot: u32, from: usize) -> Range<usize> {
        let first = from + self.particle[from..].iter().take_while(|&&other| other < slot).count();
        first..first + self.particle[first..].iter().take_while(|&&other| other == slot).count()
    }

    /// Which of some entries is that of a feature.
    #[inline]
    pub(super) fn entry(&self, entries: &Range<usize>, feature: u32) -> Option<usize> {
        // A particle touches one or a few.
        let found = self.feature[entries.clone()].iter().position(|&other| other == feature);
        found.map(|place| entries.start + place)
    }

    /// A row of what the law remembers of an entry.
    #[inline]
    pub(super) fn row(&self, entry: usize, row: usize) -> Row {
        assert!(entry < self.particle.len(), "entry {entry} of another piece");
        // SAFETY: the entry is in the list, among those of this piece.
        unsafe { self.entries.history(entry) }.get(row).copied().unwrap_or_default()
    }
}

/// The contact whose memory one with this feature and weight has as the step begins: its own; or, where the foot came over a
/// bend, the one which vanished there; or, where a bend brought it forth, that of the face across. A contact that begins has
/// none.
#[inline]
pub(super) fn source(
    (feature, weight): (u32, f64),
    present: CurrentContacts,
    (past, entries): (&PreviousContacts, &Range<usize>),
    features: &dyn Features,
    law: &Law,
) -> Option<usize> {
    if law.history().is_empty() && !law.holds_beyond_touch() {
        return None;
    }
    let own = past.entry(entries, feature);
    if own.is_some() || weight < 0.0 {
        return own;
    }
    inherited(feature, present, (past, entries), features, law)
}

/// The contact from which one that is new takes its memory.
#[inline(never)]
fn inherited(
    own: u32,
    present: CurrentContacts,
    (past, entries): (&PreviousContacts, &Range<usize>),
    features: &dyn Features,
    law: &Law,
) -> Option<usize> {
    let spring = |entry: usize| {
        law.spring().map_or(0.0, |place| {
            let spring = Vector::from(past.row(entry, place));
            spring.dot(spring)
        })
    };
    let vanished = entries.clone().filter(|&entry| {
        let feature = past.feature[entry];
        !present.features.contains(&feature) && features.meet(feature, own)
    });
    // Of two that vanish into one, the one that friction has loaded most.
    let longest = vanished.reduce(|one, other| if spring(other) > spring(one) { other } else { one });
    let across = || {
        let (_, saddle) = present.saddles.iter().find(|(_, saddle)| saddle.faces.contains(&own))?;
        let other = saddle.faces.iter().find(|face| **face != own)?;
        past.entry(entries, *other)
    };
    longest.or_else(across)
}

/// A row that comes from another feature: vectors, which change sign with the order of the bodies, lie in the tangent plane.
#[inline(never)]
pub(super) fn taken(row: Row, kept: &HistoryRow, normal: Vector) -> Row {
    if kept.odd[..3] != [true; 3] {
        return row;
    }
    turned(Vector::from(row), normal).row_with(row[3])
}

/// A spring turned into another tangent plane, its length kept.
fn turned(spring: Vector, normal: Vector) -> Vector {
    let flat = spring - normal * spring.dot(normal);
    let (before, after) = (spring.length(), flat.length());
    if after > 0.0 { flat * (before / after) } else { Vector::zero() }
}
