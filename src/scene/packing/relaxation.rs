//! Spheres in a region that are pushed apart, pair after pair, until none overlaps another.

use super::generator::uniform;
use super::region::Region;
use crate::scene::packing::overlaps::for_each_overlap;
use rand_chacha::ChaCha8Rng;

/// Largest overlap over the smaller radius that may be left. Radii carry the same margin, so none is left in truth.
pub(super) const MARGIN: f64 = 1e-4;
/// Share of an overlap that one push removes: above 1, as in successive over-relaxation.
const PUSH: f64 = 1.5;
/// Rounds between two looks at what the pushes have gained.
const WINDOW: usize = 100;
/// Where so much of the sum of overlaps is left after a window, the spheres have locked.
const LOCKED: f64 = 0.9;
/// Displacements along an axis at the beginning and the end of shaking, over the radius.
const SHAKES: [f64; 2] = [0.4, 0.1];
/// Rounds after each displacement.
const ROUNDS_A_SHAKE: usize = 2;

/// The overlaps that a round met.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Overlaps {
    /// The largest, over the smaller radius.
    pub(super) largest: f64,
    /// Their sum \[m\].
    sum: f64,
    /// The sum of the distances at which the same pairs would touch \[m\].
    reach: f64,
}

impl Overlaps {
    /// Mean overlap over the mean distance of centres that touch.
    pub(super) fn mean(&self) -> f64 {
        if self.reach > 0.0 { self.sum / self.reach } else { 0.0 }
    }
}

/// Spheres on their way apart.
pub(super) struct Crowd<'a> {
    /// Where they belong.
    region: &'a Region,
    /// Centre and radius with the margin, in coordinates of the region \[m\].
    spheres: Vec<([f64; 3], f64)>,
    /// How much further than touch pairs are listed \[m\].
    skin: f64,
    /// Near pairs.
    pairs: Vec<[u32; 2]>,
    /// In a cell, how far the images that the pairs are of are displaced, the second from the first \[m\].
    shifts: Vec<[f64; 3]>,
    /// Centres when the pairs were listed \[m\].
    listed_at: Vec<[f64; 3]>,
    /// Rounds so far.
    rounds: usize,
    /// Told the number of rounds and the largest overlap now and then.
    tell: &'a mut dyn FnMut(usize, f64),
}

impl<'a> Crowd<'a> {
    /// Spheres of these radii \[m\] at random places of a region in which each fits.
    pub(super) fn scattered(
        region: &'a Region,
        radii: &[f64],
        random: &mut ChaCha8Rng,
        tell: &'a mut dyn FnMut(usize, f64),
    ) -> Self {
        let wide: Vec<f64> = radii.iter().map(|radius| radius * (1.0 + MARGIN)).collect();
        let spheres = region.scatter(&wide, random);
        let skin = 0.3 * radii.iter().copied().fold(f64::INFINITY, f64::min);
        Self { region, spheres, skin, pairs: Vec::new(), shifts: Vec::new(), listed_at: Vec::new(), rounds: 0, tell }
    }

    /// Centres \[m\].
    pub(super) fn places(&self) -> impl Iterator<Item = [f64; 3]> {
        self.spheres.iter().map(|(place, _)| *place)
    }

    /// Pushes until no sphere overlaps another or the spheres have locked: then the overlaps that are left.
    pub(super) fn spread(&mut self) -> Result<(), Overlaps> {
        let mut before = f64::INFINITY;
        loop {
            let mut left = Overlaps::default();
            for _ in 0..WINDOW {
                left = self.round();
                if left.largest <= MARGIN && !self.has_moved_on() && self.overlaps().largest <= MARGIN {
                    return Ok(());
                }
            }
            if left.sum > LOCKED * before {
                return Err(left);
            }
            before = left.sum;
        }
    }

    /// Displaces every sphere at random so many times, each time less, and pushes in between: what has locked finds
    /// denser order.
    pub(super) fn shake(&mut self, times: usize, random: &mut ChaCha8Rng) {
        for time in 0..times {
            let share = SHAKES[0] + (SHAKES[1] - SHAKES[0]) * (time as f64 / times as f64);
            for (place, radius) in &mut self.spheres {
                let moved = place.map(|part| part + share * *radius * (2.0 * uniform(random) - 1.0));
                *place = self.region.nearest_inside(moved, *radius);
            }
            for _ in 0..ROUNDS_A_SHAKE {
                self.round();
            }
        }
    }

    /// One push of each pair.
    fn round(&mut self) -> Overlaps {
        if self.has_moved_on() {
            self.list();
        }
        let met = self.push();
        self.rounds += 1;
        (self.tell)(self.rounds, met.largest);
        met
    }

