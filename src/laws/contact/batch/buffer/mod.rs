//! The batch that goes through the phases.

mod columns;
mod contacts;
mod heat;
mod losses;
mod normal;
mod offsets;

use super::sums::Sums;
use super::{FOUND, Touching};
use crate::base::lanes::Lane;
use crate::base::number::{Row, Vector};
use columns as at;
use std::cell::RefCell;
use std::mem::offset_of;

/// Touching entries of one batch.
pub(crate) const BATCH: usize = 64;

/// Room for a batch: what one register adds beyond it, and what one writes behind that.
const ROOM: usize = BATCH + 16;

/// A batch. In the order that is written here each column begins with a line of the cache: a register that lies in two of them takes
/// twice as long.
#[repr(C, align(64))]
pub(crate) struct Buffer {
    /// Contacts, column by column.
    columns: [[f64; ROOM]; at::COUNT],
    /// What was found of the places of the bodies.
    pub(crate) found: [[f64; ROOM]; FOUND],
    /// What takes long, found from that.
    pub(crate) roots: [[f64; ROOM]; 2],
    /// Force on the first body.
    pub(crate) force: [Row; ROOM],
    /// What friction turns both bodies by, over its arm.
    pub(crate) couple: [Row; ROOM],
    /// Rolling torque.
    pub(crate) rolling: [Row; ROOM],
    /// Touching entries.
    pub(crate) entry: [u32; ROOM],
    /// Where the rows that are stored of them begin.
    pub(crate) history: [u32; ROOM],
    /// Their first bodies.
    pub(crate) first: [u32; ROOM],
    /// Their second bodies.
    pub(crate) second: [u32; ROOM],
    /// Their rows of the table, where they differ.
    pub(crate) row: [u32; ROOM],
    /// What is lost.
    pub(crate) losses: Sums,
    /// How many were found.
    pub(crate) count: usize,
    /// How many are worked on now.
    pub(crate) ready: usize,
}

const _: () = assert!(
    (offset_of!(Buffer, columns) | offset_of!(Buffer, found) | offset_of!(Buffer, roots)).is_multiple_of(64)
        && (offset_of!(Buffer, force) | offset_of!(Buffer, losses)).is_multiple_of(64)
);

/// Copies eight entries to the front.
#[inline(always)]
fn to_front<T: Copy>(entries: &mut [T; ROOM], from: usize) {
    if let Some(&eight) = entries[from..].first_chunk::<8>() {
        entries[..8].copy_from_slice(&eight);
    }
}

impl Buffer {
    /// Gives a piece of work the room of its thread, empty. What is left in it of other pieces is never looked at.
    pub(crate) fn with<T>(work: impl FnOnce(&mut Self) -> T) -> T {
        thread_local! {
            /// The room of each thread.
            static ROOM: RefCell<Box<Buffer>> = RefCell::new(Box::new(Buffer::new()));
        }
        ROOM.with_borrow_mut(|buffer| {
            buffer.count = 0;
            work(buffer)
        })
    }

    /// An empty one.
    pub(crate) fn new() -> Self {
        let rows = [[0.0; 4]; ROOM];
        let slots = [0; ROOM];
        Self {
            columns: [[0.0; ROOM]; at::COUNT],
            found: [[0.0; ROOM]; FOUND],
            roots: [[0.0; ROOM]; 2],
            force: rows,
            couple: rows,
            rolling: rows,
            entry: slots,
            history: slots,
            first: slots,
            second: slots,
            row: slots,
            losses: Sums::default(),
            count: 0,
            ready: 0,
        }
    }

    /// Says how many entries are worked on now: whole registers, or all of the last ones, of which the last is
    /// repeated to fill a register. `found` numbers are there of each.
    pub(crate) fn complete(&mut self, last: bool, found: usize) {
        self.ready = if last { self.count } else { self.count / 8 * 8 };
        if last && self.count > 0 {
            for slots in [&mut self.entry, &mut self.history, &mut self.first, &mut self.second] {
                let repeated = slots[self.count - 1];
                slots[self.count..self.count + 8].fill(repeated);
            }
            for numbers in &mut self.found[..found] {
                let repeated = numbers[self.count - 1];
                numbers[self.count..self.count + 8].fill(repeated);
            }
        }
    }

    /// Keeps what was not worked on for the next batch.
    pub(crate) fn proceed(&mut self, found: usize) {
        // Fewer than 8 are left. Copies of a length that is known are a register each.
        for slots in [&mut self.entry, &mut self.first, &mut self.second] {
            to_front(slots, self.ready);
        }
        for numbers in &mut self.found[..found] {
            to_front(numbers, self.ready);
        }
        self.count -= self.ready;
    }

    /// Reads a register's worth of what was found: `count` numbers each.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn found<N: Lane>(&self, place: usize, count: usize) -> [N; FOUND] {
        let mut found = [N::zero(); FOUND];
        let mut column = 0;
        while column < count {
            // SAFETY: the caller's promise.
            found[column] = unsafe { N::load(self.found[column].as_ptr().add(place)) };
            column += 1;
        }
        found
    }

    /// Writes numbers into a column.
    ///
    /// # Safety
    /// `place` + [`Lane::WIDTH`] is at most [`ROOM`].
    #[inline(always)]
    unsafe fn store<N: Lane>(&mut self, column: usize, place: usize, numbers: N) {
        // SAFETY: the caller's promise.
        unsafe { numbers.store(self.columns[column].as_mut_ptr().add(place)) };
    }

    /// Writes vectors into three columns.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    unsafe fn store_vector<N: Lane>(&mut self, [x, y, z]: [usize; 3], place: usize, vector: Vector<N>) {
        // SAFETY: the caller's promise.
        unsafe {
            self.store(x, place, vector.x);
            self.store(y, place, vector.y);
            self.store(z, place, vector.z);
        }
    }

    /// Reads numbers from a column.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    unsafe fn load<N: Lane>(&self, column: usize, place: usize) -> N {
        // SAFETY: the caller's promise.
        unsafe { N::load(self.columns[column].as_ptr().add(place)) }
    }

    /// Reads vectors from three columns.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    unsafe fn load_vector<N: Lane>(&self, [x, y, z]: [usize; 3], place: usize) -> Vector<N> {
        // SAFETY: the caller's promise.
        unsafe { Vector::new(self.load(x, place), self.load(y, place), self.load(z, place)) }
    }

    /// What was worked on.
    #[inline(always)]
    pub(crate) fn touching(&self) -> Touching<'_> {
        Touching {
            first: &self.first[..self.ready],
            second: &self.second[..self.ready],
            force: &self.force[..self.ready],
            couple: &self.couple[..self.ready],
            rolling: &self.rolling[..self.ready],
            first_arm: &self.columns[at::FIRST_ARM][..self.ready],
            second_arm: &self.columns[at::SECOND_ARM][..self.ready],
        }
    }
}
