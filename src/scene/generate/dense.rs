//! Spheres that fill a region as densely as asked for, none overlapping another.
//!
//! They begin at random places and are pushed apart, pair after pair, until none overlaps.

use super::packing::uniform;
use super::region::Region;
use super::{MOST, Sphere};
use crate::scene::mistake::Mistake;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// No packing of equal spheres is denser than π/√18; a search for more would only take long to fail.
const DENSEST: f64 = 0.74;
/// How much larger than itself a sphere is while it is pushed: what is left of overlaps in the end is below this.
const MARGIN: f64 = 1e-4;
/// Share of an overlap that one push removes: above 1, as in successive over-relaxation.
const PUSH: f64 = 1.5;
/// Rounds after which the spheres are taken not to fit.
const ROUNDS: usize = 10_000;

/// Spheres on their way apart.
struct Crowd<'a> {
    /// Where they belong.
    region: &'a Region,
    /// Centres, in coordinates of the region \[m\].
    places: Vec<[f64; 3]>,
    /// Radii with the margin \[m\].
    radii: Vec<f64>,
    /// How much further than touch pairs are listed \[m\].
    skin: f64,
    /// Near pairs.
    pairs: Vec<[u32; 2]>,
    /// Centres when the pairs were listed \[m\].
    listed_at: Vec<[f64; 3]>,
}

/// So many spheres that they fill this share of the region; otherwise the key that is wrong.
pub(super) fn dense(
    region: &Region,
    solid_fraction: f64,
    radii: [f64; 2],
    random: &mut ChaCha8Rng,
) -> Result<Vec<Sphere>, (&'static str, Mistake)> {
    if !(solid_fraction > 0.0 && solid_fraction <= DENSEST) {
        let (found, right) = (format!("{solid_fraction:?}"), format!("a number above 0 and at most {DENSEST}"));
        return Err(("packing.solid_fraction", Mistake::Wrong { found, right }));
    }
    let radii = drawn(region.volume() * solid_fraction, radii, random)?;
    let margin = 1.0 + MARGIN;
    let width = region.size().into_iter().fold(f64::INFINITY, f64::min);
    let largest = radii.iter().copied().fold(0.0, f64::max);
    if 2.0 * largest * margin > width {
        let (found, right) = (format!("a region {width:?} m wide"), "room for the largest sphere".to_owned());
        return Err(("packing.radius", Mistake::Wrong { found, right }));
    }
    let skin = 0.3 * radii.iter().copied().fold(largest, f64::min);
    let mut crowd = Crowd {
        region,
        places: Vec::with_capacity(radii.len()),
        radii: radii.iter().map(|radius| radius * margin).collect(),
        skin,
        pairs: Vec::new(),
        listed_at: Vec::new(),
    };
    for radius in &crowd.radii {
        let place = region.size().map(|length| length * uniform(random));
        crowd.places.push(region.nearest_inside(place, *radius));
    }
    crowd.spread().map_err(|overlap| {
        let what =
            format!("spheres that fill {solid_fraction:?} still overlap by {overlap:.1} radii after {ROUNDS} rounds");
        ("packing.solid_fraction", Mistake::Senseless { what, right: "less is right".to_owned() })
    })?;
    Ok(crowd.places.iter().zip(radii).map(|(place, radius)| (region.in_scene(*place), radius)).collect())
}

/// Radii of an even distribution whose volumes come nearest to this sum.
fn drawn(volume: f64, [least, most]: [f64; 2], random: &mut ChaCha8Rng) -> Result<Vec<f64>, (&'static str, Mistake)> {
    let of = |radius: f64| 4.0 / 3.0 * PI * radius * radius * radius;
    if volume > MOST as f64 * of(least) {
        let (found, right) = (format!("{least:?}"), format!("radii with which {MOST} spheres at most find room"));
        return Err(("packing.radius", Mistake::Wrong { found, right }));
    }
    let (mut radii, mut sum) = (Vec::new(), 0.0);
    loop {
        let radius = least + (most - least) * uniform(random);
        if sum + 0.5 * of(radius) > volume {
            break;
        }
        sum += of(radius);
        radii.push(radius);
    }
    if radii.is_empty() {
        let (found, right) = (format!("{least:?}"), "room for a sphere at least".to_owned());
        return Err(("packing.radius", Mistake::Wrong { found, right }));
    }
    Ok(radii)
}

