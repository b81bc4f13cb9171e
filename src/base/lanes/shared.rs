//! What several threads write to.

use super::Lane;
use crate::base::number::Row;

/// A place that several threads write to, each to its own part.
///
/// The passes divide particles and pairs by geometry such that no two parts worked on at the same time touch the
/// same rows; the compiler cannot see that.
pub struct Shared<T> {
    /// Where the slice begins.
    start: *mut T,
    /// How many there are, for debug assertions.
    length: usize,
}

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Shared<T> {}

// SAFETY: what is behind it is plain data; who writes where is the passes' promise, stated at each use.
unsafe impl<T: Send> Send for Shared<T> {}
// SAFETY: as above.
unsafe impl<T: Send> Sync for Shared<T> {}

impl<T> Shared<T> {
    /// The whole slice, for as long as the pass holds it.
    pub fn new(slice: &mut [T]) -> Self {
        Self { start: slice.as_mut_ptr(), length: slice.len() }
    }

    /// Where the slice begins.
    #[inline(always)]
    pub fn pointer(self) -> *mut T {
        self.start
    }

    /// How many there are.
    #[inline(always)]
    pub fn length(self) -> usize {
        self.length
    }

    /// The slice without its first elements, of which there are at least as many.
    pub fn from(self, first: usize) -> Self {
        assert!(first <= self.length, "{first} is above {}", self.length);
        Self { start: self.start.wrapping_add(first), length: self.length - first }
    }

    /// One element, to be changed.
    ///
    /// # Safety
    /// `index` is below the length, and no other thread reads or writes this element meanwhile.
    #[inline(always)]
    #[allow(clippy::mut_from_ref, reason = "disjoint use is the caller's promise")]
    pub unsafe fn at<'a>(self, index: usize) -> &'a mut T {
        debug_assert!(index < self.length, "{index} is not below {}", self.length);
        // SAFETY: the caller's promise.
        unsafe { &mut *self.start.add(index) }
    }

    /// A part, to be changed.
    ///
    /// # Safety
    /// The part is inside, and no other thread reads or writes it meanwhile.
    #[inline(always)]
    pub unsafe fn part<'a>(self, from: usize, to: usize) -> &'a mut [T] {
        debug_assert!(from <= to && to <= self.length);
        // SAFETY: the caller's promise.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(from), to - from) }
    }
}

impl Shared<Row> {
    /// Reads consecutive rows, lane by lane.
    ///
    /// # Safety
    /// There are [`Lane::WIDTH`] rows from `first` on, and no other thread writes them meanwhile.
    #[inline(always)]
    pub unsafe fn load_block<N: Lane>(self, first: usize) -> [N; 4] {
        debug_assert!(first + N::WIDTH <= self.length);
        // SAFETY: the caller's promise.
        unsafe { N::load_block(self.start.add(first)) }
    }

    /// Writes consecutive rows.
    ///
    /// # Safety
    /// As for [`Shared::load_block`]; no other thread reads them meanwhile either.
    #[inline(always)]
    pub unsafe fn store_block<N: Lane>(self, values: [N; 4], first: usize) {
        debug_assert!(first + N::WIDTH <= self.length);
        // SAFETY: the caller's promise.
        unsafe { N::store_block(values, self.start.add(first)) }
    }
}
