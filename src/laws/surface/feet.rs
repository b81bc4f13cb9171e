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
    /// How often the normal force counts: once, and less than no times at a saddle.
    pub weight: f64,
    /// Whether the centre is behind the face; where the foot is on no face, never.
    pub behind: bool,
}

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
    /// Room for who finds them.
    pub(crate) room: [Vec<u32>; 2],
}

impl Feet {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.list.clear();
        self.saddles.clear();
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
    /// A bit for each whose centre is behind the part.
    pub behind: u32,
}

impl OnPlanes {
    /// No spheres.
    pub fn none() -> Self {
        let rows = [[0.0; 4]; TOGETHER];
        Self { count: 0, sphere: rows, feature: [NO_PLANE; TOGETHER], foot: rows, touching: 0, away: 0, behind: 0 }
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
}