impl Crowd<'_> {
    /// Pushes until no sphere overlaps another, the margin set aside; otherwise the largest overlap that is left.
    fn spread(&mut self) -> Result<(), f64> {
        let mut largest = f64::INFINITY;
        for _ in 0..ROUNDS {
            if self.has_moved_on() {
                self.list();
            }
            largest = self.push();
            if largest <= MARGIN && !self.has_moved_on() && self.largest_overlap() <= MARGIN {
                return Ok(());
            }
        }
        Err(largest)
    }

    /// Whether a pair may have come near that is not listed.
    fn has_moved_on(&self) -> bool {
        let far = 0.25 * self.skin * self.skin;
        self.listed_at.is_empty()
            || self.places.iter().zip(&self.listed_at).any(|(now, then)| squared_distance(now, then) > far)
    }

    /// Lists all near pairs, in an order that depends on the places alone.
    fn list(&mut self) {
        let size = self.region.size();
        let mut width = 2.0 * self.radii.iter().copied().fold(0.0, f64::max) + self.skin;
        // More cells than spheres gain nothing.
        while size.iter().map(|length| length / width).product::<f64>() > 8.0 * self.places.len() as f64 + 64.0 {
            width *= 2.0;
        }
        let counts = size.map(|length| (length / width).floor().max(1.0) as usize);
        let cell = |place: &[f64; 3]| -> [usize; 3] {
            std::array::from_fn(|axis| {
                ((place[axis] / size[axis] * counts[axis] as f64) as usize).min(counts[axis] - 1)
            })
        };
        let around = |middle: usize, axis: usize| middle.saturating_sub(1)..=(middle + 1).min(counts[axis] - 1);
        let mut cells: Vec<Vec<u32>> = vec![Vec::new(); counts.iter().product()];
        self.pairs.clear();
        for (index, place) in self.places.iter().enumerate() {
            let [i, j, k] = cell(place);
            for k in around(k, 2) {
                for j in around(j, 1) {
                    for i in around(i, 0) {
                        for other in &cells[(k * counts[1] + j) * counts[0] + i] {
                            let there = *other as usize;
                            let reach = self.radii[index] + self.radii[there] + self.skin;
                            if squared_distance(place, &self.places[there]) < reach * reach {
                                self.pairs.push([*other, index as u32]);
                            }
                        }
                    }
                }
            }
            cells[(k * counts[1] + j) * counts[0] + i].push(index as u32);
        }
        self.listed_at.clone_from(&self.places);
    }

    /// Overlap of a pair over the smaller radius, and the way from the first to the second with its square.
    fn overlap(&self, [a, b]: [usize; 2]) -> Option<(f64, [f64; 3], f64)> {
        let (from, to) = (self.places[a], self.places[b]);
        let way: [f64; 3] = std::array::from_fn(|axis| to[axis] - from[axis]);
        let squared = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
        let reach = self.radii[a] + self.radii[b];
        (squared < reach * reach).then(|| {
            let distance = squared.sqrt();
            ((reach - distance) / self.radii[a].min(self.radii[b]), way, distance)
        })
    }

    /// Pushes each overlapping pair apart, one after the other; the largest overlap met, over the smaller radius.
    fn push(&mut self) -> f64 {
        let mut largest: f64 = 0.0;
        for pair in 0..self.pairs.len() {
            let pair = self.pairs[pair].map(|index| index as usize);
            let Some((overlap, way, distance)) = self.overlap(pair) else { continue };
            largest = largest.max(overlap);
            let [a, b] = pair;
            let half = 0.5 * PUSH * overlap * self.radii[a].min(self.radii[b]);
            // Two centres at one place part along any direction.
            let push = if distance > 0.0 { way.map(|part| half / distance * part) } else { [half, 0.0, 0.0] };
            for (index, sign) in [(a, -1.0), (b, 1.0)] {
                let place = std::array::from_fn(|axis| self.places[index][axis] + sign * push[axis]);
                self.places[index] = self.region.nearest_inside(place, self.radii[index]);
            }
        }
        largest
    }

    /// The largest overlap now, over the smaller radius.
    fn largest_overlap(&self) -> f64 {
        let overlaps = self.pairs.iter().filter_map(|pair| self.overlap(pair.map(|index| index as usize)));
        overlaps.map(|(overlap, ..)| overlap).fold(0.0, f64::max)
    }
}

