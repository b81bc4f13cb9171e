//! The bound body by body, for contacts without bonds.
//!
//! The scheme is stable while 4 M − 2 Δt C − Δt² K is positive definite. An interaction's share between two bodies is
//! bounded by what each would feel alone, |a − b|² ≤ (1 + t) |a|² + (1 + 1/t) |b|² for any t > 0, so the whole is bounded by
//! the largest root μ = 2/Δt of the bodies' own 6 × 6 blocks: μ² = λ_max(D(K) + μ D(C)). Which t is good is found by sweeps
//! over the traces of the blocks ([`super::shares`]); whatever they find is a bound. Most bodies are far below it. Those that
//! are not are taken together where that brings the bound down ([`super::cluster`]).

use super::ends::Ends;
use super::network::{Element, Network, UNMOVED, single};
use super::shares::{Shares, divided};
use super::triangle::{EMPTY, Place, Triangle, add_group, norm_squared, whole};
use crate::base::threads::{CHUNK, Context};
use crate::engine::contacts::Link;
use nalgebra::{Matrix6, Vector6};
use std::ops::Range;

/// How often bodies hand load on.
const RELIEFS: usize = 3;

/// Iterations that find the root of a block from below.
const ITERATIONS: usize = 8;

/// What a trial root grows by until it is above the root.
const TRIAL: f64 = 1.002;

/// What rounding in single precision may take from a bound, with room.
pub(super) const ROUNDING: f64 = 1e-5;

/// Where iterations begin: across no direction that a block is likely to single out.
const ASKEW: [f64; 6] = [0.5, 0.4, 0.35, 0.45, 0.3, 0.4];

/// D(K) \[1/s²\] and D(C) \[1/s\] of a body.
type Own = [Triangle; 2];

/// Own blocks of all bodies.
pub(super) struct Blocks<'a> {
    /// The network.
    network: &'a Network<'a>,
    /// The threads.
    context: &'a Context<'a>,
    /// The ends of its interactions, body by body.
    ends: Ends,
    /// What each body bears of what it shares with another.
    shares: Shares<'a>,
    /// Those of each body.
    own: Vec<Own>,
}

/// The motion that the bound of one body comes from: of this body alone, about, scaled as the network is.
pub(super) fn critical_motion(network: &Network, root: f64, mover: usize, context: &Context) -> Vec<[f64; 6]> {
    /// Iterations after which it stands out.
    const ITERATIONS: usize = 60;
    let mut motion = vec![[0.0; 6]; network.movers()];
    let mut blocks = Blocks::of(network, root, context);
    blocks.add(|other| other == mover);
    motion[mover] = ASKEW;
    blocks.estimate(&mut motion[mover], mover, root, ITERATIONS);
    motion
}

/// The largest root \[1/s\] of the blocks of interactions that are told one after the other, none of which is kept, from the safe side;
/// and the body that has it. Bodies that share one bear of it as if they had no others.
pub(super) fn quick_root(
    bodies: &Network,
    supports: Vec<(Element, [f64; 4])>,
    tell: impl FnOnce(&mut dyn FnMut(Link)),
    context: &Context,
) -> (f64, Option<usize>) {
    let (ends, shares) = (Ends::default(), Shares::of_none(bodies));
    let mut blocks = Blocks { network: bodies, context, ends, shares, own: vec![[EMPTY; 2]; bodies.movers()] };
    tell(&mut |link| blocks.add_link(&link));
    for (element, stiffness) in supports {
        blocks.add_parts(&element, [stiffness, [0.0; 4]]);
    }
    let (root, mover) = blocks.largest_of_all();
    (root * (1.0 + ROUNDING), mover)
}

impl<'a> Blocks<'a> {
    /// Those of a network; shares are weighed about this root \[1/s\], or one of their own.
    pub(super) fn filled(network: &'a Network<'a>, guess: f64, context: &'a Context<'a>) -> Self {
        let mut blocks = Self::of(network, guess, context);
        blocks.add(|_| true);
        blocks
    }

    /// Empty ones; shares are weighed about this root \[1/s\], or one of their own.
    fn of(network: &'a Network<'a>, guess: f64, context: &'a Context<'a>) -> Self {
        let ends = Ends::of(network.movers(), &network.bodies);
        let shares = Shares::of(network, &ends, guess, context);
        Self { network, context, ends, shares, own: vec![[EMPTY; 2]; network.movers()] }
    }
}

