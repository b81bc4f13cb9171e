//! Contacts that a bond suppresses or has suppressed: their overlap beyond an offset.

use super::{Buffer, at};
use crate::base::lanes::Lane;
use crate::laws::contact::Contact;
use crate::laws::contact::batch::sphere_pair::SpherePair;
use std::f64::consts::PI;

impl Buffer {
    /// Overlap of a register's worth of suppressed contacts beyond their offsets.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn pressing<N: Lane>(&self, place: usize) -> N {
        // SAFETY: the caller's promise.
        unsafe { self.load(at::PRESSING, place) }
    }

    /// Writes offsets of a register's worth of contacts, and how much of the overlap is beyond them.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put_offset<N: Lane>(&mut self, place: usize, [offset, pressing]: [N; 2]) {
        // SAFETY: the caller's promise.
        unsafe {
            self.store(at::OFFSET, place, offset);
            self.store(at::PRESSING, place, pressing);
        }
    }

    /// A register's worth of contacts at an overlap of the offset alone.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn contact_at_offset<N: Lane>(&self, place: usize) -> Contact<N> {
        // SAFETY: the caller's promise.
        unsafe {
            let (contact, offset): (Contact<N>, N) = (self.contact(place, N::zero()), self.load(at::OFFSET, place));
            let half = N::splat(0.5) * contact.overlap;
            let arms: [N; 2] = [self.load(at::FIRST_ARM, place), self.load(at::SECOND_ARM, place)];
            let spheres = SpherePair::<N>::section_area([arms[0] + half, arms[1] + half], offset);
            let wall = N::splat(PI) * offset * (contact.radius + contact.radius - offset);
            // The section of a sphere at a wall has the radius of the sphere, that of two spheres twice the effective one.
            let at_wall = contact.radius.greater(N::splat(0.75) * contact.section_radius);
            Contact { overlap: offset, section_area: N::select(at_wall, wall, spheres), ..contact }
        }
    }

    /// Takes the overlap beyond the offset for the whole.
    pub(crate) fn press(&mut self) {
        let (from, to) = self.columns.split_at_mut(at::PRESSING);
        from[at::OVERLAP].copy_from_slice(&to[0]);
    }

    /// Overlap and offset of an entry of the batch \[m\].
    pub(crate) fn overlap_and_offset(&self, place: usize) -> [f64; 2] {
        [self.columns[at::OVERLAP][place], self.columns[at::OFFSET][place]]
    }
}
