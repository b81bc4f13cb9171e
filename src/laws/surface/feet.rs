//! Where a sphere touches a surface of several features: faces, edges, vertices, or what they are in a profile.
//!
//! Every simplex of a surface has its own nearest point, its foot, and a weight; over the simplices whose feet fall
//! together the weights add up to a whole number, which is what counts:
//!
//! ```text
//! triangle +1     edge 1 − k_e     vertex 1 − k_v + Σ_e (k_e − 1)     (profile: segment +1, corner 1 − k)
//!
//! flat, convex, rim: once      concave, edge out of reach: both faces      concave, edge within reach: both less the edge
//! ```
//!
//! By the Euler characteristic of what the surface and a ball have in common, the energy of a sphere is ∫ F(R − s) χ(B(x, s) ∩ S) ds
//! whatever the triangulation: the force is continuous and conservative over flat, convex and concave bends, without a
//! tolerance.

use crate::base::lanes::Width;
use crate::base::number::{Row, Vector};
use std::fmt::Debug;

/// Where a sphere touches one feature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// The feature on which the foot lies.
    pub feature: u32,
    /// Distance of the centre from the foot \[m\].
    pub distance: f64,
    /// Unit normal from the foot to the centre, in the axes of the surface.
    pub normal: Vector,
    /// How often the contact counts: once, and less than no times at a saddle.
    pub weight: f64,
    /// What the overlap changes by for a way along the normal, over that way: 1, and less beside an axis where a sphere touches
    /// all around it. The normal force has the same share.
    pub slope: f64,
}

/// Share of the radius of a sphere in which its centre may come from one side of a surface to the other in one time step: a
/// particle goes half of it at most, a surface [`SLOW`] of it.
pub const DEEP: f64 = 0.8;

/// Share of the smallest radius that a surface goes in a time step without a look at all particles.
pub const SLOW: f64 = 0.25;

/// Halvings of the way of a centre before what is still as near as a half counts as passed.
const HALVINGS: u32 = 12;

/// What rounding may take from a half of a way, with room.
const ROOM: f64 = 1.125;

/// A feature of negative weight between two faces that both carry the sphere. It has no friction of its own; that of the
/// faces becomes less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saddle {
    /// The feature.
    pub feature: u32,
    /// The faces.
    pub faces: [u32; 2],
    /// Shares of its force that the faces' friction has less of: they add up to 1.
    pub shares: [f64; 2],
}

/// Everything that a sphere touches of a surface.
#[derive(Clone, Debug, Default)]
pub struct Feet {
    /// The feet, by ascending feature.
    pub list: Vec<Foot>,
    /// The saddles among them.
    pub saddles: Vec<Saddle>,
    /// Whether the centre is behind a part that does not count from there, and nearer to it than [`DEEP`] of the radius.
    pub behind: bool,
    /// Room for who finds them.
    pub(crate) room: [Vec<u32>; 2],
    /// Room for the parts and the feet of one of several copies.
    pub(super) of_one: Option<Box<(Vec<u32>, Feet)>>,
}

impl Feet {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.list.clear();
        self.saddles.clear();
        self.behind = false;
    }

    /// Whether the centre of a sphere with this radius \[m\] may just have come through the surface.
    pub fn are_deep(&self, radius: f64) -> bool {
        self.behind || self.list.iter().any(|foot| foot.distance < DEEP * radius)
    }

    /// The foot on a feature.
    pub fn on(&self, feature: u32) -> Option<&Foot> {
        self.list.iter().find(|foot| foot.feature == feature)
    }

    /// Adds a saddle of two faces, by the distances of their feet from its own \[m\].
    pub fn add_saddle(&mut self, feature: u32, faces: [u32; 2], [first, second]: [f64; 2]) {
        let both = first + second;
        let share = if both > 0.0 { second / both } else { 0.5 };
        self.saddles.push(Saddle { feature, faces, shares: [share, 1.0 - share] });
    }
}

/// Spheres that are looked at together where each is near parts of one plane.
pub const TOGETHER: usize = 32;

/// The feature of a sphere that is near parts of no plane.
pub const NO_PLANE: u32 = u32::MAX;

