//! A triangle as the search for feet wants it: all numbers side by side.

use crate::number::Vector;

/// A triangle. Heights and distances are taken from its first corner, so that a wall of triangles gives the bits of a plane.
/// It fills two lines of the cache: what the search for feet waits for is memory.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Face {
    /// First corner \[m\].
    corner: Vector,
    /// Unit normal.
    pub(super) normal: Vector,
    /// For each edge the unit normal in the plane of the triangle that points away from it.
    outwards: [Vector; 3],
    /// How far the second edge is from the first corner \[m\]; the others go through it.
    second: f64,
}

/// How the foot of a centre in the plane of a triangle stands to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stand {
    /// Inside or outside; which edges are within reach.
    Near {
        /// Whether the foot is inside.
        over: bool,
        /// The edges within reach.
        edges: [bool; 3],
    },
    /// Outside, and the triangle is out of reach.
    Apart,
}

/// Nothing but the name: all numbers follow from the topology, which is told already where scenes are compared.
impl std::fmt::Debug for Face {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Face")
    }
}

impl Face {
    /// A triangle.
    pub(super) fn of(corners: [Vector; 3]) -> Self {
        let [a, b, c] = corners;
        let unit = |vector: Vector| crate::surface::direction(vector.to_array()).map_or(vector, Vector::from);
        let normal = unit((b - a).cross(c - a));
        let outwards = [b - a, c - b, a - c].map(|way| unit(way.cross(normal)));
        Self { corner: a, normal, outwards, second: outwards[1].dot(b - a) }
    }

    /// Height of a centre over the plane of the triangle \[m\].
    #[inline(always)]
    pub(super) fn height(&self, centre: Vector) -> f64 {
        (centre - self.corner).dot(self.normal)
    }

    /// How far the foot of a centre is beyond each edge \[m\].
    #[inline(always)]
    fn beyond(&self, centre: Vector) -> [f64; 3] {
        let from = centre - self.corner;
        let [first, second, third] = self.outwards;
        [from.dot(first), from.dot(second) - self.second, from.dot(third)]
    }

    /// Whether the foot of a centre in the plane of the triangle is inside it.
    pub(super) fn is_over(&self, centre: Vector) -> bool {
        self.beyond(centre).iter().all(|beyond| *beyond <= 0.0)
    }

    /// How the foot of a centre stands to the triangle, where the square of a radius goes beyond that of the height by `rest`
    /// \[m²\].
    #[inline(always)]
    pub(super) fn stand(&self, centre: Vector, rest: f64) -> Stand {
        /// What rounding may take from a distance, with room.
        const ROUNDING: f64 = 1.0 + 1e-9;
        let beyond = self.beyond(centre);
        let edges = beyond.map(|beyond| beyond * beyond <= rest * ROUNDING);
        if (0..3).any(|edge| beyond[edge] > 0.0 && !edges[edge]) {
            return Stand::Apart;
        }
        Stand::Near { over: beyond.iter().all(|beyond| *beyond <= 0.0), edges }
    }
}
