//! Sums over the cells of a grid of what many bodies give them.

use crate::base::number::add;
use crate::base::threads::Context;
use crate::engine::state::Row;
use crate::laws::region::Weights;
use std::sync::{Mutex, PoisonError};

/// Parts into which bodies are divided at most, each with sums of its own. That their number does not depend on threads keeps the bits.
const MOST_PARTS: usize = 16;

/// Sums of several parts of the bodies.
#[derive(Default)]
pub(super) struct CellSums {
    /// For each part a row for each cell.
    parts: Vec<Mutex<Vec<Row>>>,
}

/// What is given to cells.
pub(super) struct Given<'a>(&'a mut [Row]);

impl Given<'_> {
    /// Gives a row to the only cell.
    #[inline(always)]
    pub(super) fn add(&mut self, row: Row) {
        add(&mut self.0[0], &row);
    }

    /// Shares rows out by weights among cells that have so many.
    #[inline(always)]
    pub(super) fn share<const ROWS: usize>(&mut self, weights: &Weights, rows: [Row; ROWS]) {
        for &(cell, weight) in weights {
            for (sum, row) in self.0[ROWS * cell..].iter_mut().zip(rows) {
                for (sum, part) in sum.iter_mut().zip(row) {
                    *sum += weight * part;
                }
            }
        }
    }
}

impl CellSums {
    /// Works through so many bodies, in parts over threads, and adds what cells are given to their rows. Returns what the bodies gave,
    /// joined in order.
    pub(super) fn over<T: Copy + Send + Sync>(
        &mut self,
        (count, cells): (usize, &mut [Row]),
        context: &Context,
        of_body: impl Fn(usize, &mut Given) -> T + Sync + Send,
        (start, join): (T, fn(T, T) -> T),
    ) -> T {
        // Sums of a part cost as much as its bodies do, where these are fewer than the cells.
        let parts = (count / cells.len()).clamp(1, MOST_PARTS);
        self.parts.resize_with(parts.max(self.parts.len()), Mutex::default);
        let rooms = &self.parts[..parts];
        let of_part = |part: usize| {
            let mut room = rooms[part].lock().unwrap_or_else(PoisonError::into_inner);
            room.clear();
            room.resize(cells.len(), [0.0; 4]);
            let bodies = part * count / parts..(part + 1) * count / parts;
            bodies.fold(start, |sum, body| join(sum, of_body(body, &mut Given(&mut room))))
        };
        let sum = context.fold(parts, of_part, start, join);
        for room in rooms {
            let room = room.lock().unwrap_or_else(PoisonError::into_inner);
            cells.iter_mut().zip(&*room).for_each(|(cell, part)| add(cell, part));
        }
        sum
    }
}
