//! Several numbers side by side: vector registers behind the [`Number`] of the laws.
//!
//! The width is chosen once, when a simulation is made, from what the processor offers. Every width gives
//! the same bits: operations are exactly rounded and never fused, and results are added in the same order.

mod columns;
mod one;
mod shared;
mod table;
#[cfg(target_arch = "x86_64")]
mod x86;

use crate::base::number::{Number, Row, Vector};

#[cfg(target_arch = "x86_64")]
pub use x86::{Eight, Four, Two};

/// One number in place of a register of four: other processors than x86-64 have none here.
#[cfg(not(target_arch = "x86_64"))]
pub type Four = f64;

/// One number in place of a register of eight, in the same way.
#[cfg(not(target_arch = "x86_64"))]
pub type Eight = f64;

pub use columns::{Column, put, take, vector_of, vector_parts};
pub use shared::Shared;
pub use table::{Table, columns_from, rows_from};

/// A [`Number`] that knows how to be read from and written to rows of four.
pub trait Lane: Number {
    /// Numbers side by side.
    const WIDTH: usize;

    /// Reads [`Lane::WIDTH`] rows and transposes them: the first numbers of all rows, the second ones, ...
    ///
    /// # Safety
    /// `index` holds [`Lane::WIDTH`] numbers, each below the length of what `rows` points to.
    unsafe fn load_rows(rows: *const Row, index: *const u32) -> [Self; 4];

    /// Reads [`Lane::WIDTH`] consecutive rows and transposes them.
    ///
    /// # Safety
    /// `rows` points to [`Lane::WIDTH`] rows.
    #[inline(always)]
    unsafe fn load_block(rows: *const Row) -> [Self; 4] {
        // SAFETY: the caller's promise.
        unsafe { Self::load_rows(rows, [0, 1, 2, 3, 4, 5, 6, 7].as_ptr()) }
    }

    /// Reads two times [`Lane::WIDTH`] rows, and transposes the first ones less the second ones.
    ///
    /// # Safety
    /// As for [`Lane::load_rows`], both times.
    #[inline(always)]
    unsafe fn load_difference(rows: *const Row, first: *const u32, second: *const u32) -> [Self; 4] {
        // SAFETY: the caller's promise.
        let ([a, b, c, d], [e, f, g, h]) = unsafe { (Self::load_rows(rows, first), Self::load_rows(rows, second)) };
        [a - e, b - f, c - g, d - h]
    }

    /// Transposes back and writes the rows, the last one last.
    ///
    /// # Safety
    /// As for [`Lane::load_rows`]; no other thread reads or writes these rows meanwhile.
    unsafe fn store_rows(values: [Self; 4], rows: *mut Row, index: *const u32);

    /// Transposes back and writes all rows to consecutive places.
    ///
    /// # Safety
    /// `rows` points to [`Lane::WIDTH`] rows.
    unsafe fn store_block(values: [Self; 4], rows: *mut Row);

    /// Reads one number for each index, `stride` numbers apart.
    ///
    /// # Safety
    /// `index` holds [`Lane::WIDTH`] numbers; each times `stride` is below the length of what `base` points to.
    unsafe fn gather(base: *const f64, index: *const u32, stride: usize) -> Self;

    /// Reads the numbers from consecutive places.
    ///
    /// # Safety
    /// `place` points to [`Lane::WIDTH`] numbers.
    unsafe fn load(place: *const f64) -> Self;

    /// Writes those of [`Lane::WIDTH`] consecutive indices whose bit is set, one after the other. What stands behind
    /// them, up to [`Lane::WIDTH`] places in all, is lost.
    ///
    /// # Safety
    /// `from` and `to` point to [`Lane::WIDTH`] indices each.
    unsafe fn compact(from: *const u32, bits: u32, to: *mut u32);

    /// Writes the numbers of those lanes whose bit is set, one after the other. What stands behind them, up to
    /// [`Lane::WIDTH`] places in all, is lost.
    ///
    /// # Safety
    /// `to` points to [`Lane::WIDTH`] numbers.
    unsafe fn store_compact(self, bits: u32, to: *mut f64);

    /// Writes the numbers to consecutive places.
    ///
    /// # Safety
    /// `place` points to [`Lane::WIDTH`] numbers.
    unsafe fn store(self, place: *mut f64);

