//! Spheres that fill a region as densely as asked for, none overlapping another.
//!
//! They begin at random places and are pushed apart, pair after pair. Where they lock before none overlaps, they are
//! shaken, at first strongly and then less and less, and pushed again: what has locked finds denser order, first at the
//! walls. Kin of this are the methods of Jodrey and Tory (Phys. Rev. A 32, 1985, 2347) and of Mościński and Bargieł
//! (Mol. Simul. 3, 1989, 201); the shaking is annealing by decreasing amplitude.

use super::radii::Draw;
use super::region::Region;
use super::relaxation::{Crowd, MARGIN, Overlaps};
use super::{MOST, Sphere};
use crate::base::document::Mistake;
use crate::scene::Particle;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// No packing of equal spheres is denser than π/√18; a search for more would only take long to fail.
const DENSEST: f64 = 0.74;
/// How often the spheres are shaken in each attempt; the slower shaking ends, the denser they lie.
const ATTEMPTS: [usize; 5] = [500, 2000, 4000, 16_000, 64_000];
/// Attempts from this number of shakes on follow only where the one before came near: half a minute of work in vain.
const LONG: usize = 16_000;
/// Mean overlap over diameter, where the spheres lock, that longer shaking overcomes now and then.
const NEAR: f64 = 0.01;
/// Spheres times shakes of one attempt at most, a few minutes of work.
const EFFORT: usize = 250_000_000;
/// Mean overlap over diameter, where the spheres lock first, that shaking does not overcome.
const HOPELESS: f64 = 0.08;

/// Spheres that fill this share of the region; otherwise the key that is wrong.
pub(super) fn dense(
    region: &Region,
    solid_fraction: f64,
    radii: &mut Draw,
    random: &mut ChaCha8Rng,
    tell: &mut dyn FnMut(usize, f64),
) -> Result<Vec<Sphere>, (&'static str, Mistake)> {
    if !(solid_fraction > 0.0 && solid_fraction <= DENSEST) {
        let (found, expected) = (format!("{solid_fraction:?}"), format!("a number above 0 and at most {DENSEST}"));
        return Err(("packing.solid_fraction", Mistake::Unexpected { found, expected }));
    }
    let (key, long) = (radii.key(), region.size().into_iter().fold(0.0, f64::max));
    // Wherever the region lies, an end of it is so far away; drawing and placing millions of spheres first would take minutes.
    if long > 2.0 * Particle::farthest(radii.least()) {
        let found = format!("a region {long:?} m long, whose ends are so far away that numbers are too coarse");
        let expected = format!("a region of at most {:.1e} m for this radius", 2.0 * Particle::farthest(radii.least()));
        return Err((key, Mistake::Unexpected { found, expected }));
    }
    let radii = drawn(region.volume() * solid_fraction, radii, random)?;
    let width = region.width();
    let largest = radii.iter().copied().fold(0.0, f64::max);
    if 2.0 * largest * (1.0 + MARGIN) > width {
        let (found, expected) = (format!("a region {width:?} m wide"), "room for the largest sphere".to_owned());
        return Err((key, Mistake::Unexpected { found, expected }));
    }
    let mut crowd = Crowd::scattered(region, &radii, random, tell);
    parted(&mut crowd, radii.len(), random).map_err(|left| {
        let what = format!(
            "spheres that fill {solid_fraction:?} of this region do not come apart: they still overlap by up to {:.1} radii",
            left.largest
        );
        let expected = "take less: random packings reach 0.55 to 0.62, and less in a region of few diameters".to_owned();
        ("packing.solid_fraction", Mistake::InvalidCombination { what, expected })
    })?;
    Ok(crowd.places().zip(radii).map(|(place, radius)| (region.in_scene(place), radius)).collect())
}

/// Brings the spheres apart; otherwise the overlaps that are left.
fn parted(crowd: &mut Crowd, count: usize, random: &mut ChaCha8Rng) -> Result<(), Overlaps> {
    let mut left = match crowd.spread() {
        Ok(()) => return Ok(()),
        Err(left) => left,
    };
    if left.mean() > HOPELESS {
        return Err(left);
    }
    for shakes in ATTEMPTS.into_iter().filter(|shakes| count.saturating_mul(*shakes) <= EFFORT) {
        if shakes >= LONG && left.mean() > NEAR {
            break;
        }
        crowd.shake(shakes, random);
        match crowd.spread() {
            Ok(()) => return Ok(()),
            Err(still) => left = still,
        }
    }
    Err(left)
}

