//! The bound of a network by Lanczos' method: of the whole, for bonds, whose block bounds cannot come near it, since bonds resist
//! shear, bending and torsion with opposite signs; of the few bodies that limit the step, for contacts ([`super::cluster`]).
//!
//! Lanczos' method finds the largest eigenvalue of S(μ) = M^-½ (K + μ C) M^-½ from below. From a start that is uniform on the
//! sphere, after k products the chance that it is off by more than the share ε is at most 1.648 √N e^(−√ε (2k − 1)) for
//! order N (J. Kuczyński & H. Woźniakowski, *SIAM J. Matrix Anal. Appl.* 13 (1992) 1094–1122). The scheme is stable with
//! Δt = 2/μ while λ_max(S(μ)) < μ², so λ ≤ θ/(1 − ε) ≤ μ² certifies it. The start comes from a hash of particle and counter, sums
//! are taken piece by piece: the same bits for any number of threads.

use super::ends::Ends;
use super::network::{Element, Network, UNMOVED};
use super::plain::Plain;
use super::tridiagonal::{all_below, eigenvector, largest_eigenvalue};
use crate::base::lanes::Shared;
use crate::base::threads::{CHUNK, Context};
use nalgebra::Vector6;
use std::f64::consts::PI;

/// Chance that the certified step is above the stable one.
const CHANCE: f64 = 1e-10;

/// ε without and with dashpots: where μ enters S, the step loses ε, else half of it.
const SHARES: [f64; 2] = [0.12, 0.07];

/// A product that adds less than this to the tridiagonal matrix, over its eigenvalue, ends the method: the value is then
/// that of the matrix.
const ENDED: f64 = 1e-9;

/// What rounding may take, with room.
const ROUNDING: f64 = 1e-6;

/// Products for a first guess, and most guesses.
const GUESSES: [usize; 2] = [14, 12];

/// What guesses agree within.
const AGREEMENT: f64 = 3e-3;

/// Most certificates that are tried.
const TRIALS: usize = 40;

/// Part of the root that was tried above which what it certifies is taken; below it that is tried in its turn.
const CLOSE: f64 = 0.98;

/// Part of the certified root above which a root that was certified earlier is kept.
const NEAR: f64 = 0.97;

/// A motion of every body, or of every one that interacts.
type Motions = Vec<[f64; 6]>;

/// The largest root μ = 2/Δt \[1/s\], certified. `guess` is a root certified earlier, or 0; `counter` chooses the start and
/// is moved on.
pub(super) fn largest_root(network: &Network, guess: f64, counter: &mut u64, context: &Context) -> f64 {
    let mut method = Method::of(network, context);
    let share = SHARES[usize::from(network.is_damped())];
    let products = products(method.order(), share, CHANCE);
    if !network.is_damped() {
        return method.certain(0.0, share, products, counter);
    }
    if guess > 0.0 {
        let certain = method.certain(guess, share, products, counter);
        if certain <= guess && certain >= NEAR * guess && certain > 0.0 {
            return guess;
        }
    }
    let mut root = method.guessed(guess, counter) / (1.0 - share);
    let mut best = None;
    for _ in 0..TRIALS {
        let certain = method.certain(root, share, products, counter);
        if certain <= root {
            // λ_max(S(μ)) grows with μ: what is certain at a larger root is so at this one.
            best = Some(certain);
            if certain >= CLOSE * root {
                break;
            }
            root = certain;
        } else if best.is_some() {
            break;
        } else {
            root = (1.01 * root).max(certain);
        }
    }
    best.unwrap_or(root)
}

/// Products after which a value of this order is certain but for the share and this chance.
pub(super) fn products(order: usize, share: f64, chance: f64) -> usize {
    let needed = libm::log(1.648 * (order.max(1) as f64).sqrt() / chance) / share.sqrt();
    ((needed + 1.0) / 2.0).ceil() as usize
}

