//! Four numbers in an AVX register.

use super::{negation, operators};
use crate::base::lanes::Lane;
use crate::base::number::{Number, Row};
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Four numbers in an AVX register.
#[derive(Clone, Copy)]
pub struct Four(__m256d);

operators!(Four, _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd);
negation!(Four, _mm256_xor_pd, _mm256_set1_pd);

impl Number for Four {
    type Mask = __m256d;
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: such a register exists only where the processor offers it; so in all of this block.
        unsafe { Self(_mm256_set1_pd(value)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see `splat`.
        unsafe { Self(_mm256_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see `splat`.
        unsafe { Self(_mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0)) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe { Self(_mm256_max_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe { Self(_mm256_min_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn greater(self, other: Self) -> __m256d {
        // SAFETY: see `splat`.
        unsafe { _mm256_cmp_pd::<_CMP_GT_OQ>(self.0, other.0) }
    }
    #[inline(always)]
    fn select(mask: __m256d, yes: Self, no: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe { Self(_mm256_blendv_pd(no.0, yes.0, mask)) }
    }
    #[inline(always)]
    fn both(one: __m256d, other: __m256d) -> __m256d {
        // SAFETY: see `splat`.
        unsafe { _mm256_and_pd(one, other) }
    }
    #[inline(always)]
    fn either(one: __m256d, other: __m256d) -> __m256d {
        // SAFETY: see `splat`.
        unsafe { _mm256_or_pd(one, other) }
    }
    #[inline(always)]
    fn any(mask: __m256d) -> bool {
        <Self as Lane>::bits(mask) != 0
    }
}

/// Turns four rows into four columns, or back.
#[inline(always)]
unsafe fn transpose_four([a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
    // SAFETY: called where AVX is offered.
    unsafe {
        let (ab_even, ab_odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        let (cd_even, cd_odd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
        [
            _mm256_permute2f128_pd::<0x20>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd),
            _mm256_permute2f128_pd::<0x31>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd),
        ]
    }
}

/// Lanes whose bit is set in the number of the row, in order, then any.
static ORDER_OF_FOUR: [[u32; 4]; 16] = orders_of_four();

/// The rows of [`ORDER_OF_FOUR`].
const fn orders_of_four() -> [[u32; 4]; 16] {
    let mut orders = [[0; 4]; 16];
    let mut bits = 0;
    while bits < 16 {
        let (mut lane, mut count) = (0, 0);
        while lane < 4 {
            if bits >> lane & 1 == 1 {
                orders[bits][count] = lane as u32;
                count += 1;
            }
            lane += 1;
        }
        bits += 1;
    }
    orders
}

/// The same for the two halves of each lane.
static HALVES_OF_FOUR: [[u32; 8]; 16] = halves_of_four();

/// The rows of [`HALVES_OF_FOUR`].
const fn halves_of_four() -> [[u32; 8]; 16] {
    let orders = orders_of_four();
    let mut halves = [[0; 8]; 16];
    let mut place = 0;
    while place < 16 * 8 {
        let (bits, half) = (place / 8, place % 8);
        halves[bits][half] = 2 * orders[bits][half / 2] + half as u32 % 2;
        place += 1;
    }
    halves
}

impl Lane for Four {
    const WIDTH: usize = 4;

    #[inline(always)]
    unsafe fn load_rows(rows: *const Row, index: *const u32) -> [Self; 4] {
        // SAFETY: the caller's promise.
        unsafe {
            let [x, y, z, w] = transpose_four([
                _mm256_loadu_pd(rows.add(*index as usize).cast()),
                _mm256_loadu_pd(rows.add(*index.add(1) as usize).cast()),
                _mm256_loadu_pd(rows.add(*index.add(2) as usize).cast()),
                _mm256_loadu_pd(rows.add(*index.add(3) as usize).cast()),
            ]);
            [Self(x), Self(y), Self(z), Self(w)]
        }
    }

    #[inline(always)]
    unsafe fn store_rows([x, y, z, w]: [Self; 4], rows: *mut Row, index: *const u32) {
        // SAFETY: the caller's promise.
        unsafe {
            let [a, b, c, d] = transpose_four([x.0, y.0, z.0, w.0]);
            _mm256_storeu_pd(rows.add(*index as usize).cast(), a);
            _mm256_storeu_pd(rows.add(*index.add(1) as usize).cast(), b);
            _mm256_storeu_pd(rows.add(*index.add(2) as usize).cast(), c);
            _mm256_storeu_pd(rows.add(*index.add(3) as usize).cast(), d);
        }
    }

    #[inline(always)]
    unsafe fn store_block([x, y, z, w]: [Self; 4], rows: *mut Row) {
        // SAFETY: the caller's promise.
        unsafe {
            let [a, b, c, d] = transpose_four([x.0, y.0, z.0, w.0]);
            _mm256_storeu_pd(rows.cast(), a);
            _mm256_storeu_pd(rows.add(1).cast(), b);
            _mm256_storeu_pd(rows.add(2).cast(), c);
            _mm256_storeu_pd(rows.add(3).cast(), d);
        }
    }

    #[inline(always)]
    unsafe fn gather(base: *const f64, index: *const u32, stride: usize) -> Self {
        // SAFETY: the caller's promise.
        unsafe {
            Self(_mm256_set_pd(
                *base.add(*index.add(3) as usize * stride),
                *base.add(*index.add(2) as usize * stride),
                *base.add(*index.add(1) as usize * stride),
                *base.add(*index as usize * stride),
            ))
        }
    }

    #[inline(always)]
    unsafe fn load(place: *const f64) -> Self {
        // SAFETY: the caller's promise.
        unsafe { Self(_mm256_loadu_pd(place)) }
    }

    #[inline(always)]
    unsafe fn compact(from: *const u32, bits: u32, to: *mut u32) {
        // SAFETY: the caller's promise.
        unsafe {
            let order = _mm_loadu_si128(ORDER_OF_FOUR[(bits & 15) as usize].as_ptr().cast());
            _mm_storeu_ps(to.cast(), _mm_permutevar_ps(_mm_loadu_ps(from.cast()), order));
        }
    }

    #[inline(always)]
    unsafe fn store_compact(self, bits: u32, to: *mut f64) {
        // SAFETY: the caller's promise.
        unsafe {
            let order = _mm256_loadu_si256(HALVES_OF_FOUR[(bits & 15) as usize].as_ptr().cast());
            let numbers = _mm256_permutevar8x32_ps(_mm256_castpd_ps(self.0), order);
            _mm256_storeu_pd(to, _mm256_castps_pd(numbers));
        }
    }

    #[inline(always)]
    unsafe fn store(self, place: *mut f64) {
        // SAFETY: the caller's promise.
        unsafe { _mm256_storeu_pd(place, self.0) }
    }

    #[inline(always)]
    fn bits(mask: __m256d) -> u32 {
        // SAFETY: called where AVX is offered.
        unsafe { _mm256_movemask_pd(mask) as u32 }
    }
}
