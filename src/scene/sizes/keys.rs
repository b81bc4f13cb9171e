//! `sizes` of an insertion or a packing as a scene writes them.

use super::lists::{Bounds, Names, Radii, Shares};
use super::normal::CutNormal;
use super::{Sizes, logarithmic};
use crate::base::document::Mistake;
use crate::base::quantity::Positive;
use serde::Deserialize;

/// Share of a normal distribution that must lie between its bounds: less is a slip.
const LEAST_SHARE: f64 = 0.05;

/// `sizes = { .. }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SizesKeys {
    /// Name of the clump that comes, or names of classes; absent: spheres.
    pub(in crate::scene) clump: Option<Names>,
    /// Radius, or radii of classes \[m\].
    pub(in crate::scene) radius: Option<Radii>,
    /// Shares of the number, class by class.
    by_number: Option<Shares>,
    /// Shares of the mass, class by class.
    by_mass: Option<Shares>,
    /// Least and largest radius, all between equally likely \[m\].
    uniform: Option<Bounds>,
    /// A normal distribution by number.
    normal: Option<NormalKeys>,
    /// A log-normal distribution by mass.
    log_normal: Option<LogNormalKeys>,
    /// A sieve curve.
    sieve: Option<SieveKeys>,
}

/// `normal = { mean, deviation, between }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct NormalKeys {
    /// Mean radius \[m\].
    mean: Positive,
    /// Standard deviation \[m\].
    deviation: Positive,
    /// Least and largest radius \[m\].
    between: Bounds,
}

/// `log_normal = { median, geometric_deviation, between }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct LogNormalKeys {
    /// Radius below which half of the mass is \[m\].
    median: Positive,
    /// Factor of one standard deviation, above 1.
    geometric_deviation: Positive,
    /// Least and largest radius \[m\].
    between: Bounds,
}

/// `sieve = { openings, passing }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SieveKeys {
    /// Openings of the sieves, diameters that pass, ascending \[m\].
    openings: Radii,
    /// Share of the mass that passes each, rising from 0 to 1.
    passing: Shares,
}

/// What is wrong.
fn unexpected<T>(found: String, expected: &str) -> Result<T, Mistake> {
    Err(Mistake::Unexpected { found, expected: expected.to_owned() })
}

impl SizesKeys {
    /// Names of the clumps that come; none where spheres do.
    pub(crate) fn clumps(&self) -> &[String] {
        self.clump.as_ref().map_or(&[], |Names(names)| names)
    }

    /// Share of the number up to each class, of one with this mass in any unit; none for those without a share.
    pub(in crate::scene) fn shares(&self, masses: &[f64], [one, all]: [&str; 2]) -> Result<Vec<Option<f64>>, Mistake> {
        let (shares, by_mass) = match (&self.by_number, &self.by_mass) {
            (Some(Shares(shares)), None) => (shares, false),
            (None, Some(Shares(shares))) => (shares, true),
            (None, None) => {
                let expected = format!("by_number or by_mass = [..] gives the shares of the {all}");
                return Err(Mistake::Missing { expected });
            }
            (Some(_), Some(_)) => return unexpected("both".to_owned(), "one of by_number and by_mass"),
        };
        if shares.len() != masses.len() {
            let found = format!("{} {all} and {} shares", masses.len(), shares.len());
            return unexpected(found, &format!("a share for each {one}"));
        }
        let number = |(mass, share): (&f64, &f64)| if by_mass { share / mass } else { *share };
        let numbers: Vec<f64> = masses.iter().zip(shares).map(number).collect();
        let sum: f64 = numbers.iter().sum();
        let mut so_far = 0.0;
        let up_to = |number: f64| {
            so_far += number / sum;
            (number > 0.0).then_some(so_far)
        };
        Ok(numbers.into_iter().map(up_to).collect())
    }

    /// Whether shares of classes are written.
    pub(in crate::scene) fn has_shares(&self) -> bool {
        self.by_number.is_some() || self.by_mass.is_some()
    }

    /// Whether a distribution is written: those of clumps are then not as their table has them.
    pub(in crate::scene) fn has_sizes(&self) -> bool {
        self.written().contains(&true)
    }

    /// Which of the ways to say sizes are written.
    fn written(&self) -> [bool; 5] {
        let Self { radius, uniform, normal, log_normal, sieve, .. } = self;
        [radius.is_some(), uniform.is_some(), normal.is_some(), log_normal.is_some(), sieve.is_some()]
    }

