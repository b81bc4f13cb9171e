//! A box along the axes of the scene.

use super::sphere::{UNIT, beyond};
use super::{EVERYWHERE, between_planes, in_both};
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

    /// Volume of the part of a sphere that is inside \[m³\]: the sum over the corners of the box of the part of the sphere
    /// beyond each, with alternating signs.
    pub(super) fn volume_of_sphere(&self, centre: Vector, radius: f64) -> f64 {
        let centre = centre.to_array();
        let [lower, upper] = self.corners.map(|corner| [0, 1, 2].map(|axis| (corner[axis] - centre[axis]) / radius));
        let axes = 0..3;
        if axes.clone().any(|axis| lower[axis] >= 1.0 || upper[axis] <= -1.0) {
            return 0.0;
        }
        let cube = radius * radius * radius;
        if axes.clone().all(|axis| lower[axis] <= -1.0 && upper[axis] >= 1.0) {
            return UNIT * cube;
        }
        let farthest = axes.map(|axis| lower[axis].abs().max(upper[axis].abs()));
        if farthest.map(|distance| distance * distance).sum::<f64>() <= 1.0 {
            return self.volume();
        }
        let mut sum = 0.0;
        for corner in 0..8_usize {
            let planes = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { lower[axis] } else { upper[axis] });
            let part = beyond(planes);
            sum += if corner.count_ones() % 2 == 0 { part } else { -part };
        }
        (sum * cube).clamp(0.0, self.volume())
    }

    /// Where a line is inside, over its way.
    pub(super) fn passage(&self, from: Vector, way: Vector) -> [f64; 2] {
        let [lower, upper] = self.corners;
        let (from, way) = (from.to_array(), way.to_array());
        (0..3).fold(EVERYWHERE, |passage, axis| {
            in_both(passage, between_planes(from[axis] - lower[axis], way[axis], upper[axis] - lower[axis]))
        })
    }
}
