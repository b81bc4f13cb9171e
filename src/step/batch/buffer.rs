//! The batch that goes through the phases.

use super::{Meeting, Needs, Touching};
use crate::contact::Contact;
use crate::number::Vector;
use crate::state::Row;
use crate::step::lanes::Lane;

/// Touching entries of one batch.
pub(super) const BATCH: usize = 64;

/// Room for a batch: what one register adds beyond it, and what one writes behind that.
const ROOM: usize = BATCH + 16;

/// Columns in which a meeting is written.
const COLUMNS: usize = 17;

/// A batch.
#[repr(align(64))]
pub(super) struct Buffer {
    /// Meetings, column by column.
    pub(super) columns: [[f64; ROOM]; COLUMNS],
    /// Force on the first body.
    pub(super) force: [Row; ROOM],
    /// Torque on the first body.
    pub(super) first_torque: [Row; ROOM],
    /// Torque on the second body.
    pub(super) second_torque: [Row; ROOM],
    /// Touching entries.
    pub(super) entry: [u32; ROOM],
    /// Their first bodies.
    pub(super) first: [u32; ROOM],
    /// Their second bodies.
    pub(super) second: [u32; ROOM],
    /// Their rows of the table, where they differ.
    pub(super) row: [u32; ROOM],
    /// How many were found.
    pub(super) count: usize,
    /// How many are worked on now.
    pub(super) ready: usize,
}

impl Buffer {
    /// An empty one.
    pub(super) fn new() -> Self {
        let rows = [[0.0; 4]; ROOM];
        let slots = [0; ROOM];
        Self {
            columns: [[0.0; ROOM]; COLUMNS],
            force: rows,
            first_torque: rows,
            second_torque: rows,
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
    pub(super) fn complete(&mut self, last: bool) {
        self.ready = if last { self.count } else { self.count / 8 * 8 };
        if last && self.count > 0 {
            for slots in [&mut self.entry, &mut self.first, &mut self.second] {
                let repeated = slots[self.count - 1];
                slots[self.count..self.count + 8].fill(repeated);
            }
        }
    }

    /// Keeps what was not worked on for the next batch.
    pub(super) fn proceed(&mut self) {
        for slots in [&mut self.entry, &mut self.first, &mut self.second] {
            slots.copy_within(self.ready..self.count, 0);
        }
        self.count -= self.ready;
    }

    /// Writes a register's worth of meetings.
    ///
    /// # Safety
    /// `place` + [`Lane::WIDTH`] is at most [`ROOM`].
    #[inline(always)]
    pub(super) unsafe fn put<N: Lane, const TORQUE: bool>(&mut self, place: usize, meeting: &Meeting<N>, needs: Needs) {
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

    /// Reads a register's worth of meetings.
    ///
    /// # Safety
    /// As for [`Buffer::put`].
    #[inline(always)]
    pub(super) unsafe fn take<N: Lane>(&self, place: usize, pair_constant: N) -> Meeting<N> {
        let base = self.columns.as_ptr().cast::<f64>();
        macro_rules! take {
            ($column:literal) => {
                // SAFETY: the caller's promise; the column is one of them.
                unsafe { N::load(base.add($column * ROOM + place)) }
            };
        }
        let contact = Contact {
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
        };
        Meeting { contact, first_arm: take!(10), second_arm: take!(11) }
    }

    /// What was worked on.
    #[inline(always)]
    pub(super) fn touching(&self) -> Touching<'_> {
        Touching {
            first: &self.first[..self.ready],
            second: &self.second[..self.ready],
            force: &self.force[..self.ready],
            first_torque: &self.first_torque[..self.ready],
            second_torque: &self.second_torque[..self.ready],
            first_arm: &self.columns[10][..self.ready],
        }
    }
}
