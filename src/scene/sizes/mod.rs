//! Radii of particles, drawn from a distribution: those of insertions and of packings.

mod keys;
mod lists;
mod normal;

pub(crate) use keys::SizesKeys;
pub(in crate::scene) use lists::Radii;

use normal::CutNormal;

/// How radii are distributed.
#[derive(Clone, Debug, PartialEq)]
pub enum Sizes {
    /// All alike \[m\].
    Fixed(f64),
    /// As likely between two radii \[m\].
    Uniform([f64; 2]),
    /// Normal by number, cut off at two radii.
    Normal {
        /// Mean radius of the whole distribution \[m\].
        mean: f64,
        /// Standard deviation of the whole distribution \[m\].
        deviation: f64,
        /// Least and largest radius \[m\].
        between: [f64; 2],
    },
    /// Log-normal by mass, cut off at two radii.
    LogNormal {
        /// Radius below which half of the mass of the whole distribution is \[m\].
        median: f64,
        /// Factor by which radii one standard deviation above the median are larger, above 1.
        geometric_deviation: f64,
        /// Least and largest radius \[m\].
        between: [f64; 2],
    },
    /// Classes: radius \[m\], and the share of the number up to it.
    Classes(Vec<[f64; 2]>),
    /// A sieve curve: radii \[m\] that pass, and the share of the number up to each.
    Sieve(Vec<[f64; 2]>),
}

impl Sizes {
    /// Least and largest radius \[m\].
    pub fn bounds(&self) -> [f64; 2] {
        match self {
            Self::Fixed(radius) => [*radius; 2],
            Self::Uniform(bounds) => *bounds,
            Self::Normal { between, .. } | Self::LogNormal { between, .. } => *between,
            Self::Classes(points) | Self::Sieve(points) => {
                let radii = points.iter().map(|[radius, _]| *radius);
                [radii.clone().fold(f64::INFINITY, f64::min), radii.fold(0.0, f64::max)]
            }
        }
    }

    /// Whether a radius over `length` \[m\] is this number.
    pub fn hold(&self, over: f64, length: f64) -> bool {
        let [least, most] = self.bounds().map(|radius| radius / length);
        match self {
            Self::Classes(classes) => classes.iter().any(|[known, _]| *known / length == over),
            _ => (least..=most).contains(&over),
        }
    }

    /// A radius \[m\]. `uniform` hands out numbers from 0 to below 1, all equally likely; those that are all alike need none.
    pub fn draw(&self, uniform: &mut dyn FnMut() -> f64) -> f64 {
        match self {
            Self::Fixed(radius) => *radius,
            _ => self.at(uniform()),
        }
    }

    /// The radius \[m\] at this share of the number, from 0 to below 1.
    pub fn at(&self, share: f64) -> f64 {
        let [least, most] = self.bounds();
        match self {
            Self::Fixed(radius) => *radius,
            Self::Uniform([least, most]) => (least + (most - least) * share).min(*most),
            Self::Normal { mean, deviation, between } => {
                let cut = CutNormal::between(between.map(|radius| (radius - mean) / deviation));
                (mean + deviation * cut.place(share)).clamp(least, most)
            }
            Self::LogNormal { median, geometric_deviation, between } => {
                let (deviation, shift) = logarithmic(*geometric_deviation);
                let place = |radius: &f64| libm::log(radius / median) / deviation + shift;
                let cut = CutNormal::between([place(&between[0]), place(&between[1])]);
                (median * libm::exp(deviation * (cut.place(share) - shift))).clamp(least, most)
            }
            Self::Classes(classes) => {
                let class = classes.iter().find(|[_, so_far]| share < *so_far).or(classes.last());
                class.map_or(0.0, |[radius, _]| *radius)
            }
            Self::Sieve(points) => {
                let above = points.iter().position(|[_, so_far]| share < *so_far).unwrap_or(points.len() - 1).max(1);
                let [[low, before], [high, after]] = [points[above - 1], points[above]];
                // As much mass at each logarithm of the radius, so numbers fall as its third power.
                let (inside, ratio) = ((share - before) / (after - before), low / high);
                let cubed = 1.0 - inside * (1.0 - ratio * ratio * ratio);
                (low / libm::cbrt(cubed)).clamp(low, high)
            }
        }
    }
}

