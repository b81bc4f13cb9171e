//! A box along the axes of the scene.

use super::sphere::{beyond, in_box};
use super::{EVERYWHERE, between_planes, in_both, length_inside};
use crate::base::number::Vector;

/// A box along the axes of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// Lower and upper corner \[m\].
    pub corners: [[f64; 3]; 2],
}

impl Cuboid {
    /// Its volume \[m³\].
    pub(super) fn volume(&self) -> f64 {
        let [lower, upper] = self.corners;
        (0..3).map(|axis| upper[axis] - lower[axis]).product()
    }

    /// Whether a point is inside. The lower faces are, the upper ones are not.
    pub(super) fn holds(&self, point: Vector) -> bool {
        let [lower, upper] = self.corners;
        point.to_array().iter().enumerate().all(|(axis, at)| (lower[axis]..upper[axis]).contains(at))
    }

    /// The centre of a sphere that lies whole inside, all places equally likely \[m\].
    pub(super) fn place(&self, radius: f64, uniform: &mut dyn FnMut() -> f64) -> Option<Vector> {
        let [lower, upper] = self.corners;
        let room = [0, 1, 2].map(|axis| upper[axis] - lower[axis] - 2.0 * radius);
        let fits = room.iter().all(|room| *room >= 0.0);
        let mut along = |axis: usize| lower[axis] + radius + room[axis] * uniform();
        fits.then(|| Vector::new(along(0), along(1), along(2)))
    }

    /// Volume of the part of a sphere that is inside \[m³\].
    pub(super) fn volume_of_sphere(&self, centre: Vector, radius: f64) -> f64 {
        let centre = centre.to_array();
        let corners = self.corners.map(|corner| [0, 1, 2].map(|axis| (corner[axis] - centre[axis]) / radius));
        in_box(corners, (radius, self.volume()), |corner| {
            beyond([0, 1, 2].map(|axis| corners[corner >> axis & 1][axis]))
        })
    }

    /// The part of the line between two points \[m\] that is inside, over its length.
    pub(super) fn share_of_line(&self, from: Vector, to: Vector) -> f64 {
        length_inside(self.passage(from, to - from))
    }

    /// Where a line is inside, over its way.
    fn passage(&self, from: Vector, way: Vector) -> [f64; 2] {
        let [lower, upper] = self.corners;
        let (from, way) = (from.to_array(), way.to_array());
        (0..3).fold(EVERYWHERE, |passage, axis| {
            in_both(passage, between_planes(from[axis] - lower[axis], way[axis], upper[axis] - lower[axis]))
        })
    }
}
