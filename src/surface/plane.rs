//! `plane`: infinite and one-sided.

use super::{Around, Shape, ShapeKeys, Surface, direction};
use crate::number::Vector;
use crate::quantity::{MaterialIndex, Triple};
use serde::Deserialize;

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

    fn distance(&self, centre: Vector) -> Option<f64> {
        Some(self.height(centre.to_array()))
    }

    fn reference(&self) -> Option<[f64; 3]> {
        Some(self.point)
    }
}

/// `plane = { point, normal }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Keys {
    /// A point on it \[m\].
    point: Triple,
    /// Towards the particles, of any length but 0.
    normal: Triple,
}

impl ShapeKeys for Keys {
    const HINT: &'static str = "plane = { point, normal }";

    fn shape(&self, around: &mut dyn Around) -> Option<Shape> {
        let (material, normal) = (around.material("a plane"), direction(self.normal.0));
        if normal.is_none() {
            let right = "one that points towards the particles";
            around.refuse("plane.normal", "a normal of length 0".to_owned(), right);
        }
        Some(Shape::of(Plane { material: material?, point: self.point.0, normal: normal? }))
    }
}
