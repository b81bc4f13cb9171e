//! The bound body by body, for contacts without bonds.
//!
//! The scheme is stable while 4 M − 2 Δt C − Δt² K is positive definite. An interaction's share between two bodies is
//! bounded by what each would feel alone, |a − b|² ≤ (1 + t) |a|² + (1 + 1/t) |b|² for any t > 0, so the whole is bounded by
//! the largest root μ = 2/Δt of the bodies' own 6 × 6 blocks: μ² = λ_max(D(K) + μ D(C)). Which t is good is found by sweeps
//! over the traces of the blocks ([`super::shares`]); whatever they find is a bound. Most bodies are far below it. Those that
//! are not are taken together where that brings the bound down ([`super::cluster`]).

use super::network::{Element, Network, single};
use super::shares::{Shares, divided};
use super::triangle::{EMPTY, Place, Triangle, add_group, norm_squared, whole};
use crate::engine::contacts::Link;
use nalgebra::{Matrix6, Vector6};

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

/// Own blocks of all bodies.
pub(super) struct Blocks<'a> {
    /// The network.
    network: &'a Network<'a>,
    /// What each body bears of what it shares with another.
    shares: Shares<'a>,
    /// D(K) of each body \[1/s²\].
    stiffness: Vec<Triangle>,
    /// D(C) of each body \[1/s\]; empty where nothing is damped.
    damping: Vec<Triangle>,
}

/// The motion that the bound of one body comes from: of this body alone, about, scaled as the network is.
pub(super) fn critical_motion(network: &Network, root: f64, mover: usize) -> Vec<[f64; 6]> {
    /// Iterations after which it stands out.
    const ITERATIONS: usize = 60;
    let mut motion = vec![[0.0; 6]; network.movers()];
    let mut blocks = Blocks::of(network, root);
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
) -> (f64, Option<usize>) {
    let (movers, shares) = (bodies.movers(), Shares::of_none(bodies));
    let mut blocks = Blocks { network: bodies, shares, stiffness: vec![EMPTY; movers], damping: Vec::new() };
    tell(&mut |link| blocks.add_link(&link));
    for (element, stiffness) in supports {
        blocks.add_parts(&element, [stiffness, [0.0; 4]]);
    }
    let (root, mover) = blocks.largest_of_all();
    (root * (1.0 + ROUNDING), mover)
}

impl<'a> Blocks<'a> {
    /// Those of a network; shares are weighed about this root \[1/s\], or one of their own.
    pub(super) fn filled(network: &'a Network<'a>, guess: f64) -> Self {
        let mut blocks = Self::of(network, guess);
        blocks.add(|_| true);
        blocks
    }

    /// Empty ones; shares are weighed about this root \[1/s\], or one of their own.
    fn of(network: &'a Network<'a>, guess: f64) -> Self {
        let movers = network.movers();
        Self {
            network,
            shares: Shares::of(network, guess),
            stiffness: vec![EMPTY; movers],
            damping: vec![EMPTY; if network.is_damped() { movers } else { 0 }],
        }
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
        if self.damping.is_empty() && parts[1] != [0.0; 4] {
            self.damping = vec![EMPTY; self.stiffness.len()];
        }
        for end in 0..2 {
            if let Some(mover) = movers[end] {
                self.add_end(mover, (element, end), parts, shares[end]);
            }
        }
    }

    /// Whether anything is damped.
    pub(super) fn is_damped(&self) -> bool {
        self.network.is_damped()
    }

