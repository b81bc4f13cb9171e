//! Breakage by distance alone.

use crate::bond::{Breakage, Cause, Coefficients, Elastic, Motion};
use crate::number::Number;

/// Breaks where the centres are further apart than `max_distance` (the engine without `stressBreak`);
/// with an infinite distance, never.
#[derive(Clone, Copy, Debug)]
pub struct Distance;

impl Breakage for Distance {
    #[inline(always)]
    fn judge<N: Number>(law: &Coefficients<N>, motion: &Motion<N>, _elastic: &Elastic<N>) -> N {
        let apart = motion.distance.greater(law.max_distance);
        N::select(apart, N::splat(Cause::Distance.code()), N::zero())
    }
}
