//! The velocity along the normal that a dashpot sees, where springs are not carried.

use super::touch::{is_near_touch, share_of_step, weight_of};
use crate::base::number::Number;
use crate::laws::contact::{Contact, Onset};

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::{assert_close, contact};

    /// A step \[s\].
    const STEP: f64 = 1e-3;

    /// What a dashpot sees of a contact with this overlap \[m\] and this velocity at mid-step \[m/s\], and what is found beside it.
    fn seen(overlap: f64, [middle, before]: [f64; 2], onset: Onset, step: f64) -> (f64, Foreseen<f64>) {
        let mut contact = Contact { overlap, normal_velocity: middle, ..contact() };
        let foreseen = foresee_normal(&mut contact, before, onset, step);
        (contact.normal_velocity, foreseen)
    }

    #[test]
    fn velocity_goes_on_by_half_of_what_it_changed() {
        let (velocity, Foreseen { middle, weight }) = seen(1.0, [-0.5, -0.75], Onset::Constant, STEP);
        assert_eq!([velocity, middle, weight], [-0.375, -0.5, 1.0]);
    }

    #[test]
    fn a_contact_that_begins_has_the_velocity_of_the_middle_and_the_weight_of_its_time() {
        // Half of the way of the step before touch; until the next mid-step the bodies touch for ½ + ½ of a step.
        let (velocity, Foreseen { middle, weight }) = seen(0.25e-3, [-0.5, 0.0], Onset::Constant, STEP);
        assert_eq!([velocity, middle, weight], [-0.5, -0.5, 1.0]);
        // A quarter: ¼ + ½.
        let (velocity, Foreseen { weight, .. }) = seen(0.125e-3, [-0.5, 0.0], Onset::Constant, STEP);
        assert_eq!([velocity, weight], [-0.375, 0.75]);
        // ∫ t^½ from 0 to ¾ over ¼^½: ⅔ · ¾ · √3
        let weight = seen(0.125e-3, [-0.5, 0.0], Onset::SquareRoot, STEP).1.weight;
        assert_close(weight, 0.5 * 3.0_f64.sqrt(), 1e-14);
    }

    #[test]
    fn a_contact_that_ends_within_the_next_step_counts_for_what_is_left() {
        // It goes on for a quarter of a step, and was there for half a step before.
        let (velocity, Foreseen { weight, .. }) = seen(0.125e-3, [0.5, 0.5], Onset::Constant, STEP);
        assert_eq!([velocity, weight], [0.375, 0.75]);
    }

    #[test]
    fn nothing_is_foreseen_or_remembered_before_the_first_step_nor_weighed_where_a_model_does_not_say_how() {
        let (velocity, Foreseen { middle, weight }) = seen(0.125e-3, [-0.5, -0.25], Onset::Constant, 0.0);
        assert_eq!([velocity, middle, weight], [-0.5, -0.25, 1.0]);
        assert_eq!(seen(0.125e-3, [-0.5, 0.0], Onset::Unweighed, STEP).0, -0.5);
    }
}
