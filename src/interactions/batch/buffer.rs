//! The batch that goes through the phases.

use super::{Bodies, FOUND, Meeting, Needs, Touching};
use crate::contact::{Contact, Law, Roots};
use crate::lanes::Lane;
use crate::number::Vector;
use crate::state::Row;
use std::cell::RefCell;

/// Touching entries of one batch.
pub(crate) const BATCH: usize = 64;

/// Room for a batch: what one register adds beyond it, and what one writes behind that.
const ROOM: usize = BATCH + 16;

/// Columns in which a meeting is written.
const COLUMNS: usize = 17;

/// A batch.
#[repr(align(64))]
pub(crate) struct Buffer {
    /// Meetings, column by column.
    pub(crate) columns: [[f64; ROOM]; COLUMNS],
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
    /// Their first bodies.
    pub(crate) first: [u32; ROOM],
    /// Their second bodies.
    pub(crate) second: [u32; ROOM],
    /// Their rows of the table, where they differ.
    pub(crate) row: [u32; ROOM],
    /// How many were found.
    pub(crate) count: usize,
    /// How many are worked on now.
    pub(crate) ready: usize,
}

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
    fn new() -> Self {
        let rows = [[0.0; 4]; ROOM];
        let slots = [0; ROOM];
        Self {
            columns: [[0.0; ROOM]; COLUMNS],
            found: [[0.0; ROOM]; FOUND],
            roots: [[0.0; ROOM]; 2],
            force: rows,
            couple: rows,
            rolling: rows,
            entry: slots,
            first: slots,
            second: slots,
            row: slots,
            count: 0,
            ready: 0,
        }
    }

    /// Says how many entries are worked on now: whole registers, or all of the last ones, of which the last is
    /// repeated to fill a register.
    pub(crate) fn complete<B: Bodies>(&mut self, last: bool) {
        self.ready = if last { self.count } else { self.count / 8 * 8 };
        if last && self.count > 0 {
            for slots in [&mut self.entry, &mut self.first, &mut self.second] {
                let repeated = slots[self.count - 1];
                slots[self.count..self.count + 8].fill(repeated);
            }
            for numbers in &mut self.found[..B::FOUND] {
                let repeated = numbers[self.count - 1];
                numbers[self.count..self.count + 8].fill(repeated);
            }
        }
    }

    /// Keeps what was not worked on for the next batch.
    pub(crate) fn proceed<B: Bodies>(&mut self) {
        // Fewer than 8 are left. Copies of a length that is known are a register each.
        for slots in [&mut self.entry, &mut self.first, &mut self.second] {
            to_front(slots, self.ready);
        }
        for numbers in &mut self.found[..B::FOUND] {
            to_front(numbers, self.ready);
        }
        self.count -= self.ready;
    }

    /// Reads a register's worth of what was found.
    ///
    /// # Safety
    /// As for [`Buffer::put`].
    #[inline(always)]
    pub(crate) unsafe fn found<N: Lane, B: Bodies>(&self, place: usize) -> [N; FOUND] {
        let mut found = [N::zero(); FOUND];
        let mut column = 0;
        while column < B::FOUND {
            // SAFETY: the caller's promise.
            found[column] = unsafe { N::load(self.found[column].as_ptr().add(place)) };
            column += 1;
        }
        found
    }

    /// Writes a register's worth of meetings.
    ///
    /// # Safety
    /// `place` + [`Lane::WIDTH`] is at most [`ROOM`].
    #[inline(always)]
    pub(crate) unsafe fn put<N: Lane, const TORQUE: bool>(&mut self, place: usize, meeting: &Meeting<N>, needs: Needs) {
        let Meeting { contact, first_arm, second_arm } = meeting;
        let base = self.columns.as_mut_ptr().cast::<f64>();
        macro_rules! put {
            ($($column:literal: $value:expr,)+) => {
                // SAFETY: the caller's promise; the column is one of them.
                $(unsafe { $value.store(base.add($column * ROOM + place)) };)+
            };
        }
        let (n, s, w) = (contact.normal, contact.slip, contact.relative_spin);
        put! { 0: contact.overlap, 1: contact.radius, 2: contact.mass, 3: n.x, 4: n.y, 5: n.z, 6: contact.normal_velocity, 10: first_arm, }
        if TORQUE {
            put! { 7: s.x, 8: s.y, 9: s.z, 11: second_arm, }
            if needs.spin {
                put! { 12: w.x, 13: w.y, 14: w.z, }
            }
        }
        if needs.section {
            put! { 15: contact.section_area, 16: contact.section_radius, }
        }
    }

    /// Reads a register's worth of contacts.
    ///
    /// # Safety
    /// As for [`Buffer::put`].
    #[inline(always)]
    pub(crate) unsafe fn take<N: Lane>(&self, place: usize, pair_constant: N) -> Contact<N> {
        let base = self.columns.as_ptr().cast::<f64>();
        macro_rules! take {
            ($column:literal) => {
                // SAFETY: the caller's promise; the column is one of them.
                unsafe { N::load(base.add($column * ROOM + place)) }
            };
        }
        Contact {
            overlap: take!(0),
            radius: take!(1),
            mass: take!(2),
            normal: Vector::new(take!(3), take!(4), take!(5)),
            normal_velocity: take!(6),
            slip: Vector::new(take!(7), take!(8), take!(9)),
            relative_spin: Vector::new(take!(12), take!(13), take!(14)),
            section_area: take!(15),
            section_radius: take!(16),
            pair_constant,
        }
    }

    /// Finds the roots that a law wants of a register's worth of meetings.
    ///
    /// # Safety
    /// As for [`Buffer::put`].
    #[inline(always)]
    pub(crate) unsafe fn find_roots<N: Lane, L: Law>(&mut self, place: usize) {
        // SAFETY: the caller's promise.
        unsafe {
            let [overlap, radius, mass, ..] = &self.columns;
            let [overlap, radius, mass] = [overlap.as_ptr(), radius.as_ptr(), mass.as_ptr()];
            let [one, other] =
                L::roots(N::load(overlap.add(place)), N::load(radius.add(place)), N::load(mass.add(place)));
            one.store(self.roots[0].as_mut_ptr().add(place));
            other.store(self.roots[1].as_mut_ptr().add(place));
        }
    }

    /// The roots that were found.
    ///
    /// # Safety
    /// As for [`Buffer::put`].
    #[inline(always)]
    pub(crate) unsafe fn roots<N: Lane>(&self, place: usize) -> Roots<N> {
        // SAFETY: the caller's promise.
        unsafe { [N::load(self.roots[0].as_ptr().add(place)), N::load(self.roots[1].as_ptr().add(place))] }
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
            first_arm: &self.columns[10][..self.ready],
            second_arm: &self.columns[11][..self.ready],
        }
    }
}
