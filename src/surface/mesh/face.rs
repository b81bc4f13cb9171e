//! A triangle as the search for feet wants it: all numbers side by side.

use crate::memory::prefetch;
use crate::number::Vector;

/// What rounding may take from a distance, with room.
const ROUNDING: f64 = 1.0 + 1e-9;

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

/// The sine of the angle at an edge below which it is flat: vertices in single precision give 1e-7 and more.
pub(super) const FLAT: f64 = 1e-6;

/// Where the foot of a centre is nearer to a flat edge than this share of the radius, it may lie on both triangles or on none:
/// some ten times what their angle makes of the distance of the centre.
const BAND: f64 = 10.0 * FLAT;

/// What a triangle has to do with a sphere near it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// The foot is on the triangle, and what its edges count cancels: they are flat or out of reach.
    Over,
    /// The triangle is out of reach, or the foot is on another one in the same plane.
    Away,
    /// An edge within reach is not flat, or the foot is on an edge.
    AtBend,
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

    /// Asks the memory for both of its lines.
    pub(super) fn prefetch(&self) {
        prefetch(&raw const *self);
        prefetch(&raw const self.second);
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

    /// Whether the foot of the centre of a sphere with this radius \[m\] is inside the triangle, and not so near to an edge that
    /// it may be on the next one as well.
    #[inline(always)]
    pub(super) fn is_well_over(&self, centre: Vector, radius: f64) -> bool {
        largest(self.beyond(centre)) <= -BAND * radius
    }

    /// How a centre stands to the triangle where edges within reach are flat, a bit for each edge in `flat`; `rest` as for
    /// [`Face::stand`], `radius` that of the sphere \[m\].
    #[inline(always)]
    pub(super) fn place(&self, centre: Vector, rest: f64, radius: f64, flat: u8) -> Place {
        let beyond = self.beyond(centre);
        let [first, second, third] = beyond.map(|beyond| beyond * beyond.abs());
        let (most, reach) = (largest([first, second, third]), rest * ROUNDING);
        if most > reach {
            return Place::Away;
        }
        if most < -reach {
            return Place::Over;
        }
        let near = [first, second, third].map(|square| square >= -reach);
        let near = u8::from(near[0]) | u8::from(near[1]) << 1 | u8::from(near[2]) << 2;
        let (furthest, band) = (largest(beyond), BAND * radius);
        if near & !flat != 0 || furthest.abs() < band {
            Place::AtBend
        } else if furthest < 0.0 {
            Place::Over
        } else {
            Place::Away
        }
    }

    /// How the foot of a centre stands to the triangle, where the square of a radius goes beyond that of the height by `rest`
    /// \[m²\].
    #[inline(always)]
    pub(super) fn stand(&self, centre: Vector, rest: f64) -> Stand {
        let beyond = self.beyond(centre);
        let edges = beyond.map(|beyond| beyond * beyond <= rest * ROUNDING);
        if (0..3).any(|edge| beyond[edge] > 0.0 && !edges[edge]) {
            return Stand::Apart;
        }
        Stand::Near { over: beyond.iter().all(|beyond| *beyond <= 0.0), edges }
    }
}

/// The largest of three finite numbers; the maximum of the standard library takes longer, for numbers that are not.
#[inline(always)]
fn largest([first, second, third]: [f64; 3]) -> f64 {
    let larger = if second > first { second } else { first };
    if third > larger { third } else { larger }
}
