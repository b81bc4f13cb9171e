//! Clumps as the scene writes them.

use super::ClumpShape;
use super::union::moments;
use crate::base::document::{Forms, Mistake, keys, several_forms};
use crate::base::geometry::Quaternion;
use crate::base::geometry::principal::principal;
use crate::base::number::Vector;
use crate::base::quantity::{Numbers, Positive, Triple};
use crate::scene::file::Inertia;
use serde::Deserialize;
use serde::de::{Error, SeqAccess, Visitor};
use std::f64::consts::TAU;

/// Most spheres that a clump may have.
const MOST_SPHERES: usize = 256;

keys! {
    /// `[clump.<name>]`
    #[derive(Clone, Debug)]
    pub(in crate::scene) struct ClumpKeys {
        /// `[{ position, radius }, ..]` in a frame of its own \[m\]; they may overlap.
        spheres: Option<Vec<SphereKeys>> = "this or `file`",
        /// A file of them with the columns `x`, `y`, `z`, `radius`, or a `.multisphere` of LIGGGHTS (lines x y z radius).
        pub(in crate::scene) file: Option<String> = "this or `spheres`",
        /// Material where the set names none.
        pub(in crate::scene) material: Option<String> = "none",
        /// Density where the set gives none \[kg/m³\].
        pub(in crate::scene) density: Option<Positive> = "that of the material",
        /// Mass at `scale = 1` \[kg\].
        mass: Option<Positive> = "density times the volume of the union",
        /// Inertia about the mass centre \[kg m²\]: three moments, or three rows; with `mass`.
        inertia: Option<Inertia> = "of the union",
        /// Mass centre in its frame \[m\].
        centre: Option<Triple> = "of the union",
    }
}

/// A sphere of a clump.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SphereKeys {
    /// Its centre \[m\].
    position: Triple,
    /// Its radius \[m\].
    radius: Positive,
}

impl ClumpKeys {
    /// The shape, of the spheres that the file of the table has, if it names one; reports what is wrong.
    pub(in crate::scene) fn shape(
        &self,
        name: &str,
        filed: Option<Vec<([f64; 3], f64)>>,
        report: &mut dyn FnMut(&str, Mistake),
    ) -> Option<ClumpShape> {
        let written = |list: &Vec<SphereKeys>| list.iter().map(|it| (it.position.get(), it.radius.get())).collect();
        let spheres: Vec<_> = match (self.spheres.as_ref().map(written), filed) {
            (Some(spheres), None) | (None, Some(spheres)) => spheres,
            (Some(_), Some(_)) => {
                let (found, expected) = ("spheres and file".to_owned(), "one of them".to_owned());
                report("spheres", Mistake::Unexpected { found, expected });
                return None;
            }
            (None, None) => {
                let expected = "spheres = [{ position, radius }, ..] or file = \"..\" says what it is".to_owned();
                report("spheres", Mistake::Missing { expected });
                return None;
            }
        };
        let mut unexpected = |key: &str, found: String, expected: &str| {
            report(key, Mistake::Unexpected { found, expected: expected.to_owned() });
        };
        let count = spheres.len();
        if count == 0 || count > MOST_SPHERES {
            let key = if self.file.is_some() { "file" } else { "spheres" };
            unexpected(key, format!("{count}"), &format!("1 to {MOST_SPHERES} spheres"));
            return None;
        }
        if let (Some(_), None) = (self.inertia, self.mass) {
            report("mass", Mistake::Missing { expected: "an inertia is that of a mass".to_owned() });
            return None;
        }
        if let (Some(_), Some(_)) = (self.density, self.mass) {
            let (what, expected) = ("the clump has a mass".to_owned(), "leave density out".to_owned());
            report("density", Mistake::InvalidCombination { what, expected });
            return None;
        }
        // About one of the spheres, so that nothing is lost far from the origin of the frame.
        let base = spheres[0].0;
        let about: Vec<_> =
            spheres.iter().map(|(place, radius)| ([0, 1, 2].map(|k| place[k] - base[k]), *radius)).collect();
        let (union, error) = moments(&about);
        let of_union = union.first.map(|first| first / union.volume);
        let from_base = self.centre.map_or(of_union, |centre| [0, 1, 2].map(|k| centre.get()[k] - base[k]));
        let centre = self.centre.map_or([0, 1, 2].map(|k| base[k] + of_union[k]), Triple::get);
        // Second moments about the mass centre, over the volume.
        let [xx, yy, zz, xy, xz, yz] = union.second.map(|second| second / union.volume);
        let c = from_base;
        let (f, s) = (of_union, [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
        let second = |i: usize, j: usize| s[i][j] - f[i] * c[j] - c[i] * f[j] + c[i] * c[j];
        let trace = second(0, 0) + second(1, 1) + second(2, 2);
        let own = [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { trace - second(i, i) } else { -second(i, j) }));
        let over_mass = match (self.inertia, self.mass) {
            (Some(Inertia(rows)), Some(mass)) => rows.map(|row| row.map(|part| part / mass.get())),
            _ => own,
        };
        let (gyration, axes) = principal(over_mass);
        let [a, b, c] = gyration;
        let bodily = |a: f64, b: f64, c: f64| a > 0.0 && a <= (b + c) * (1.0 + 1e-9);
        if !(bodily(a, b, c) && bodily(b, c, a) && bodily(c, a, b) && union.volume.is_normal()) {
            let found = format!("principal moments {gyration:?} m² over the mass");
            unexpected("inertia", found, "moments above 0, none above the sum of the others, as bodies have");
            return None;
        }
        Some(ClumpShape {
            name: name.to_owned(),
            spheres,
            mass: self.mass.map(Positive::get),
            volume: union.volume,
            centre,
            axes: axes.to_row(),
            gyration,
            error: if self.inertia.is_some() { 0.0 } else { error },
        })
    }
}

/// How the own frames of clumps are turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OrientationKey {
    /// By this unit quaternion: scalar, x, y, z.
    Turned([f64; 4]),
    /// Principal axes along x, y, z.
    PrincipalAxes,
    /// All orientations alike, by the seed of the scene.
    Random,
}

