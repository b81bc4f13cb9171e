//! The bodies that limit the step, taken together.
//!
//! The blocks of single bodies are sharp where all neighbours of a body can move against it at once: in lattices, and about a
//! small sphere among large ones. In random packings they are not: three spheres that touch each other cannot all approach. But
//! only a few bodies have roots near the largest. These and their neighbours are taken together as a network of their own, with
//! what they bear of contacts with others. The root of the whole is at most the larger one of the root of that network, which
//! Lanczos' method certifies, and of the largest root of the blocks of the others.

use super::blocks::{Blocks, ROUNDING};
use super::lanczos::{Method, products};
use super::network::Network;
use crate::base::threads::Context;

/// Part of the bound by blocks that the true root certainly reaches where that bound is left as it is.
const SHARP: f64 = 0.93;

/// Products by which the root is estimated.
const PRODUCTS: usize = 20;

/// Bodies of a part that may tell as much as all that limit the step,
const FEW: usize = 4000;

/// where these are so many times as many.
const MANY: usize = 4;

/// ε of a certificate without and with dashpots.
const SHARES: [f64; 2] = [0.08, 0.05];

/// Chance that a certificate is wrong; that of all that are tried stays below 1e-10.
const CHANCE: f64 = 1e-11;

/// Most certificates that are tried.
const TRIALS: usize = 4;

/// Room above the root that is estimated, from below: the more of it, the fewer bodies are taken together.
const ROOM: f64 = 1.015;

/// What was tried and what is then certain are this close where that is taken.
const CLOSE: f64 = 0.97;

/// Part of the bound above which it is not worth another certificate.
const GAIN: f64 = 0.99;

/// The largest root μ = 2/Δt \[1/s\] of contacts without bonds, from the safe side, and the body that has it; none where several
/// have it together. `guess` is a root found earlier, or 0.
pub(super) fn largest_root(network: &Network, guess: f64, context: &Context) -> (f64, Option<usize>) {
    let mut blocks = Blocks::filled(network, guess, context);
    let bound = blocks.largest_of_all();
    let (root, mover) = sharpened(&mut blocks, bound, context);
    (root * (1.0 + ROUNDING), mover)
}

/// The largest root \[1/s\], not above this bound by the blocks alone, and the body that has it; none where several have it
/// together.
fn sharpened(blocks: &mut Blocks, bound: (f64, Option<usize>), context: &Context) -> (f64, Option<usize>) {
    // Starts depend on the particles alone: a network that has not changed keeps its bound.
    let mut counter = 0;
    let share = SHARES[usize::from(blocks.is_damped())];
    let sharp = SHARP * bound.0;
    let limiting = blocks.with_neighbours(&blocks.above(sharp));
    // A part of them alone has no larger root: in a lattice, where nearly all bodies limit, it tells as much.
    let several = bound.1.filter(|_| limiting.iter().filter(|limits| **limits).count() > MANY * FEW);
    if let Some(mover) = several {
        let near = blocks.together(&blocks.nearest(&limiting, mover, FEW), true);
        if Method::of(&near, context).below(sharp, PRODUCTS, &mut counter.clone()).is_none() {
            return bound;
        }
    }
    let alone = blocks.together(&limiting, true);
    let Some([root, slope]) = Method::of(&alone, context).below(sharp, PRODUCTS, &mut counter) else { return bound };
    // Where √λ_max/√(1 − ε) = μ, about.
    let slope = slope.min(0.5);
    let mut tried = ROOM * root * (1.0 - slope) / ((1.0 - share).sqrt() - slope);
    let mut best = bound;
    for _ in 0..TRIALS {
        if tried >= GAIN * best.0 {
            break;
        }
        let (certain, close) = certified(blocks, tried, share, &mut counter, context);
        if certain.0 < best.0 {
            best = certain;
        }
        if close {
            break;
        }
        tried = certain.0;
    }
    best
}

/// What the root \[1/s\] certainly is not above, with the body that has it, found from those that limit a step with the
/// root that is tried; and whether that is so close to it that another trial would gain little.
fn certified(
    blocks: &mut Blocks,
    tried: f64,
    share: f64,
    counter: &mut u64,
    context: &Context,
) -> ((f64, Option<usize>), bool) {
    let above = blocks.relieve(tried);
    let chosen = blocks.with_neighbours(&above);
    let together = blocks.together(&chosen, false);
    let mut method = Method::of(&together, context);
    let certain = method.certain(tried, share, products(method.order(), share, CHANCE), counter);
    if certain > tried {
        // S(r μ) is at most r S(μ) for r above 1: so the root is at most where r √λ_max² = r² μ².
        let root = if blocks.is_damped() { certain * certain / tried } else { certain };
        return ((root, None), root < tried / CLOSE);
    }
    (blocks.largest(|mover| !chosen[mover], certain), certain > CLOSE * tried)
}
