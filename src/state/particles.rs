//! The particles, laid out for the loops that read them.

use super::Row;
use serde::{Deserialize, Serialize};

/// Particles in the order of the neighbour list, rows of 32 bytes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Particles {
    /// x, y, z, radius \[m\].
    pub position: Vec<Row>,
    /// Velocity \[m/s\] and mass \[kg\].
    pub velocity: Vec<Row>,
    /// Angular velocity \[rad/s\] and moment of inertia \[kg m²\].
    pub angular_velocity: Vec<Row>,
    /// Force \[N\]; the fourth number is 0.
    pub force: Vec<Row>,
    /// Torque \[N m\]; the fourth number is 0.
    pub torque: Vec<Row>,
    /// Attitude since time 0 as a unit quaternion: scalar, x, y, z. Empty where no bond needs it.
    pub attitude: Vec<Row>,
    /// Index of the material.
    pub material: Vec<u32>,
    /// What moves the particle: 0, the forces on it; k + 1, boundary k, to whose group it belongs.
    pub owner: Vec<u32>,
    /// Index into the scene's particles, of each slot here.
    pub id: Vec<u32>,
    /// Slot here, of each of the scene's particles.
    pub slot: Vec<u32>,
}

impl Particles {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
}
