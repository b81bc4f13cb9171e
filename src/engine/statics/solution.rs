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

/// A direction in which a body's own stiffness is below this share of that in another is free: what is left then comes of the way in
/// which loads turn with a displacement.
const FREE: f64 = 1e-6;

/// How much above the rounding of a difference a stiffness must be to be one.
const ABOVE_ROUNDING: f64 = 16.0;

/// The inverses of the bodies' own blocks.
pub(super) struct Factors {
    /// One for each body, without its free directions.
    inverses: Vec<Block>,
    /// What takes the free directions out of a motion, of each body that has any.
    free: Vec<Option<Block>>,
    /// How many freedoms each has.
    each: usize,
    /// What is added to the diagonal \[N/m\].
    held: f64,
    /// Rounding of the coordinates over the way of the differences: loads are not known better than by this share.
    rounding: f64,
}

impl Factors {
    /// Those of a network whose blocks are differences over a way beside which the coordinates have this `rounding`.
    pub(super) fn of(columns: &Columns, rounding: f64) -> Self {
        let (each, held) = (columns.each(), HELD * columns.mean_stiffness());
        let least = FREE.max(ABOVE_ROUNDING * rounding);
        let (mut inverses, mut free) = (Vec::new(), Vec::new());
        for own in columns.own_blocks() {
            let (inverse, projection) = inverse(&own, each, held, least);
            inverses.push(inverse);
            free.push(projection);
        }
        Self { inverses, free, each, held, rounding }
    }

    /// Bodies that are free in some direction.
    pub(super) fn loose(&self) -> impl Iterator<Item = usize> {
        self.free.iter().enumerate().filter(|(_, free)| free.is_some()).map(|(body, _)| body)
    }

    /// Takes the free directions out of loads or motions.
    fn bind(&self, parts: &mut [f64]) {
        for (parts, free) in parts.chunks_exact_mut(self.each).zip(&self.free) {
            if let Some(free) = free {
                let bound: Vec<f64> = (0..self.each).map(|row| along(free, row, parts)).collect();
                parts.copy_from_slice(&bound);
            }
        }
    }

    /// Divides loads by the bodies' own blocks.
    fn divide(&self, loads: &[f64]) -> Vec<f64> {
        let bodies = loads.chunks_exact(self.each).zip(&self.inverses);
        let divided = bodies.flat_map(|(loads, inverse)| (0..self.each).map(move |row| along(inverse, row, loads)));
        divided.collect()
    }

    /// −J times displacements.
    fn times(&self, columns: &Columns, ways: &[f64]) -> Vec<f64> {
        let mut answer = columns.times(ways);
        for (answer, way) in answer.iter_mut().zip(ways) {
            *answer += self.held * way;
        }
        self.bind(&mut answer);
        answer
    }

    /// The displacements under which −J u is these loads; none where they are not found.
    pub(super) fn solve(&self, columns: &Columns, loads: &[f64]) -> Option<Vec<f64>> {
        let mut loads = loads.to_vec();
        self.bind(&mut loads);
        let loads = &loads[..];
        let mut ways = vec![0.0; loads.len()];
        let (mut rest, first, mut direction) = (loads.to_vec(), loads.to_vec(), loads.to_vec());
        let (mut before, size) = (dot(loads, loads), dot(loads, loads).sqrt());
        let left = |rest: &[f64]| dot(rest, rest).sqrt();
        for _ in 0..MOST {
            if left(&rest) <= ENOUGH.max(self.rounding) * size {
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
        (left(&rest) <= TOLERABLE.max(ABOVE_ROUNDING * self.rounding) * size).then_some(ways)
    }
}

/// Scalar product.
fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

/// A row of a block times loads or motions.
fn along(block: &Block, row: usize, parts: &[f64]) -> f64 {
    block.row(row).iter().zip(parts).map(|(entry, part)| entry * part).sum()
}

/// The inverse of a block with something added to its diagonal, in directions in which it is above the `least` share of the
/// largest, and what is to be multiplied to a motion that has others.
fn inverse(own: &Block, each: usize, held: f64, least: f64) -> (Block, Option<Block>) {
    let parts = own.svd(true, true);
    let (Some(left), Some(right)) = (parts.u, parts.v_t) else { return (Block::zeros(), Some(Block::zeros())) };
    let largest = parts.singular_values.max();
    let bears = parts.singular_values.map(|value| f64::from(value > least * largest));
    if bears.sum() as usize == each {
        let held = Vector6::from_fn(|freedom, _| if freedom < each { held } else { largest });
        return ((own + Matrix6::from_diagonal(&held)).try_inverse().unwrap_or_default(), None);
    }
    let inverse = parts.singular_values.zip_map(&bears, |value, bears| if bears > 0.0 { 1.0 / value } else { 0.0 });
    let projection = right.transpose() * Matrix6::from_diagonal(&bears) * right;
    (right.transpose() * Matrix6::from_diagonal(&inverse) * left.transpose(), Some(projection))
}
