//! Parts of space: how much of a sphere lies inside, and which part of a line.
//!
//! A region has no body. It is looked at where it stands at time 0; whoever asks about one that moved hands in positions
//! less its displacement.

mod crossing;
mod cuboid;
mod cut;
mod cylinder;
mod grid;
mod keys;
mod quadrature;
mod solid;
mod sphere;

use crate::base::number::Vector;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use grid::{Centres, Grid, Weights};
pub(crate) use keys::Keys;
pub use solid::Solid;

/// What a region looks like.
#[derive(Clone, Debug)]
pub enum Region {
    /// A box along the axes of the scene.
    Box(Cuboid),
    /// A cylinder between two points.
    Cylinder(Cylinder),
    /// The inside of a closed mesh.
    Solid(Solid),
}

impl Region {
    /// Its volume \[m³\].
    pub fn volume(&self) -> f64 {
        match self {
            Self::Box(cuboid) => cuboid.volume(),
            Self::Cylinder(cylinder) => cylinder.volume(),
            Self::Solid(solid) => solid.volume(),
        }
    }

    /// Whether a point \[m\] is inside.
    pub fn holds(&self, point: Vector) -> bool {
        match self {
            Self::Box(cuboid) => cuboid.holds(point),
            Self::Cylinder(cylinder) => cylinder.holds(point),
            Self::Solid(solid) => solid.holds(point),
        }
    }

    /// The smallest box around it: lower and upper corner \[m\].
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        match self {
            Self::Box(cuboid) => cuboid.corners,
            Self::Cylinder(cylinder) => cylinder.bounds(),
            Self::Solid(solid) => solid.bounds(),
        }
    }

    /// The centre of a sphere of this radius \[m\] that lies whole inside, all places equally likely; none where it does not fit. `uniform` hands
    /// out numbers from 0 to below 1.
    pub fn place(&self, radius: f64, uniform: &mut dyn FnMut() -> f64) -> Option<Vector> {
        match self {
            Self::Box(cuboid) => cuboid.place(radius, uniform),
            Self::Cylinder(cylinder) => cylinder.place_of(radius, uniform),
            Self::Solid(solid) => solid.place(radius, uniform),
        }
    }

    /// Volume of the part of a sphere that is inside, from its centre \[m\] and radius \[m\] \[m³\]: for a box and for a mesh
    /// in closed form, to rounding of the sphere's volume; for a cylinder to 1e-12 of it.
    pub fn volume_of_sphere(&self, centre: Vector, radius: f64) -> f64 {
        match self {
            Self::Box(cuboid) => cuboid.volume_of_sphere(centre, radius),
            Self::Cylinder(cylinder) => cylinder.volume_of_sphere(centre, radius),
            Self::Solid(solid) => solid.volume_of_sphere(centre, radius),
        }
    }

    /// The part of the line between two points \[m\] that is inside, over its length.
    pub fn share_of_line(&self, from: Vector, to: Vector) -> f64 {
        match self {
            Self::Box(cuboid) => cuboid.share_of_line(from, to),
            Self::Cylinder(cylinder) => length_inside(cylinder.passage(from, to - from)),
            Self::Solid(solid) => solid.share_of_line(from, to),
        }
    }
}

/// Where a line is between two parallel planes: from this multiple of its way to that one. `height` is that of its beginning
/// over the lower plane, `rise` what it gains along its way, `between` the distance of the planes \[m\]. The lower plane is inside, the
/// upper one is not: of parts that fill space each line is in one.
fn between_planes(height: f64, rise: f64, between: f64) -> [f64; 2] {
    if rise == 0.0 {
        return if (0.0..between).contains(&height) { EVERYWHERE } else { NOWHERE };
    }
    let (low, high) = (-height / rise, (between - height) / rise);
    [low.min(high), low.max(high)]
}

/// How much of a line is inside that is so from this multiple of its way to that one.
fn length_inside([enters, leaves]: [f64; 2]) -> f64 {
    (leaves.min(1.0) - enters.max(0.0)).max(0.0)
}

/// A line that is inside all along.
const EVERYWHERE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// A line that is nowhere inside.
const NOWHERE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Where a line is in both of two parts.
fn in_both(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    [one[0].max(other[0]), one[1].min(other[1])]
}

#[cfg(test)]
mod tests;

#[cfg(test)]
mod grid_tests;

#[cfg(test)]
mod solid_tests;
