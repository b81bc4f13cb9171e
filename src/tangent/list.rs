//! Slopes of what the entries of a list remember, which go with their bodies when lists are made anew.

use super::Inputs;
use crate::dual::Slopes;
use crate::lanes::{Lane, Places};

/// How what a list remembers of its entries changes.
pub(crate) struct ListSlopes<I: Inputs> {
    /// Bodies of each entry, as the scene numbers them.
    bodies: Vec<[u32; 2]>,
    /// Slopes of each entry, a column for each row.
    pub rows: Vec<Vec<I::Row>>,
    /// Which numbers of each row change their sign where the bodies change places.
    odd: Vec<[bool; 4]>,
    /// Evaluation in which each entry had its slopes last, where that is kept: those of what began anew since then are none.
    last: Vec<u32>,
    /// The present evaluation.
    evaluation: u32,
}

impl<I: Inputs> ListSlopes<I> {
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
    pub(crate) fn begin<N: Lane>(&mut self, row: usize, entries: &Places, count: usize) -> [I::Slopes<N>; 4] {
        let Self { rows, last, evaluation, .. } = self;
        if row == 0 {
            for &entry in entries.first(count) {
                let entry = entry as usize;
                if std::mem::replace(&mut last[entry], *evaluation) + 1 != *evaluation {
                    rows.iter_mut().for_each(|rows| rows[entry] = I::NONE);
                }
            }
        }
        I::rows_at::<N>(&rows[row], entries)
    }

    /// Writes slopes of a row.
    #[inline(always)]
    pub(crate) fn put<N: Lane>(&mut self, row: usize, entries: &Places, slopes: [I::Slopes<N>; 4]) {
        I::put::<N>(slopes, &mut self.rows[row], entries);
    }

    /// Takes over the entries of a list: those of the same bodies keep their slopes, others have none.
    pub(super) fn follow(&mut self, bodies: impl Iterator<Item = [u32; 2]>) {
        let bodies: Vec<[u32; 2]> = bodies.collect();
        if bodies == self.bodies {
            return;
        }
        if self.bodies.is_empty() {
            self.rows.iter_mut().for_each(|rows| *rows = vec![I::NONE; bodies.len()]);
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
                Some(entry) => reversed::<I>(&rows[*entry], odd),
                None => I::NONE,
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
fn reversed<I: Inputs>(row: &I::Row, odd: &[bool; 4]) -> I::Row {
    I::row([0, 1, 2, 3].map(|place| I::each(row, place).times(if odd[place] { -1.0 } else { 1.0 })))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tangent::OneInput;

    /// Slopes that are the same in each number of a row.
    fn of<I: Inputs>(slope: f64) -> I::Row {
        let mut each = I::Each::none();
        each[I::COUNT - 1] = slope;
        I::row([each; 4])
    }

    /// The slopes of a row by the last of the inputs.
    fn told<I: Inputs>(row: &I::Row) -> [f64; 4] {
        [0, 1, 2, 3].map(|place| I::each(row, place)[I::COUNT - 1])
    }

    /// A list is made anew.
    fn follow<I: Inputs>() {
        let mut list = ListSlopes::<I>::of(1);
        list.set_odd([[true, true, true, false]].into_iter());
        list.follow([[0, 1], [2, 3]].into_iter());
        list.rows[0] = vec![of::<I>(1.0), of::<I>(2.0)];
        list.follow([[3, 2], [0, 4], [0, 1]].into_iter());
        let found: Vec<[f64; 4]> = list.rows[0].iter().map(told::<I>).collect();
        assert_eq!(found, [[-2.0, -2.0, -2.0, 2.0], [0.0; 4], [1.0; 4]]);
    }

    #[test]
    fn slopes_go_with_their_bodies_and_change_sign_with_their_order() {
        follow::<OneInput>();
    }
}