/// What products need.
pub(super) struct Method<'a> {
    /// The network.
    network: &'a Network<'a>,
    /// The threads.
    context: &'a Context<'a>,
    /// Bodies that interact: their places in the network. Motions are theirs alone, in this order.
    movers: Vec<u32>,
    /// Where the bodies at the ends of each element stand among them; [`UNMOVED`] for what does not move.
    ends_of: Vec<[u32; 2]>,
    /// The ends of elements, body by body.
    ends: Ends,
    /// Force and couple of each element.
    loads: Motions,
    /// The network once more, in place of all that, where it is one of contacts between particles.
    plain: Option<Plain>,
}

impl<'a> Method<'a> {
    /// For this network.
    pub(super) fn of(network: &'a Network<'a>, context: &'a Context<'a>) -> Self {
        let mut places = vec![UNMOVED; network.movers()];
        let mut ends_of = network.bodies.clone();
        for end in ends_of.iter().flatten().filter(|end| **end != UNMOVED) {
            places[*end as usize] = 0;
        }
        let movers: Vec<u32> = (0..places.len() as u32).filter(|&mover| places[mover as usize] == 0).collect();
        for (place, &mover) in movers.iter().enumerate() {
            places[mover as usize] = place as u32;
        }
        for end in ends_of.iter_mut().flatten().filter(|end| **end != UNMOVED) {
            *end = places[*end as usize];
        }
        let ends = Ends::of(movers.len(), &ends_of);
        let plain = Plain::of(network, &movers, &ends_of);
        let loads = vec![[0.0; 6]; if plain.is_some() { 0 } else { ends_of.len() }];
        Self { network, context, movers, ends_of, ends, loads, plain }
    }

    /// Degrees of freedom.
    pub(super) fn order(&self) -> usize {
        6 * self.movers.len()
    }

    /// What √λ_max(S(μ)) is not above, at this root μ \[1/s\], after so many products that leave the share ε open.
    pub(super) fn certain(&mut self, root: f64, share: f64, products: usize, counter: &mut u64) -> f64 {
        *counter += 1;
        let (value, exact) = self.value(root, products, *counter, f64::INFINITY);
        if exact { (value * (1.0 + ROUNDING)).sqrt() } else { (value / (1.0 - share)).sqrt() }
    }

    /// About the root, from below.
    fn guessed(&mut self, guess: f64, counter: &mut u64) -> f64 {
        *counter += 1;
        let mut value = |root: f64| self.value(root, GUESSES[0], *counter, f64::INFINITY).0.sqrt();
        let root = if guess > 0.0 { guess } else { value(0.0) };
        let found = value(root);
        self.followed([root, found], GUESSES[0], *counter)[0]
    }

    /// About the root, from below, and the slope of √λ_max(S(μ)) there; none where the root is found to be above this one.
    pub(super) fn below(&mut self, root: f64, products: usize, counter: &mut u64) -> Option<[f64; 2]> {
        *counter += 1;
        let found = self.value(root, products, *counter, root * root).0.sqrt();
        let damped = self.network.is_damped();
        (found < root).then(|| if damped { self.followed([root, found], products, *counter) } else { [found, 0.0] })
    }

    /// Where √λ_max(S(μ)) = μ, about, and its slope there, by the secant method, from one μ and what was found there.
    fn followed(&mut self, [mut root, mut found]: [f64; 2], products: usize, counter: u64) -> [f64; 2] {
        let mut slope = 0.0;
        for _ in 0..GUESSES[1] {
            if (found - root).abs() <= AGREEMENT * root {
                return [found, slope];
            }
            let [root_before, found_before] = [root, found];
            root = (found - slope * root) / (1.0 - slope);
            found = self.value(root, products, counter, f64::INFINITY).0.sqrt();
            slope = (found - found_before) / (root - root_before);
            slope = if slope.is_finite() { slope.clamp(0.0, 0.9) } else { 0.0 };
        }
        [root, slope]
    }

