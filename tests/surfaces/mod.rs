//! Surfaces of features: the force is that of theory on faces, edges, vertices, bends and in corners, does not feel the
//! triangulation, and what crosses the surface balances.
//!
//! Unless something else is said: radius 5 mm, E = 5 MPa and ν = 0.3 of both, hence E* = 2.7473 MPa; F(δ) = 4/3 E* √(R δ³).

mod balances;
mod boxes;
mod courses;
pub(crate) mod every_surface;
mod forces;
mod on_axis;
mod scenes;
mod through;
mod turned;
