//! Items of some rows of four numbers each, read one by one or several at a time.

use super::Lane;
use crate::base::memory::prefetch;
use crate::base::number::Row;

/// An item. It begins at a line of the cache: what is read of items that lie all over the memory waits for lines.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Item<const ROWS: usize>([Row; ROWS]);

/// Items of so many rows.
#[derive(Clone)]
pub struct Table<const ROWS: usize>(Vec<Item<ROWS>>);

impl<const ROWS: usize> Table<ROWS> {
    /// Rows from the beginning of an item to that of the next one.
    const STRIDE: usize = size_of::<Item<ROWS>>() / size_of::<Row>();

    /// The table of these items.
    pub fn of(items: impl Iterator<Item = [Row; ROWS]>) -> Self {
        Self(items.map(Item).collect())
    }

    /// How many items there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Bytes of all.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.0[..])
    }

    /// An item.
    #[inline(always)]
    pub fn at(&self, item: usize) -> &[Row; ROWS] {
        &self.0[item].0
    }

    /// All items, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut [Row; ROWS]> {
        self.0.iter_mut().map(|item| &mut item.0)
    }

    /// Asks the memory for an item, if it is there.
    #[inline(always)]
    pub fn prefetch(&self, item: usize) {
        if let Some(item) = self.0.get(item) {
            item.0.iter().step_by(2).for_each(|row| prefetch(&raw const *row));
        }
    }

    /// The first [`Lane::WIDTH`] of these items, all of which are there: four columns for each of their rows.
    #[inline(always)]
    pub fn columns<N: Lane>(&self, items: &[u32; 8]) -> [[N; 4]; ROWS] {
        let last = items.iter().fold(0, |last, &item| last.max(item));
        assert!((last as usize) < self.0.len(), "item {last} of {}", self.0.len());
        let rows = items.map(|item| item * Self::STRIDE as u32);
        let start = self.0.as_ptr().cast::<Row>();
        // SAFETY: the items are in the table, and each has so many rows.
        std::array::from_fn(|row| unsafe { N::load_rows(start.add(row), rows.as_ptr()) })
    }
}

/// Consecutive rows from one on, [`Lane::WIDTH`] of them, as four columns.
#[inline(always)]
pub fn columns_from<N: Lane>(rows: &[Row], first: usize) -> [N; 4] {
    // SAFETY: so many rows are there.
    unsafe { N::load_block(rows[first..first + N::WIDTH].as_ptr()) }
}

/// Writes four columns to consecutive rows from one on.
#[inline(always)]
pub fn rows_from<N: Lane>(columns: [N; 4], rows: &mut [Row], first: usize) {
    // SAFETY: so many rows are there.
    unsafe { N::store_block(columns, rows[first..first + N::WIDTH].as_mut_ptr()) };
}
