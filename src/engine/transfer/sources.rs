//! What heat sources warm.

use super::flows::{Body, body};
use crate::engine::state::{GONE, State};
use crate::scene::HeatSource;

/// The slots of the particles that a source warms: a clump counts as one.
pub(super) fn warmed(source: &HeatSource, state: &State) -> impl Iterator<Item = u32> {
    source.members.iter().filter_map(|&member| {
        let slot = state.particles.slot[member as usize];
        let is_there =
            slot != GONE && matches!(body(state, slot as usize), Body::Particle(index) if index == member as usize);
        is_there.then_some(slot)
    })
}