    /// The largest eigenvalue of S(μ) as found after so many products, or fewer where it is then above `enough`, and whether
    /// it is that of the whole.
    fn value(&mut self, root: f64, products: usize, counter: u64, enough: f64) -> (f64, bool) {
        let (diagonal, beside, exact) = self.tridiagonal(root, products, counter, enough, None);
        (largest_eigenvalue(&diagonal, &beside), exact)
    }

    /// The tridiagonal matrix of so many products, or of fewer, whose largest eigenvalue is then above `enough`; where coefficients are given, the sum of the basis with them, too.
    fn tridiagonal(
        &mut self,
        root: f64,
        products: usize,
        counter: u64,
        enough: f64,
        mut sum: Option<(&[f64], &mut Motions)>,
    ) -> (Vec<f64>, Vec<f64>, bool) {
        let mut now = self.start(counter);
        let mut before = vec![[0.0; 6]; now.len()];
        let mut image = vec![[0.0; 6]; now.len()];
        let (mut diagonal, mut beside) = (Vec::with_capacity(products), Vec::with_capacity(products));
        let mut last = 0.0;
        for product in 0..products {
            if let Some((coefficients, sum)) = &mut sum {
                for (sum, now) in sum.iter_mut().zip(&now) {
                    for (sum, now) in sum.iter_mut().zip(now) {
                        *sum += coefficients[product] * now;
                    }
                }
            }
            self.multiply(root, &now, &mut image);
            let along = self.dot(&now, &image);
            self.context.update(&mut image, |body, image| {
                for k in 0..6 {
                    image[k] -= along * now[body][k] + last * before[body][k];
                }
            });
            diagonal.push(along);
            let next = self.dot(&image, &image).sqrt();
            let scale = diagonal.iter().copied().fold(0.0, f64::max);
            if next <= ENDED * scale || product + 1 >= self.order() {
                return (diagonal, beside, true);
            }
            if !all_below(&diagonal, &beside, enough) {
                return (diagonal, beside, false);
            }
            if product + 1 < products {
                beside.push(next);
            }
            let per_next = 1.0 / next;
            self.context.update(&mut image, |_, image| *image = image.map(|part| per_next * part));
            last = next;
            // The motion before gives its room to the next image.
            std::mem::swap(&mut before, &mut now);
            std::mem::swap(&mut now, &mut image);
        }
        (diagonal, beside, false)
    }

    /// The motion of every body that belongs to the largest eigenvalue of S(μ), about.
    fn motion(&mut self, root: f64, products: usize, counter: u64) -> Motions {
        let (diagonal, beside, _) = self.tridiagonal(root, products, counter, f64::INFINITY, None);
        let coefficients = eigenvector(&diagonal, &beside, largest_eigenvalue(&diagonal, &beside));
        let mut sum = vec![[0.0; 6]; self.movers.len()];
        self.tridiagonal(root, diagonal.len(), counter, f64::INFINITY, Some((&coefficients, &mut sum)));
        let mut motions = vec![[0.0; 6]; self.network.movers()];
        for (&mover, motion) in self.movers.iter().zip(sum) {
            motions[mover as usize] = motion;
        }
        motions
    }

    /// A start uniform on the sphere of the bodies that interact.
    fn start(&self, counter: u64) -> Motions {
        let mut start = vec![[0.0; 6]; self.movers.len()];
        let state = self.network.state;
        self.context.update(&mut start, |body, motion| {
            let mover = self.movers[body] as usize;
            let name = match mover.checked_sub(self.network.roots.len()) {
                None => u64::from(state.particles.id[mover]),
                Some(group) => (1 << 32) + group as u64,
            };
            *motion = normal_numbers(name, counter);
        });
        let length = self.dot(&start, &start).sqrt();
        if length > 0.0 {
            self.context.update(&mut start, |_, motion| *motion = motion.map(|part| part / length));
        }
        start
    }

