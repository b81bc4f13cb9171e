//! A triangle as the search for feet wants it: all numbers side by side.

use crate::base::lanes::{Lane, Table};
use crate::base::number::{Number, Row, Vector};

/// What rounding may take from a distance, with room.
const ROUNDING: f64 = 1.0 + 1e-9;

/// Triangles, side by side: what the search for feet waits for is memory, and each fills two lines of the cache.
#[derive(Clone)]
pub(super) struct Faces(Table<4>);

/// A triangle. Heights and distances are taken from its first corner, so that a wall of triangles gives the bits of a plane.
#[derive(Clone, Copy)]
pub(super) struct Face<N = f64> {
    /// First corner \[m\].
    corner: Vector<N>,
    /// Unit normal.
    pub(super) normal: Vector<N>,
    /// For each edge the unit normal in the plane of the triangle that points away from it.
    outwards: [Vector<N>; 3],
    /// How far the second edge is from the first corner \[m\]; the others go through it.
    second: N,
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
impl std::fmt::Debug for Faces {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Faces")
    }
}

impl Faces {
    /// Those with these corners \[m\].
    pub(super) fn of(corners: impl Iterator<Item = [Vector; 3]>) -> Self {
        Self(Table::of(corners.map(|corners| Face::of(corners).to_rows())))
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// A triangle.
    #[inline(always)]
    pub(super) fn at(&self, triangle: u32) -> Face {
        Face::of_rows(*self.0.at(triangle as usize))
    }

    /// The first of these triangles, one in each lane.
    #[inline(always)]
    pub(super) fn in_lanes<N: Lane>(&self, triangles: &[u32; 8]) -> Face<N> {
        Face::of_rows(self.0.columns(triangles))
    }

    /// Moves each to other corners \[m\].
    pub(super) fn follow(&mut self, corners: impl Iterator<Item = [Vector; 3]>) {
        self.0.iter_mut().zip(corners).for_each(|(rows, corners)| *rows = Face::of(corners).to_rows());
    }

    /// Whether they are too many for the first cache, whose other half is for the particles.
    pub(super) fn are_many(&self) -> bool {
        self.0.bytes() > FIRST_CACHE / 2
    }

    /// Asks the memory for a triangle, if it is there.
    pub(super) fn prefetch(&self, triangle: u32) {
        self.0.prefetch(triangle as usize);
    }
}

/// What the first cache of every processor of the last ten years holds at least \[bytes\].
const FIRST_CACHE: usize = 1 << 15;

impl Face {
    /// A triangle.
    fn of(corners: [Vector; 3]) -> Self {
        let [a, b, c] = corners;
        let unit = |vector: Vector| crate::laws::surface::direction(vector.to_array()).map_or(vector, Vector::from);
        let normal = unit((b - a).cross(c - a));
        let outwards = [b - a, c - b, a - c].map(|way| unit(way.cross(normal)));
        Self { corner: a, normal, outwards, second: outwards[1].dot(b - a) }
    }

    /// Its numbers, row by row.
    fn to_rows(self) -> [Row; 4] {
        let [first, second, third] = self.outwards;
        [
            self.corner.row_with(self.second),
            self.normal.row_with(first.x),
            [first.y, first.z, second.x, second.y],
            third.row_with(second.z),
        ]
    }
}

impl<N: Number> Face<N> {
    /// The triangle with these numbers.
    #[inline(always)]
    fn of_rows([corner, normal, first, third]: [[N; 4]; 4]) -> Self {
        let outwards = [
            Vector::new(normal[3], first[0], first[1]),
            Vector::new(first[2], first[3], third[3]),
            Vector::of_row(third),
        ];
        Self { corner: Vector::of_row(corner), normal: Vector::of_row(normal), outwards, second: corner[3] }
    }

    /// Height of a centre over the plane of the triangle \[m\].
    #[inline(always)]
    pub(super) fn height(&self, centre: Vector<N>) -> N {
        (centre - self.corner).dot(self.normal)
    }

    /// How far the foot of a centre is beyond each edge \[m\].
    #[inline(always)]
    fn beyond(&self, centre: Vector<N>) -> [N; 3] {
        let from = centre - self.corner;
        let [first, second, third] = self.outwards;
        [from.dot(first), from.dot(second) - self.second, from.dot(third)]
    }

    /// Whether the foot of the centre of a sphere with this radius \[m\] is not well inside the triangle: it is outside, or so near
    /// to an edge that it may be on the next one as well.
    #[inline(always)]
    pub(super) fn is_beside(&self, centre: Vector<N>, radius: N) -> N::Mask {
        largest(self.beyond(centre)).greater(-(N::splat(BAND) * radius))
    }
}

impl Face {
    /// Whether a centre at this height over the triangle is nearer than `reach` to its plane, and its foot to the triangle \[m\].
    #[inline(always)]
    pub(super) fn is_within(&self, centre: Vector, reach: f64, height: f64) -> bool {
        height.abs() < reach && self.beyond(centre).iter().all(|beyond| *beyond < reach)
    }

    /// Whether the foot of a centre in the plane of the triangle is inside it.
    pub(super) fn is_over(&self, centre: Vector) -> bool {
        self.beyond(centre).iter().all(|beyond| *beyond <= 0.0)
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
fn largest<N: Number>([first, second, third]: [N; 3]) -> N {
    let larger = N::select(second.greater(first), second, first);
    N::select(third.greater(larger), third, larger)
}