/// Of two places \[m²\].
fn squared_distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let way: [f64; 3] = std::array::from_fn(|axis| a[axis] - b[axis]);
    way[0] * way[0] + way[1] * way[1] + way[2] * way[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::{Fraction, Positive};
    use crate::scene::file::{CylinderTable, PackingTable, Radii, Triple};
    use crate::scene::generate::packing;
    use std::num::NonZeroU32;

    /// An inclined cylinder that is filled so far with spheres of sizes from 1 to 1.66.
    fn core(solid_fraction: f64) -> PackingTable {
        let cylinder = CylinderTable {
            from: Triple([1.0, 2.0, 3.0]),
            to: Triple([3.0, 1.0, 1.0]),
            radius: Positive::new(0.75).unwrap(),
        };
        PackingTable {
            corners: None,
            cylinder: Some(cylinder),
            count: None,
            solid_fraction: Fraction::new(solid_fraction),
            radius: Radii([0.1, 0.166]),
        }
    }

    /// Lengths by which neighbours are apart; below 0 where they overlap.
    fn gaps(spheres: &[Sphere]) -> Vec<f64> {
        let mut gaps = Vec::new();
        for (index, (p, r)) in spheres.iter().enumerate() {
            gaps.extend(spheres[..index].iter().map(|(q, s)| squared_distance(p, q).sqrt() - r - s));
        }
        gaps
    }

    /// How far spheres reach out of `core`, at most.
    fn excess(spheres: &[Sphere]) -> f64 {
        let (from, along) = ([1.0, 2.0, 3.0], [2.0 / 3.0, -1.0 / 3.0, -2.0 / 3.0]);
        let beyond = |(place, radius): &Sphere| {
            let way: [f64; 3] = std::array::from_fn(|axis| place[axis] - from[axis]);
            let height: f64 = (0..3).map(|axis| way[axis] * along[axis]).sum();
            let across = squared_distance(&way, &along.map(|part| part * height)).sqrt();
            (radius - height).max(height + radius - 3.0).max(across + radius - 0.75)
        };
        spheres.iter().map(beyond).fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn a_cylinder_is_filled_as_far_as_asked_without_overlap() {
        let spheres = packing(&core(0.56), 1, "a").unwrap();
        let volume: f64 = spheres.iter().map(|(_, radius)| 4.0 / 3.0 * PI * radius * radius * radius).sum();
        let fraction = volume / (PI * 0.75 * 0.75 * 3.0);
        assert!((fraction - 0.56).abs() < 0.56 / spheres.len() as f64 * 4.0, "{fraction}");
        assert!(excess(&spheres) < 1e-14, "{}", excess(&spheres));
        assert!(gaps(&spheres).iter().all(|gap| *gap > 0.0));
    }

    #[test]
    fn most_spheres_of_a_dense_packing_touch_but_for_the_margin() {
        let spheres = packing(&core(0.56), 1, "a").unwrap();
        let touching = gaps(&spheres).iter().filter(|gap| **gap < 1e-3 * 0.1).count();
        let coordination = 2.0 * touching as f64 / spheres.len() as f64;
        assert!((3.0..6.0).contains(&coordination), "{coordination}");
    }

    #[test]
    fn the_same_seed_and_set_give_the_same_dense_packing_and_others_another() {
        let of = |seed, set| packing(&core(0.5), seed, set).unwrap();
        assert_eq!(of(1, "a"), of(1, "a"));
        assert_ne!(of(1, "a"), of(2, "a"));
        assert_ne!(of(1, "a"), of(1, "b"));
    }

    #[test]
    fn scattered_spheres_stay_inside_a_cylinder() {
        let table = PackingTable { count: NonZeroU32::new(150), solid_fraction: None, ..core(0.5) };
        let spheres = packing(&table, 1, "a").unwrap();
        assert!(excess(&spheres) < 1e-14, "{}", excess(&spheres));
        assert!(gaps(&spheres).iter().all(|gap| *gap > -1e-14));
    }
}
