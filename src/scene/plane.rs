//! Scenes whose particles stay in one plane.

use serde::Deserialize;
use std::f64::consts::PI;

/// `[run] plane`: the plane in which the centres of all particles stay.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionPlane {
    /// x and z: y is the same for all particles, nothing moves along y, and particles spin about y alone.
    Xz,
}

/// `[run] plane_particles`: what a particle's mass and moment of inertia are those of. Contact and bond laws see its
/// radius and mass alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum ParticleShape {
    /// A full sphere.
    #[default]
    #[serde(rename = "spheres")]
    Sphere,
    /// A disc of unit thickness \[1 m\] that lies in the plane.
    #[serde(rename = "discs")]
    Disc,
}

impl ParticleShape {
    /// Volume of a body of this radius \[m\] \[m³\].
    pub fn volume(self, radius: f64) -> f64 {
        match self {
            Self::Sphere => 4.0 / 3.0 * PI * radius.powi(3),
            Self::Disc => PI * radius.powi(2),
        }
    }

    /// Moment of inertia of a body of this mass \[kg\] and radius \[m\]: of a sphere about any diameter, of a disc about its axis
    /// \[kg m²\].
    pub fn inertia(self, mass: f64, radius: f64) -> f64 {
        let share = match self {
            Self::Sphere => 0.4,
            Self::Disc => 0.5,
        };
        share * mass * radius * radius
    }
}
