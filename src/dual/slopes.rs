//! Slopes of numbers, in memory or in registers.
//!
//! Nothing here makes arrays by closures: those are not always compiled in line, and then not for the features of the registers.

use crate::lanes::{Lane, Work};
use crate::number::Number;

/// How a number, or a register of numbers `V`, changes with some inputs.
pub trait Slopes<V: Number>: Copy + Send + Sync + 'static {
    /// Those of numbers that do not change.
    fn none() -> Self;

    /// The sums with other slopes.
    fn plus(self, other: Self) -> Self;

    /// The differences from other slopes.
    fn minus(self, other: Self) -> Self;

    /// Multiples of the slopes.
    fn times(self, factor: V) -> Self;

    /// Multiples of the slopes and of others, added.
    fn mixed(self, factor: V, other: Self, with: V) -> Self;

    /// `yes` where the mask holds, otherwise `no`.
    fn select(mask: V::Mask, yes: Self, no: Self) -> Self;

    /// Does something with the features of the processor that the registers come from.
    fn within<W: Work>(work: W) -> W::Output;
}

/// A number for each input.
impl<V: Lane, const D: usize> Slopes<V> for [V; D] {
    #[inline(always)]
    fn none() -> Self {
        [V::zero(); D]
    }

    #[inline(always)]
    fn plus(mut self, other: Self) -> Self {
        for d in 0..D {
            self[d] = self[d] + other[d];
        }
        self
    }

    #[inline(always)]
    fn minus(mut self, other: Self) -> Self {
        for d in 0..D {
            self[d] = self[d] - other[d];
        }
        self
    }

    #[inline(always)]
    fn times(mut self, factor: V) -> Self {
        for slope in &mut self {
            *slope = *slope * factor;
        }
        self
    }

    #[inline(always)]
    fn mixed(mut self, factor: V, other: Self, with: V) -> Self {
        for d in 0..D {
            self[d] = self[d] * factor + other[d] * with;
        }
        self
    }

    #[inline(always)]
    fn select(mask: V::Mask, mut yes: Self, no: Self) -> Self {
        for d in 0..D {
            yes[d] = V::select(mask, yes[d], no[d]);
        }
        yes
    }

    #[inline(always)]
    fn within<W: Work>(work: W) -> W::Output {
        V::within(work)
    }
}
