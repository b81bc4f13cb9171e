//! Sums over the cells of a grid of what many bodies give them.

use crate::base::number::add;
use crate::base::threads::Context;
use crate::engine::state::Row;
use crate::laws::region::Weights;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Parts into which bodies are divided at most, each with sums of its own. That their number does not depend on threads keeps the bits.
const MOST_PARTS: usize = 16;

/// Sums of several parts of the bodies.
#[derive(Default)]
pub(super) struct CellSums {
    /// For each part a row for each cell.
    parts: Vec<Mutex<Vec<Row>>>,
    /// The same of all.
    whole: Vec<Row>,
}

/// What is given to cells; to none without a grid.
pub(super) struct Given<'a>(pub(super) &'a mut [Row]);

impl Given<'_> {
    /// Shares rows out by weights among cells that have so many.
    #[inline(always)]
    pub(super) fn share<const ROWS: usize>(&mut self, weights: &Weights, rows: [Row; ROWS]) {
        for &(cell, weight) in weights {
            for (sum, row) in self.0[ROWS * cell..ROWS * (cell + 1)].iter_mut().zip(&rows) {
                add(sum, &row.map(|part| weight * part));
            }
        }
    }
}

impl CellSums {
    /// What all bodies gave, row by row.
    pub(super) fn whole(&self) -> &[Row] {
        &self.whole
    }

    /// Works through so many bodies, in parts over threads, and adds what they give to so many rows. Returns what the bodies of each part
    /// gave, joined in order.
    pub(super) fn over<T: Send>(
        &mut self,
        (count, rows): (usize, usize),
        context: &Context,
        of_bodies: impl Fn(Range<usize>, &mut Given) -> T + Sync + Send,
        (start, join): (T, fn(T, T) -> T),
    ) -> T {
        // Sums of a part cost as much as its bodies do, where these are fewer than the rows.
        let parts = (count / rows).clamp(1, MOST_PARTS);
        self.parts.resize_with(parts.max(self.parts.len()), Mutex::default);
        let rooms = &self.parts[..parts];
        let of_part = |part: usize| {
            let mut room = rooms[part].lock().unwrap_or_else(PoisonError::into_inner);
            room.clear();
            room.resize(rows, [0.0; 4]);
            of_bodies(part * count / parts..(part + 1) * count / parts, &mut Given(&mut room))
        };
        let found = context.fold(parts, of_part, start, join);
        self.whole.clear();
        self.whole.resize(rows, [0.0; 4]);
        for room in rooms {
            let room = room.lock().unwrap_or_else(PoisonError::into_inner);
            self.whole.iter_mut().zip(&*room).for_each(|(whole, part)| add(whole, part));
        }
        found
    }
}
