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

/// A number for each input. Written out for each count: a loop in every sum and product is most of what the compiler then
/// works at.
macro_rules! numbers {
    ($count:literal: $($own:ident $other:ident),+) => {
        impl<V: Lane> Slopes<V> for [V; $count] {
            #[inline(always)]
            fn none() -> Self {
                [V::zero(); $count]
            }

            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                let ([$($own),+], [$($other),+]) = (self, other);
                [$($own + $other),+]
            }

            #[inline(always)]
            fn minus(self, other: Self) -> Self {
                let ([$($own),+], [$($other),+]) = (self, other);
                [$($own - $other),+]
            }

            #[inline(always)]
            fn times(self, factor: V) -> Self {
                let [$($own),+] = self;
                [$($own * factor),+]
            }

            #[inline(always)]
            fn mixed(self, factor: V, other: Self, with: V) -> Self {
                let ([$($own),+], [$($other),+]) = (self, other);
                [$($own * factor + $other * with),+]
            }

            #[inline(always)]
            fn select(mask: V::Mask, yes: Self, no: Self) -> Self {
                let ([$($own),+], [$($other),+]) = (yes, no);
                [$(V::select(mask, $own, $other)),+]
            }

            #[inline(always)]
            fn within<W: Work>(work: W) -> W::Output {
                V::within(work)
            }
        }
    };
}

numbers!(1: a b);
#[cfg(test)]
numbers!(2: a b, c d);
#[cfg(test)]
numbers!(5: a b, c d, e f, g h, i j);
