//! SSE2, AVX2 and AVX-512 registers of x86-64.

mod eight;
mod four;
mod two;

pub use eight::Eight;
pub use four::Four;
pub use two::Two;

use super::Kernel;

/// Runs a kernel with AVX2.
///
/// # Safety
/// The processor offers AVX2 and POPCNT.
#[target_feature(enable = "avx2,popcnt")]
pub(super) unsafe fn run_four<K: Kernel>(kernel: K) {
    kernel.run::<Four>();
}

/// Runs a kernel with AVX-512.
///
/// # Safety
/// The processor offers AVX-512 F, VL and DQ, and POPCNT.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,popcnt")]
pub(super) unsafe fn run_eight<K: Kernel>(kernel: K) {
    kernel.run::<Eight>();
}

/// An operator of one register type by its intrinsic.
macro_rules! operator {
    ($name:ident, $operator:ident, $method:ident, $intrinsic:ident) => {
        impl $operator for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: such a register exists only where the processor offers it.
                unsafe { Self($intrinsic(self.0, other.0)) }
            }
        }
    };
}

/// Negation flips the sign bit, also of zero, as scalar negation does.
macro_rules! negation {
    ($name:ident, $xor:ident, $splat:ident) => {
        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: such a register exists only where the processor offers it.
                unsafe { Self($xor(self.0, $splat(-0.0))) }
            }
        }
    };
}

use {negation, operator};
