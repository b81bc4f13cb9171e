//! Meshes whose nodes the outside moves: forces of the nodes are those of theory on faces, edges and vertices, add up to force and
//! moment of the surface, and do its work; the surface moves as its nodes do.
//!
//! Unless something else is said: radius 5 mm, E = 5 MPa and ν = 0.3 of both, restitution 0.5, friction 0.4, rolling friction 0.1.

mod forces;
mod scenes;
mod work;
