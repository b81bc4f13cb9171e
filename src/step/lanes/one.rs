//! One number at a time.

use super::Lane;
use crate::state::Row;

impl Lane for f64 {
    const WIDTH: usize = 1;

    #[inline(always)]
    unsafe fn load_rows(rows: *const Row, index: *const u32) -> [Self; 4] {
        // SAFETY: the caller's promise.
        unsafe { *rows.add(*index as usize) }
    }

    #[inline(always)]
    unsafe fn store_rows(values: [Self; 4], rows: *mut Row, index: *const u32, count: usize) {
        if count > 0 {
            // SAFETY: the caller's promise.
            unsafe { *rows.add(*index as usize) = values }
        }
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
    unsafe fn store(self, place: *mut f64) {
        // SAFETY: the caller's promise.
        unsafe { *place = self }
    }

    #[inline(always)]
    fn bits(mask: bool) -> u32 {
        u32::from(mask)
    }
}
