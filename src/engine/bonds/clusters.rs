//! Which bodies bonds hold together, and where these stand in a cluster.
//!
//! Bodies are numbered as the network of the stable step does: particles by slot, behind them bodies of several parts.

use crate::base::number::Vector;
use crate::engine::state::State;

/// Instead of the number of a cluster: a body without a bond.
const ALONE: u32 = u32::MAX;

/// Two places of one body further apart than this, over the distance of its neighbour, are those of a cluster that goes once
/// around a periodic cell.
const ROUND: f64 = 0.5;

/// Clusters of bonded bodies. Its rows are kept, so that to find them again requests no memory.
#[derive(Debug, Default)]
pub(crate) struct Clusters {
    /// Of each body another one of its cluster; of the first one itself.
    parents: Vec<u32>,
    /// From that one to the body \[m\].
    offsets: Vec<Vector>,
    /// Number of the cluster of each body.
    numbers: Vec<u32>,
    /// Of each cluster whether it goes around a periodic cell.
    around: Vec<bool>,
    /// Bodies of clusters that do.
    closed: Vec<u32>,
}

impl Clusters {
    /// Begins with so many bodies without bonds.
    pub(crate) fn begin(&mut self, bodies: usize) {
        self.parents.clear();
        self.parents.extend(0..bodies as u32);
        self.offsets.clear();
        self.offsets.resize(bodies, Vector::zero());
        self.numbers.clear();
        self.numbers.resize(bodies, ALONE);
        self.around.clear();
        self.closed.clear();
    }

    /// The first body of the cluster of a body, and from there to this one \[m\].
    fn first(&mut self, body: usize) -> (usize, Vector) {
        let (mut first, mut place) = (body, Vector::zero());
        while self.parents[first] as usize != first {
            place += self.offsets[first];
            first = self.parents[first] as usize;
        }
        let (mut at, mut left) = (body, place);
        while at != first {
            let (next, offset) = (self.parents[at] as usize, self.offsets[at]);
            (self.parents[at], self.offsets[at]) = (first as u32, left);
            (at, left) = (next, left - offset);
        }
        (first, place)
    }

    /// Notes a bond between two bodies, the second of which is there from the first \[m\].
    pub(crate) fn unite(&mut self, [a, b]: [usize; 2], way: Vector) {
        let ((first, to_a), (other, to_b)) = (self.first(a), self.first(b));
        (self.numbers[a], self.numbers[b]) = (0, 0);
        let between = to_a + way - to_b;
        if first < other {
            (self.parents[other], self.offsets[other]) = (first as u32, between);
        } else if other < first {
            (self.parents[first], self.offsets[first]) = (other as u32, -between);
        } else if between.length() > ROUND * way.length() && way.length() > 0.0 {
            self.closed.push(a as u32);
        }
    }

    /// Numbers the clusters, by their first bodies. Afterwards every body knows its own.
    pub(crate) fn number(&mut self) {
        let mut count = 0;
        for body in 0..self.parents.len() {
            if self.numbers[body] == ALONE {
                continue;
            }
            let (first, _) = self.first(body);
            self.numbers[body] = if first == body { count } else { self.numbers[first] };
            count += u32::from(first == body);
        }
        self.around.resize(count as usize, false);
        for &body in &self.closed {
            self.around[self.numbers[body as usize] as usize] = true;
        }
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.around.len()
    }

    /// Whether a cluster goes around a periodic cell.
    pub(crate) fn goes_around(&self, cluster: usize) -> bool {
        self.around[cluster]
    }

    /// The number of the cluster of a body, if it has one.
    #[inline]
    pub(crate) fn of(&self, body: usize) -> Option<usize> {
        let number = self.numbers[body];
        (number != ALONE).then_some(number as usize)
    }

    /// The body that stands for all of its cluster.
    #[inline]
    pub(crate) fn representative(&self, body: usize) -> usize {
        self.parents[body] as usize
    }

    /// From the first body of its cluster to a body \[m\].
    #[inline]
    pub(crate) fn place(&self, body: usize) -> Vector {
        self.offsets[body]
    }
}

/// The body that moves a particle (slot): itself, or behind all particles the body of several parts.
#[inline]
pub(crate) fn mover(state: &State, slot: u32) -> usize {
    let original = state.particles.original(slot) as usize;
    match state.particles.group(original) {
        None => original,
        Some(group) => state.particles.len() + group,
    }
}

/// How many bodies there may be.
pub(crate) fn bodies(state: &State) -> usize {
    state.particles.len() + state.owners()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A vector along x \[m\].
    fn along(x: f64) -> Vector {
        Vector::new(x, 0.0, 0.0)
    }

    #[test]
    fn bonds_make_clusters_and_tell_where_bodies_stand_in_them() {
        let mut clusters = Clusters::default();
        for _ in 0..2 {
            clusters.begin(8);
            clusters.unite([5, 6], along(2.0));
            clusters.unite([1, 2], along(1.0));
            clusters.unite([3, 2], along(-4.0));
            clusters.unite([6, 3], along(3.0));
            clusters.unite([4, 7], along(1.0));
            clusters.number();
            let numbers: Vec<_> = (0..8).map(|body| clusters.of(body)).collect();
            assert_eq!(numbers, [None, Some(0), Some(0), Some(0), Some(1), Some(0), Some(0), Some(1)]);
            let places = [1, 2, 3, 5, 6].map(|body| clusters.place(body).x);
            assert_eq!(places, [0.0, 1.0, 5.0, 0.0, 2.0]);
            assert_eq!([clusters.len(), clusters.representative(6)], [2, 1]);
            assert!(!clusters.goes_around(0));
        }
    }

    #[test]
    fn a_ring_through_the_faces_of_a_cell_goes_around_it_and_one_in_space_does_not() {
        let mut clusters = Clusters::default();
        clusters.begin(6);
        for (pair, x) in [([0, 1], 1.0), ([1, 2], 1.0), ([2, 0], 1.0), ([3, 4], 1.0), ([4, 5], 1.0), ([5, 3], -2.0)] {
            clusters.unite(pair, along(x));
        }
        clusters.number();
        assert_eq!([clusters.goes_around(0), clusters.goes_around(1)], [true, false]);
    }
}