    /// Whether a pair may have come near that is not listed.
    fn has_moved_on(&self) -> bool {
        let far = 0.25 * self.skin * self.skin;
        self.listed_at.is_empty()
            || self.spheres.iter().zip(&self.listed_at).any(|((now, _), then)| squared_distance(now, then) > far)
    }

    /// Lists all near pairs, in an order that depends on the places alone.
    fn list(&mut self) {
        let half = 0.5 * self.skin;
        let Self { region, spheres, pairs, shifts, .. } = self;
        spheres.iter_mut().for_each(|(place, _)| *place = region.brought_back(*place));
        let largest = spheres.iter().fold(0.0_f64, |most, (_, radius)| most.max(*radius));
        let mut wide: Vec<([f64; 3], f64)> = spheres.iter().map(|(place, radius)| (*place, radius + half)).collect();
        let (own, mut images) = (wide.len(), Vec::new());
        for index in 0..own {
            let (place, radius) = wide[index];
            region.images(place, radius + largest + half, |shift| {
                images.push((index as u32, shift));
                wide.push(([0, 1, 2].map(|axis| place[axis] + shift[axis]), radius));
            });
        }
        let of = |index: u32| images.get((index as usize).wrapping_sub(own)).copied().unwrap_or((index, [0.0; 3]));
        pairs.clear();
        shifts.clear();
        for_each_overlap(&wide, |a, b, _| {
            let ((i, from), (j, to)) = (of(a), of(b));
            if a.min(b) < own as u32 {
                pairs.push([i, j]);
                if !images.is_empty() {
                    shifts.push([0, 1, 2].map(|axis| to[axis] - from[axis]));
                }
            }
        });
        self.listed_at.clear();
        self.listed_at.extend(self.spheres.iter().map(|(place, _)| *place));
    }

    /// Pushes each overlapping pair apart, one after the other.
    fn push(&mut self) -> Overlaps {
        let mut met = Overlaps::default();
        for (number, pair) in self.pairs.iter().enumerate() {
            let [a, b] = pair.map(|index| index as usize);
            let Some(Overlap { depth, reach, way, distance }) = self.overlap(number) else {
                continue;
            };
            met.note(depth, reach, self.spheres[a].1.min(self.spheres[b].1));
            let half = 0.5 * PUSH * depth;
            // Two centres at one place part along any direction; a diagonal one leads out of corners too.
            let push = if distance > 0.0 { way.map(|part| half / distance * part) } else { [0.6 * half; 3] };
            for (index, sign) in [(a, -1.0), (b, 1.0)] {
                let (place, radius) = self.spheres[index];
                let pushed = std::array::from_fn(|axis| place[axis] + sign * push[axis]);
                self.spheres[index].0 = self.region.nearest_inside(pushed, radius);
            }
        }
        met
    }

    /// The overlaps as the spheres stand.
    fn overlaps(&self) -> Overlaps {
        let mut met = Overlaps::default();
        for (number, pair) in self.pairs.iter().enumerate() {
            let [a, b] = pair.map(|index| self.spheres[index as usize]);
            if let Some(Overlap { depth, reach, .. }) = self.overlap(number) {
                met.note(depth, reach, a.1.min(b.1));
            }
        }
        met
    }

    /// The overlap of a pair, if there is one.
    #[inline]
    fn overlap(&self, number: usize) -> Option<Overlap> {
        let [a, (place, radius)] = self.pairs[number].map(|index| self.spheres[index as usize]);
        let [x, y, z] = self.shifts.get(number).copied().unwrap_or_default();
        overlap(a, ([place[0] + x, place[1] + y, place[2] + z], radius))
    }
}

impl Overlaps {
    /// Counts one, of spheres of which this is the smaller radius \[m\].
    fn note(&mut self, depth: f64, reach: f64, radius: f64) {
        self.largest = self.largest.max(depth / radius);
        self.sum += depth;
        self.reach += reach;
    }
}

/// How two spheres overlap.
struct Overlap {
    /// By how much \[m\].
    depth: f64,
    /// Sum of the radii \[m\].
    reach: f64,
    /// From the first centre to the second \[m\].
    way: [f64; 3],
    /// Its length \[m\].
    distance: f64,
}

/// The overlap of two spheres, if they do.
#[inline]
fn overlap((from, a): ([f64; 3], f64), (to, b): ([f64; 3], f64)) -> Option<Overlap> {
    let way: [f64; 3] = std::array::from_fn(|axis| to[axis] - from[axis]);
    let squared = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
    let reach = a + b;
    (squared < reach * reach).then(|| {
        let distance = squared.sqrt();
        Overlap { depth: reach - distance, reach, way, distance }
    })
}

/// Of two places \[m²\].
pub(super) fn squared_distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let way: [f64; 3] = std::array::from_fn(|axis| a[axis] - b[axis]);
    way[0] * way[0] + way[1] * way[1] + way[2] * way[2]
}
