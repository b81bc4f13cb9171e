//! What goes along with the evaluation of a list: slopes of its contacts, batch by batch.

use super::buffer::Buffer;
use super::{Entries, FOUND};
use crate::lanes::Lane;
use crate::state::contacts::SLIDING;

/// Goes along with the evaluation of a list.
pub(crate) trait Along: Sync {
    /// Looks at the touching entries of a batch before the law is evaluated, and at those whose bodies have parted. Returns what is
    /// left to be done.
    fn follow(&self, batch: &mut Batch) -> Left;
}

/// What is left to be done with a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Left {
    /// Everything.
    All,
    /// The law has been evaluated: loads, history and flags are there. Loads are to be added to the bodies.
    Spreading,
    /// Nothing: the list has been looked at alone.
    Nothing,
}

/// Touching entries of a list, which are worked on together.
pub(crate) struct Batch<'a> {
    /// What the list stores. The entries of the batch belong to the piece that is worked on.
    pub(super) entries: &'a Entries,
    /// The batch.
    pub(crate) buffer: &'a mut Buffer,
}

impl Batch<'_> {
    /// What was found of their places.
    #[inline(always)]
    pub(crate) fn found<N: Lane>(&self, at: usize) -> [N; FOUND] {
        let mut found = [N::zero(); FOUND];
        for (number, column) in found.iter_mut().zip(&self.buffer.found) {
            // SAFETY: so many numbers are there.
            *number = unsafe { N::load(column[at..at + N::WIDTH].as_ptr()) };
        }
        found
    }

    /// Pair constants, where the list has any.
    #[inline(always)]
    pub(crate) fn constants<N: Lane>(&self, at: usize) -> N {
        let entries = &self.buffer.entry[at..at + N::WIDTH];
        match self.entries.pair_constant.length() {
            0 => N::zero(),
            // SAFETY: there is one for each entry.
            _ => unsafe { N::gather(self.entries.pair_constant.pointer(), entries.as_ptr(), 1) },
        }
    }

    /// A row of what the law remembers.
    #[inline(always)]
    pub(crate) fn remembered<N: Lane>(&self, row: usize, at: usize) -> [N; 4] {
        let places = &self.buffer.history[at..at + N::WIDTH];
        // SAFETY: there is a row for each entry.
        unsafe { N::load_rows(self.entries.row(row), places.as_ptr()) }
    }

    /// Remembers a row.
    #[inline(always)]
    pub(crate) fn remember<N: Lane>(&mut self, row: usize, at: usize, values: [N; 4]) {
        let places = &self.buffer.history[at..at + N::WIDTH];
        // SAFETY: there is a row for each entry, which this piece alone works on; a repeated one is written twice with the same.
        unsafe { N::store_rows(values, self.entries.row(row), places.as_ptr()) };
    }

    /// Notes that those entries of a register's worth slide whose bit is set.
    #[inline(always)]
    pub(crate) fn slide(&mut self, at: usize, mut sliding: u32) {
        while sliding != 0 {
            let entry = self.buffer.entry[at + sliding.trailing_zeros() as usize] as usize;
            // SAFETY: there is a flag for each entry, which this piece alone works on.
            unsafe { *self.entries.flags.at(entry) |= SLIDING };
            sliding &= sliding - 1;
        }
    }
}
