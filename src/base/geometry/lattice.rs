//! A parallelepiped that repeats along some of its edges.

/// Names of the components of a cell's strain: the others stand below the diagonal, where triangular edges have none.
pub const STRAINS: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

/// Row and column of each.
pub const STRAIN_PLACES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Where a periodic parallelepiped stands, and along which edges it repeats.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lattice {
    /// The corner from which the edges go out \[m\].
    pub origin: [f64; 3],
    /// The edges a, b, c, lower triangular: a along x, b in the xy plane \[m\].
    pub edges: [[f64; 3]; 3],
    /// Whether it repeats along each edge.
    pub periodic: [bool; 3],
}

/// Whether an image stands behind the cell, not before it: of two opposite displacements the one whose last number that is not 0 is
/// above 0.
pub(crate) fn is_behind([a, b, c]: [i64; 3]) -> bool {
    (c, b, a) > (0, 0, 0)
}

/// The displacement by so many edges \[m\].
#[inline]
pub(crate) fn displacement([a, b, c]: &[[f64; 3]; 3], edges: [i64; 3]) -> [f64; 3] {
    let [i, j, k] = edges.map(|count| count as f64);
    [i * a[0] + j * b[0] + k * c[0], j * b[1] + k * c[1], k * c[2]]
}

impl Lattice {
    /// Its volume \[m³\].
    pub fn volume(&self) -> f64 {
        self.edges[0][0] * self.edges[1][1] * self.edges[2][2]
    }

    /// The displacement by so many edges \[m\].
    #[inline]
    pub fn displacement(&self, edges: [i64; 3]) -> [f64; 3] {
        displacement(&self.edges, edges)
    }

    /// A displacement in whole edges, along those that repeat.
    pub(crate) fn whole_edges(&self, [x, y, z]: [f64; 3]) -> [i64; 3] {
        let parts = self.parts([self.origin[0] + x, self.origin[1] + y, self.origin[2] + z]);
        [0, 1, 2].map(|edge| if self.periodic[edge] { parts[edge].round() as i64 } else { 0 })
    }

    /// A point in parts of the edges.
    #[inline]
    pub fn parts(&self, point: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = &self.edges;
        let [x, y, z] = [0, 1, 2].map(|axis| point[axis] - self.origin[axis]);
        let along_c = z / c[2];
        let along_b = (y - along_c * c[1]) / b[1];
        [(x - along_b * b[0] - along_c * c[0]) / a[0], along_b, along_c]
    }

    /// The point of these parts of the edges \[m\].
    pub(crate) fn point(&self, [i, j, k]: [f64; 3]) -> [f64; 3] {
        let ([a, b, c], [x, y, z]) = (&self.edges, self.origin);
        [x + i * a[0] + j * b[0] + k * c[0], y + j * b[1] + k * c[1], z + k * c[2]]
    }

    /// Distance of the two faces that each edge joins \[m\].
    pub fn heights(&self) -> [f64; 3] {
        let [a, b, c] = &self.edges;
        let (lean, tilt) = (c[1] / b[1], b[0] / b[1]);
        let across = (c[0] - b[0] * lean) / c[2];
        let of_a = a[0] / (1.0 + tilt * tilt + across * across).sqrt();
        [of_a, b[1] / (1.0 + (c[1] / c[2]) * (c[1] / c[2])).sqrt(), c[2]]
    }

    /// By how many edges a point is away from the cell, along those that repeat.
    #[inline]
    pub fn edges_away(&self, point: [f64; 3]) -> [i64; 3] {
        let parts = self.parts(point);
        [0, 1, 2].map(|edge| if self.periodic[edge] { parts[edge].floor() as i64 } else { 0 })
    }

    /// A point, brought back into the cell.
    pub(crate) fn brought_back(&self, point: [f64; 3]) -> [f64; 3] {
        let shift = self.displacement(self.edges_away(point));
        [0, 1, 2].map(|axis| point[axis] - shift[axis])
    }

    /// Distance of a point from the nearest image of another \[m\].
    pub(crate) fn distance(&self, a: [f64; 3], b: [f64; 3]) -> f64 {
        let [x, y, z] = self.nearest(a, b);
        (x * x + y * y + z * z).sqrt()
    }

    /// The vector to a point from the nearest image of another \[m\]; in a cell that leans much, from one that is near.
    pub(crate) fn nearest(&self, a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        let apart = [0, 1, 2].map(|axis| a[axis] - b[axis]);
        let shift = self.displacement(self.whole_edges(apart));
        [0, 1, 2].map(|axis| apart[axis] - shift[axis])
    }

    /// Hands out the displacements of the images of a point in the cell that stand behind it ([`is_behind`]) and are no further than
    /// `depth` \[m\] from it.
    pub(crate) fn images(&self, point: [f64; 3], depth: f64, hand: &mut dyn FnMut([i64; 3])) {
        let (parts, heights) = (self.parts(point), self.heights());
        let range = |edge: usize| {
            if !self.periodic[edge] {
                return 0..=0;
            }
            let margin = depth / heights[edge];
            (-margin - parts[edge]).ceil() as i64..=(1.0 + margin - parts[edge]).floor() as i64
        };
        for c in range(2) {
            for b in range(1) {
                for a in range(0).filter(|&a| is_behind([a, b, c])) {
                    hand([a, b, c]);
                }
            }
        }
    }

    /// The least and the largest part of each edge of what is in a box \[m\].
    pub(crate) fn parts_of_box(&self, corners: [[f64; 3]; 2]) -> [[f64; 2]; 3] {
        let mut found = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for corner in 0..8 {
            let parts = self.parts([0, 1, 2].map(|axis| corners[corner >> axis & 1][axis]));
            for ([low, high], part) in found.iter_mut().zip(parts) {
                (*low, *high) = (low.min(part), high.max(part));
            }
        }
        found
    }

