//! The velocity along the normal that a dashpot sees, where springs are not carried.

use super::touch::{is_near_touch, share_of_step, weight_of};
use crate::contact::{Contact, Onset};
use crate::number::Number;

/// What [`foresee_normal`] finds beside the velocity that the dashpot along the normal sees.
#[derive(Clone, Copy, Debug)]
pub struct Foreseen<N> {
    /// Velocity along the normal at mid-step, which is remembered \[m/s\].
    pub middle: N,
    /// Weight of dashpots, as by [`super::Carry::weigh`]. It is in the velocity along the normal already; slip stays that of mid-step, by
    /// which springs grow, and the weight counts for the damping coefficient γ_t.
    pub weight: N,
}

/// Gives a contact the velocity along its normal at the end of the step \[s\], from that of its middle and that of the step
/// `before` \[m/s\]. A contact that begins keeps the velocity of the middle.
#[inline(always)]
pub fn foresee_normal<N: Number>(contact: &mut Contact<N>, before: N, onset: Onset, step: N) -> Foreseen<N> {
    let (along, overlap, mut weight) = (contact.normal_velocity, contact.overlap, N::splat(1.0));
    let moved = step.greater(N::zero());
    let known = N::both(moved, before.abs().greater(N::zero()));
    let mut seen = along + N::select(known, (along - before) * N::splat(0.5), N::zero());
    let ways = [along * step, before * step];
    if onset != Onset::Unweighed && is_near_touch(overlap, ways) {
        weight = weight_of(overlap, share_of_step(overlap, ways[0]), onset, ways);
        seen = seen * weight;
    }
    contact.normal_velocity = seen;
    Foreseen { middle: N::select(moved, along, before), weight }
}
