//! The equations of rest, solved by iteration (BiCGSTAB) about sparse factors of their symmetric part, or about the bodies' own
//! blocks. About factors one iteration is enough where all contacts stick and springs are linear.

use super::columns::{Block, Columns};
use super::factors::{Factored, Factorise, factored};
use super::network::Network;
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

/// What takes directions in which nothing bears out of a motion, body by body.
pub(super) struct Bound {
    /// What takes them out, of each body that has any.
    free: Vec<Option<Block>>,
    /// What stands in their place on the diagonal \[N/m\].
    instead: f64,
}

impl Bound {
    /// A block of one body by another without them; on the diagonal with a stiffness in them.
    pub(super) fn within(&self, [body, moving]: [usize; 2], block: &Block) -> Block {
        let mut within = *block;
        if let Some(bound) = &self.free[body] {
            within = bound.transpose() * within;
        }
        if let Some(bound) = &self.free[moving] {
            within *= bound;
        }
        match &self.free[body] {
            Some(bound) if body == moving => within + (Block::identity() - bound) * self.instead,
            _ => within,
        }
    }

    /// Takes them out of loads or motions.
    fn bind(&self, parts: &mut [f64], each: usize) {
        for (parts, free) in parts.chunks_exact_mut(each).zip(&self.free) {
            if let Some(free) = free {
                let bound: Vec<f64> = (0..each).map(|row| along(free, row, parts)).collect();
                parts.copy_from_slice(&bound);
            }
        }
    }
}

/// The equations of a network, and how they are solved.
pub(super) struct Equations {
    /// −J.
    pub(super) columns: Columns,
    /// The inverses of the bodies' own blocks, without their free directions.
    inverses: Vec<Block>,
    /// The free directions.
    bound: Bound,
    /// Whether each body is free in some direction by itself.
    is_free: Vec<bool>,
    /// Factors of all, where they are used.
    factored: Option<Factored>,
    /// What is added to the diagonal \[N/m\].
    held: f64,
    /// Rounding of the coordinates over the way of the differences: loads are not known better than by this share.
    rounding: f64,
}

impl Equations {
    /// Those of a network whose blocks are differences over a way beside which the coordinates have this `rounding`.
    pub(super) fn of(columns: Columns, network: &Network, rounding: f64) -> Self {
        let (each, mean) = (columns.each(), columns.mean_stiffness());
        let held = HELD * mean;
        let least = FREE.max(ABOVE_ROUNDING * rounding);
        let (mut inverses, mut free, mut is_free) = (Vec::new(), Vec::new(), Vec::new());
        for (body, own) in columns.own_blocks().enumerate() {
            let (inverse, projection, rests) = inverse(&own, (each, network.pinned[body]), held, least);
            inverses.push(inverse);
            free.push(projection);
            is_free.push(!rests);
        }
        let bound = Bound { free, instead: mean };
        Self { columns, inverses, bound, is_free, factored: None, held, rounding }
    }

    /// Uses factors from here on, where there are any.
    pub(super) fn factorise(&mut self, factorise: Factorise) {
        let least = ABOVE_ROUNDING * self.rounding.max(f64::EPSILON);
        self.factored = factored(factorise, &self.columns, &self.bound, least);
    }

    /// Whether a difference of loads is no more than rounding makes of it \[N/m\].
    pub(super) fn is_rounding(&self, load: f64) -> bool {
        load <= ABOVE_ROUNDING * self.rounding * self.bound.instead
    }

    /// Bodies that are free in some direction by themselves.
    pub(super) fn free(&self) -> impl Iterator<Item = usize> {
        self.is_free.iter().enumerate().filter(|(_, free)| **free).map(|(body, _)| body)
    }

    /// Bodies that are free in some direction by themselves, or, as far as factors tell it, with others; ascending.
    pub(super) fn loose(&self) -> Vec<usize> {
        let together = self.factored.iter().flat_map(|factored| factored.loose.iter().copied());
        let mut all: Vec<usize> = self.free().chain(together).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Whether factors say that every motion takes energy.
    pub(super) fn is_stable(&self) -> bool {
        self.factored.as_ref().is_some_and(|factored| factored.is_stable) && self.loose().is_empty()
    }

    /// Takes the free directions out of loads or motions.
    fn bind(&self, parts: &mut [f64]) {
        self.bound.bind(parts, self.columns.each());
        if let Some(factored) = &self.factored {
            factored.held.iter().for_each(|&freedom| parts[freedom] = 0.0);
        }
    }

    /// Divides loads by the factors, or by the bodies' own blocks.
    fn divide(&self, loads: &[f64]) -> Vec<f64> {
        let each = self.columns.each();
        if let Some(factored) = &self.factored {
            let mut ways = loads.to_vec();
            (factored.divide)(&mut ways);
            self.bind(&mut ways);
            return ways;
        }
        let bodies = loads.chunks_exact(each).zip(&self.inverses);
        let divided = bodies.flat_map(|(loads, inverse)| (0..each).map(move |row| along(inverse, row, loads)));
        divided.collect()
    }

    /// −J times displacements.
    fn times(&self, ways: &[f64]) -> Vec<f64> {
        let mut answer = self.columns.times(ways);
        for (answer, way) in answer.iter_mut().zip(ways) {
            *answer += self.held * way;
        }
        self.bind(&mut answer);
        answer
    }

    /// The displacements under which −J u is these loads; none where they are not found.
    pub(super) fn solve(&self, loads: &[f64]) -> Option<Vec<f64>> {
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
            let change = self.times(&step);
            let along = before / dot(&first, &change);
            let half: Vec<f64> = rest.iter().zip(&change).map(|(rest, change)| rest - along * change).collect();
            let second = self.divide(&half);
            let answer = self.times(&second);
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
/// largest; what is to be multiplied to a motion that has others; whether it has none beside those that are pinned.
fn inverse(own: &Block, (each, pinned): (usize, [bool; 6]), held: f64, least: f64) -> (Block, Option<Block>, bool) {
    let fixed = Block::from_diagonal(&Vector6::from_fn(|freedom, _| f64::from(!pinned[freedom])));
    let parts = (fixed * own * fixed).svd(true, true);
    let (Some(left), Some(right)) = (parts.u, parts.v_t) else { return (Block::zeros(), Some(Block::zeros()), false) };
    let largest = parts.singular_values.max();
    let bears = parts.singular_values.map(|value| f64::from(value > least * largest));
    let count = bears.sum() as usize;
    let rests = count + pinned[..each].iter().filter(|pinned| **pinned).count() >= each;
    if count == each {
        let held = Vector6::from_fn(|freedom, _| if freedom < each { held } else { largest });
        return ((own + Matrix6::from_diagonal(&held)).try_inverse().unwrap_or_default(), None, rests);
    }
    let inverse = parts.singular_values.zip_map(&bears, |value, bears| if bears > 0.0 { 1.0 / value } else { 0.0 });
    let projection = right.transpose() * Matrix6::from_diagonal(&bears) * right;
    (right.transpose() * Matrix6::from_diagonal(&inverse) * left.transpose(), Some(projection), rests)
}
