//! Surfaces of triangles: read from files, cleaned, and asked which of their features a sphere touches.
//!
//! Which features count is decided by signed weights: a triangle counts +1, an edge of k triangles 1 − k, a vertex of k
//! triangles 1 − k + Σ (kₑ − 1) over its edges. The force of a sphere is the weighted sum of the forces of all simplices
//! in reach, each at its own closest point. It is the gradient of an energy, continuous, and the same for every
//! triangulation of one surface: at every point of the surface the weights of the simplices through it add up to 1, so
//! that the energy is an integral of the Euler characteristic of what the sphere covers.

mod coincident;
mod features;
mod obj;
mod read;
mod stl;
mod topology;
mod vtk;

pub use features::{Feature, Sides, Touch};
pub use read::{MeshError, Soup, read};
pub use topology::{Edge, Finding, SurfaceMesh};

use crate::geometry::rotation::attitude;
use crate::number::Vector;

/// A point as a vector.
fn vector([x, y, z]: [f64; 3]) -> Vector {
    Vector::new(x, y, z)
}

/// Where a mesh stands: every vertex is scaled, then turned, then shifted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Length of the file's unit \[m\].
    pub scale: f64,
    /// Rotation vector about the file's origin \[rad\].
    pub rotation: [f64; 3],
    /// Shift \[m\].
    pub offset: [f64; 3],
}

impl Default for Placement {
    fn default() -> Self {
        Self { scale: 1.0, rotation: [0.0; 3], offset: [0.0; 3] }
    }
}

impl Placement {
    /// Where a point of the file is \[m\].
    pub fn place(&self, point: [f64; 3]) -> [f64; 3] {
        let scaled = vector(point) * self.scale;
        let turned = match self.rotation == [0.0; 3] {
            true => scaled,
            false => attitude(vector(self.rotation)).turn(scaled),
        };
        (turned + vector(self.offset)).to_array()
    }
}
