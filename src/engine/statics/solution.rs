//! The equations of rest, solved by iteration (BiCGSTAB) about the bodies' own blocks: the network is sparse, nearly symmetric
//! and as large as the packing.

use super::columns::{Block, Columns};
use nalgebra::{Matrix6, Vector6};

/// What is added to the diagonal, over the mean stiffness, so that motions which nothing holds do not end the iteration.
const HELD: f64 = 1e-12;

/// Remaining load over the first at which the iteration ends.
const ENOUGH: f64 = 1e-12;

/// Remaining load over the first with which a solution is one.
const TOLERABLE: f64 = 1e-6;

/// Most iterations.
const MOST: usize = 5000;

/// The inverses of the bodies' own blocks.
pub(super) struct Factors {
    /// One for each body.
    inverses: Vec<Block>,
    /// How many freedoms each has.
    each: usize,
    /// What is added to the diagonal \[N/m\].
    held: f64,
}

impl Factors {
    /// Those of a network.
    pub(super) fn of(columns: &Columns) -> Self {
        let (each, held) = (columns.each(), HELD * columns.mean_stiffness());
        let inverses = columns.own_blocks().map(|own| inverse(own, each, held)).collect();
        Self { inverses, each, held }
    }

    /// Divides loads by the bodies' own blocks.
    fn divide(&self, loads: &[f64]) -> Vec<f64> {
        let bodies = loads.chunks_exact(self.each).zip(&self.inverses);
        let divided = bodies.flat_map(|(loads, inverse)| {
            let product = move |row: usize| inverse.row(row).iter().zip(loads).map(|(entry, load)| entry * load).sum();
            (0..self.each).map(product)
        });
        divided.collect()
    }

    /// −J times displacements.
    fn times(&self, columns: &Columns, ways: &[f64]) -> Vec<f64> {
        let mut answer = columns.times(ways);
        for (answer, way) in answer.iter_mut().zip(ways) {
            *answer += self.held * way;
        }
        answer
    }

    /// The displacements under which −J u is these loads; none where they are not found.
    pub(super) fn solve(&self, columns: &Columns, loads: &[f64]) -> Option<Vec<f64>> {
        let mut ways = vec![0.0; loads.len()];
        let (mut rest, first, mut direction) = (loads.to_vec(), loads.to_vec(), loads.to_vec());
        let (mut before, size) = (dot(loads, loads), dot(loads, loads).sqrt());
        let left = |rest: &[f64]| dot(rest, rest).sqrt();
        for _ in 0..MOST {
            if left(&rest) <= ENOUGH * size {
                break;
            }
            let step = self.divide(&direction);
            let change = self.times(columns, &step);
            let along = before / dot(&first, &change);
            let half: Vec<f64> = rest.iter().zip(&change).map(|(rest, change)| rest - along * change).collect();
            let second = self.divide(&half);
            let answer = self.times(columns, &second);
            let squared = dot(&answer, &answer);
            let share = if squared > 0.0 { dot(&answer, &half) / squared } else { 0.0 };
            for (way, (step, second)) in ways.iter_mut().zip(step.iter().zip(&second)) {
                *way += along * step + share * second;
            }
            for (rest, (half, answer)) in rest.iter_mut().zip(half.iter().zip(&answer)) {
                *rest = half - share * answer;
            }
            let now = dot(&first, &rest);
            if now == 0.0 || share == 0.0 {
                break;
            }
            let ratio = now / before * (along / share);
            before = now;
            for (direction, (rest, change)) in direction.iter_mut().zip(rest.iter().zip(&change)) {
                *direction = rest + ratio * (*direction - share * change);
            }
        }
        (left(&rest) <= TOLERABLE * size).then_some(ways)
    }
}

/// Scalar product.
fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

/// The inverse of a block with something added to its diagonal; 0 where there is none.
fn inverse(own: &Block, each: usize, held: f64) -> Block {
    let held = Vector6::from_fn(|freedom, _| if freedom < each { held } else { 1.0 });
    (own + Matrix6::from_diagonal(&held)).try_inverse().unwrap_or_default()
}