    /// The sizes; otherwise what is wrong.
    pub(in crate::scene) fn sizes(&self) -> Result<Sizes, Mistake> {
        let one = "one of radius, uniform, normal, log_normal and sieve";
        if self.written().iter().filter(|written| **written).count() > 1 {
            return unexpected("several".to_owned(), one);
        }
        // Shares of several clumps are theirs.
        if self.radius.is_none() && self.has_sizes() && self.has_shares() && self.clumps().len() < 2 {
            return unexpected("shares without classes".to_owned(), "radius = [..] beside by_number or by_mass");
        }
        match self {
            Self { radius: Some(Radii(radii)), .. } => self.classes(radii),
            Self { uniform: Some(Bounds(bounds)), .. } => Ok(Sizes::Uniform(*bounds)),
            Self { normal: Some(normal), .. } => normal.sizes(),
            Self { log_normal: Some(log_normal), .. } => log_normal.sizes(),
            Self { sieve: Some(sieve), .. } => sieve.sizes(),
            _ => Err(Mistake::Missing { expected: one.to_owned() }),
        }
    }

    /// One radius, or classes with their shares.
    fn classes(&self, radii: &[f64]) -> Result<Sizes, Mistake> {
        if let (None, None, [radius]) = (&self.by_number, &self.by_mass, radii) {
            return Ok(Sizes::Fixed(*radius));
        }
        let masses: Vec<f64> = radii.iter().map(|radius| radius.powi(3)).collect();
        let shares = self.shares(&masses, ["radius", "radii"])?;
        Ok(Sizes::Classes(radii.iter().zip(shares).filter_map(|(radius, up_to)| Some([*radius, up_to?])).collect()))
    }
}

/// Refuses bounds between which there is hardly anything of a normal distribution.
fn enough(cut: CutNormal, between: [f64; 2]) -> Result<(), Mistake> {
    if cut.share() >= LEAST_SHARE {
        return Ok(());
    }
    let found = format!("{:.1} % between {between:?}", 100.0 * cut.share());
    unexpected(found, "at least 5 % of the normal distribution between the bounds")
}

impl NormalKeys {
    /// The sizes; otherwise what is wrong.
    fn sizes(&self) -> Result<Sizes, Mistake> {
        let (mean, deviation, Bounds(between)) = (self.mean.get(), self.deviation.get(), self.between);
        enough(CutNormal::between(between.map(|radius| (radius - mean) / deviation)), between)?;
        Ok(Sizes::Normal { mean, deviation, between })
    }
}

impl LogNormalKeys {
    /// The sizes; otherwise what is wrong.
    fn sizes(&self) -> Result<Sizes, Mistake> {
        let (median, geometric_deviation, Bounds(between)) =
            (self.median.get(), self.geometric_deviation.get(), self.between);
        if geometric_deviation <= 1.0 {
            let found = format!("geometric_deviation {geometric_deviation:?}");
            return unexpected(found, "a number above 1, the factor between the median and one standard deviation");
        }
        let (deviation, _) = logarithmic(geometric_deviation);
        enough(CutNormal::between(between.map(|radius| libm::log(radius / median) / deviation)), between)?;
        Ok(Sizes::LogNormal { median, geometric_deviation, between })
    }
}

impl SieveKeys {
    /// The sizes; otherwise what is wrong.
    fn sizes(&self) -> Result<Sizes, Mistake> {
        let (Radii(openings), Shares(passing)) = (&self.openings, &self.passing);
        if openings.len() != passing.len() {
            let found = format!("{} openings and {} shares that pass", openings.len(), passing.len());
            return unexpected(found, "a share for each opening");
        }
        if !openings.is_sorted_by(|one, next| one < next) {
            return unexpected(format!("openings {openings:?}"), "openings that rise");
        }
        if !passing.is_sorted() || passing.first() != Some(&0.0) || passing.last() != Some(&1.0) {
            let expected = "shares of the mass that rise from 0, below which there is nothing, to 1";
            return unexpected(format!("passing {passing:?}"), expected);
        }
        let (mut so_far, mut points) = (0.0, vec![[0.5 * openings[0], 0.0]]);
        for step in 1..openings.len() {
            let [low, high] = [openings[step - 1], openings[step]].map(|opening| 0.5 * opening);
            // As much mass at each logarithm of the radius: the number of one is ∫ dr/r⁴ = (1/a³ − 1/b³)/3 over the mass ln(b/a).
            let ratio = low / high;
            let number = (1.0 - ratio * ratio * ratio) / libm::log(high / low) / (low / points[0][0]).powi(3);
            so_far += (passing[step] - passing[step - 1]) * number;
            points.push([high, so_far]);
        }
        points.iter_mut().for_each(|point| point[1] /= so_far);
        Ok(Sizes::Sieve(points))
    }
}
