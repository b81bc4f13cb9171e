//! SSE2, AVX2 and AVX-512 registers of x86-64.

mod eight;
mod four;
mod two;

pub use eight::Eight;
pub use four::Four;
pub use two::Two;

use super::Kernel;
use std::arch::x86_64::*;

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

/// Which of eight numbers are equal to another, a bit for each, the first one lowest.
#[inline(always)]
pub(super) fn equal(numbers: &[u32; 8], wanted: u32) -> u32 {
    // SAFETY: SSE2 is part of x86-64; each half is four numbers.
    unsafe {
        let wanted = _mm_set1_epi32(wanted as i32);
        let half = |from: usize| _mm_cmpeq_epi32(_mm_loadu_si128(numbers[from..].as_ptr().cast()), wanted);
        let words = _mm_packs_epi32(half(0), half(4));
        _mm_movemask_epi8(_mm_packs_epi16(words, words)) as u32 & 0xff
    }
}

/// The operators of one register type by their intrinsics.
macro_rules! operators {
    ($name:ident, $add:ident, $sub:ident, $mul:ident, $div:ident) => {
        operators!(@ $name, Add, add, $add);
        operators!(@ $name, Sub, sub, $sub);
        operators!(@ $name, Mul, mul, $mul);
        operators!(@ $name, Div, div, $div);
    };
    (@ $name:ident, $operator:ident, $method:ident, $intrinsic:ident) => {
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

use {negation, operators};
