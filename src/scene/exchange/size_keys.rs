//! `sizes` of an insertion as a scene writes them.

use super::Sizes;
use super::kinds::{InsertedClump, Kind};
use crate::base::document::Mistake;
use crate::base::quantity::{Numbers, Positive};
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// Share of the draws of a normal distribution that must lie between its bounds.
const LEAST_SHARE: f64 = 0.05;

/// `sizes = { .. }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SizesKeys {
    /// Name of the clump that comes, or names of classes; absent: spheres.
    clump: Option<Names>,
    /// Radius, or radii of classes \[m\].
    radius: Option<Radii>,
    /// Shares of the number, class by class.
    by_number: Option<Shares>,
    /// Shares of the mass, class by class.
    by_mass: Option<Shares>,
    /// Least and largest radius, all between equally likely \[m\].
    uniform: Option<Bounds>,
    /// A normal distribution by number.
    normal: Option<NormalKeys>,
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

/// One name or several.
#[derive(Clone, Debug)]
struct Names(Vec<String>);

impl<'de> Deserialize<'de> for Names {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a word or a list.
        struct OneOrMore;
        /// What is expected.
        const EXPECTED: &str = "the name of a clump, or a list of such names";
        impl<'de> Visitor<'de> for OneOrMore {
            type Value = Names;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(EXPECTED)
            }
            fn visit_str<E: Error>(self, name: &str) -> Result<Names, E> {
                Ok(Names(vec![name.to_owned()]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Names, A::Error> {
                let mut names = Vec::new();
                while let Some(name) = list.next_element()? {
                    names.push(name);
                }
                if names.is_empty() {
                    return Err(A::Error::custom(format!("expected {EXPECTED}, found []")));
                }
                Ok(Names(names))
            }
        }
        deserializer.deserialize_any(OneOrMore)
    }
}

/// One radius or several \[m\].
#[derive(Clone, Debug)]
struct Radii(Vec<f64>);

impl<'de> Deserialize<'de> for Radii {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Takes a number or a list.
        struct OneOrMore;
        /// What is expected.
        const EXPECTED: &str = "a number above 0, or a list of such numbers";
        impl<'de> Visitor<'de> for OneOrMore {
            type Value = Radii;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(EXPECTED)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Radii, E> {
                let refused = || E::custom(format!("expected {EXPECTED}, found {value:?}"));
                Positive::new(value).map(|radius| Radii(vec![radius.get()])).ok_or_else(refused)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Radii, E> {
                self.visit_f64(value as f64)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Radii, A::Error> {
                let radii: Vec<f64> = Numbers.visit_seq(list)?.iter().map(|radius| radius.get()).collect();
                if radii.is_empty() || radii.iter().any(|radius| *radius <= 0.0) {
                    return Err(A::Error::custom(format!("expected {EXPECTED}, found {radii:?}")));
                }
                Ok(Radii(radii))
            }
        }
        deserializer.deserialize_any(OneOrMore)
    }
}

/// Shares of classes, of any sum above 0.
#[derive(Clone, Debug)]
struct Shares(Vec<f64>);

impl<'de> Deserialize<'de> for Shares {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let shares: Vec<f64> = deserializer.deserialize_seq(Numbers)?.iter().map(|share| share.get()).collect();
        let sum: f64 = shares.iter().sum();
        if shares.iter().all(|share| *share >= 0.0) && sum.is_normal() {
            return Ok(Self(shares));
        }
        Err(D::Error::custom(format!("expected shares of 0 or above, not all of them 0, found {shares:?}")))
    }
}

/// Least and largest radius \[m\].
#[derive(Clone, Copy, Debug)]
struct Bounds([f64; 2]);

impl<'de> Deserialize<'de> for Bounds {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let bounds: Vec<f64> = deserializer.deserialize_seq(Numbers)?.iter().map(|radius| radius.get()).collect();
        match bounds[..] {
            [least, most] if least > 0.0 && least <= most => Ok(Self([least, most])),
            _ => Err(D::Error::custom(format!("expected [least, largest] above 0, found {bounds:?}"))),
        }
    }
}

