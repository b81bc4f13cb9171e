//! What a list stores of its entries.

use crate::base::lanes::Shared;
use crate::base::number::Row;
use std::ops::Range;

/// What a list stores for each entry.
#[derive(Clone, Copy)]
pub(crate) struct Entries {
    /// Its bits.
    pub flags: Shared<u8>,
    /// What is stored: the rows of one entry after the other.
    pub history: Shared<Row>,
    /// How many rows are stored of each.
    pub kept: usize,
    /// Its pair constant; empty where the law has none.
    pub pair_constant: Shared<f64>,
}

impl Entries {
    /// What a list stores, `kept` rows of history for each entry.
    pub(crate) fn of(flags: &mut [u8], kept: usize, history: &mut [Row], pair_constant: &mut [f64]) -> Self {
        let history = Shared::new(history);
        Self { flags: Shared::new(flags), history, kept, pair_constant: Shared::new(pair_constant) }
    }

    /// Those from an entry on, with pair constants that are kept elsewhere.
    pub(crate) fn from(&self, first: usize, pair_constant: &mut [f64]) -> Self {
        let (flags, pair_constant) = (self.flags.from(first), Shared::new(pair_constant));
        Self { flags, history: self.history.from(first * self.kept), kept: self.kept, pair_constant }
    }

    /// How many rows are stored for each.
    pub(crate) fn rows(&self) -> usize {
        self.kept
    }

    /// The rows of an entry.
    ///
    /// # Safety
    /// There is such an entry, and it belongs to the piece that asks, which holds no other reference to its rows.
    #[inline(always)]
    #[allow(clippy::mut_from_ref, reason = "disjoint use is the caller's promise")]
    pub(crate) unsafe fn history(&self, entry: usize) -> &mut [Row] {
        // SAFETY: the caller's promise.
        unsafe { self.history.part(entry * self.kept, (entry + 1) * self.kept) }
    }

    /// Where a row of the first entry stands: that of another one stands as many rows further as [`Buffer::history`] says.
    #[inline(always)]
    pub(super) fn row(&self, row: usize) -> *mut Row {
        debug_assert!(row < self.kept, "row {row} of {}", self.kept);
        self.history.pointer().wrapping_add(row)
    }

    /// The bits that any of these entries has.
    pub(crate) fn present(&self, entries: Range<usize>) -> u8 {
        // SAFETY: the entries belong to the piece that asks.
        unsafe { self.flags.part(entries.start, entries.end) }.iter().fold(0, |all, flags| all | flags)
    }
}
