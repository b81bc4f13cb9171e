//! The contact that has been the deepest so far.

use super::Particles;
use serde::{Deserialize, Serialize};

/// The deepest contact of all time steps so far, of those that no bond suppresses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Deepest {
    /// Its overlap over the smaller radius; 0 where nothing has touched.
    pub overlap: f64,
    /// When \[s\].
    pub time: f64,
    /// The particle.
    pub particle: Named,
    /// The other one; none at a surface.
    pub partner: Option<Named>,
    /// The boundary; none between particles.
    pub boundary: Option<u32>,
}

/// A particle that may be gone, and another at its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Named {
    /// Its index.
    pub index: u32,
    /// The number with which it came, if it did.
    pub number: Option<u32>,
}

impl Named {
    /// The particle in a slot.
    pub(crate) fn at(particles: &Particles, slot: u32) -> Self {
        let index = particles.id[slot as usize];
        Self { index, number: particles.number_of_inserted(index) }
    }
}

impl Deepest {
    /// Takes another one, if it is deeper.
    pub(crate) fn take(&mut self, other: Self) {
        if other.overlap > self.overlap {
            *self = other;
        }
    }
}
