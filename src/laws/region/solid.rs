//! The inside of a closed mesh.

use super::crossing::{Crossing, Line};
use super::cut::{Corner, Cut};
use super::sphere::UNIT;
use crate::base::number::Vector;
use crate::laws::surface::Shape;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Random places that are tried for a sphere before it counts as too large.
const TRIES: usize = 100_000;

/// How much farther than their radius balls look for faces: rounding must not hide one of two faces at an edge.
const WIDER: f64 = 1.0 + 1e-9;

/// Where the centre of a ball is moved to count its turns, over the radius: anywhere but along the axes.
const BESIDE: [[f64; 3]; 6] = [
    [0.482e-5, -0.713e-5, 0.508e-5],
    [-0.611e-5, -0.329e-5, 0.719e-5],
    [0.277e-5, 0.843e-5, 0.461e-5],
    [-0.737e-5, 0.421e-5, -0.529e-5],
    [0.853e-5, 0.317e-5, -0.415e-5],
    [-0.359e-5, -0.547e-5, -0.756e-5],
];

/// The inside of a closed mesh.
#[derive(Clone, Debug)]
pub struct Solid(Arc<Faces>);

/// A closed surface, and what is known of it.
#[derive(Debug)]
struct Faces {
    /// The surface.
    shape: Shape,
    /// 1 where normals point outwards, −1 where they point inwards.
    outward: f64,
    /// Outward unit normal of each triangle.
    normals: Vec<Vector>,
    /// Volume \[m³\].
    volume: f64,
    /// Lower and upper corner of the box around it \[m\].
    bounds: [[f64; 3]; 2],
}

impl Solid {
    /// The inside of a closed surface of triangles. Otherwise a place on a part of it that has the inside of the whole on the wrong
    /// side \[m\].
    pub(crate) fn of(shape: Shape) -> Result<Self, [f64; 3]> {
        let bounds = around(shape.vertices());
        let middle = (Vector::from(bounds[0]) + Vector::from(bounds[1])) * 0.5;
        let places = |triangle: &[u32; 3]| triangle.map(|vertex| shape.vertices()[vertex as usize]);
        let volume: f64 = shape.triangles().iter().map(|it| six_volumes(places(it), middle) / 6.0).sum();
        let outward = 1.0_f64.copysign(volume);
        let normal = |triangle: &[u32; 3]| {
            let [a, b, c] = places(triangle);
            let across = (b - a).cross(c - a);
            across * (outward / across.length())
        };
        let normals = shape.triangles().iter().map(normal).collect();
        for triangle in firsts_of_parts(&shape) {
            let [a, b, c] = places(&shape.triangles()[triangle]);
            let place = (a + b + c) * (1.0 / 3.0);
            let others = (0..).zip(shape.triangles()).filter(|(other, _)| *other != triangle);
            let angle: f64 = others.map(|(_, it)| outward * solid_angle(places(it).map(|at| at - place))).sum();
            // Half of the directions see the inside, 4π/2 less than behind and more than in front of the triangle.
            if (angle - TAU).abs() > 1.0 {
                return Err(place.to_array());
            }
        }
        Ok(Self(Arc::new(Faces { shape, outward, normals, volume: volume.abs(), bounds })))
    }

    /// Its volume \[m³\].
    pub(super) fn volume(&self) -> f64 {
        self.0.volume
    }

    /// The smallest box around it: lower and upper corner \[m\].
    pub(super) fn bounds(&self) -> [[f64; 3]; 2] {
        self.0.bounds
    }

    /// Distance from the surface, below 0 inside \[m\].
    fn distance(&self, point: Vector) -> f64 {
        self.0.shape.distance(point).map_or(f64::INFINITY, |distance| self.0.outward * distance)
    }

    /// Whether a point is farther than this \[m\] from the box around it.
    fn is_far(&self, point: Vector, reach: f64) -> bool {
        let [lower, upper] = self.0.bounds;
        let point = point.to_array();
        (0..3).any(|axis| point[axis] < lower[axis] - reach || point[axis] > upper[axis] + reach)
    }

    /// Whether a point is inside.
    pub(super) fn holds(&self, point: Vector) -> bool {
        !self.is_far(point, 0.0) && self.distance(point) <= 0.0
    }

    /// The centre of a sphere that lies whole inside, all places equally likely \[m\]; none if it is not found.
    pub(super) fn place(&self, radius: f64, uniform: &mut dyn FnMut() -> f64) -> Option<Vector> {
        let [lower, upper] = self.0.bounds;
        let room = [0, 1, 2].map(|axis| upper[axis] - lower[axis] - 2.0 * radius);
        if room.iter().any(|room| *room < 0.0) {
            return None;
        }
        for _ in 0..TRIES {
            let mut along = |axis: usize| lower[axis] + radius + room[axis] * uniform();
            let place = Vector::new(along(0), along(1), along(2));
            if self.distance(place) <= -radius {
                return Some(place);
            }
        }
        None
    }

    /// The triangles near a point \[m\].
    fn near(&self, point: Vector, reach: f64) -> Vec<u32> {
        let mut parts = Vec::new();
        if let Some(features) = self.0.shape.features() {
            features.near(point, reach, &mut parts);
        }
        parts
    }

    /// The corners of a triangle \[m\].
    fn corners(&self, triangle: u32) -> [Vector; 3] {
        self.0.shape.triangles()[triangle as usize].map(|vertex| self.0.shape.vertices()[vertex as usize])
    }

    /// Volume of the part of a sphere that is inside \[m³\].
    pub(super) fn volume_of_sphere(&self, centre: Vector, radius: f64) -> f64 {
        if self.is_far(centre, radius) {
            return 0.0;
        }
        let (distance, cube) = (self.distance(centre), radius * radius * radius);
        if distance.abs() >= radius {
            return if distance < 0.0 { (UNIT * cube).min(self.0.volume) } else { 0.0 };
        }
        (self.part_of_ball(centre, radius) * cube).clamp(0.0, self.0.volume.min(UNIT * cube))
    }

