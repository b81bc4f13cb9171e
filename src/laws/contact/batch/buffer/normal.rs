//! What a normal model makes of contacts.

use super::{Buffer, ROOM, at};
use crate::base::lanes::Lane;
use crate::laws::contact::{NormalForce, NormalForm, Response, Roots};

impl Buffer {
    /// Writes what a normal model made of a register's worth of contacts.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put_normal<N: Lane>(&mut self, place: usize, normal: &NormalForce<N>) {
        let Response { normal_stiffness, normal_damping, tangential_stiffness, tangential_damping } = normal.response;
        // SAFETY: the caller's promise.
        unsafe {
            self.store(at::NORMAL_STIFFNESS, place, normal_stiffness);
            self.store(at::NORMAL_DAMPING, place, normal_damping);
            self.store(at::TANGENTIAL_STIFFNESS, place, tangential_stiffness);
            self.store(at::TANGENTIAL_DAMPING, place, tangential_damping);
            self.put_force(place, normal);
        }
    }

    /// Writes the force of a register's worth of contacts alone.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put_force<N: Lane>(&mut self, place: usize, normal: &NormalForce<N>) {
        // SAFETY: the caller's promise.
        unsafe {
            self.store(at::FORCE, place, normal.force);
            self.store(at::SEEN, place, normal.seen);
        }
    }

    /// Reads what a normal model made of a register's worth of contacts. What is not looked at is not read.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn normal<N: Lane>(&self, place: usize) -> NormalForce<N> {
        // SAFETY: the caller's promise.
        unsafe {
            NormalForce {
                response: Response {
                    normal_stiffness: self.load(at::NORMAL_STIFFNESS, place),
                    normal_damping: self.load(at::NORMAL_DAMPING, place),
                    tangential_stiffness: self.load(at::TANGENTIAL_STIFFNESS, place),
                    tangential_damping: self.load(at::TANGENTIAL_DAMPING, place),
                },
                force: self.load(at::FORCE, place),
                seen: self.load(at::SEEN, place),
            }
        }
    }

    /// Leaves no normal force of what friction has seen.
    pub(crate) fn mute(&mut self) {
        self.columns[at::FORCE] = [0.0; ROOM];
    }

    /// Leaves of an entry of the batch whose bodies are apart the force along the normal alone; whether they are.
    pub(crate) fn part(&mut self, place: usize) -> bool {
        let apart = self.columns[at::OVERLAP][place] < 0.0;
        if apart {
            let force = self.columns[at::FORCE][place];
            let [x, y, z] = at::NORMAL.map(|column| self.columns[column][place] * force);
            self.force[place] = [x, y, z, 0.0];
            (self.couple[place], self.rolling[place]) = ([0.0; 4], [0.0; 4]);
        }
        apart
    }

    /// Finds the roots that a normal model wants of a register's worth of contacts.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn find_roots<N: Lane, A: NormalForm>(&mut self, place: usize) {
        // SAFETY: the caller's promise. (A closure here would not be compiled for the features of the width.)
        unsafe {
            let (overlap, radius): (N, N) = (self.load(at::OVERLAP, place), self.load(at::RADIUS, place));
            let [one, other] = A::roots(overlap, radius, self.load(at::MASS, place));
            one.store(self.roots[0].as_mut_ptr().add(place));
            other.store(self.roots[1].as_mut_ptr().add(place));
        }
    }

    /// The roots that were found.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn roots<N: Lane>(&self, place: usize) -> Roots<N> {
        // SAFETY: the caller's promise.
        unsafe { [N::load(self.roots[0].as_ptr().add(place)), N::load(self.roots[1].as_ptr().add(place))] }
    }
}
