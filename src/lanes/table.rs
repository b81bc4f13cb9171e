//! Items of some rows of four numbers each, read one by one or several at a time.

use super::Lane;
use crate::memory::prefetch;
use crate::number::{Row, Vector, add, subtract};

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

/// Places in columns, one for each lane; behind the last lane places that are there, too.
#[derive(Clone, Copy, Debug)]
pub struct Places {
    /// The places.
    places: [u32; 8],
    /// The last of them.
    last: u32,
}

impl Places {
    /// These places, at most eight; behind them the first one is repeated.
    #[inline(always)]
    pub fn of(some: &[u32]) -> Self {
        let mut places = [some[0]; 8];
        if some.len() == 1 {
            return Self { places, last: some[0] };
        }
        if let Ok(all) = <[u32; 8]>::try_from(some) {
            places = all;
        } else if let Ok(half) = <[u32; 4]>::try_from(some) {
            places[..4].copy_from_slice(&half);
        } else {
            for (place, own) in places.iter_mut().zip(some) {
                *place = *own;
            }
        }
        let mut last = 0;
        for place in places {
            last = u32::max(last, place);
        }
        Self { places, last }
    }

    /// As many places as a register has numbers, from one on in a list that is longer; behind them the first one is repeated.
    #[inline(always)]
    pub fn from<N: Lane>(list: &[u32], first: usize) -> Self {
        Self::of(&list[first..first + N::WIDTH])
    }

    /// So many places from one on, at least one; behind them the first one is repeated.
    #[inline(always)]
    pub fn consecutive(first: usize, count: usize) -> Self {
        let first = first as u32;
        let mut places = [first; 8];
        for (place, next) in places.iter_mut().zip(first..).take(count) {
            *place = next;
        }
        // A last place before the first would let an index pass that is not there.
        Self { places, last: first.saturating_add(count.max(1) as u32 - 1) }
    }

    /// The first of them.
    #[inline(always)]
    pub fn first(&self, count: usize) -> &[u32] {
        &self.places[..count]
    }

    /// The place of a lane.
    #[inline(always)]
    pub fn at(&self, lane: usize) -> usize {
        self.places[lane] as usize
    }
}

/// The numbers at these places.
#[inline(always)]
pub fn numbers_at(numbers: &[u32], places: &Places) -> [u32; 8] {
    let mut found = [0; 8];
    for (lane, found) in found.iter_mut().enumerate() {
        *found = numbers[places.at(lane)];
    }
    found
}

/// The rows at these places, as four columns.
#[inline(always)]
pub fn columns_at<N: Lane>(rows: &[Row], places: &Places) -> [N; 4] {
    assert!((places.last as usize) < rows.len(), "row {} of {}", places.last, rows.len());
    // SAFETY: the rows are there.
    unsafe { N::load_rows(rows.as_ptr(), places.places.as_ptr()) }
}

/// The rows at the first places less those at the others, as four columns.
#[inline(always)]
pub fn differences_at<N: Lane>(rows: &[Row], first: &Places, others: &Places) -> [N; 4] {
    let last = u32::max(first.last, others.last);
    assert!((last as usize) < rows.len(), "row {last} of {}", rows.len());
    // SAFETY: the rows are there.
    unsafe { N::load_difference(rows.as_ptr(), first.places.as_ptr(), others.places.as_ptr()) }
}

/// Writes four columns to the rows at these places; where a place is repeated, its rows are the same.
#[inline(always)]
pub fn put_at<N: Lane>(columns: [N; 4], rows: &mut [Row], places: &Places) {
    assert!((places.last as usize) < rows.len(), "row {} of {}", places.last, rows.len());
    // SAFETY: the rows are there.
    unsafe { N::store_rows(columns, rows.as_mut_ptr(), places.places.as_ptr()) };
}

/// Adds four columns to the rows at the first so many places, one after another.
#[inline(always)]
pub fn add_at<N: Lane>(columns: [N; 4], rows: &mut [Row], places: &Places, count: usize) {
    assert!((places.last as usize) < rows.len(), "row {} of {}", places.last, rows.len());
    for (&place, part) in places.places[..count].iter().zip(&rows_of(columns)) {
        // SAFETY: no place is behind the last one.
        add(unsafe { rows.get_unchecked_mut(place as usize) }, part);
    }
}

/// Adds four columns to the rows at the first places, and takes them from those at the others, pair by pair.
#[inline(always)]
pub fn add_opposite_at<N: Lane>(columns: [N; 4], rows: &mut [Row], first: &Places, others: &Places, count: usize) {
    let last = u32::max(first.last, others.last);
    assert!((last as usize) < rows.len(), "row {last} of {}", rows.len());
    let pairs = first.places[..count].iter().zip(&others.places[..count]);
    for ((&first, &other), part) in pairs.zip(&rows_of(columns)) {
        // SAFETY: no place is behind the last one.
        unsafe {
            add(rows.get_unchecked_mut(first as usize), part);
            subtract(rows.get_unchecked_mut(other as usize), part);
        }
    }
}

/// Adds four columns to the rows at the first places, and others to those at the others, pair by pair.
#[inline(always)]
pub fn add_pairs_at<N: Lane>(columns: [[N; 4]; 2], rows: &mut [Row], first: &Places, others: &Places, count: usize) {
    let last = u32::max(first.last, others.last);
    assert!((last as usize) < rows.len(), "row {last} of {}", rows.len());
    let [to_first, to_others] = columns;
    let (to_first, to_others) = (rows_of(to_first), rows_of(to_others));
    let pairs = first.places[..count].iter().zip(&others.places[..count]);
    for ((&first, &other), (part, opposite)) in pairs.zip(to_first.iter().zip(&to_others)) {
        // SAFETY: no place is behind the last one.
        unsafe {
            add(rows.get_unchecked_mut(first as usize), part);
            add(rows.get_unchecked_mut(other as usize), opposite);
        }
    }
}

/// Four columns as rows; those behind the last lane are zero.
#[inline(always)]
pub fn rows_of<N: Lane>(columns: [N; 4]) -> [Row; 8] {
    let mut rows = [[0.0; 4]; 8];
    // SAFETY: no register has more than eight lanes.
    unsafe { N::store_block(columns, rows.as_mut_ptr()) };
    rows
}

/// One number for each lane, made one by one.
#[inline(always)]
pub fn lanes_of<N: Lane>(make: impl Fn(usize) -> f64) -> N {
    let mut numbers = [0.0; 8];
    let mut lane = 0;
    while lane < N::WIDTH {
        numbers[lane] = make(lane);
        lane += 1;
    }
    // SAFETY: no register has more than eight lanes.
    unsafe { N::load(numbers.as_ptr()) }
}

/// A vector for each lane, as three columns.
#[inline(always)]
pub fn vectors_of<N: Lane>(make: impl Fn(usize) -> Vector) -> [N; 3] {
    [lanes_of(|lane| make(lane).x), lanes_of(|lane| make(lane).y), lanes_of(|lane| make(lane).z)]
}
