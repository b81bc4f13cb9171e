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
    /// Evaluation in which each entry had its slopes last, where that is kept: those of what began anew since then are none.
    last: Vec<u32>,
    /// The present evaluation.
    evaluation: u32,
}

impl ListSlopes {
    /// An empty list of so many rows.
    pub(super) fn of(rows: usize) -> Self {
        Self {
            bodies: Vec::new(),
            rows: vec![Vec::new(); rows],
            odd: vec![[false; 4]; rows],
            last: Vec::new(),
            evaluation: 0,
        }
    }

    /// Says which numbers of the first rows change their sign where the bodies change places.
    pub(crate) fn set_odd(&mut self, odd: impl Iterator<Item = [bool; 4]>) {
        for (known, odd) in self.odd.iter_mut().zip(odd) {
            *known = odd;
        }
    }

    /// The next evaluation begins.
    pub(crate) fn go_on(&mut self) {
        self.evaluation += 1;
        self.last.resize(self.bodies.len(), 0);
    }

    /// Slopes of a row of some entries, as many as there are lanes of which the first so many count; of those that were not there in
    /// the last evaluation none are left.
    #[inline(always)]
    pub(crate) fn begin<N: Lane>(&mut self, row: usize, entries: &Places, count: usize) -> [N; 4] {
        let Self { rows, last, evaluation, .. } = self;
        if row == 0 {
            for &entry in entries.first(count) {
                let entry = entry as usize;
                if std::mem::replace(&mut last[entry], *evaluation) + 1 != *evaluation {
                    rows.iter_mut().for_each(|rows| rows[entry] = [0.0; 4]);
                }
            }
        }
        columns_at(&rows[row], entries)
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
            self.last = vec![0; if self.last.is_empty() { 0 } else { bodies.len() }];
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
        if !self.last.is_empty() {
            let last = |entry: &Option<usize>| entry.map_or(0, |entry| self.last[entry]);
            self.last = before.iter().map(last).collect();
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