    /// The largest root of all bodies, from the safe side, and the body that has it.
    pub(super) fn largest_of_all(&self) -> (f64, Option<usize>) {
        self.largest(0..self.network.movers(), 0.0)
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
                self.stiffness[mover] = EMPTY;
                if let Some(block) = self.damping.get_mut(mover) {
                    *block = EMPTY;
                }
            }
            self.add(|mover| touched[mover]);
            for mover in (0..touched.len()).filter(|&mover| touched[mover]) {
                above[mover] = !self.is_below(mover, root);
            }
        }
        above
    }

    /// Adds all elements to the blocks of the bodies that are chosen.
    fn add(&mut self, chosen: impl Fn(usize) -> bool) {
        for place in 0..self.network.elements.len() {
            if !self.network.elements[place].slots.iter().any(|slot| self.network.mover(*slot).is_some_and(&chosen)) {
                continue;
            }
            for (end, borne) in self.shares.borne(place).into_iter().enumerate() {
                if let Some((mover, factor)) = borne.filter(|(mover, _)| chosen(*mover)) {
                    let network = self.network;
                    let parts = [network.stiffness.of(place), network.damping.of(place)];
                    self.add_end(mover, (&network.elements[place], end), parts, factor);
                }
            }
        }
    }

    /// The bodies whose root is not below this one \[1/s\].
    pub(super) fn above(&self, root: f64) -> Vec<bool> {
        (0..self.network.movers()).map(|mover| !self.is_below(mover, root)).collect()
    }

    /// These bodies and their neighbours.
    pub(super) fn with_neighbours(&self, chosen: &[bool]) -> Vec<bool> {
        let mut more = chosen.to_vec();
        for element in &self.network.elements {
            if let [Some(a), Some(b)] = element.slots.map(|slot| self.network.mover(slot)) {
                more[a] |= chosen[b];
                more[b] |= chosen[a];
            }
        }
        more
    }

    /// The network of these bodies alone, to which all others stand still: what two of them share, and what one shares with
    /// others as often as it bears it, or only once.
    pub(super) fn together(&self, chosen: &[bool], once: bool) -> Network<'_> {
        let borne = |place: usize, end: usize| match self.shares.borne(place)[end] {
            Some((_, factor)) if !once => factor,
            _ => 1.0,
        };
        self.network.part(chosen, borne)
    }

    /// Adds one end of an element, with its springs and dashpots, to the block of its body, which bears this share of them.
    fn add_end(
        &mut self,
        mover: usize,
        (element, end): (&Element, usize),
        [stiffness, damping]: [[f64; 4]; 2],
        share: f64,
    ) {
        let network = self.network;
        let damped = damping != [0.0; 4];
        match mover.checked_sub(network.roots.len()) {
            None => {
                let place = Place::of(element, end, network.roots[mover], share);
                place.add(&mut self.stiffness[mover], stiffness);
                if damped {
                    place.add(&mut self.damping[mover], damping);
                }
            }
            Some(group) => {
                let Some(group) = &network.groups[group] else { return };
                let arm = network.arm(element, end, group).to_array();
                add_group(&mut self.stiffness[mover], element.normal, arm, stiffness, group, share);
                if damped {
                    add_group(&mut self.damping[mover], element.normal, arm, damping, group, share);
                }
            }
        }
    }

    /// D(K) and D(C) of a body.
    fn block(&self, mover: usize) -> Block {
        Block { stiffness: whole(&self.stiffness[mover]), damping: self.damping.get(mover).map(whole) }
    }

    /// Whether the root of a body is below this one: whether μ² − D(K) − μ D(C) is positive definite.
    fn is_below(&self, mover: usize, root: f64) -> bool {
        let square = root * root;
        // No eigenvalue is above the norm of all entries: most bodies need no more.
        let damping = self.damping.get(mover).unwrap_or(&EMPTY);
        norm_squared(&self.stiffness[mover], damping, root) < square * square
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

    /// The largest root of these bodies that is above `floor`, from the safe side, and the body that has it.
    pub(super) fn largest(&self, movers: impl Iterator<Item = usize>, floor: f64) -> (f64, Option<usize>) {
        let (mut most, mut at) = (floor, None);
        for mover in movers {
            let is_empty =
                || self.stiffness[mover] == EMPTY && self.damping.get(mover).is_none_or(|block| *block == EMPTY);
            let is_passed = if most > 0.0 { self.is_below(mover, most) } else { is_empty() };
            if is_passed {
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
        (most, at)
    }
}

/// D(K) \[1/s²\] and, where anything is damped, D(C) \[1/s\] of a body.
struct Block {
    /// D(K).
    stiffness: Matrix6<f64>,
    /// D(C).
    damping: Option<Matrix6<f64>>,
}

impl Block {
    /// D(K) + μ D(C).
    #[inline(always)]
    fn combined(&self, root: f64) -> Matrix6<f64> {
        self.damping.map_or(self.stiffness, |damping| self.stiffness + damping * root)
    }

    /// The root of one motion.
    #[inline(always)]
    fn root_of_motion(&self, motion: &Vector6<f64>) -> f64 {
        let form = |block: &Matrix6<f64>| (block * motion).dot(motion);
        let (k, c) = (form(&self.stiffness), self.damping.as_ref().map_or(0.0, form));
        0.5 * (c + (c * c + 4.0 * k).max(0.0).sqrt())
    }
}
