//! `plane`: infinite and one-sided.

use super::facets::{Facets, across};
use super::feet::{Features, Feet, Foot};
use super::{Copies, Repeated, Shape, ShapeContext, ShapeKeys, Surface, direction};
use crate::base::document::keys;
use crate::base::number::Vector;
use crate::base::quantity::{MaterialIndex, Triple};

/// An infinite plane. Particles live where its normal points: a centre behind it is lost.
///
/// ```text
/// δ = R − (x − p) · n
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// What it is made of.
    pub material: MaterialIndex,
    /// A point p on it at time 0 \[m\].
    pub point: [f64; 3],
    /// Unit normal n towards the particles.
    pub normal: [f64; 3],
}

impl Plane {
    /// How far in front of the plane, at time 0, a point is, negative behind it \[m\].
    pub fn height(&self, point: [f64; 3]) -> f64 {
        (0..3).map(|axis| (point[axis] - self.point[axis]) * self.normal[axis]).sum()
    }
}

impl Surface for Plane {
    fn key(&self) -> &'static str {
        "plane"
    }

    fn material(&self) -> Option<MaterialIndex> {
        Some(self.material)
    }

    fn plane(&self) -> Option<Plane> {
        Some(*self)
    }

    fn features(&self) -> Option<&dyn Features> {
        Some(self)
    }

    fn distance(&self, centre: Vector) -> Option<f64> {
        Some(self.height(centre.to_array()))
    }

    fn reference(&self) -> Option<[f64; 3]> {
        Some(self.point)
    }

    fn turns(&self) -> bool {
        true
    }

    fn facets(&self, beside: &[Vector]) -> Option<Facets> {
        let (point, [along, up]) = (Vector::from(self.point), across(self.normal.into()));
        let span = |direction: Vector| {
            let places = beside.iter().map(|place| (*place - point).dot(direction));
            places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| [low.min(place), high.max(place)])
        };
        let ([left, right], [low, high], mut facets) = (span(along), span(up), Facets::default());
        if left < right && low < high {
            let corners = [[left, low], [right, low], [right, high], [left, high]];
            facets.points.extend(corners.map(|[x, y]| point + along * x + up * y));
            facets.add(&[0, 1, 2, 3]);
        }
        Some(facets)
    }

    fn repeated(&self, _copies: &Copies) -> Result<Repeated, [String; 2]> {
        Ok(Repeated::Endless)
    }
}

/// For a plane that turns: one that only shifts has its particles worked on in lanes.
impl Features for Plane {
    fn near(&self, centre: Vector, reach: f64, parts: &mut Vec<u32>) {
        if self.height(centre.to_array()) <= reach {
            parts.push(0);
        }
    }

    fn counts(&self) -> [usize; 2] {
        [1, 1]
    }

    fn feet(&self, centre: Vector, radius: f64, _parts: &[u32], feet: &mut Feet) {
        let distance = self.height(centre.to_array());
        if distance <= radius {
            feet.list.push(Foot { feature: 0, distance, normal: self.normal.into(), weight: 1.0, slope: 1.0 });
        }
    }

    /// Everything behind the plane is near it: only the way out of its front leads through.
    fn is_passed(&self, [from, to]: [Vector; 2]) -> bool {
        self.height(from.to_array()) >= 0.0 && self.height(to.to_array()) < 0.0
    }

    fn meet(&self, _one: u32, _other: u32) -> bool {
        true
    }

    fn extent(&self, _point: Vector) -> f64 {
        f64::INFINITY
    }
}

keys! {
    /// `plane = { point, normal }`
    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Keys {
        /// A point on it \[m\].
        point: Triple = "required",
        /// Towards the particles, of any length but 0.
        normal: Triple = "required",
    }
}

impl ShapeKeys for Keys {
    const KEY: &'static str = "plane";
    const HINT: &'static str = "plane = { point, normal }";

    fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape> {
        let (material, normal) = (around.material("a plane"), direction(self.normal.0));
        if normal.is_none() {
            let right = "a normal that points towards the particles";
            around.refuse("plane.normal", "one of length 0".to_owned(), right);
        }
        Some(Shape::of(Plane { material: material?, point: self.point.0, normal: normal? }))
    }
}
