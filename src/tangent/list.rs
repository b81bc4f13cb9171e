//! Slopes of what the entries of a list remember, which go with their bodies when lists are made anew.

use super::NONE;
use crate::dual::RowSlopes;

/// How what a list remembers of its entries changes.
pub(crate) struct ListSlopes {
    /// Bodies of each entry, as the scene numbers them.
    bodies: Vec<[u32; 2]>,
    /// Slopes of each entry, a column for each row.
    pub rows: Vec<Vec<RowSlopes>>,
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

    /// Takes over the entries of a list: those of the same bodies keep their slopes, others have none.
    pub(super) fn follow(&mut self, bodies: impl Iterator<Item = [u32; 2]>) {
        let bodies: Vec<[u32; 2]> = bodies.collect();
        if bodies == self.bodies {
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
                None => NONE,
            });
            *rows = moved.collect();
        }
        self.bodies = bodies;
    }
}

/// Slopes as the other body sees them.
fn reversed(row: &RowSlopes, odd: &[bool; 4]) -> RowSlopes {
    std::array::from_fn(|place| if odd[place] { row[place].map(|slope| -slope) } else { row[place] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::DIRECTIONS;

    #[test]
    fn slopes_go_with_their_bodies_and_change_sign_with_their_order() {
        let mut list = ListSlopes::of(1);
        list.set_odd([[true, true, true, false]].into_iter());
        list.follow([[0, 1], [2, 3]].into_iter());
        list.rows[0][0] = [[1.0; DIRECTIONS]; 4];
        list.rows[0][1] = [[2.0; DIRECTIONS]; 4];
        list.follow([[3, 2], [0, 4], [0, 1]].into_iter());
        assert_eq!(list.rows[0][0], [-2.0, -2.0, -2.0, 2.0].map(|slope| [slope; DIRECTIONS]));
        assert_eq!(list.rows[0][1], NONE);
        assert_eq!(list.rows[0][2], [[1.0; DIRECTIONS]; 4]);
    }
}