/// A key that is wrong, and why.
type Wrong = (&'static str, Mistake);

impl SizesKeys {
    /// Names of the clumps that come; none where spheres do.
    pub(crate) fn clumps(&self) -> &[String] {
        self.clump.as_ref().map_or(&[], |Names(names)| names)
    }

    /// What comes: spheres of this density \[kg/m³\] or, where clumps are named, these; otherwise the key that is wrong.
    pub(crate) fn kinds(&self, clumps: Vec<InsertedClump>, density: f64) -> Result<Vec<Kind>, Wrong> {
        let kind = |clump, sizes| Kind { clump, density, sizes, up_to: 1.0 };
        let as_written = self.radius.is_none() && self.uniform.is_none() && self.normal.is_none();
        let own = |clump: &InsertedClump| Sizes::Fixed(clump.shape.bounding_radius());
        if clumps.len() > 1 {
            let sizes = match &self.radius {
                Some(Radii(radii)) if radii.len() > 1 && radii.len() != clumps.len() => {
                    let found = format!("{} radii and {} clumps", radii.len(), clumps.len());
                    let expected = "a radius for all, or for each clump".to_owned();
                    return Err(("sizes", Mistake::Unexpected { found, expected }));
                }
                Some(Radii(radii)) => radii.iter().cycle().take(clumps.len()).map(|it| Sizes::Fixed(*it)).collect(),
                None if as_written => clumps.iter().map(own).collect(),
                None => vec![self.sizes()?; clumps.len()],
            };
            let kinds = clumps.into_iter().zip(sizes).map(|(clump, sizes)| kind(Some(clump), sizes));
            return self.shared(kinds.collect());
        }
        let Some(clump) = clumps.into_iter().next() else { return Ok(vec![kind(None, self.sizes()?)]) };
        let shared = self.by_number.is_some() || self.by_mass.is_some();
        let sizes = if as_written && !shared { own(&clump) } else { self.sizes()? };
        Ok(vec![kind(Some(clump), sizes)])
    }

    /// Kinds with their shares.
    fn shared(&self, kinds: Vec<Kind>) -> Result<Vec<Kind>, Wrong> {
        // Sizes that all have say nothing of the shares: any radius does.
        let mass = |kind: &Kind| kind.mass(kind.sizes.bounds()[0]);
        let masses: Vec<f64> = kinds.iter().map(mass).collect();
        let shares = self.shares(&masses, ["clump", "clumps"])?;
        let with_share = kinds.into_iter().zip(shares).filter_map(|(kind, up_to)| Some(Kind { up_to: up_to?, ..kind }));
        Ok(with_share.collect())
    }

    /// Share of the number up to each class, of one with this mass in any unit; none for those without a share.
    fn shares(&self, masses: &[f64], [one, all]: [&str; 2]) -> Result<Vec<Option<f64>>, Wrong> {
        let (shares, by_mass) = match (&self.by_number, &self.by_mass) {
            (Some(Shares(shares)), None) => (shares, false),
            (None, Some(Shares(shares))) => (shares, true),
            (None, None) => {
                let expected = format!("by_number or by_mass = [..] gives the shares of the {all}");
                return Err(("sizes", Mistake::Missing { expected }));
            }
            (Some(_), Some(_)) => {
                let (found, expected) = ("both".to_owned(), "one of by_number and by_mass".to_owned());
                return Err(("sizes", Mistake::Unexpected { found, expected }));
            }
        };
        if shares.len() != masses.len() {
            let found = format!("{} {all} and {} shares", masses.len(), shares.len());
            return Err(("sizes", Mistake::Unexpected { found, expected: format!("a share for each {one}") }));
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

    /// The sizes; otherwise the key that is wrong, below `sizes`.
    pub(super) fn sizes(&self) -> Result<Sizes, Wrong> {
        let one = "radius, uniform or normal";
        let chosen = [self.radius.is_some(), self.uniform.is_some(), self.normal.is_some()];
        match chosen.iter().filter(|chosen| **chosen).count() {
            1 => {}
            0 => return Err(("sizes", Mistake::Missing { expected: format!("one of {one}") })),
            _ => {
                let found = "several".to_owned();
                return Err(("sizes", Mistake::Unexpected { found, expected: format!("one of {one}") }));
            }
        }
        // Shares of several clumps are theirs.
        let shared = self.by_number.is_some() || self.by_mass.is_some();
        if self.radius.is_none() && shared && self.clumps().len() < 2 {
            let found = "shares without classes".to_owned();
            let expected = "radius = [..] beside by_number or by_mass".to_owned();
            return Err(("sizes", Mistake::Unexpected { found, expected }));
        }
        match (&self.radius, self.uniform, self.normal) {
            (Some(Radii(radii)), ..) => self.classes(radii),
            (_, Some(Bounds(bounds)), _) => Ok(Sizes::Uniform(bounds)),
            (_, _, Some(normal)) => normal.sizes(),
            (None, None, None) => Err(("sizes", Mistake::Missing { expected: format!("one of {one}") })),
        }
    }

    /// One radius, or classes with their shares.
    fn classes(&self, radii: &[f64]) -> Result<Sizes, Wrong> {
        if let (None, None, [radius]) = (&self.by_number, &self.by_mass, radii) {
            return Ok(Sizes::Fixed(*radius));
        }
        let masses: Vec<f64> = radii.iter().map(|radius| radius.powi(3)).collect();
        let shares = self.shares(&masses, ["radius", "radii"])?;
        Ok(Sizes::Classes(radii.iter().zip(shares).filter_map(|(radius, up_to)| Some([*radius, up_to?])).collect()))
    }
}

impl NormalKeys {
    /// The sizes; otherwise what is wrong.
    fn sizes(&self) -> Result<Sizes, (&'static str, Mistake)> {
        let (mean, deviation, Bounds(between)) = (self.mean.get(), self.deviation.get(), self.between);
        let below = |radius: f64| 0.5 * libm::erfc((mean - radius) / (deviation * std::f64::consts::SQRT_2));
        let share = below(between[1]) - below(between[0]);
        if share < LEAST_SHARE {
            let found = format!("{:.1} % between {between:?}", 100.0 * share);
            return Err((
                "sizes.normal",
                Mistake::Unexpected {
                    found,
                    expected: "at least 5 % of the normal distribution between the bounds".to_owned(),
                },
            ));
        }
        Ok(Sizes::Normal { mean, deviation, between })
    }
}
