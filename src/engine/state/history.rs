//! The history of the contacts of a list.

use super::in_place::clone_in_place;
use super::{Row, plain};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// History rows of the entries of a list, the same number for each. The rows of an entry stand side by side, as an evaluation reads
/// all of them: that takes fewer lines of the cache than a list for each row.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// How many rows there are of each entry.
    of_each: u32,
    /// The rows, entry by entry.
    #[serde(with = "plain")]
    all: Vec<Row>,
}

clone_in_place!(History { of_each, all });

impl History {
    /// This many rows for each of this many entries, all zero.
    pub fn of(rows: usize, count: usize) -> Self {
        Self { of_each: rows as u32, all: vec![Row::default(); rows * count] }
    }

    /// How many rows there are of each entry.
    pub fn rows(&self) -> usize {
        self.of_each as usize
    }

    /// The rows of all entries, one entry after the other.
    pub fn all(&self) -> &[Row] {
        &self.all
    }

    /// The same, to be changed.
    pub fn all_mut(&mut self) -> &mut [Row] {
        &mut self.all
    }

    /// The rows of an entry; none of one that is not there.
    pub fn get(&self, entry: usize) -> &[Row] {
        self.all.get(self.places(entry..entry + 1)).unwrap_or_default()
    }

    /// The same, to be changed.
    pub fn get_mut(&mut self, entry: usize) -> &mut [Row] {
        let places = self.places(entry..entry + 1);
        self.all.get_mut(places).unwrap_or_default()
    }

    /// Adds an entry with these rows, as many as the others have.
    pub fn push(&mut self, rows: impl IntoIterator<Item = Row>) {
        self.all.extend(rows);
        debug_assert!(self.all.len().is_multiple_of(self.rows().max(1)), "{} rows", self.all.len());
    }

    /// Removes all entries; new ones have this many rows.
    pub fn clear(&mut self, rows: usize) {
        self.of_each = rows as u32;
        self.all.clear();
    }

    /// Resizes to this many rows for each of this many entries, whose values are not specified.
    pub(crate) fn resize(&mut self, rows: usize, count: usize) {
        self.of_each = rows as u32;
        self.all.resize(rows * count, Row::default());
    }

    /// Adds entries of another list with as many rows.
    pub(crate) fn append(&mut self, other: &Self, entries: Range<usize>) {
        debug_assert_eq!(self.of_each, other.of_each);
        self.all.extend_from_slice(&other.all[other.places(entries)]);
    }

    /// These entries, in this order.
    pub(crate) fn chosen(&self, entries: &[usize]) -> Self {
        Self { of_each: self.of_each, all: entries.iter().flat_map(|&entry| self.get(entry)).copied().collect() }
    }

    /// Keeps the entries for which this holds.
    pub(super) fn keep(&mut self, stays: impl Fn(usize) -> bool) {
        let (rows, mut place) = (self.rows(), 0);
        self.all.retain(|_| {
            place += 1;
            stays((place - 1) / rows)
        });
    }

    /// Where the rows of some entries stand.
    fn places(&self, entries: Range<usize>) -> Range<usize> {
        entries.start * self.rows()..entries.end * self.rows()
    }
}

#[cfg(test)]
mod tests {
    use super::History;

    /// Two rows of each of some entries.
    fn history(entries: &[f64]) -> History {
        let mut history = History::of(2, 0);
        entries.iter().for_each(|&entry| history.push([[entry; 4], [-entry; 4]]));
        history
    }

    #[test]
    fn rows_go_with_their_entries() {
        let mut all = history(&[1.0, 2.0, 3.0]);
        assert_eq!(all.get(1), [[2.0; 4], [-2.0; 4]]);
        assert!(all.get(3).is_empty() && all.get_mut(3).is_empty());
        assert_eq!(all.chosen(&[2, 0]), history(&[3.0, 1.0]));
        all.append(&history(&[4.0, 5.0, 6.0]), 1..3);
        assert_eq!(all, history(&[1.0, 2.0, 3.0, 5.0, 6.0]));
        all.keep(|entry| entry % 2 == 1);
        assert_eq!(all, history(&[2.0, 5.0]));
    }

    #[test]
    fn a_list_may_remember_nothing() {
        let mut none = History::of(0, 3);
        none.keep(|_| false);
        assert!(none.get(1).is_empty() && none.chosen(&[2, 0]).all().is_empty());
        assert_eq!(none, History::default());
    }
}
