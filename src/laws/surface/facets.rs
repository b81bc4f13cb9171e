//! What a surface looks like: flat facets, for pictures and for what each part of it bears.

use crate::base::number::Vector;

/// Facets with three or four corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facets {
    /// Corners of the facets \[m\].
    pub points: Vec<Vector>,
    /// The corners of each facet, facet after facet: indices into the points.
    pub corners: Vec<u32>,
    /// Behind the last corner of each facet: an index into `corners`.
    pub ends: Vec<u32>,
}

impl Facets {
    /// Adds a facet. Corners that coincide count once.
    pub fn add(&mut self, corners: &[u32]) {
        for (place, corner) in corners.iter().enumerate() {
            if !corners[..place].contains(corner) {
                self.corners.push(*corner);
            }
        }
        self.ends.push(self.corners.len() as u32);
    }

    /// How many facets there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The corners of a facet \[m\].
    fn of(&self, facet: usize) -> impl Iterator<Item = Vector> + '_ {
        let from = facet.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        self.corners[from..self.ends[facet] as usize].iter().map(|corner| self.points[*corner as usize])
    }

    /// The area of a facet \[m²\].
    pub fn area(&self, facet: usize) -> f64 {
        let mut corners = self.of(facet);
        let Some(first) = corners.next() else { return 0.0 };
        let arms: Vec<Vector> = corners.map(|corner| corner - first).collect();
        let twice = arms.windows(2).map(|pair| pair[0].cross(pair[1])).fold(Vector::zero(), |sum, part| sum + part);
        0.5 * twice.length()
    }
}

/// Two unit vectors across a unit vector and each other, right-handed with it.
pub(super) fn across(unit: Vector) -> [Vector; 2] {
    let parts = unit.to_array();
    let least = (0..3).fold(0, |least, axis| if parts[axis].abs() < parts[least].abs() { axis } else { least });
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let first = unit.cross(axis.into());
    let first = first * (1.0 / first.length());
    [first, unit.cross(first)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_facet_has_the_area_of_its_polygon() {
        let points = [[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 0.0, 4.0], [0.0, 0.0, 4.0]].map(Vector::from).to_vec();
        let mut facets = Facets { points, ..Facets::default() };
        facets.add(&[0, 1, 2, 3]);
        facets.add(&[1, 2, 3, 3]);
        assert_eq!((facets.len(), facets.area(0), facets.area(1)), (2, 6.0, 3.0));
        assert_eq!(facets.ends, [4, 7]);
    }

    #[test]
    fn directions_across_are_right_handed() {
        for unit in [[0.0, 0.0, 1.0], [0.6, -0.8, 0.0], [1.0, 0.0, 0.0]].map(Vector::from) {
            let [first, second] = across(unit);
            assert!((first.cross(second) - unit).length() < 1e-15 && first.dot(second).abs() < 1e-15);
        }
    }
}