    /// S(μ) of a motion.
    fn multiply(&mut self, root: f64, motion: &Motions, image: &mut Motions) {
        let (network, context) = (self.network, self.context);
        if let Some(plain) = &mut self.plain {
            return plain.multiply(root, (motion, image), &self.ends, context);
        }
        let (movers, ends_of) = (&self.movers, &self.ends_of);
        let moved = |place: usize, end: usize| {
            let body = ends_of[place][end];
            let here = || {
                moved(network, &network.elements[place], end, movers[body as usize] as usize, &motion[body as usize])
            };
            if body == UNMOVED { [[0.0; 3]; 2] } else { here() }
        };
        let loads = Shared::new(&mut self.loads);
        context.each(network.elements.len().div_ceil(CHUNK), |piece| {
            let (from, to) = (piece * CHUNK, ((piece + 1) * CHUNK).min(network.elements.len()));
            // SAFETY: pieces do not overlap.
            let loads = unsafe { loads.part(from, to) };
            for (load, place) in loads.iter_mut().zip(from..to) {
                *load = load_of(network, place, root, [moved(place, 0), moved(place, 1)]);
            }
        });
        let (ends, loads) = (&self.ends, &self.loads);
        context.update(image, |body, image| {
            let (mover, mut sum) = (movers[body] as usize, [0.0; 6]);
            for (place, end) in ends.each_of(body) {
                add_load(network, mover, place, end, loads, &mut sum);
            }
            *image = scaled_back(network, mover, &sum);
        });
    }

    /// Scalar product, summed piece by piece.
    fn dot(&self, a: &Motions, b: &Motions) -> f64 {
        let sums = self.context.collect(a.len().div_ceil(CHUNK), |piece| {
            let range = piece * CHUNK..((piece + 1) * CHUNK).min(a.len());
            let mut sum = [0.0; 6];
            for (a, b) in a[range.clone()].iter().zip(&b[range]) {
                for k in 0..6 {
                    sum[k] += a[k] * b[k];
                }
            }
            sum.iter().sum::<f64>()
        });
        sums.into_iter().sum()
    }
}

/// Velocity of the point at one end of an element, and angular velocity there, where its body has this scaled motion.
#[inline(always)]
fn moved(network: &Network, element: &Element, end: usize, mover: usize, scaled: &[f64; 6]) -> [[f64; 3]; 2] {
    let (velocity, spin, arm) = match mover.checked_sub(network.roots.len()) {
        None => {
            let [v, w] = network.roots[mover];
            let arm = f64::from(element.arms[end]);
            let normal = element.normal.map(f64::from);
            (
                [v * scaled[0], v * scaled[1], v * scaled[2]],
                [w * scaled[3], w * scaled[4], w * scaled[5]],
                normal.map(|part| arm * part),
            )
        }
        Some(group) => {
            let Some(group) = &network.groups[group] else { return [[0.0; 3]; 2] };
            let [a, b, c, d, e, f] = (group.root * Vector6::from(*scaled)).into();
            ([a, b, c], [d, e, f], network.arm(element, end, group).to_array())
        }
    };
    let by_spin = cross(spin, arm);
    [[velocity[0] + by_spin[0], velocity[1] + by_spin[1], velocity[2] + by_spin[2]], spin]
}

/// Force and couple on the first end of an element whose ends move like this.
#[inline(always)]
fn load_of(network: &Network, place: usize, root: f64, [[u, w], [v, z]]: [[[f64; 3]; 2]; 2]) -> [f64; 6] {
    let element = &network.elements[place];
    let [along, across, twisting, bending] = network.parts(place, root);
    let n = element.normal.map(f64::from);
    let slip = [u[0] - v[0], u[1] - v[1], u[2] - v[2]];
    let turn = [w[0] - z[0], w[1] - z[1], w[2] - z[2]];
    let along = (along - across) * dot(slip, n);
    let twist = (twisting - bending) * dot(turn, n);
    [
        across * slip[0] + along * n[0],
        across * slip[1] + along * n[1],
        across * slip[2] + along * n[2],
        bending * turn[0] + twist * n[0],
        bending * turn[1] + twist * n[1],
        bending * turn[2] + twist * n[2],
    ]
}

