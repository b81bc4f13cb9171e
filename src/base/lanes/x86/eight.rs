//! Eight numbers in an AVX-512 register.

use super::{negation, operators};
use crate::base::lanes::Lane;
use crate::base::number::{Number, Row};
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Eight numbers in an AVX-512 register.
#[derive(Clone, Copy)]
pub struct Eight(__m512d);

operators!(Eight, _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd);
negation!(Eight, _mm512_xor_pd, _mm512_set1_pd);

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

/// Orders of lanes, of two registers (8 and above: the second one). They are read as if they could change: knowing
/// them, the compiler takes the transpositions apart into twice as many narrower ones.
static ORDERS: [[i64; 8]; 8] = [
    [0, 1, 8, 9, 4, 5, 12, 13],
    [2, 3, 10, 11, 6, 7, 14, 15],
    [0, 8, 1, 9, 2, 10, 3, 11],
    [4, 12, 5, 13, 6, 14, 7, 15],
    [0, 1, 8, 9, 2, 3, 10, 11],
    [4, 5, 12, 13, 6, 7, 14, 15],
    [0, 4, 8, 12, 1, 5, 9, 13],
    [2, 6, 10, 14, 3, 7, 11, 15],
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
    unsafe fn load_block(rows: *const Row) -> [Self; 4] {
        // SAFETY: the caller's promise.
        unsafe {
            let pair = |place: usize| _mm512_loadu_pd(rows.add(2 * place).cast());
            let [a, b, c, d] = [pair(0), pair(1), pair(2), pair(3)];
            let (front, back) = (order(6), order(7));
            let (low_front, low_back) = (_mm512_permutex2var_pd(a, front, b), _mm512_permutex2var_pd(a, back, b));
            let (high_front, high_back) = (_mm512_permutex2var_pd(c, front, d), _mm512_permutex2var_pd(c, back, d));
            [
                Self(_mm512_shuffle_f64x2::<0x44>(low_front, high_front)),
                Self(_mm512_shuffle_f64x2::<0xee>(low_front, high_front)),
                Self(_mm512_shuffle_f64x2::<0x44>(low_back, high_back)),
                Self(_mm512_shuffle_f64x2::<0xee>(low_back, high_back)),
            ]
        }
    }

    #[inline(always)]
    unsafe fn load_difference(rows: *const Row, first: *const u32, second: *const u32) -> [Self; 4] {
        // SAFETY: the caller's promise.
        unsafe {
            let difference = |lane: usize| {
                _mm512_sub_pd(
                    row_pair(rows, *first.add(lane), *first.add(lane + 4)),
                    row_pair(rows, *second.add(lane), *second.add(lane + 4)),
                )
            };
            let [x, y, z, w] = transpose_in([difference(0), difference(1), difference(2), difference(3)]);
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
    unsafe fn store_compact(self, bits: u32, to: *mut f64) {
        // SAFETY: the caller's promise.
        unsafe { _mm512_storeu_pd(to, _mm512_maskz_compress_pd(bits as __mmask8, self.0)) }
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
