//! SSE2, AVX2 and AVX-512 registers of x86-64.

use super::{Kernel, Lane, compact_one_by_one};
use crate::number::Number;
use crate::state::Row;
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Two numbers in an SSE2 register.
#[derive(Clone, Copy)]
pub struct Two(__m128d);

/// Four numbers in an AVX register.
#[derive(Clone, Copy)]
pub struct Four(__m256d);

/// Eight numbers in an AVX-512 register.
#[derive(Clone, Copy)]
pub struct Eight(__m512d);

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

operator!(Two, Add, add, _mm_add_pd);
operator!(Two, Sub, sub, _mm_sub_pd);
operator!(Two, Mul, mul, _mm_mul_pd);
operator!(Two, Div, div, _mm_div_pd);
operator!(Four, Add, add, _mm256_add_pd);
operator!(Four, Sub, sub, _mm256_sub_pd);
operator!(Four, Mul, mul, _mm256_mul_pd);
operator!(Four, Div, div, _mm256_div_pd);
operator!(Eight, Add, add, _mm512_add_pd);
operator!(Eight, Sub, sub, _mm512_sub_pd);
operator!(Eight, Mul, mul, _mm512_mul_pd);
operator!(Eight, Div, div, _mm512_div_pd);

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

negation!(Two, _mm_xor_pd, _mm_set1_pd);
negation!(Four, _mm256_xor_pd, _mm256_set1_pd);
negation!(Eight, _mm512_xor_pd, _mm512_set1_pd);