    /// The mask as bits, lane 0 lowest.
    fn bits(mask: Self::Mask) -> u32;

    /// Writes `first` plus the number of each lane whose bit is set, one behind the other. Returns how many.
    ///
    /// # Safety
    /// `place` points to [`Lane::WIDTH`] numbers, all of which may be written.
    #[inline(always)]
    unsafe fn compress(bits: u32, first: u32, place: *mut u32) -> usize {
        let mut count = 0;
        let mut lane = 0;
        while lane < Self::WIDTH {
            // SAFETY: no more than one number for each lane.
            unsafe { *place.add(count) = first + lane as u32 };
            count += ((bits >> lane) & 1) as usize;
            lane += 1;
        }
        count
    }
}

/// The first three of four columns as a vector.
#[inline(always)]
pub fn vector<N: Number>([x, y, z, _]: [N; 4]) -> Vector<N> {
    Vector::new(x, y, z)
}

/// A vector and zero as four columns.
#[inline(always)]
pub fn columns<N: Number>(vector: Vector<N>) -> [N; 4] {
    [vector.x, vector.y, vector.z, N::zero()]
}

/// Which of eight numbers are equal to another, a bit for each, the first one lowest.
#[inline(always)]
pub fn equal(numbers: &[u32; 8], wanted: u32) -> u32 {
    #[cfg(target_arch = "x86_64")]
    return x86::equal(numbers, wanted);
    #[cfg(not(target_arch = "x86_64"))]
    (0..8).fold(0, |bits, place| bits | u32::from(numbers[place] == wanted) << place)
}

/// Writes those of `width` consecutive indices whose bit is set, one after the other, without a branch.
///
/// # Safety
/// As for [`Lane::compact`].
#[inline(always)]
unsafe fn compact_one_by_one(width: usize, from: *const u32, bits: u32, to: *mut u32) {
    let (mut lane, mut count) = (0, 0);
    while lane < width {
        // SAFETY: the caller's promise; `count` never exceeds `lane`.
        unsafe { *to.add(count) = *from.add(lane) };
        count += (bits >> lane & 1) as usize;
        lane += 1;
    }
}

/// Lane widths that can be chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// The width that every processor of the target offers: two numbers (SSE2) on x86-64, elsewhere one.
    Least,
    /// Four numbers: AVX2.
    Four,
    /// Eight numbers: AVX-512.
    Eight,
}

impl Width {
    /// Every width there is, narrow to wide.
    pub const ALL: [Self; 3] = [Self::Least, Self::Four, Self::Eight];

    /// The widest this processor offers.
    pub fn widest() -> Self {
        Self::ALL.into_iter().rev().find(|width| width.offered()).unwrap_or(Self::Least)
    }

    /// Whether this processor offers it.
    pub fn offered(self) -> bool {
        match self {
            Self::Least => true,
            #[cfg(target_arch = "x86_64")]
            Self::Four => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("popcnt"),
            #[cfg(target_arch = "x86_64")]
            Self::Eight => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("popcnt")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }
}

/// Work that can be done in any lane width.
pub trait Kernel {
    /// Does the work in lanes of `N`. Must be `#[inline(always)]` with all it calls, so that it is compiled for the
    /// processor features of the width.
    fn run<N: Lane>(self);
}

/// Runs a kernel in this width.
pub fn run<K: Kernel>(width: Width, kernel: K) {
    match width {
        Width::Least => run_least(kernel),
        wide => run_wide(wide, kernel),
    }
}

/// Runs a kernel in registers of four or eight numbers.
fn run_wide<K: Kernel>(width: Width, kernel: K) {
    debug_assert!(width.offered(), "{width:?} is not offered by this processor");
    match width {
        // SAFETY: `Width::widest` and `Simulation::set_width` choose only what the processor offers.
        #[cfg(target_arch = "x86_64")]
        Width::Four => unsafe { x86::run_four(kernel) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Width::Eight => unsafe { x86::run_eight(kernel) },
        _ => unreachable!("{width:?} has no wide registers"),
    }
}

/// Runs a kernel in the least width, for work that is too little to be worth compiling in all of them.
pub fn run_least<K: Kernel>(kernel: K) {
    #[cfg(target_arch = "x86_64")]
    kernel.run::<Two>();
    #[cfg(not(target_arch = "x86_64"))]
    kernel.run::<f64>();
}
