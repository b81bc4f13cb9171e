//! What a contact with a feature remembers, and how it goes from one feature to the next.

use super::records;
use crate::contact::{Law, MOST_HISTORY};
use crate::number::{Row, Vector};
use crate::state::WallContacts;
use crate::state::contacts::REVERSE;
use crate::surface::{Features, Feet, Foot};
use std::ops::Range;

/// What a law remembers of one contact.
type History = [Row; MOST_HISTORY];

/// The contacts that a particle had with the features of a surface in the last evaluation.
pub(crate) struct Past<'a> {
    /// The list that they stand in.
    list: &'a WallContacts,
    /// Where.
    entries: Range<usize>,
}

impl<'a> Past<'a> {
    /// These entries of a list.
    pub(crate) fn of(list: &'a WallContacts, entries: Range<usize>) -> Self {
        Self { list, entries }
    }

    /// The entry of a feature.
    fn entry(&self, feature: u32) -> Option<usize> {
        let found = self.list.feature[self.entries.clone()].binary_search(&feature);
        found.ok().map(|place| self.entries.start + place)
    }

    /// Whether the centre has come from one side of a face to the other.
    pub(crate) fn went_through(&self, foot: &Foot) -> bool {
        self.entry(foot.feature).is_some_and(|entry| (self.list.flags[entry] & REVERSE != 0) != foot.behind)
    }

    /// What the law remembers of an entry.
    fn history(&self, entry: usize) -> History {
        records::history(&self.list.history, entry)
    }
}

/// What a contact remembers as the step begins: its own; or, where the foot came over a bend, that of the contact which
/// vanished there; or, where a bend brought it forth, that of the face across. A contact that begins remembers nothing.
pub(crate) fn carry(
    foot: &Foot,
    normal: Vector,
    feet: &Feet,
    past: &Past,
    features: &dyn Features,
    law: &Law,
) -> History {
    let nothing = [[0.0; 4]; MOST_HISTORY];
    if law.history().is_empty() {
        return nothing;
    }
    if let Some(entry) = past.entry(foot.feature) {
        return past.history(entry);
    }
    if foot.weight <= 0.0 {
        return nothing;
    }
    let spring = |entry: usize| {
        law.spring().map_or(0.0, |place| {
            let spring = Vector::from(past.history(entry)[place]);
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
    let Some(entry) = longest.or_else(across) else { return nothing };
    let mut history = past.history(entry);
    for (row, kept) in history.iter_mut().zip(law.history()) {
        // Vectors change sign with the order of the bodies, and lie in the tangent plane.
        if kept.odd[..3] == [true; 3] {
            let [x, y, z] = turned(Vector::from(*row), normal).to_array();
            *row = [x, y, z, row[3]];
        }
    }
    history
}

/// A spring turned into another tangent plane, its length kept.
fn turned(spring: Vector, normal: Vector) -> Vector {
    let flat = spring - normal * spring.dot(normal);
    let (before, after) = (spring.length(), flat.length());
    if after > 0.0 { flat * (before / after) } else { Vector::zero() }
}