/// Standard deviation of the logarithm, and by how many of them the distribution by number lies below that by mass.
///
/// T. Hatch, S. P. Choate, J. Franklin Inst. 207, 1929, 369: ln m₃ = ln m₀ + 3 σ².
fn logarithmic(geometric_deviation: f64) -> (f64, f64) {
    let deviation = libm::log(geometric_deviation);
    (deviation, 3.0 * deviation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::document::Mistake;

    /// What a text says.
    fn read(text: &str) -> Result<Sizes, Mistake> {
        toml::from_str::<SizesKeys>(text).unwrap().sizes()
    }

    /// Draws so many radii with numbers that fill 0 to 1 evenly.
    fn draws(sizes: &Sizes, count: usize) -> Vec<f64> {
        let (mut next, golden) = (0.0_f64, 0.618_033_988_749_894_9);
        let mut uniform = || {
            next = (next + golden).fract();
            next
        };
        (0..count).map(|_| sizes.at(uniform())).collect()
    }

    #[test]
    fn classes_by_mass_have_the_shares_of_mass() {
        let sizes = read("radius = [0.001, 0.002, 0.004]\nby_mass = [1, 2, 1]").unwrap();
        let radii = draws(&sizes, 200_000);
        let mass = |radius: f64| radii.iter().filter(|drawn| **drawn == radius).count() as f64 * radius.powi(3);
        let all: f64 = radii.iter().map(|radius| radius.powi(3)).sum();
        for (radius, share) in [(0.001, 0.25), (0.002, 0.5), (0.004, 0.25)] {
            assert!((mass(radius) / all - share).abs() < 0.01, "{radius}: {}", mass(radius) / all);
        }
        assert_eq!(sizes.bounds(), [0.001, 0.004]);
    }

    #[test]
    fn a_normal_distribution_is_cut_off_and_keeps_its_mean_where_the_cut_is_even() {
        let sizes = read("normal = { mean = 2.0, deviation = 0.5, between = [1.0, 3.0] }").unwrap();
        let count = 100_000;
        let radii = draws(&sizes, count);
        assert!(radii.iter().all(|radius| (1.0..=3.0).contains(radius)));
        let mean = radii.iter().sum::<f64>() / count as f64;
        let variance = radii.iter().map(|radius| (radius - mean).powi(2)).sum::<f64>() / count as f64;
        assert!((mean - 2.0).abs() < 0.01, "{mean}");
        // Of a normal distribution cut off at two deviations: σ² (1 − 4 φ(2)/(2 Φ(2) − 1)).
        assert!((variance / 0.25 - 0.7737).abs() < 0.01, "{variance}");
    }

    #[test]
    fn uniform_radii_lie_between_their_bounds() {
        let radii = draws(&read("uniform = [0.5, 1.5]").unwrap(), 10_000);
        let mean = radii.iter().sum::<f64>() / 10_000.0;
        assert!(radii.iter().all(|radius| (0.5..=1.5).contains(radius)) && (mean - 1.0).abs() < 1e-3);
    }

    /// Shares of the mass of so many evenly drawn radii up to each of some.
    fn passing(sizes: &Sizes, radii: &[f64]) -> Vec<f64> {
        let drawn = draws(sizes, 200_000);
        let mass =
            |up_to: f64| drawn.iter().filter(|radius| **radius < up_to).map(|radius| radius.powi(3)).sum::<f64>();
        radii.iter().map(|radius| mass(*radius) / mass(f64::INFINITY)).collect()
    }

    #[test]
    fn a_sieve_lets_as_much_mass_pass_as_its_curve_says() {
        let sizes = read("sieve = { openings = [0.002, 0.004, 0.016], passing = [0.0, 0.25, 1.0] }").unwrap();
        assert_eq!(sizes.bounds(), [0.001, 0.008]);
        // Half way on the logarithmic axis from 0.002 m to 0.004 m, and from 0.004 m to 0.016 m.
        let found = passing(&sizes, &[0.001 * 2.0_f64.sqrt(), 0.002, 0.004]);
        for (found, wanted) in found.iter().zip([0.125, 0.25, 0.625]) {
            assert!((found - wanted).abs() < 0.003, "{found} {wanted}");
        }
    }

    #[test]
    fn half_of_the_mass_of_a_log_normal_distribution_lies_below_its_median() {
        let text = "log_normal = { median = 0.002, geometric_deviation = 1.5, between = [0.0005, 0.008] }";
        // Φ(−1), Φ(0), Φ(1); the cut takes Φ(−3.4) = 0.03 % at each end.
        let found = passing(&read(text).unwrap(), &[0.002 / 1.5, 0.002, 0.003]);
        for (found, wanted) in found.iter().zip([0.1587, 0.5, 0.8413]) {
            assert!((found - wanted).abs() < 0.003, "{found} {wanted}");
        }
    }

    #[test]
    fn a_length_twice_as_large_gives_radii_twice_as_large_to_the_bit() {
        for [text, twice] in [
            [
                "sieve = { openings = [0.1, 0.3], passing = [0, 1] }",
                "sieve = { openings = [0.2, 0.6], passing = [0, 1] }",
            ],
            [
                "log_normal = { median = 0.1, geometric_deviation = 2, between = [0.05, 0.3] }",
                "log_normal = { median = 0.2, geometric_deviation = 2, between = [0.1, 0.6] }",
            ],
        ] {
            let [one, other] = [text, twice].map(|text| read(text).unwrap());
            for share in [0.0, 0.1, 0.5, 0.9, 0.999] {
                assert_eq!((2.0 * one.at(share)).to_bits(), other.at(share).to_bits(), "{text} {share}");
            }
        }
    }

    #[test]
    fn wrong_sizes_are_refused() {
        for text in [
            "radius = [1.0, 2.0]",
            "radius = [1.0, 2.0]\nby_mass = [1.0]",
            "uniform = [1.0, 2.0]\nby_mass = [1.0]",
            "normal = { mean = 1.0, deviation = 0.1, between = [2.0, 3.0] }",
            "radius = 1.0\nuniform = [1.0, 2.0]",
            "sieve = { openings = [1.0, 2.0], passing = [0.0, 0.9] }",
            "sieve = { openings = [1.0, 2.0], passing = [0.1, 1.0] }",
            "sieve = { openings = [2.0, 1.0], passing = [0.0, 1.0] }",
            "sieve = { openings = [1.0, 2.0, 3.0], passing = [0.0, 1.0] }",
            "sieve = { openings = [1.0], passing = [1.0] }",
            "log_normal = { median = 1.0, geometric_deviation = 1.0, between = [0.5, 2.0] }",
            "log_normal = { median = 1.0, geometric_deviation = 1.1, between = [2.0, 3.0] }",
            "",
        ] {
            assert!(toml::from_str::<SizesKeys>(text).is_err() || read(text).is_err(), "{text}");
        }
    }
}