/// Adds the load of one end of an element to the sum of its body.
#[inline(always)]
fn add_load(network: &Network, mover: usize, place: usize, end: usize, loads: &Motions, sum: &mut [f64; 6]) {
    let (element, load) = (&network.elements[place], &loads[place]);
    let sign = if end == 0 { 1.0 } else { -1.0 };
    let force = [sign * load[0], sign * load[1], sign * load[2]];
    let arm = match mover.checked_sub(network.roots.len()).and_then(|group| network.groups[group].as_ref()) {
        None => {
            let arm = f64::from(element.arms[end]);
            element.normal.map(|part| arm * f64::from(part))
        }
        Some(group) => network.arm(element, end, group).to_array(),
    };
    let couple = cross(arm, force);
    for k in 0..3 {
        sum[k] += force[k];
        sum[3 + k] += couple[k] + sign * load[3 + k];
    }
}

/// A load on a body in its scaled freedoms.
#[inline(always)]
fn scaled_back(network: &Network, mover: usize, load: &[f64; 6]) -> [f64; 6] {
    match mover.checked_sub(network.roots.len()) {
        None => {
            let [v, w] = network.roots[mover];
            [v * load[0], v * load[1], v * load[2], w * load[3], w * load[4], w * load[5]]
        }
        Some(group) => {
            network.groups[group].as_ref().map_or([0.0; 6], |group| group.root.tr_mul(&Vector6::from(*load)).into())
        }
    }
}

/// Scalar product.
#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
#[inline(always)]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Six numbers of a normal distribution (Box and Muller) that belong to a name and a counter.
fn normal_numbers(name: u64, counter: u64) -> [f64; 6] {
    let mut state = name.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ counter.wrapping_mul(0xD1B5_4A32_D192_ED03);
    let mut uniform = || {
        // One step of SplitMix64 (G. L. Steele, D. Lea & C. H. Flood, OOPSLA 2014).
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^= mixed >> 31;
        ((mixed >> 11) as f64 + 0.5) / 9_007_199_254_740_992.0
    };
    let mut numbers = [0.0; 6];
    for pair in numbers.chunks_exact_mut(2) {
        let (length, angle) = ((-2.0 * libm::log(uniform())).sqrt(), 2.0 * PI * uniform());
        let (sine, cosine) = libm::sincos(angle);
        pair[0] = length * cosine;
        pair[1] = length * sine;
    }
    numbers
}

/// The motion that a network is stiffest against: of its own root, or without dashpots.
pub(super) fn critical_motion(network: &Network, root: f64, counter: u64, context: &Context) -> Motions {
    /// Products after which it stands out.
    const PRODUCTS: usize = 60;
    let at = if network.is_damped() { root } else { 0.0 };
    Method::of(network, context).motion(at, PRODUCTS, counter)
}

/// What an element takes of a motion, part by part: along the normal, across it, twisting, bending.
pub(super) fn shares(network: &Network, place: usize, root: f64, motion: &Motions) -> [f64; 4] {
    let element = &network.elements[place];
    let [[u, w], [v, z]] = [0, 1].map(|end| match network.mover(element.slots[end]) {
        Some(mover) => moved(network, element, end, mover, &motion[mover]),
        None => [[0.0; 3]; 2],
    });
    let n = element.normal.map(f64::from);
    let slip = [u[0] - v[0], u[1] - v[1], u[2] - v[2]];
    let turn = [w[0] - z[0], w[1] - z[1], w[2] - z[2]];
    let parts = network.parts(place, root);
    let (along, twist) = (dot(slip, n), dot(turn, n));
    [
        parts[0] * along * along,
        parts[1] * (dot(slip, slip) - along * along),
        parts[2] * twist * twist,
        parts[3] * (dot(turn, turn) - twist * twist),
    ]
}