impl Blocks<'_> {
    /// Adds an interaction that the network does not keep.
    fn add_link(&mut self, link: &Link) {
        for link in self.network.with_itself(link).iter().flatten() {
            if let Some(element) = self.network.element(link) {
                self.add_parts(&element, [link.stiffness, link.damping]);
            }
        }
    }

    /// Adds an element with these springs and dashpots.
    fn add_parts(&mut self, element: &Element, parts: [[f64; 4]; 2]) {
        let movers = element.slots.map(|slot| self.network.mover(slot));
        let mut shares = [1.0; 2];
        if let [Some(_), Some(_)] = movers {
            let strengths = [0, 1].map(|end| self.network.trace(element, end, parts[0]).sqrt());
            shares = divided(strengths);
        }
        // As a network keeps them.
        let parts = parts.map(|parts| parts.map(single));
        for end in 0..2 {
            if let Some(mover) = movers[end] {
                add_end(self.network, (mover, &mut self.own[mover]), (element, end), parts, shares[end]);
            }
        }
    }

    /// Whether anything is damped.
    pub(super) fn is_damped(&self) -> bool {
        self.network.is_damped()
    }

    /// The largest root of all bodies, from the safe side, and the body that has it.
    pub(super) fn largest_of_all(&self) -> (f64, Option<usize>) {
        self.largest(|_| true, 0.0)
    }

    /// Lets bodies whose root is above this one \[1/s\] hand load on to their neighbours; tells which of all bodies still are.
    pub(super) fn relieve(&mut self, root: f64) -> Vec<bool> {
        let mut above = self.above(root);
        for _ in 0..RELIEFS {
            for mover in (0..above.len()).filter(|&mover| above[mover]) {
                let ratio = self.estimate(&mut ASKEW.clone(), mover, root, ITERATIONS) / root;
                self.shares.relieve(mover, ratio.clamp(1.0, 2.0));
            }
            let touched = self.with_neighbours(&above);
            for mover in (0..touched.len()).filter(|&mover| touched[mover]) {
                self.own[mover] = [EMPTY; 2];
            }
            self.add(|mover| touched[mover]);
            for mover in (0..touched.len()).filter(|&mover| touched[mover]) {
                above[mover] = !self.is_below(mover, root);
            }
        }
        above
    }

    /// Adds all elements to the blocks of the bodies that are chosen.
    fn add(&mut self, chosen: impl Fn(usize) -> bool + Sync + Send) {
        let Self { network, ends, shares, own, .. } = self;
        self.context.update(own, |mover, own| {
            let ends = if chosen(mover) { ends.each_of(mover) } else { return };
            for (place, end) in ends {
                let parts = [network.stiffness.of(place), network.damping.of(place)];
                let element = (&network.elements[place], end);
                add_end(network, (mover, own), element, parts, shares.borne(place)[end]);
            }
        });
    }

    /// The bodies of which this is true.
    fn those(&self, chosen: impl Fn(usize) -> bool + Sync + Send) -> Vec<bool> {
        let mut those = vec![false; self.network.movers()];
        self.context.update(&mut those, |mover, that| *that = chosen(mover));
        those
    }

    /// The bodies whose root is not below this one \[1/s\].
    pub(super) fn above(&self, root: f64) -> Vec<bool> {
        self.those(|mover| !self.is_below(mover, root))
    }

    /// The body at the other end of an interaction, if one moves there.
    fn other(&self, (place, end): (usize, usize)) -> Option<usize> {
        Some(self.network.bodies[place][1 - end]).filter(|other| *other != UNMOVED).map(|other| other as usize)
    }

    /// These bodies and their neighbours.
    pub(super) fn with_neighbours(&self, chosen: &[bool]) -> Vec<bool> {
        let is_chosen = |end| self.other(end).is_some_and(|other| chosen[other]);
        self.those(|mover| chosen[mover] || self.ends.each_of(mover).any(is_chosen))
    }

    /// So many of these bodies, or fewer, that are next to this one, by contacts among them.
    pub(super) fn nearest(&self, chosen: &[bool], mover: usize, most: usize) -> Vec<bool> {
        let (mut near, mut found, mut next) = (vec![false; chosen.len()], vec![mover], 0);
        near[mover] = true;
        while next < found.len() && found.len() < most {
            for other in self.ends.each_of(found[next]).filter_map(|end| self.other(end)) {
                if chosen[other] && !near[other] {
                    near[other] = true;
                    found.push(other);
                }
            }
            next += 1;
        }
        near
    }

    /// The network of these bodies alone, to which all others stand still: what two of them share, and what one shares with
    /// others as often as it bears it, or only once.
    pub(super) fn together(&self, chosen: &[bool], once: bool) -> Network<'_> {
        let borne = |place: usize, end: usize| if once { 1.0 } else { self.shares.borne(place)[end] };
        self.network.part(chosen, borne)
    }

    /// D(K) and D(C) of a body.
    fn block(&self, mover: usize) -> Block {
        let [stiffness, damping] = self.own[mover].each_ref().map(whole);
        Block { stiffness, damping }
    }

    /// Whether the root of a body is below this one: whether μ² − D(K) − μ D(C) is positive definite.
    fn is_below(&self, mover: usize, root: f64) -> bool {
        let square = root * root;
        let [stiffness, damping] = &self.own[mover];
        // No eigenvalue is above the norm of all entries: most bodies need no more.
        norm_squared(stiffness, damping, root) < square * square
            || (Matrix6::from_diagonal_element(square) - self.block(mover).combined(root)).cholesky().is_some()
    }

    /// About the root of a body, from below: that of the motion that iteration comes to.
    fn estimate(&self, vector: &mut [f64; 6], mover: usize, guess: f64, iterations: usize) -> f64 {
        let (mut root, block, mut motion) = (guess, self.block(mover), Vector6::from(*vector));
        for _ in 0..iterations {
            let next = block.combined(root) * motion;
            let length = next.norm();
            if length <= 0.0 {
                return 0.0;
            }
            motion = next / length;
            root = block.root_of_motion(&motion);
        }
        *vector = motion.into();
        root
    }

    /// The largest root of the bodies that are chosen and above `floor`, from the safe side, and the body that has it.
    pub(super) fn largest(&self, chosen: impl Fn(usize) -> bool + Sync + Send, floor: f64) -> (f64, Option<usize>) {
        let (mut most, mut at) = (floor, None);
        let is_passed = |mover: usize, most: f64| match most > 0.0 {
            true => most.is_infinite() || self.is_below(mover, most),
            false => self.own[mover] == [EMPTY; 2],
        };
        // What is below a root that was found earlier is below a larger one.
        for movers in rounds(self.network.movers()) {
            let (begin, count, known) = (movers.start, movers.len(), most);
            let pieces = self.context.collect(count.div_ceil(CHUNK), |piece| {
                let movers = begin + piece * CHUNK..begin + ((piece + 1) * CHUNK).min(count);
                movers.filter(|&mover| chosen(mover) && !is_passed(mover, known)).collect::<Vec<_>>()
            });
            for mover in pieces.into_iter().flatten() {
                if is_passed(mover, most) {
                    continue;
                }
                let mut vector = ASKEW;
                most = self.estimate(&mut vector, mover, most, ITERATIONS).max(most) * TRIAL;
                // A block that holds no number has no root; the trial then ends at infinity.
                let mut growth = TRIAL;
                while most.is_finite() && !self.is_below(mover, most) {
                    most *= growth;
                    growth *= TRIAL;
                }
                at = Some(mover);
            }
        }
        (most, at)
    }
}

