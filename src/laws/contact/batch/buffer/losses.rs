//! What a book of losses keeps of contacts.

use super::{Buffer, at};
use crate::base::lanes::Lane;
use crate::base::number::Vector;

impl Buffer {
    /// Writes what a book of losses wants to know of a register's worth of contacts before sub-models change it: spring, and
    /// velocity along the normal at mid-step.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put_before<N: Lane>(&mut self, place: usize, spring: Vector<N>, velocity: N) {
        // SAFETY: the caller's promise.
        unsafe {
            self.store_vector(at::SPRING, place, spring);
            self.store(at::VELOCITY, place, velocity);
        }
    }

    /// Reads it.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn before<N: Lane>(&self, place: usize) -> (Vector<N>, N) {
        // SAFETY: the caller's promise.
        unsafe { (self.load_vector(at::SPRING, place), self.load(at::VELOCITY, place)) }
    }

    /// Stores what of the losses of a register's worth of contacts is heat \[J\].
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put_heat<N: Lane>(&mut self, place: usize, heat: N) {
        // SAFETY: the caller's promise.
        unsafe { self.store(at::SPRING[0], place, heat) };
    }

    /// Stores what a register's worth of contacts lose along the normal and across it \[J\].
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put_lost<N: Lane>(&mut self, place: usize, [along, across]: [N; 2]) {
        // SAFETY: the caller's promise.
        unsafe {
            self.store(at::LOST[0], place, along);
            self.store(at::LOST[1], place, across);
        }
    }

    /// What a contact loses along the normal and across it \[J\].
    pub(crate) fn lost(&self, place: usize) -> [f64; 2] {
        at::LOST.map(|column| self.columns[column][place])
    }

    /// What of the losses of the contacts is heat, contact by contact \[J\].
    pub(crate) fn heat(&self) -> &[f64] {
        &self.columns[at::SPRING[0]][..self.ready]
    }

    /// The same, to be changed.
    pub(crate) fn heat_mut(&mut self) -> &mut [f64] {
        &mut self.columns[at::SPRING[0]][..self.ready]
    }
}
