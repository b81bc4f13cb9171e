//! A plane polygon, and whether a way passes through it.

use crate::base::number::Vector;

/// How far a corner may be off the plane of the others, over the longest distance of two corners.
const FLAT: f64 = 1e-6;

/// A plane polygon without holes. It has a front, from which its corners are seen counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Its corners \[m\].
    corners: Vec<[f64; 3]>,
    /// Unit normal, towards its front.
    normal: [f64; 3],
    /// Coordinates of the corners in its plane \[m\].
    flat: Vec<[f64; 2]>,
    /// Directions of these coordinates.
    axes: [[f64; 3]; 2],
}

impl Polygon {
    /// The polygon with these corners \[m\]; otherwise what is wrong with them.
    pub(super) fn new(corners: Vec<[f64; 3]>) -> Result<Self, String> {
        if corners.len() < 3 {
            return Err(format!("{} corners", corners.len()));
        }
        let place = |index: usize| Vector::from(corners[index % corners.len()]);
        let (origin, mut area) = (place(0), Vector::zero());
        for index in 0..corners.len() {
            area += (place(index) - origin).cross(place(index + 1) - origin);
        }
        let size = (1..corners.len()).map(|index| (place(index) - origin).length()).fold(0.0, f64::max);
        let length = area.length();
        if length <= 1e-9 * size * size || !length.is_normal() {
            return Err("corners on one line".to_owned());
        }
        let normal = area * (1.0 / length);
        if (0..corners.len()).any(|index| (place(index) - origin).dot(normal).abs() > FLAT * size) {
            return Err("corners that are not in one plane".to_owned());
        }
        let first = place(1) - origin;
        let first = first * (1.0 / first.length());
        let second = normal.cross(first);
        let flat = (0..corners.len()).map(|index| {
            let from = place(index) - origin;
            [from.dot(first), from.dot(second)]
        });
        let flat = flat.collect();
        Ok(Self { flat, normal: normal.to_array(), axes: [first.to_array(), second.to_array()], corners })
    }

    /// The smallest box around it: lower and upper corner \[m\].
    pub(crate) fn bounds(&self) -> [[f64; 3]; 2] {
        let start = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        self.corners.iter().fold(start, |[low, high], corner| {
            [[0, 1, 2].map(|axis| low[axis].min(corner[axis])), [0, 1, 2].map(|axis| high[axis].max(corner[axis]))]
        })
    }

    /// Whether the way from one point to another \[m\] passes through it: `Some(true)` towards its front.
    pub fn is_passed(&self, from: Vector, to: Vector) -> Option<bool> {
        let (origin, normal) = (Vector::from(self.corners[0]), Vector::from(self.normal));
        let [before, after] = [from, to].map(|point| (point - origin).dot(normal));
        // A point on the plane counts as in front of it: a way that ends there has passed, one that begins there has not.
        let forward = match (before < 0.0, after < 0.0) {
            (true, false) => true,
            (false, true) => false,
            _ => return None,
        };
        let at = from + (to - from) * (before / (before - after)) - origin;
        let [first, second] = self.axes.map(|axis| at.dot(axis.into()));
        self.holds([first, second]).then_some(forward)
    }

    /// Whether a point of its plane is inside: how often a line from there crosses its edges.
    fn holds(&self, [x, y]: [f64; 2]) -> bool {
        let mut inside = false;
        for index in 0..self.flat.len() {
            let ([a, b], [c, d]) = (self.flat[index], self.flat[(index + 1) % self.flat.len()]);
            if (b > y) != (d > y) && x < a + (y - b) / (d - b) * (c - a) {
                inside = !inside;
            }
        }
        inside
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point.
    fn at(x: f64, y: f64, z: f64) -> Vector {
        Vector::new(x, y, z)
    }

    #[test]
    fn a_way_through_it_counts_by_its_direction() {
        // An L seen from above.
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let polygon = Polygon::new(corners.map(|[x, y]| [x, y, 0.5]).to_vec()).unwrap();
        assert_eq!(polygon.is_passed(at(0.5, 1.5, 0.0), at(0.5, 1.5, 1.0)), Some(true));
        assert_eq!(polygon.is_passed(at(1.5, 0.5, 1.0), at(1.5, 0.5, 0.0)), Some(false));
        assert_eq!(polygon.is_passed(at(1.5, 1.5, 0.0), at(1.5, 1.5, 1.0)), None, "in the corner that is missing");
        assert_eq!(polygon.is_passed(at(0.5, 0.5, 0.6), at(0.5, 0.5, 1.0)), None, "in front of it");
        let (on, beyond, before) = (at(0.5, 0.5, 0.5), at(0.5, 0.5, 0.9), at(0.5, 0.5, 0.1));
        assert_eq!(polygon.is_passed(before, on), Some(true));
        assert_eq!(polygon.is_passed(on, beyond), None, "once only");
        assert_eq!(polygon.is_passed(on, before), Some(false));
        // Of two polygons that share an edge, one counts what passes through the edge.
        assert_eq!(polygon.is_passed(at(-1.0, 0.5, 0.0), at(1.0, 0.5, 1.0)), Some(true), "through its left edge");
        assert_eq!(polygon.is_passed(at(1.0, 0.5, 0.0), at(3.0, 0.5, 1.0)), None, "through its right edge");
    }

    #[test]
    fn what_is_no_polygon_is_refused() {
        let refused = |corners: &[[f64; 3]]| Polygon::new(corners.to_vec()).unwrap_err();
        assert_eq!(refused(&[[0.0; 3], [1.0, 0.0, 0.0]]), "2 corners");
        assert_eq!(refused(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), "corners on one line");
        let bent = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.1], [0.0, 1.0, 0.0]];
        assert_eq!(refused(&bent), "corners that are not in one plane");
    }
}