/// Places up to this number, in rounds each of which is twice as long as those before.
fn rounds(count: usize) -> impl Iterator<Item = Range<usize>> {
    let ends = std::iter::successors(Some(0), move |from| (*from < count).then(|| (3 * from).max(CHUNK).min(count)));
    ends.clone().zip(ends.skip(1)).map(|(from, to)| from..to)
}

/// Adds one end of an element, with its springs and dashpots, to the block of its body, which bears this share of them.
fn add_end(
    network: &Network,
    (mover, own): (usize, &mut Own),
    (element, end): (&Element, usize),
    parts: [[f64; 4]; 2],
    share: f64,
) {
    match mover.checked_sub(network.roots.len()) {
        None => {
            let place = Place::of(element, end, network.roots[mover], share);
            for (block, parts) in own.iter_mut().zip(parts).filter(|(_, parts)| *parts != [0.0; 4]) {
                place.add(block, parts);
            }
        }
        Some(group) => {
            let Some(group) = &network.groups[group] else { return };
            let arm = network.arm(element, end, group).to_array();
            for (block, parts) in own.iter_mut().zip(parts).filter(|(_, parts)| *parts != [0.0; 4]) {
                add_group(block, element.normal, arm, parts, group, share);
            }
        }
    }
}

/// D(K) \[1/s²\] and D(C) \[1/s\] of a body as whole matrices.
struct Block {
    /// D(K).
    stiffness: Matrix6<f64>,
    /// D(C).
    damping: Matrix6<f64>,
}

impl Block {
    /// D(K) + μ D(C).
    #[inline(always)]
    fn combined(&self, root: f64) -> Matrix6<f64> {
        self.stiffness + self.damping * root
    }

    /// The root of one motion.
    #[inline(always)]
    fn root_of_motion(&self, motion: &Vector6<f64>) -> f64 {
        let form = |block: &Matrix6<f64>| (block * motion).dot(motion);
        let (k, c) = (form(&self.stiffness), form(&self.damping));
        0.5 * (c + (c * c + 4.0 * k).max(0.0).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_hold_every_place_once_and_in_order() {
        for count in [0, 1, CHUNK, CHUNK + 1, 100_000] {
            let all: Vec<usize> = rounds(count).flatten().collect();
            assert!(all.iter().copied().eq(0..count), "{count}");
        }
    }
}
