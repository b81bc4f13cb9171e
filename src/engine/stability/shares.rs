//! How two bodies divide what they share.
//!
//! |a − b|² ≤ (1 + t) |a|² + (1 + 1/t) |b|² holds for any t > 0. Each body has a weight y, and t = (|b| y_b)/(|a| y_a): a body
//! with less of it bears more. Sweeps lay load from bodies with a large trace on neighbours with a small one (after Collatz
//! and Wielandt). Bodies limit the step by the largest eigenvalue of their block, but its trace costs a hundredth and tells
//! nearly as well what a body could still bear.

use super::ends::Ends;
use super::network::{Network, UNMOVED};
use crate::base::threads::Context;

/// Sweeps. More of them level the traces further than what the traces stand for.
const SWEEPS: usize = 2;

/// Largest and least share ratio t.
const MOST_UNEVEN: f64 = 1e6;

/// The largest eigenvalue of a block over its trace, about.
const LARGEST: f64 = 0.4;

/// How all bodies divide what they share.
pub(super) struct Shares<'a> {
    /// The network.
    network: &'a Network<'a>,
    /// Of each element the square roots of the traces of what each end would feel alone \[1/s\].
    traces: Vec<[f32; 2]>,
    /// y of each body.
    weights: Vec<f32>,
}

impl<'a> Shares<'a> {
    /// Those of a network, whose bodies have these ends: springs and dashpots are weighed about this root \[1/s\], or, if it is 0, about
    /// one that follows from traces.
    pub(super) fn of(network: &'a Network<'a>, ends: &Ends, guess: f64, context: &Context) -> Self {
        let mut shares = Self { network, traces: Vec::new(), weights: vec![1.0; network.movers()] };
        let mut at = guess;
        if network.is_damped() && guess <= 0.0 {
            let sums = [&network.stiffness, &network.damping].map(|parts| {
                shares.weigh(context, |place| parts.of(place));
                shares.sums(ends, context)
            });
            let root = |(k, c): (&f64, &f64)| {
                let (k, c) = (LARGEST * k, LARGEST * c);
                0.5 * (c + (c * c + 4.0 * k).sqrt())
            };
            at = sums[0].iter().zip(&sums[1]).map(root).fold(0.0, f64::max);
        }
        shares.weigh(context, |place| network.parts(place, at));
        for _ in 0..SWEEPS {
            let sums = shares.sums(ends, context);
            let most = sums.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
            for (weight, sum) in shares.weights.iter_mut().zip(sums) {
                *weight *= (sum / most).sqrt() as f32;
            }
        }
        shares
    }

    /// Finds the traces of all elements, each with these springs.
    fn weigh(&mut self, context: &Context, parts: impl Fn(usize) -> [f64; 4] + Sync + Send) {
        let network = self.network;
        self.traces.resize(network.elements.len(), [0.0; 2]);
        context.update(&mut self.traces, |place, traces| {
            let (element, parts) = (&network.elements[place], parts(place));
            *traces = [0, 1].map(|end| network.trace(element, end, parts).sqrt() as f32);
        });
    }

    /// The traces of all blocks \[1/s²\].
    fn sums(&self, ends: &Ends, context: &Context) -> Vec<f64> {
        let mut sums = vec![0.0; self.network.movers()];
        context.update(&mut sums, |mover, sum| {
            for (place, end) in ends.each_of(mover) {
                let trace = f64::from(self.traces[place][end]);
                *sum += self.borne(place)[end] * trace * trace;
            }
        });
        sums
    }

    /// How many times what they would feel of an element alone the bodies at its ends bear.
    #[inline]
    pub(super) fn borne(&self, place: usize) -> [f64; 2] {
        let [first, second] = self.network.bodies[place];
        if first == UNMOVED || second == UNMOVED {
            return [1.0; 2];
        }
        let strength =
            |end: usize, mover: u32| f64::from(self.traces[place][end]) * f64::from(self.weights[mover as usize]);
        divided([strength(0, first), strength(1, second)])
    }

    /// Of no interaction.
    pub(super) fn of_none(network: &'a Network<'a>) -> Self {
        Self { network, traces: Vec::new(), weights: Vec::new() }
    }

    /// Lets a body, whose root is to shrink by this ratio, bear less of all that it shares.
    pub(super) fn relieve(&mut self, mover: usize, ratio: f64) {
        let square = ratio * ratio;
        self.weights[mover] *= (1.05 * square * square) as f32;
    }
}

/// How many times what it would feel alone each of two bodies bears of what they share, by these strengths: the stronger one bears less.
#[inline]
pub(super) fn divided([first, second]: [f64; 2]) -> [f64; 2] {
    let ratio = second / first;
    // It is not a number where neither end can move.
    let share = if ratio.is_nan() { 1.0 } else { ratio.clamp(1.0 / MOST_UNEVEN, MOST_UNEVEN) };
    [1.0 + share, 1.0 + 1.0 / share]
}
