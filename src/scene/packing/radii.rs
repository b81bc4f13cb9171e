//! Radii of the spheres of a packing, one after the other.

use super::generator::uniform;
use super::keys::{PackingTable, Radii};
use crate::base::document::Mistake;
use crate::scene::sizes::Sizes;
use rand_chacha::ChaCha8Rng;

/// Part of 1 by which shares of the number go on: (√5 − 1)/2, with which any first few of them are spread most evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// How many radii a mean is taken of.
const SAMPLES: u32 = 1000;

/// Radii of a packing.
pub(super) struct Draw {
    /// How they are distributed.
    sizes: Sizes,
    /// The share of the number that the last had, where shares go on evenly; none where each is a random one.
    share: Option<f64>,
}

impl Draw {
    /// Radii as they are written; otherwise the key that is wrong.
    pub(super) fn of(table: &PackingTable, random: &mut ChaCha8Rng) -> Result<Self, (&'static str, Mistake)> {
        let (found, expected) = match (table.radius, &table.sizes) {
            (Some(Radii(bounds)), None) => return Ok(Self { sizes: Sizes::Uniform(bounds), share: None }),
            (None, Some(keys)) if keys.clumps().is_empty() => {
                let sizes = keys.sizes().map_err(|mistake| ("packing.sizes", mistake))?;
                return Ok(Self { sizes, share: Some(uniform(random)) });
            }
            (None, Some(_)) => {
                let expected = "clump = \"..\" beside packing: all of a set are clumps of one shape".to_owned();
                return Err(("packing.sizes", Mistake::Unexpected { found: "clump".to_owned(), expected }));
            }
            (Some(_), Some(_)) => ("both", "one of radius and sizes"),
            (None, None) => ("neither", "one of radius and sizes"),
        };
        Err(("packing", Mistake::Unexpected { found: found.to_owned(), expected: expected.to_owned() }))
    }

    /// The next radius \[m\].
    pub(super) fn next(&mut self, random: &mut ChaCha8Rng) -> f64 {
        let share = match &mut self.share {
            Some(share) => {
                *share = (*share + GOLDEN).fract();
                *share
            }
            None => uniform(random),
        };
        self.sizes.at(share)
    }

    /// Mean of what a function of the radius says, about.
    pub(super) fn mean(&self, of: impl Fn(f64) -> f64) -> f64 {
        let shares = (0..SAMPLES).map(|sample| (f64::from(sample) + 0.5) / f64::from(SAMPLES));
        shares.map(|share| of(self.sizes.at(share))).sum::<f64>() / f64::from(SAMPLES)
    }

    /// Least radius \[m\].
    pub(super) fn least(&self) -> f64 {
        self.sizes.bounds()[0]
    }

    /// The key that says them.
    pub(super) fn key(&self) -> &'static str {
        if self.share.is_some() { "packing.sizes" } else { "packing.radius" }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::packing::generator::generator;
    use crate::scene::packing::packing;

    /// The packing that is written so.
    fn read(text: &str) -> PackingTable {
        toml::from_str(text).unwrap()
    }

    #[test]
    fn a_few_hundred_spheres_have_the_shares_of_mass_of_a_sieve_curve() {
        let text = "box = [[0, 0, 0], [1, 1, 1]]\ncount = 400\nsizes.sieve = { openings = [0.04, 0.06, 0.12], passing = [0, 0.4, 1] }";
        let spheres = packing(&read(text), None, (1, "a"), &mut |_| {}).unwrap();
        assert_eq!(spheres.len(), 400);
        let mass = |most: f64| spheres.iter().filter(|(_, radius)| *radius < most).map(|(_, r)| r * r * r).sum::<f64>();
        // Of 400 spheres the largest has 1 % of the mass; the next few decide how far the sum is off.
        assert!((mass(0.03) / mass(1.0) - 0.4).abs() < 0.02, "{}", mass(0.03) / mass(1.0));
        assert!(spheres.iter().all(|(_, radius)| (0.02..=0.06).contains(radius)));
    }

    #[test]
    fn a_dense_packing_has_the_shares_of_its_classes() {
        let text =
            "box = [[0, 0, 0], [1, 1, 1]]\nsolid_fraction = 0.5\nsizes = { radius = [0.05, 0.1], by_mass = [1, 1] }";
        let spheres = packing(&read(text), None, (1, "a"), &mut |_| {}).unwrap();
        let large = spheres.iter().filter(|(_, radius)| *radius == 0.1).count();
        // Half of the mass is 0.25 of the volume: 0.25 / (4/3 π 0.1³) = 59.7 spheres.
        assert!((57..=62).contains(&large), "{large}");
    }

    #[test]
    fn one_radius_in_sizes_is_that_of_all() {
        let text = "box = [[0, 0, 0], [1, 1, 1]]\ncount = 10\nsizes.radius = 0.05";
        let mut random = generator(1, "a");
        let mut draw = Draw::of(&read(text), &mut random).unwrap();
        assert_eq!([draw.next(&mut random), draw.next(&mut random)], [0.05; 2]);
    }
}
