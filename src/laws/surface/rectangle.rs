//! `rectangle`: a flat plate.

use super::facets::Facets;
use super::feet::{Features, Feet, Foot};
use super::{Copies, Repeated, Shape, ShapeContext, ShapeKeys, Surface, mesh};
use crate::base::document::keys;
use crate::base::number::Vector;
use crate::base::quantity::{MaterialIndex, Triple};

/// How far from a right angle the edges may be: the cosine of the angle between them.
const SQUARE: f64 = 1e-9;

/// A flat plate, touched from both sides. It is convex: a sphere touches it once, at the nearest point.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rectangle {
    /// What it is made of.
    material: MaterialIndex,
    /// One of its corners \[m\].
    corner: Vector,
    /// Unit vectors along the two edges there.
    along: [Vector; 2],
    /// Their lengths \[m\].
    lengths: [f64; 2],
    /// Unit vector across both.
    normal: Vector,
}

impl Rectangle {
    /// Distance of a centre from the nearest point \[m\] and unit normal from there to the centre.
    fn nearest(&self, centre: Vector) -> (f64, Vector) {
        let apart = centre - self.corner;
        let height = apart.dot(self.normal);
        // How far beyond the edges the foot in the plane of the plate is.
        let beyond = [0, 1].map(|edge| {
            let place = apart.dot(self.along[edge]);
            place - place.max(0.0).min(self.lengths[edge])
        });
        if beyond == [0.0; 2] {
            return (height.abs(), if height < 0.0 { -self.normal } else { self.normal });
        }
        let apart = self.along[0] * beyond[0] + self.along[1] * beyond[1] + self.normal * height;
        let distance = apart.length();
        (distance, apart * (1.0 / distance))
    }
}

impl Rectangle {
    /// Its corners, one after the other \[m\].
    fn corners(&self) -> [Vector; 4] {
        let [first, second] = [0, 1].map(|edge| self.along[edge] * self.lengths[edge]);
        [self.corner, self.corner + first, self.corner + first + second, self.corner + second]
    }
}

impl Surface for Rectangle {
    fn key(&self) -> &'static str {
        "rectangle"
    }

    fn material(&self) -> Option<MaterialIndex> {
        Some(self.material)
    }

    fn features(&self) -> Option<&dyn Features> {
        Some(self)
    }

    fn distance(&self, centre: Vector) -> Option<f64> {
        Some(self.nearest(centre).0)
    }

    fn reference(&self) -> Option<[f64; 3]> {
        let half = |edge: usize| self.along[edge] * (0.5 * self.lengths[edge]);
        Some((self.corner + half(0) + half(1)).to_array())
    }

    fn turns(&self) -> bool {
        true
    }

    fn facets(&self, _beside: &[Vector]) -> Option<Facets> {
        let mut facets = Facets { points: self.corners().to_vec(), ..Facets::default() };
        facets.add(&[0, 1, 2, 3]);
        Some(facets)
    }

    fn repeated(&self, copies: &Copies) -> Result<Repeated, [String; 2]> {
        let [a, b, c, d] = self.corners().map(Vector::to_array);
        mesh::joined(self.material, &[[a, b, c], [a, c, d]], copies)
    }
}

impl Features for Rectangle {
    fn near(&self, centre: Vector, reach: f64, parts: &mut Vec<u32>) {
        if self.nearest(centre).0 <= reach {
            parts.push(0);
        }
    }

    fn counts(&self) -> [usize; 2] {
        [1, 1]
    }

    fn feet(&self, centre: Vector, radius: f64, _parts: &[u32], feet: &mut Feet) {
        let (distance, normal) = self.nearest(centre);
        if distance <= radius {
            feet.list.push(Foot { feature: 0, distance, normal, weight: 1.0, slope: 1.0 });
        }
    }

    fn meet(&self, _one: u32, _other: u32) -> bool {
        true
    }

    fn extent(&self, point: Vector) -> f64 {
        let corner = |place: usize| {
            let edge = |edge: usize| self.along[edge] * if place >> edge & 1 == 1 { self.lengths[edge] } else { 0.0 };
            (self.corner + edge(0) + edge(1) - point).length()
        };
        (0..4).map(corner).fold(0.0, f64::max)
    }
}

keys! {
    /// `rectangle = { corner, edges }`
    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Keys {
        /// One of its corners \[m\].
        corner: Triple = "required",
        /// The two edges there, at a right angle \[m\].
        edges: [Triple; 2] = "required",
    }
}

impl ShapeKeys for Keys {
    const KEY: &'static str = "rectangle";
    const HINT: &'static str = "rectangle = { corner, edges }";

    fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape> {
        let material = around.material("a rectangle");
        let [first, second] = self.edges.map(|edge| Vector::from(edge.0));
        let lengths = [first.length(), second.length()];
        if first.dot(second).abs() > SQUARE * lengths[0] * lengths[1] || lengths.contains(&0.0) {
            let found = format!("{:?} and {:?}", self.edges[0].0, self.edges[1].0);
            around.refuse("rectangle.edges", found, "two edges of some length at a right angle");
            return None;
        }
        let along = [first * (1.0 / lengths[0]), second * (1.0 / lengths[1])];
        let across = along[0].cross(along[1]);
        let normal = across * (1.0 / across.length());
        Some(Shape::of(Rectangle { material: material?, corner: self.corner.0.into(), along, lengths, normal }))
    }
}
