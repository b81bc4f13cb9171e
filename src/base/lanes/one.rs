//! One number at a time.

use super::{Lane, compact_one_by_one};
use crate::base::number::Row;

impl Lane for f64 {
    const WIDTH: usize = 1;

    #[inline(always)]
    unsafe fn load_rows(rows: *const Row, index: *const u32) -> [Self; 4] {
        // SAFETY: the caller's promise.
        unsafe { *rows.add(*index as usize) }
    }

    #[inline(always)]
    unsafe fn store_rows(values: [Self; 4], rows: *mut Row, index: *const u32) {
        // SAFETY: the caller's promise.
        unsafe { *rows.add(*index as usize) = values }
    }

    #[inline(always)]
    unsafe fn store_block(values: [Self; 4], rows: *mut Row) {
        // SAFETY: the caller's promise.
        unsafe { *rows = values }
    }

    #[inline(always)]
    unsafe fn gather(base: *const f64, index: *const u32, stride: usize) -> Self {
        // SAFETY: the caller's promise.
        unsafe { *base.add(*index as usize * stride) }
    }

    #[inline(always)]
    unsafe fn load(place: *const f64) -> Self {
        // SAFETY: the caller's promise.
        unsafe { *place }
    }

    #[inline(always)]
    unsafe fn compact(from: *const u32, bits: u32, to: *mut u32) {
        // SAFETY: the caller's promise.
        unsafe { compact_one_by_one(1, from, bits, to) }
    }

    #[inline(always)]
    unsafe fn store_compact(self, _bits: u32, to: *mut f64) {
        // SAFETY: the caller's promise.
        unsafe { *to = self }
    }

    #[inline(always)]
    unsafe fn store(self, place: *mut f64) {
        // SAFETY: the caller's promise.
        unsafe { *place = self }
    }

    #[inline(always)]
    fn bits(mask: bool) -> u32 {
        u32::from(mask)
    }
}
