//! Two numbers in an SSE2 register, which every x86-64 processor has.

use super::{negation, operators};
use crate::base::lanes::{Lane, compact_one_by_one};
use crate::base::number::{Number, Row};
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Two numbers in an SSE2 register.
#[derive(Clone, Copy)]
pub struct Two(__m128d);

operators!(Two, _mm_add_pd, _mm_sub_pd, _mm_mul_pd, _mm_div_pd);
negation!(Two, _mm_xor_pd, _mm_set1_pd);

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
    unsafe fn store_compact(self, bits: u32, to: *mut f64) {
        // SAFETY: the caller's promise.
        unsafe {
            _mm_storel_pd(to, self.0);
            _mm_storeh_pd(to.add((bits & 1) as usize), self.0);
        }
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
