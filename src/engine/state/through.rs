//! Particles that touch each other through a thin surface.

use super::contacts::{TOUCHING, is_suppressed};
use super::{ContactList, Named, Particles};
use serde::{Deserialize, Serialize};

/// Pairs of particles with a surface between them. Contacts of particles do not know surfaces: such a pair acts as if nothing were there.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Through {
    /// Near pairs that a surface was between when the lists were made; none once two have touched.
    pub pairs: Vec<Separated>,
    /// The first two that touched.
    pub first: Option<TouchedThrough>,
}

/// A near pair with a surface between its particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Separated {
    /// Index of the list of contacts.
    pub list: u32,
    /// The entry in it.
    pub entry: u32,
    /// The boundary.
    pub boundary: u32,
}

/// Two particles that touched each other through a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TouchedThrough {
    /// The particles.
    pub particles: [Named; 2],
    /// The boundary.
    pub boundary: u32,
    /// When \[s\].
    pub time: f64,
}

impl Through {
    /// Notes the first of the pairs that touches at this time \[s\], if any does.
    pub(crate) fn look(&mut self, contacts: &[ContactList], particles: &Particles, time: f64) {
        let touches = |pair: &&Separated| {
            let flags = contacts[pair.list as usize].flags[pair.entry as usize];
            flags & TOUCHING != 0 && !is_suppressed(flags)
        };
        let Some(&Separated { list, entry, boundary }) = self.pairs.iter().find(touches) else { return };
        let (list, entry) = (&contacts[list as usize], entry as usize);
        let particles = [list.first[entry], list.second[entry]].map(|slot| Named::at(particles, slot));
        self.first = Some(TouchedThrough { particles, boundary, time });
        self.pairs.clear();
    }

    /// Whether it can be that of a state with these lists of contacts and so many boundaries.
    pub(super) fn is_sound(&self, contacts: &[ContactList], boundaries: usize) -> bool {
        let is_boundary = |boundary: u32| (boundary as usize) < boundaries;
        let is_entry = |pair: &Separated| {
            contacts.get(pair.list as usize).is_some_and(|list| (pair.entry as usize) < list.flags.len())
                && is_boundary(pair.boundary)
        };
        let first = self.first.is_none_or(|first| first.time.is_finite() && is_boundary(first.boundary));
        first && self.pairs.iter().all(is_entry)
    }
}
