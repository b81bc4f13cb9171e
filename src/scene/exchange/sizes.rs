//! Radii of particles that come.

/// How often a normal distribution is asked for a radius between its bounds before the mean is taken.
const MOST_DRAWS: usize = 1000;

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
    /// Classes: radius \[m\], and the share of the number up to it.
    Classes(Vec<[f64; 2]>),
}

impl Sizes {
    /// Least and largest radius \[m\].
    pub fn bounds(&self) -> [f64; 2] {
        match self {
            Self::Fixed(radius) => [*radius; 2],
            Self::Uniform(bounds) => *bounds,
            Self::Normal { between, .. } => *between,
            Self::Classes(classes) => {
                let radii = classes.iter().map(|[radius, _]| *radius);
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

    /// A radius \[m\]. `uniform` hands out numbers from 0 to below 1, all equally likely.
    pub fn draw(&self, uniform: &mut dyn FnMut() -> f64) -> f64 {
        match self {
            Self::Fixed(radius) => *radius,
            Self::Uniform([least, most]) => (least + (most - least) * uniform()).min(*most),
            Self::Normal { mean, deviation, between: [least, most] } => {
                for _ in 0..MOST_DRAWS {
                    let radius = mean + deviation * normal(uniform);
                    if (*least..=*most).contains(&radius) {
                        return radius;
                    }
                }
                mean.clamp(*least, *most)
            }
            Self::Classes(classes) => {
                let share = uniform();
                let class = classes.iter().find(|[_, so_far]| share < *so_far).or(classes.last());
                class.map_or(0.0, |[radius, _]| *radius)
            }
        }
    }
}

/// A number of the normal distribution of mean 0 and deviation 1 (Box and Muller).
fn normal(uniform: &mut dyn FnMut() -> f64) -> f64 {
    let (one, other) = (1.0 - uniform(), uniform());
    libm::sqrt(-2.0 * libm::log(one)) * libm::cos(2.0 * std::f64::consts::PI * other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::document::Mistake;
    use crate::scene::exchange::size_keys::SizesKeys;

    /// What a text says.
    fn read(text: &str) -> Result<Sizes, (&'static str, Mistake)> {
        toml::from_str::<SizesKeys>(text).unwrap().sizes()
    }

    /// Draws so many radii with numbers that fill 0 to 1 evenly.
    fn draws(sizes: &Sizes, count: usize) -> Vec<f64> {
        let (mut next, golden) = (0.0_f64, 0.618_033_988_749_894_9);
        let mut uniform = || {
            next = (next + golden).fract();
            next
        };
        (0..count).map(|_| sizes.draw(&mut uniform)).collect()
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
        let (mut seed, count) = (1_u64, 100_000);
        let mut uniform = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let radii: Vec<f64> = (0..count).map(|_| sizes.draw(&mut uniform)).collect();
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

    #[test]
    fn wrong_sizes_are_refused() {
        for text in [
            "radius = [1.0, 2.0]",
            "radius = [1.0, 2.0]\nby_mass = [1.0]",
            "uniform = [1.0, 2.0]\nby_mass = [1.0]",
            "normal = { mean = 1.0, deviation = 0.1, between = [2.0, 3.0] }",
            "radius = 1.0\nuniform = [1.0, 2.0]",
            "",
        ] {
            assert!(read(text).is_err(), "{text}");
        }
    }
}