impl OrientationKey {
    /// How the own frame of a clump of this shape is turned. `uniform` hands out numbers from 0 to below 1, all equally likely.
    pub(crate) fn turn(self, shape: &ClumpShape, uniform: &mut dyn FnMut() -> f64) -> Quaternion {
        match self {
            Self::Turned(row) => Quaternion::from_row(row),
            Self::PrincipalAxes => Quaternion::from_row(shape.axes).conjugate(),
            Self::Random => any_turn(uniform),
        }
    }
}

/// A turn of which all are alike likely (Shoemake 1992).
fn any_turn(uniform: &mut dyn FnMut() -> f64) -> Quaternion {
    let [share, one, other] = [0; 3].map(|_| uniform());
    let (near, far) = ((1.0 - share).sqrt(), share.sqrt());
    let vector = Vector::new(near * libm::sin(TAU * one), near * libm::cos(TAU * one), far * libm::sin(TAU * other));
    Quaternion { scalar: far * libm::cos(TAU * other), vector }.normalised()
}

impl Forms for OrientationKey {
    const EXPECTED: &'static str = "a quaternion [w, x, y, z] that is not zero, \"random\" or \"principal_axes\"";

    fn word<E: Error>(word: &str) -> Result<Self, E> {
        match word {
            "random" => Ok(Self::Random),
            "principal_axes" => Ok(Self::PrincipalAxes),
            _ => Err(Self::refused(word)),
        }
    }

    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let parts: Vec<f64> = Numbers.visit_seq(list)?.iter().map(|part| part.get()).collect();
        let refused = || Self::refused(&parts);
        let row = <[f64; 4]>::try_from(&parts[..]).map_err(|_| refused())?;
        unit(row).map(Self::Turned).ok_or_else(refused)
    }
}
several_forms!(OrientationKey);

/// The unit quaternion of the same turn; none of zero.
pub(in crate::scene) fn unit(row: [f64; 4]) -> Option<[f64; 4]> {
    let largest = row.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    // Neither squares too large nor too small for a number.
    let row = row.map(|part| part / largest);
    let length = row.iter().map(|part| part * part).sum::<f64>().sqrt();
    Some(row.map(|part| part / length))
}