/// Spheres, each near parts of one plane, and what one part of this plane tells of each. Behind the last sphere stands anything.
#[derive(Clone, Copy, Debug)]
pub struct OnPlanes {
    /// How many there are.
    pub count: usize,
    /// Centre, in the axes of the surface, and radius of each \[m\].
    pub sphere: [Row; TOGETHER],
    /// The part that is asked: its feature.
    pub feature: [u32; TOGETHER],
    /// The unit normal from the foot on the part to the centre, and the distance \[m\].
    pub foot: [Row; TOGETHER],
    /// A bit for each sphere that touches its plane in this foot, and in no other one.
    pub touching: u32,
    /// A bit for each that does not touch its plane. Of the rest nothing is known: all parts are to be looked at.
    pub away: u32,
}

impl OnPlanes {
    /// No spheres.
    pub fn none() -> Self {
        let rows = [[0.0; 4]; TOGETHER];
        Self { count: 0, sphere: rows, feature: [NO_PLANE; TOGETHER], foot: rows, touching: 0, away: 0 }
    }
}

/// A surface of features. Positions are in the axes of the surface, as it stands at time 0.
pub trait Features: Debug + Send + Sync {
    /// Adds the parts within reach of a centre, ascending. A surface of few parts adds one whenever any is.
    fn near(&self, centre: Vector, reach: f64, parts: &mut Vec<u32>);

    /// How many parts, and how many features, there are: those of a saved contact are below.
    fn counts(&self) -> [usize; 2];

    /// Finds the feet on these parts that are nearer to a centre than `radius` \[m\].
    fn feet(&self, centre: Vector, radius: f64, parts: &[u32], feet: &mut Feet);

    /// Whether the straight way of a centre, as the surface sees it, leads through it \[m\].
    fn is_passed(&self, way: [Vector; 2]) -> bool {
        is_passed(self, way, HALVINGS, &mut Vec::new())
    }

    /// The feature of the first of these parts, all that are within reach of a centre \[m\], if they lie in one plane that goes on
    /// to the end of this reach.
    fn plane(&self, _centre: Vector, _reach: f64, _parts: &[u32]) -> Option<u32> {
        None
    }

    /// What [`Features::feet`] finds where each sphere is near parts of one plane, by a look at one of them. The bits of all are 0
    /// before.
    fn on_planes(&self, _spheres: &mut OnPlanes, _width: Width) {}

    /// Asks the memory for what a look at these features needs, so that it is there soon.
    fn prefetch(&self, _features: &[u32]) {}

    /// Whether the history of a contact passes from one feature to another.
    fn meet(&self, one: u32, other: u32) -> bool;

    /// The largest distance of its points from a point; infinite where it has no end \[m\].
    fn extent(&self, point: Vector) -> f64;

    /// The same feature of the copy that stands by so many edges of a periodic cell beside.
    fn beside(&self, feature: u32, _by: [i64; 3]) -> Option<u32> {
        Some(feature)
    }
}

/// Whether a sphere with this radius \[m\] touches a surface somewhere on the straight way of its centre \[m\], and at neither end.
pub fn is_skipped(surface: &dyn Features, [from, to]: [Vector; 2], radius: f64) -> bool {
    let mut parts = Vec::new();
    let mut touches = |centre: Vector, reach: f64| {
        parts.clear();
        surface.near(centre, reach, &mut parts);
        !parts.is_empty()
    };
    let mut waiting = vec![([from, to], HALVINGS)];
    if touches(from, radius) || touches(to, radius) {
        return false;
    }
    while let Some(([from, to], halvings)) = waiting.pop() {
        let (half, middle) = (0.5 * (to - from).length(), (from + to) * 0.5);
        if !touches(middle, half + radius) {
            continue;
        }
        if touches(middle, radius) {
            return true;
        }
        if halvings > 0 && half > SLOW * radius {
            waiting.extend([[middle, to], [from, middle]].map(|way| (way, halvings - 1)));
        }
    }
    false
}

/// Whether the way of a centre leads through a surface, by what is near to the middle of ever smaller parts of it.
fn is_passed(surface: &(impl Features + ?Sized), [from, to]: [Vector; 2], halvings: u32, parts: &mut Vec<u32>) -> bool {
    let (half, middle) = (0.5 * (to - from).length(), (from + to) * 0.5);
    parts.clear();
    surface.near(middle, ROOM * half, parts);
    if parts.is_empty() || half == 0.0 || halvings == 0 {
        return !parts.is_empty() && half > 0.0;
    }
    is_passed(surface, [from, middle], halvings - 1, parts) || is_passed(surface, [middle, to], halvings - 1, parts)
}
