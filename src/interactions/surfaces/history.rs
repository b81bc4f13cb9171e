//! What a contact with a feature remembers, and how it goes from one feature to the next.

use crate::contact::{HistoryRow, Law};
use crate::number::{Row, Vector};
use crate::state::WallContacts;
use crate::state::contacts::REVERSE;
use crate::surface::{Features, Feet, Foot};
use std::ops::Range;

/// The contacts that a particle had with the features of a surface in the last evaluation.
pub(super) struct Past<'a> {
    /// The list that they stand in.
    list: &'a WallContacts,
    /// Where.
    entries: Range<usize>,
}

impl<'a> Past<'a> {
    /// These entries of a list.
    pub(super) fn of(list: &'a WallContacts, entries: Range<usize>) -> Self {
        Self { list, entries }
    }

    /// The entry of a feature.
    #[inline]
    pub(super) fn entry(&self, feature: u32) -> Option<usize> {
        // A particle touches one or a few.
        let found = self.list.feature[self.entries.clone()].iter().position(|&other| other == feature);
        found.map(|place| self.entries.start + place)
    }

    /// Whether the centre was behind the face of an entry.
    pub(super) fn was_behind(&self, entry: usize) -> bool {
        self.list.flags[entry] & REVERSE != 0
    }

    /// A row of what the law remembers of an entry.
    #[inline]
    pub(super) fn row(&self, entry: usize, row: usize) -> Row {
        self.list.history.get(row).map_or([0.0; 4], |rows| rows[entry])
    }
}

/// The contact whose memory a contact has as the step begins: its own; or, where the foot came over a bend, the one which
/// vanished there; or, where a bend brought it forth, that of the face across. A contact that begins has none.
#[inline]
pub(super) fn source(
    foot: &Foot,
    own: Option<usize>,
    feet: &Feet,
    past: &Past,
    features: &dyn Features,
    law: &Law,
) -> Option<usize> {
    if law.history().is_empty() && !law.holds_beyond_touch() {
        return None;
    }
    if own.is_some() || foot.weight <= 0.0 {
        return own;
    }
    inherited(foot, feet, past, features, law)
}

/// The contact from which one that is new takes its memory.
#[inline(never)]
fn inherited(foot: &Foot, feet: &Feet, past: &Past, features: &dyn Features, law: &Law) -> Option<usize> {
    let spring = |entry: usize| {
        law.spring().map_or(0.0, |place| {
            let spring = Vector::from(past.row(entry, place));
            spring.dot(spring)
        })
    };
    let vanished = past.entries.clone().filter(|&entry| {
        let feature = past.list.feature[entry];
        feet.on(feature).is_none() && features.meet(feature, foot.feature)
    });
    // Of two that vanish into one, the one that friction has loaded most.
    let longest = vanished.reduce(|one, other| if spring(other) > spring(one) { other } else { one });
    let across = || {
        let saddle = feet.saddles.iter().find(|saddle| saddle.faces.contains(&foot.feature))?;
        let other = saddle.faces.iter().find(|face| **face != foot.feature)?;
        past.entry(*other)
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
