//! Courses of spheres over surfaces of features: facets are felt with the order of theory, energy is kept over bends, and neither
//! the triangulation nor the axes of the scene matter.
//!
//! Unless something else is said: radius 5 mm, density 2500 kg/m³, E = 5 MPa and ν = 0.3 of both.

mod drums;
mod meshes;
mod scenes;
