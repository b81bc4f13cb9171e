//! For which part of a step bodies touched, and what that makes of a dashpot that begins or ends within it.

use crate::base::number::Number;
use crate::laws::contact::Onset;

/// Part of an overlap below which a contact did not press a step ago.
const SHALLOW: f64 = 1e-9;

/// Part of the step in which bodies touched that now overlap and moved apart by `leaving` in it \[m\].
#[inline(always)]
pub(super) fn share_of_step<N: Number>(overlap: N, leaving: N) -> N {
    let (approach, mut share) = (-leaving, N::splat(1.0));
    let begins = N::both(approach.greater(overlap), overlap.greater(N::zero()));
    if N::any(begins) {
        share = N::select(begins, overlap / approach, share);
    }
    share
}

/// Whether any contact is so shallow that it may have begun or may end within a step, by the ways along the normal in this step
/// and in the one before it \[m\]: where not, [`weight_of`] is 1.
#[inline(always)]
pub(super) fn is_near_touch<N: Number>(overlap: N, [leaving, left]: [N; 2]) -> bool {
    let way = (leaving.abs() + left.abs()) * N::splat(2.0) + N::splat(f64::MIN_POSITIVE);
    N::any(way.greater(overlap))
}

/// The weight of [`super::Carry::weigh`], by the overlap, the part of the step in which the bodies touched and the ways along the
/// normal in this step and in the one before it \[m\].
#[inline(always)]
pub(super) fn weight_of<N: Number>(overlap: N, share: N, onset: Onset, [leaving, left]: [N; 2]) -> N {
    let (zero, half, one) = (N::zero(), N::splat(0.5), N::splat(1.0));
    let earlier = overlap + leaving;
    // Also a contact that touched a step ago without pressing began in this step: the last bits are not to tell.
    let began = N::either(one.greater(share), (overlap * N::splat(SHALLOW)).greater(earlier));
    let ends = N::both(leaving.greater(overlap), overlap.greater(zero));
    let stayed = N::both(left.greater(earlier), earlier.greater(overlap * N::splat(SHALLOW)));
    // A plane touches what does not press on it yet: that dashpot begins with the next step.
    let flat = N::splat(f64::MIN_POSITIVE).greater(overlap);
    let weighed = N::either(N::either(began, ends), N::either(stayed, flat));
    if !N::any(weighed) {
        return one;
    }
    let since = N::select(stayed, one - earlier / N::select(stayed, left, one), half);
    // ∫ of t^p over the time of touch, over the p-th power of the time between touch and now; with p = 0 in the midst of it
    let part = N::select(began, share, N::select(ends, overlap / N::select(ends, leaving, one), half));
    let reach = part + N::select(began, half, since);
    let edge = N::either(began, ends);
    let ratio = N::select(edge, reach / part, one);
    let weight = match onset {
        Onset::Unweighed | Onset::Constant => reach,
        Onset::FourthRoot => reach * ratio.sqrt().sqrt() * N::select(edge, N::splat(0.8), one),
        Onset::SquareRoot => reach * ratio.sqrt() * N::select(edge, N::splat(2.0 / 3.0), one),
    };
    N::select(flat, zero, N::select(weighed, weight, one))
}
