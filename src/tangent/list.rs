//! Slopes of what the entries of a list remember, which go with their bodies when lists are made anew.

use crate::lanes::{Lane, Places, columns_at, put_at};
use crate::state::Row;

/// How what a list remembers of its entries changes.
pub(crate) struct ListSlopes {
    /// Bodies of each entry, as the scene numbers them.
    bodies: Vec<[u32; 2]>,
    /// Slopes of each entry, a column for each row.
    pub rows: Vec<Vec<Row>>,
    /// Which numbers of each row change their sign where the bodies change places.
    odd: Vec<[bool; 4]>,
}

impl ListSlopes {
    /// An empty list of so many rows.
    pub(super) fn of(rows: usize) -> Self {
        Self { bodies: Vec::new(), rows: vec![Vec::new(); rows], odd: vec![[false; 4]; rows] }
    }

    /// Says which numbers of the first rows change their sign where the bodies change places.
    pub(crate) fn set_odd(&mut self, odd: impl Iterator<Item = [bool; 4]>) {
        for (known, odd) in self.odd.iter_mut().zip(odd) {
            *known = odd;
        }
    }

    /// Slopes of a row of some entries, as many as there are lanes.
    #[inline(always)]
    pub(crate) fn read<N: Lane>(&self, row: usize, entries: &Places) -> [N; 4] {
        columns_at(&self.rows[row], entries)
    }

    /// Nothing is remembered of some entries any more.
    pub(crate) fn end(&mut self, entries: &[u32]) {
        for rows in &mut self.rows {
            entries.iter().for_each(|&entry| rows[entry as usize] = [0.0; 4]);
        }
    }

    /// Writes slopes of a row.
    #[inline(always)]
    pub(crate) fn put<N: Lane>(&mut self, row: usize, entries: &Places, slopes: [N; 4]) {
        put_at(slopes, &mut self.rows[row], entries);
    }

    /// Takes over the entries of a list: those of the same bodies keep their slopes, others have none.
    pub(super) fn follow(&mut self, bodies: impl Iterator<Item = [u32; 2]>) {
        let bodies: Vec<[u32; 2]> = bodies.collect();
        if bodies == self.bodies {
            return;
        }
        if self.bodies.is_empty() {
            self.rows.iter_mut().for_each(|rows| *rows = vec![[0.0; 4]; bodies.len()]);
            self.bodies = bodies;
            return;
        }
        let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let mut order: Vec<u32> = (0..self.bodies.len() as u32).collect();
        order.sort_unstable_by_key(|&entry| sorted(self.bodies[entry as usize]));
        let before: Vec<Option<usize>> = bodies
            .iter()
            .map(|&pair| {
                let found = order.binary_search_by_key(&sorted(pair), |&entry| sorted(self.bodies[entry as usize]));
                found.ok().map(|place| order[place] as usize)
            })
            .collect();
        for (rows, odd) in self.rows.iter_mut().zip(&self.odd) {
            let moved = bodies.iter().zip(&before).map(|(pair, entry)| match entry {
                Some(entry) if self.bodies[*entry] == *pair => rows[*entry],
                Some(entry) => reversed(&rows[*entry], odd),
                None => [0.0; 4],
            });
            *rows = moved.collect();
        }
        self.bodies = bodies;
    }
}

/// Slopes as the other body sees them.
fn reversed(row: &Row, odd: &[bool; 4]) -> Row {
    [0, 1, 2, 3].map(|place| if odd[place] { -row[place] } else { row[place] })
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn slopes_go_with_their_bodies_and_change_sign_with_their_order() {
        let mut list = ListSlopes::of(1);
        list.set_odd([[true, true, true, false]].into_iter());
        list.follow([[0, 1], [2, 3]].into_iter());
        list.rows[0] = vec![[1.0; 4], [2.0; 4]];
        list.follow([[3, 2], [0, 4], [0, 1]].into_iter());
        assert_eq!(list.rows[0], [[-2.0, -2.0, -2.0, 2.0], [0.0; 4], [1.0; 4]]);
    }
}