impl Number for Two {
    type Mask = __m128d;
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { Self(_mm_set1_pd(value)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { Self(_mm_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { Self(_mm_andnot_pd(_mm_set1_pd(-0.0), self.0)) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { Self(_mm_max_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { Self(_mm_min_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn greater(self, other: Self) -> __m128d {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { _mm_cmpgt_pd(self.0, other.0) }
    }
    #[inline(always)]
    fn select(mask: __m128d, yes: Self, no: Self) -> Self {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { Self(_mm_or_pd(_mm_and_pd(mask, yes.0), _mm_andnot_pd(mask, no.0))) }
    }
    #[inline(always)]
    fn both(one: __m128d, other: __m128d) -> __m128d {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { _mm_and_pd(one, other) }
    }
    #[inline(always)]
    fn either(one: __m128d, other: __m128d) -> __m128d {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { _mm_or_pd(one, other) }
    }
    #[inline(always)]
    fn any(mask: __m128d) -> bool {
        <Self as Lane>::bits(mask) != 0
    }
}

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

impl Number for Eight {
    type Mask = __mmask8;
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: such a register exists only where the processor offers it; so in all of this block.
        unsafe { Self(_mm512_set1_pd(value)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see `splat`.
        unsafe { Self(_mm512_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see `splat`.
        unsafe { Self(_mm512_andnot_pd(_mm512_set1_pd(-0.0), self.0)) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe { Self(_mm512_max_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe { Self(_mm512_min_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn greater(self, other: Self) -> __mmask8 {
        // SAFETY: see `splat`.
        unsafe { _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.0, other.0) }
    }
    #[inline(always)]
    fn select(mask: __mmask8, yes: Self, no: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe { Self(_mm512_mask_blend_pd(mask, no.0, yes.0)) }
    }
    #[inline(always)]
    fn both(one: __mmask8, other: __mmask8) -> __mmask8 {
        one & other
    }
    #[inline(always)]
    fn either(one: __mmask8, other: __mmask8) -> __mmask8 {
        one | other
    }
    #[inline(always)]
    fn any(mask: __mmask8) -> bool {
        mask != 0
    }
}

impl Lane for Two {
    const WIDTH: usize = 2;

    #[inline(always)]
    unsafe fn load_rows(rows: *const Row, index: *const u32) -> [Self; 4] {
        // SAFETY: the caller's promise.
        unsafe {
            let (a, b) = (rows.add(*index as usize).cast::<f64>(), rows.add(*index.add(1) as usize).cast::<f64>());
            let (a_low, a_high) = (_mm_loadu_pd(a), _mm_loadu_pd(a.add(2)));
            let (b_low, b_high) = (_mm_loadu_pd(b), _mm_loadu_pd(b.add(2)));
            [
                Self(_mm_unpacklo_pd(a_low, b_low)),
                Self(_mm_unpackhi_pd(a_low, b_low)),
                Self(_mm_unpacklo_pd(a_high, b_high)),
                Self(_mm_unpackhi_pd(a_high, b_high)),
            ]
        }
    }

    #[inline(always)]
    unsafe fn store_rows([x, y, z, w]: [Self; 4], rows: *mut Row, index: *const u32) {
        // SAFETY: the caller's promise.
        unsafe {
            let place = rows.add(*index as usize).cast::<f64>();
            _mm_storeu_pd(place, _mm_unpacklo_pd(x.0, y.0));
            _mm_storeu_pd(place.add(2), _mm_unpacklo_pd(z.0, w.0));
            let place = rows.add(*index.add(1) as usize).cast::<f64>();
            _mm_storeu_pd(place, _mm_unpackhi_pd(x.0, y.0));
            _mm_storeu_pd(place.add(2), _mm_unpackhi_pd(z.0, w.0));
        }
    }

    #[inline(always)]
    unsafe fn store_block([x, y, z, w]: [Self; 4], rows: *mut Row) {
        // SAFETY: the caller's promise.
        unsafe {
            let place = rows.cast::<f64>();
            _mm_storeu_pd(place, _mm_unpacklo_pd(x.0, y.0));
            _mm_storeu_pd(place.add(2), _mm_unpacklo_pd(z.0, w.0));
            _mm_storeu_pd(place.add(4), _mm_unpackhi_pd(x.0, y.0));
            _mm_storeu_pd(place.add(6), _mm_unpackhi_pd(z.0, w.0));
        }
    }

    #[inline(always)]
    unsafe fn gather(base: *const f64, index: *const u32, stride: usize) -> Self {
        // SAFETY: the caller's promise.
        unsafe { Self(_mm_set_pd(*base.add(*index.add(1) as usize * stride), *base.add(*index as usize * stride))) }
    }

    #[inline(always)]
    unsafe fn load(place: *const f64) -> Self {
        // SAFETY: the caller's promise.
        unsafe { Self(_mm_loadu_pd(place)) }
    }

    #[inline(always)]
    unsafe fn compact(from: *const u32, bits: u32, to: *mut u32) {
        // SAFETY: the caller's promise.
        unsafe { compact_one_by_one(2, from, bits, to) }
    }

    #[inline(always)]
    unsafe fn store(self, place: *mut f64) {
        // SAFETY: the caller's promise.
        unsafe { _mm_storeu_pd(place, self.0) }
    }

    #[inline(always)]
    fn bits(mask: __m128d) -> u32 {
        // SAFETY: SSE2 is part of x86-64.
        unsafe { _mm_movemask_pd(mask) as u32 }
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

/// Orders of lanes, of two registers (8 and above: the second one). They are read as if they could change: knowing
/// them, the compiler takes the transpositions apart into twice as many narrower ones.
static ORDERS: [[i64; 8]; 6] = [
    [0, 1, 8, 9, 4, 5, 12, 13],
    [2, 3, 10, 11, 6, 7, 14, 15],
    [0, 8, 1, 9, 2, 10, 3, 11],
    [4, 12, 5, 13, 6, 14, 7, 15],
    [0, 1, 8, 9, 2, 3, 10, 11],
    [4, 5, 12, 13, 6, 7, 14, 15],
];

/// One of [`ORDERS`].
#[inline(always)]
unsafe fn order(which: usize) -> __m512i {
    // SAFETY: called where AVX-512 is offered; an order has 64 bytes.
    unsafe { std::ptr::read_volatile(ORDERS[which].as_ptr().cast::<Unaligned>()).0 }
}

/// A register that may stand anywhere.
#[derive(Clone, Copy)]
#[repr(C, packed)]
struct Unaligned(__m512i);

/// Turns eight rows (rows k and k + 4 in one register) into four columns of eight.
#[inline(always)]
unsafe fn transpose_in([a, b, c, d]: [__m512d; 4]) -> [__m512d; 4] {
    // SAFETY: called where AVX-512 is offered.
    unsafe {
        let (ab_even, ab_odd) = (_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
        let (cd_even, cd_odd) = (_mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(c, d));
        let low = _mm512_set_epi64(13, 12, 5, 4, 9, 8, 1, 0);
        let high = _mm512_set_epi64(15, 14, 7, 6, 11, 10, 3, 2);
        [
            _mm512_permutex2var_pd(ab_even, low, cd_even),
            _mm512_permutex2var_pd(ab_odd, low, cd_odd),
            _mm512_permutex2var_pd(ab_even, high, cd_even),
            _mm512_permutex2var_pd(ab_odd, high, cd_odd),
        ]
    }
}

/// Turns four columns of eight into rows: register k holds rows k and k + 4.
#[inline(always)]
unsafe fn transpose_out([x, y, z, w]: [Eight; 4]) -> [__m512d; 4] {
    // SAFETY: called where AVX-512 is offered.
    unsafe {
        let (xy_even, xy_odd) = (_mm512_unpacklo_pd(x.0, y.0), _mm512_unpackhi_pd(x.0, y.0));
        let (zw_even, zw_odd) = (_mm512_unpacklo_pd(z.0, w.0), _mm512_unpackhi_pd(z.0, w.0));
        let (low, high) = (order(0), order(1));
        [
            _mm512_permutex2var_pd(xy_even, low, zw_even),
            _mm512_permutex2var_pd(xy_odd, low, zw_odd),
            _mm512_permutex2var_pd(xy_even, high, zw_even),
            _mm512_permutex2var_pd(xy_odd, high, zw_odd),
        ]
    }
}

/// Turns four columns of eight into rows: register k holds rows 2 k and 2 k + 1.
#[inline(always)]
unsafe fn transpose_along([x, y, z, w]: [Eight; 4]) -> [__m512d; 4] {
    // SAFETY: called where AVX-512 is offered.
    unsafe {
        let (first, last) = (order(2), order(3));
        let (xy_first, xy_last) = (_mm512_permutex2var_pd(x.0, first, y.0), _mm512_permutex2var_pd(x.0, last, y.0));
        let (zw_first, zw_last) = (_mm512_permutex2var_pd(z.0, first, w.0), _mm512_permutex2var_pd(z.0, last, w.0));
        let (low, high) = (order(4), order(5));
        [
            _mm512_permutex2var_pd(xy_first, low, zw_first),
            _mm512_permutex2var_pd(xy_first, high, zw_first),
            _mm512_permutex2var_pd(xy_last, low, zw_last),
            _mm512_permutex2var_pd(xy_last, high, zw_last),
        ]
    }
}

/// Two rows in one register.
#[inline(always)]
unsafe fn row_pair(rows: *const Row, low: u32, high: u32) -> __m512d {
    // SAFETY: called where AVX-512 is offered, with indices inside.
    unsafe {
        let low = _mm512_castpd256_pd512(_mm256_loadu_pd(rows.add(low as usize).cast()));
        _mm512_insertf64x4::<1>(low, _mm256_loadu_pd(rows.add(high as usize).cast()))
    }
}

impl Lane for Eight {
    const WIDTH: usize = 8;

    #[inline(always)]
    unsafe fn load_rows(rows: *const Row, index: *const u32) -> [Self; 4] {
        // SAFETY: the caller's promise.
        unsafe {
            let [x, y, z, w] = transpose_in([
                row_pair(rows, *index, *index.add(4)),
                row_pair(rows, *index.add(1), *index.add(5)),
                row_pair(rows, *index.add(2), *index.add(6)),
                row_pair(rows, *index.add(3), *index.add(7)),
            ]);
            [Self(x), Self(y), Self(z), Self(w)]
        }
    }

    #[inline(always)]
    unsafe fn store_rows(values: [Self; 4], rows: *mut Row, index: *const u32) {
        // SAFETY: the caller's promise.
        unsafe {
            let pairs = transpose_out(values);
            let mut lane = 0;
            while lane < 4 {
                _mm256_storeu_pd(rows.add(*index.add(lane) as usize).cast(), _mm512_castpd512_pd256(pairs[lane]));
                lane += 1;
            }
            let mut lane = 0;
            while lane < 4 {
                let high = _mm512_extractf64x4_pd::<1>(pairs[lane]);
                _mm256_storeu_pd(rows.add(*index.add(lane + 4) as usize).cast(), high);
                lane += 1;
            }
        }
    }

    #[inline(always)]
    unsafe fn store_block(values: [Self; 4], rows: *mut Row) {
        // SAFETY: the caller's promise.
        unsafe {
            let pairs = transpose_along(values);
            let mut pair = 0;
            while pair < 4 {
                _mm512_storeu_pd(rows.add(2 * pair).cast(), pairs[pair]);
                pair += 1;
            }
        }
    }

    #[inline(always)]
    unsafe fn gather(base: *const f64, index: *const u32, stride: usize) -> Self {
        // SAFETY: the caller's promise.
        unsafe {
            let mut values = [0.0; 8];
            let mut lane = 0;
            while lane < 8 {
                values[lane] = *base.add(*index.add(lane) as usize * stride);
                lane += 1;
            }
            Self(_mm512_loadu_pd(values.as_ptr()))
        }
    }

    #[inline(always)]
    unsafe fn load(place: *const f64) -> Self {
        // SAFETY: the caller's promise.
        unsafe { Self(_mm512_loadu_pd(place)) }
    }

    #[inline(always)]
    unsafe fn compact(from: *const u32, bits: u32, to: *mut u32) {
        // SAFETY: the caller's promise.
        unsafe {
            let all = _mm256_loadu_si256(from.cast());
            _mm256_storeu_si256(to.cast(), _mm256_maskz_compress_epi32(bits as __mmask8, all));
        }
    }

    #[inline(always)]
    unsafe fn store(self, place: *mut f64) {
        // SAFETY: the caller's promise.
        unsafe { _mm512_storeu_pd(place, self.0) }
    }

    #[inline(always)]
    unsafe fn compress(bits: u32, first: u32, place: *mut u32) -> usize {
        // SAFETY: the caller's promise.
        unsafe {
            let numbers = _mm256_add_epi32(_mm256_set1_epi32(first as i32), _mm256_set_epi32(7, 6, 5, 4, 3, 2, 1, 0));
            _mm256_storeu_si256(place.cast(), _mm256_maskz_compress_epi32(bits as u8, numbers));
        }
        (bits as u8).count_ones() as usize
    }

    #[inline(always)]
    fn bits(mask: __mmask8) -> u32 {
        u32::from(mask)
    }
}
