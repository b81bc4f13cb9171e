//! The deepest contact of a time step, where it is deeper than all before.

use super::{Bodies, Buffer};
use std::sync::{Mutex, PoisonError};

/// A contact that is deeper than all before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Found {
    /// Overlap over the smaller radius.
    pub(crate) overlap: f64,
    /// First body (slot).
    pub(crate) first: u32,
    /// Second body (slot), or what stands for it.
    pub(crate) second: u32,
}

/// Looks for a contact that is deeper than all before. Threads share it: what is found does not depend on their order.
#[derive(Debug)]
pub(crate) struct DeepestSearch {
    /// The overlap over the smaller radius that is to be exceeded.
    pub(super) so_far: f64,
    /// The deepest one that does.
    found: Mutex<Option<Found>>,
}

impl DeepestSearch {
    /// Of what exceeds this overlap over radius.
    pub(crate) fn beyond(so_far: f64) -> Self {
        Self { so_far, found: Mutex::new(None) }
    }

    /// What was found.
    pub(crate) fn found(self) -> Option<Found> {
        self.found.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    /// Looks through a batch of which some entry is deeper.
    #[cold]
    pub(super) fn look<B: Bodies>(&self, bodies: &B, buffer: &Buffer) {
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        for place in 0..buffer.ready {
            let (first, second) = (buffer.first[place], buffer.second[place]);
            let [overlap, radius] = buffer.depth(place);
            let overlap = overlap / B::smaller_radius(buffer.found.each_ref().map(|column| column[place]), radius);
            let counts = bodies.weights().is_none_or(|weights| weights[second as usize][0] > 0.0);
            let deepest = found.map_or((self.so_far, first, second), |it| (it.overlap, it.first, it.second));
            let is_deeper = overlap > deepest.0 || overlap == deepest.0 && (first, second) < (deepest.1, deepest.2);
            if counts && is_deeper {
                *found = Some(Found { overlap, first, second });
            }
        }
    }
}