/// Radii whose volumes come nearest to this sum.
fn drawn(volume: f64, draw: &mut Draw, random: &mut ChaCha8Rng) -> Result<Vec<f64>, (&'static str, Mistake)> {
    let of = |radius: f64| 4.0 / 3.0 * PI * radius * radius * radius;
    let (least, key) = (draw.least(), draw.key());
    if volume > MOST as f64 * draw.mean(of) {
        let (found, expected) = (format!("{least:?}"), format!("radii of which at most {MOST} fit"));
        return Err((key, Mistake::Unexpected { found, expected }));
    }
    let (mut radii, mut sum) = (Vec::new(), 0.0);
    loop {
        let radius = draw.next(random);
        if sum + 0.5 * of(radius) > volume {
            break;
        }
        sum += of(radius);
        radii.push(radius);
    }
    if radii.is_empty() {
        let (found, expected) = (format!("{least:?}"), "a radius at which one sphere at least fits".to_owned());
        return Err((key, Mistake::Unexpected { found, expected }));
    }
    Ok(radii)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::quantity::Triple;
    use crate::base::quantity::{Fraction, Positive};
    use crate::scene::packing::keys::{CylinderTable, PackingTable, Radii};
    use crate::scene::packing::packing;
    use crate::scene::packing::relaxation::squared_distance;
    use std::num::NonZeroU32;

    /// An inclined cylinder that is filled so far with spheres of sizes from 1 to 1.66.
    fn core(solid_fraction: f64) -> PackingTable {
        let cylinder = CylinderTable {
            from: Triple([1.0, 2.0, 3.0]),
            to: Triple([3.0, 1.0, 1.0]),
            radius: Positive::new(0.75).unwrap(),
        };
        PackingTable {
            r#box: None,
            cylinder: Some(cylinder),
            count: None,
            solid_fraction: Fraction::new(solid_fraction),
            radius: Some(Radii([0.1, 0.166])),
            sizes: None,
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
        let spheres = packing(&core(0.56), None, (1, "a"), &mut |_| {}).unwrap();
        let volume: f64 = spheres.iter().map(|(_, radius)| 4.0 / 3.0 * PI * radius * radius * radius).sum();
        let fraction = volume / (PI * 0.75 * 0.75 * 3.0);
        assert!((fraction - 0.56).abs() < 0.56 / spheres.len() as f64 * 4.0, "{fraction}");
        assert!(excess(&spheres) < 1e-14, "{}", excess(&spheres));
        assert!(gaps(&spheres).iter().all(|gap| *gap > 0.0));
    }

    #[test]
    fn a_wide_cylinder_is_filled_as_far_as_a_box() {
        let (to, radius) = (Triple([0.0, 0.0, 0.8]), Positive::new(4.0).unwrap());
        let cylinder = CylinderTable { from: Triple([0.0; 3]), to, radius };
        let table = PackingTable { cylinder: Some(cylinder), radius: Some(Radii([0.1, 0.1])), ..core(0.55) };
        let spheres = packing(&table, None, (1, "a"), &mut |_| {}).unwrap();
        assert_eq!(spheres.len(), 5280);
        assert!(gaps(&spheres).iter().all(|gap| *gap > 0.0));
    }

    #[test]
    fn most_spheres_of_a_dense_packing_touch_but_for_the_margin() {
        let spheres = packing(&core(0.57), None, (1, "a"), &mut |_| {}).unwrap();
        let touching = gaps(&spheres).iter().filter(|gap| **gap < 1e-3 * 0.1).count();
        let coordination = 2.0 * touching as f64 / spheres.len() as f64;
        assert!((3.0..6.0).contains(&coordination), "{coordination}");
    }

    #[test]
    fn the_same_seed_and_set_give_the_same_dense_packing_and_others_another() {
        let of = |seed, set| packing(&core(0.5), None, (seed, set), &mut |_| {}).unwrap();
        assert_eq!(of(1, "a"), of(1, "a"));
        assert_ne!(of(1, "a"), of(2, "a"));
        assert_ne!(of(1, "a"), of(1, "b"));
    }

    #[test]
    fn scattered_spheres_stay_inside_a_cylinder() {
        let table = PackingTable { count: NonZeroU32::new(150), solid_fraction: None, ..core(0.5) };
        let spheres = packing(&table, None, (1, "a"), &mut |_| {}).unwrap();
        assert!(excess(&spheres) < 1e-14, "{}", excess(&spheres));
        assert!(gaps(&spheres).iter().all(|gap| *gap > -1e-14));
    }
}