    /// Hands out by how much a point is displaced to where it or an image of it is no further than `depth` from between these parts
    /// of the edges \[m\].
    #[inline]
    pub(crate) fn near(&self, point: [f64; 3], parts: &[[f64; 2]; 3], depth: f64, mut hand: impl FnMut([f64; 3])) {
        let (own, heights) = (self.parts(point), self.heights());
        let range = |edge: usize| {
            let ([low, high], margin) = (parts[edge], depth / heights[edge]);
            let [from, to] = [(low - margin - own[edge]).ceil(), (high + margin - own[edge]).floor()];
            if self.periodic[edge] { from as i64..=to as i64 } else { 0..=0 }
        };
        for c in range(2) {
            for b in range(1) {
                range(0).for_each(|a| hand(self.displacement([a, b, c])));
            }
        }
    }

    /// How often b is to be brought back by a, c by a and c by b, so that no edge leans over by more than half of another: what the
    /// edges span stays the same.
    pub(crate) fn leaning(&self) -> [i64; 3] {
        let [a, b, c] = &self.edges;
        // One that leans by just half stays as it is, whatever rounding makes of it.
        let leans = |part: f64| part.abs() > 0.5 + 1e-9;
        let whole = |part: f64, repeats: bool| if repeats && leans(part) { part.round() as i64 } else { 0 };
        let [along_a, along_b, _] = self.periodic;
        let by_b = whole(c[1] / b[1], along_b && self.periodic[2]);
        let of_b = whole(b[0] / a[0], along_a && along_b);
        // What is left of c when b has been taken from it, and b itself is brought back.
        let upright = b[0] - of_b as f64 * a[0];
        [of_b, whole((c[0] - by_b as f64 * upright) / a[0], along_a && self.periodic[2]), by_b]
    }
}

/// Edges of which b has been brought back by a, c by a and c by b so often.
pub(crate) fn brought_back([a, b, c]: [[f64; 3]; 3], [b_by_a, c_by_a, c_by_b]: [i64; 3]) -> [[f64; 3]; 3] {
    let less = |edge: [f64; 3], other: [f64; 3], times: i64| {
        [0, 1, 2].map(|axis| if times == 0 { edge[axis] } else { edge[axis] - times as f64 * other[axis] })
    };
    let b = less(b, a, b_by_a);
    [a, b, less(less(c, b, c_by_b), a, c_by_a)]
}

/// The same displacement, counted in those edges.
pub(crate) fn counted_anew([i, j, k]: [i64; 3], [b_by_a, c_by_a, c_by_b]: [i64; 3]) -> [i64; 3] {
    [i + j * b_by_a + k * c_by_a, j + k * c_by_b, k]
}

#[cfg(test)]
mod tests {
    use super::{Lattice, brought_back, counted_anew, is_behind};

    /// A cell that leans over.
    fn tilted() -> Lattice {
        let edges = [[4.0, 0.0, 0.0], [1.0, 2.0, 0.0], [-1.5, 0.5, 3.0]];
        Lattice { origin: [1.0, -1.0, 0.5], edges, periodic: [true; 3] }
    }

    #[test]
    fn parts_of_the_edges_lead_back_to_the_point() {
        let cell = tilted();
        let away = cell.displacement([2, -1, 3]);
        let point = [0, 1, 2].map(|axis| cell.origin[axis] + 0.25 * cell.edges[0][axis] + away[axis]);
        assert_eq!(cell.edges_away(point), [2, -1, 3]);
        let parts = cell.parts(point);
        [2.25, -1.0, 3.0].iter().zip(parts).for_each(|(wanted, part)| assert!((part - wanted).abs() < 1e-14));
    }

    #[test]
    fn heights_are_the_volume_over_the_area_of_the_faces() {
        let cell = tilted();
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let area = |a, b| cross(a, b).iter().map(|part| part * part).sum::<f64>().sqrt();
        let [a, b, c] = cell.edges;
        let expected = [area(b, c), area(c, a), area(a, b)].map(|area| cell.volume() / area);
        expected
            .iter()
            .zip(cell.heights())
            .for_each(|(wanted, height)| assert!((height - wanted).abs() < 1e-14, "{height} {wanted}"));
    }

    #[test]
    fn of_each_two_opposite_images_one_is_behind() {
        let cell = tilted();
        let mut images = Vec::new();
        cell.images(cell.origin, 0.0, &mut |image| images.push(image));
        // A corner is on three faces: its images at the seven other corners, none of them twice.
        assert_eq!(images.len(), 7);
        assert!(images.iter().all(|&image| is_behind(image) && !is_behind(image.map(|count| -count))));
    }

    #[test]
    fn edges_that_are_brought_back_span_the_same_points() {
        let edges = [[4.0, 0.0, 0.0], [9.0, 2.0, 0.0], [-21.5, 13.5, 3.0]];
        let cell = Lattice { edges, ..tilted() };
        let times = cell.leaning();
        let upright = Lattice { edges: brought_back(edges, times), ..cell };
        assert_eq!(upright.leaning(), [0; 3]);
        let [a, b, c] = upright.edges;
        assert!(b[0].abs() <= 0.5 * a[0] && c[0].abs() <= 0.5 * a[0] && c[1].abs() <= 0.5 * b[1], "{b:?} {c:?}");
        for count in [[1, 0, 0], [0, 1, 0], [0, 0, 1], [3, -7, 5]] {
            assert_eq!(cell.displacement(count), upright.displacement(counted_anew(count, times)), "{count:?}");
        }
    }
}