    /// The same of a sphere that the surface cuts, over the cube of its radius.
    fn part_of_ball(&self, centre: Vector, radius: f64) -> f64 {
        let near = self.near(centre, radius * WIDER);
        let cut = self.cut(centre, radius, &near);
        let about = |beside: &[f64; 3]| {
            let beside = centre + Vector::from(*beside) * radius;
            let whole = if self.holds(beside) { 2.0 * TAU } else { 0.0 };
            whole - self.cut(beside, radius, &self.near(beside, radius * WIDER)).angle
        };
        let found = BESIDE.iter().find_map(|beside| cut.volume(about(beside)));
        // Only a surface that goes through itself leads here.
        found.unwrap_or_else(|| (cut.cone + about(&BESIDE[0]).clamp(0.0, 2.0 * TAU)) / 3.0)
    }

    /// What some triangles have of a ball, over its radius.
    fn cut(&self, centre: Vector, radius: f64, triangles: &[u32]) -> Cut {
        let mut cut = Cut::default();
        for &triangle in triangles {
            let numbers = self.0.shape.triangles()[triangle as usize];
            let place = |number: u32| (self.0.shape.vertices()[number as usize] - centre) * (1.0 / radius);
            let corners = numbers.map(|number| Corner { number, place: place(number) });
            // Corners run counter-clockwise around the outward normal.
            let corners = if self.0.outward < 0.0 { [corners[0], corners[2], corners[1]] } else { corners };
            cut.add(corners, self.0.normals[triangle as usize]);
        }
        cut
    }

    /// The part of the line between two points \[m\] that is inside, over its length.
    pub(super) fn share_of_line(&self, from: Vector, to: Vector) -> f64 {
        let (middle, half) = ((from + to) * 0.5, 0.5 * (to - from).length());
        if self.is_far(middle, half) {
            return 0.0;
        }
        let distance = self.distance(middle);
        let Some(line) = Line::between(from, to).filter(|_| distance.abs() < half) else {
            return if distance <= 0.0 { 1.0 } else { 0.0 };
        };
        let near = self.near(middle, half * WIDER);
        let mut crossings: Vec<Crossing> =
            near.iter().filter_map(|triangle| line.through(self.corners(*triangle))).collect();
        crossings.retain(|crossing| 0.0 < crossing.at && crossing.at < 1.0);
        crossings.sort_by(|one, other| one.at.total_cmp(&other.at));
        self.inside_between(&crossings, |at| from + (to - from) * at)
    }

    /// How much of a line is inside that crosses the surface at these places: the middle of the longest piece says whether it is
    /// inside, and each crossing what is beyond it.
    fn inside_between(&self, crossings: &[Crossing], place: impl Fn(f64) -> Vector) -> f64 {
        let ends: Vec<f64> =
            std::iter::once(0.0).chain(crossings.iter().map(|crossing| crossing.at)).chain([1.0]).collect();
        let length = |piece: usize| ends[piece + 1] - ends[piece];
        let longest =
            (1..=crossings.len()).fold(0, |most, piece| if length(piece) > length(most) { piece } else { most });
        // Depth of each piece: how many times it is inside; a crossing outwards lowers it.
        let falls = |crossing: &Crossing| if self.0.outward > 0.0 { crossing.out } else { !crossing.out };
        let mut depths = vec![0_i64];
        for crossing in crossings {
            depths.push(depths[depths.len() - 1] + if falls(crossing) { -1 } else { 1 });
        }
        let known = i64::from(self.holds(place(0.5 * (ends[longest] + ends[longest + 1]))));
        let offset = known - depths[longest];
        (0..depths.len()).filter(|piece| depths[*piece] + offset > 0).map(length).sum()
    }
}

/// The smallest box around points: lower and upper corner.
fn around(points: &[Vector]) -> [[f64; 3]; 2] {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for point in points {
        for (axis, part) in point.to_array().into_iter().enumerate() {
            bounds[0][axis] = bounds[0][axis].min(part);
            bounds[1][axis] = bounds[1][axis].max(part);
        }
    }
    bounds
}

/// Six times the volume between a triangle and a point.
fn six_volumes([a, b, c]: [Vector; 3], point: Vector) -> f64 {
    (a - point).dot((b - point).cross(c - point))
}

/// The solid angle at which the origin sees a triangle, above 0 from behind it (van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30,
/// 1983, 125).
pub(super) fn solid_angle([a, b, c]: [Vector; 3]) -> f64 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    2.0 * libm::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
}

/// The first triangle of each connected part of a surface.
fn firsts_of_parts(shape: &Shape) -> Vec<usize> {
    let mut part: Vec<u32> = (0..shape.vertices().len() as u32).collect();
    // The vertex that stands for the part of a vertex.
    fn find(part: &mut [u32], vertex: u32) -> u32 {
        let mut here = vertex;
        while part[here as usize] != here {
            part[here as usize] = part[part[here as usize] as usize];
            here = part[here as usize];
        }
        here
    }
    for triangle in shape.triangles() {
        let [a, b, c] = triangle.map(|vertex| find(&mut part, vertex));
        let least = a.min(b).min(c);
        [a, b, c].into_iter().for_each(|root| part[root as usize] = least);
    }
    let mut met = vec![false; part.len()];
    let triangles = (0..).zip(shape.triangles());
    triangles
        .filter(|(_, it)| !std::mem::replace(&mut met[find(&mut part, it[0]) as usize], true))
        .map(|(at, _)| at)
        .collect()
}
