//! Contacts in their columns: geometry, relative motion, and how springs and dashpots were carried.

use super::{Buffer, at};
use crate::base::lanes::Lane;
use crate::laws::contact::batch::ContactGeometry;
use crate::laws::contact::{Carry, Contact, Needs};

impl Buffer {
    /// Overlap and radius of an entry \[m\].
    pub(crate) fn depth(&self, place: usize) -> [f64; 2] {
        [self.columns[at::OVERLAP][place], self.columns[at::RADIUS][place]]
    }

    /// Writes a register's worth of contacts.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put<N: Lane, const TORQUE: bool>(
        &mut self,
        place: usize,
        geometry: &ContactGeometry<N>,
        needs: Needs,
    ) {
        let ContactGeometry { contact, first_arm, second_arm } = geometry;
        // SAFETY: the caller's promise.
        unsafe {
            self.store(at::OVERLAP, place, contact.overlap);
            self.store(at::RADIUS, place, contact.radius);
            self.store(at::MASS, place, contact.mass);
            self.store_vector(at::NORMAL, place, contact.normal);
            self.store(at::NORMAL_VELOCITY, place, contact.normal_velocity);
            self.store(at::FIRST_ARM, place, *first_arm);
            if TORQUE || needs.section {
                self.store(at::SECOND_ARM, place, *second_arm);
            }
            if TORQUE || needs.carry {
                self.store_vector(at::SLIP, place, contact.slip);
            }
            if needs.carry {
                self.store_vector(at::TURNING, place, contact.turning);
                self.store(at::PER_DISTANCE, place, contact.per_distance);
                self.store_vector(at::SPIN_SUM, place, contact.spin_sum);
            }
            if TORQUE && needs.spin {
                self.store_vector(at::SPIN, place, contact.relative_spin);
            }
            if needs.bodies {
                self.store(at::PER_REACH, place, contact.per_reach);
                self.store(at::ROLLING_INERTIA, place, contact.rolling_inertia);
            }
            if TORQUE && needs.spin_sum && !needs.carry {
                self.store_vector(at::SPIN_SUM, place, contact.spin_sum);
            }
            if needs.section {
                self.store(at::SECTION_AREA, place, contact.section_area);
                self.store(at::SECTION_RADIUS, place, contact.section_radius);
            }
        }
    }

    /// Reads a register's worth of contacts. What is not looked at is not read.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn contact<N: Lane>(&self, place: usize, pair_constant: N) -> Contact<N> {
        // SAFETY: the caller's promise.
        unsafe {
            Contact {
                overlap: self.load(at::OVERLAP, place),
                radius: self.load(at::RADIUS, place),
                mass: self.load(at::MASS, place),
                normal: self.load_vector(at::NORMAL, place),
                normal_velocity: self.load(at::NORMAL_VELOCITY, place),
                slip: self.load_vector(at::SLIP, place),
                relative_spin: self.load_vector(at::SPIN, place),
                spin_sum: self.load_vector(at::SPIN_SUM, place),
                turning: self.load_vector(at::TURNING, place),
                per_distance: self.load(at::PER_DISTANCE, place),
                per_reach: self.load(at::PER_REACH, place),
                rolling_inertia: self.load(at::ROLLING_INERTIA, place),
                section_area: self.load(at::SECTION_AREA, place),
                section_radius: self.load(at::SECTION_RADIUS, place),
                pair_constant,
            }
        }
    }

    /// Gives a register's worth of contacts the slip and, at walls, the arms of undeformed bodies.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn undeform_arms<N: Lane>(&mut self, place: usize) {
        // SAFETY: the caller's promise.
        unsafe {
            let contact = self.contact(place, N::zero()).with_undeformed_arms();
            self.store_vector(at::SLIP, place, contact.slip);
            self.store_vector(at::TURNING, place, contact.turning);
            let arm: N = self.load(at::FIRST_ARM, place);
            let between_bodies = contact.per_reach.greater(N::zero());
            self.store(at::FIRST_ARM, place, N::select(between_bodies, arm, contact.radius));
        }
    }

    /// Writes how a register's worth of contacts was carried, over what that was found from, and the velocities that
    /// dashpots see.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put_carry<N: Lane>(&mut self, place: usize, carry: &Carry<N>, contact: &Contact<N>) {
        // SAFETY: the caller's promise.
        unsafe {
            self.store_vector(at::TURNING, place, carry.stretch);
            self.store(at::PER_DISTANCE, place, carry.twist);
            self.store_vector(at::TILT, place, carry.tilt);
            self.store(at::SHARE, place, carry.share);
            self.store(at::NORMAL_VELOCITY, place, contact.normal_velocity);
            self.store_vector(at::SLIP, place, contact.slip);
        }
    }

    /// Writes the velocities along the normal that dashpots see, and the weight of γ_t.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put_foreseen<N: Lane>(&mut self, place: usize, velocity: N, weight: N) {
        // SAFETY: the caller's promise.
        unsafe {
            self.store(at::NORMAL_VELOCITY, place, velocity);
            self.store(at::SHARE, place, weight);
        }
    }

    /// Reads the weight of γ_t.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn weight<N: Lane>(&self, place: usize) -> N {
        // SAFETY: the caller's promise.
        unsafe { self.load(at::SHARE, place) }
    }

    /// Reads how a register's worth of contacts was carried.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn carry<N: Lane>(&self, place: usize) -> Carry<N> {
        // SAFETY: the caller's promise.
        unsafe {
            Carry {
                stretch: self.load_vector(at::TURNING, place),
                twist: self.load(at::PER_DISTANCE, place),
                tilt: self.load_vector(at::TILT, place),
                share: self.load(at::SHARE, place),
            }
        }
    }

    /// Overlaps and effective radii of a register's worth of contacts \[m\].
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn depths<N: Lane>(&self, place: usize) -> [N; 2] {
        // SAFETY: the caller's promise.
        unsafe { [self.load(at::OVERLAP, place), self.load(at::RADIUS, place)] }
    }
}
