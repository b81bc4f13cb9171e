//! The batch that goes through the phases.

use super::sphere_pair::SpherePair;
use super::sums::Sums;
use super::{ContactGeometry, FOUND, Touching};
use crate::base::lanes::Lane;
use crate::base::number::{Row, Vector};
use crate::laws::contact::heat::Spot;
use crate::laws::contact::{Carry, Contact, Needs, NormalForce, NormalForm, Response, Roots};
use std::cell::RefCell;
use std::f64::consts::PI;
use std::mem::offset_of;

/// Touching entries of one batch.
pub(crate) const BATCH: usize = 64;

/// Room for a batch: what one register adds beyond it, and what one writes behind that.
const ROOM: usize = BATCH + 16;

/// Columns: what is known of a contact, then what its normal model makes of it.
mod column {
    /// Overlap.
    pub(crate) const OVERLAP: usize = 0;
    /// Effective radius.
    pub(crate) const RADIUS: usize = 1;
    /// Effective mass.
    pub(crate) const MASS: usize = 2;
    /// Unit normal.
    pub(crate) const NORMAL: [usize; 3] = [3, 4, 5];
    /// Velocity along it.
    pub(crate) const NORMAL_VELOCITY: usize = 6;
    /// Slip.
    pub(crate) const SLIP: [usize; 3] = [7, 8, 9];
    /// Arm at the first body.
    pub(crate) const FIRST_ARM: usize = 10;
    /// Arm at the second body.
    pub(crate) const SECOND_ARM: usize = 11;
    /// Relative spin.
    pub(crate) const SPIN: [usize; 3] = [12, 13, 14];
    /// Area of the section.
    pub(crate) const SECTION_AREA: usize = 15;
    /// Radius of the linearised section.
    pub(crate) const SECTION_RADIUS: usize = 16;
    /// k_n.
    pub(crate) const NORMAL_STIFFNESS: usize = 17;
    /// γ_n.
    pub(crate) const NORMAL_DAMPING: usize = 18;
    /// k_t.
    pub(crate) const TANGENTIAL_STIFFNESS: usize = 19;
    /// γ_t.
    pub(crate) const TANGENTIAL_DAMPING: usize = 20;
    /// Force along the normal.
    pub(crate) const FORCE: usize = 21;
    /// What of it friction sees.
    pub(crate) const SEEN: usize = 22;
    /// 1/(R_i + R_j).
    pub(crate) const PER_REACH: usize = 23;
    /// Moment of inertia of rolling.
    pub(crate) const ROLLING_INERTIA: usize = 24;
    /// Sum of the spins.
    pub(crate) const SPIN_SUM: [usize; 3] = [25, 26, 27];
    /// Overlap beyond the offset, of a contact that a bond suppresses or has suppressed.
    pub(crate) const PRESSING: usize = 28;
    /// The offset.
    pub(crate) const OFFSET: usize = 29;
    /// Angular velocities times arms; then how far the bodies slipped.
    pub(crate) const TURNING: [usize; 3] = [30, 31, 32];
    /// 1/distance; then half the turn about the normal.
    pub(crate) const PER_DISTANCE: usize = 33;
    /// What the normal gained.
    pub(crate) const TILT: [usize; 3] = [34, 35, 36];
    /// Part of the step in which the bodies touched.
    pub(crate) const SHARE: usize = 37;
    /// Of a book of losses: the tangential spring before; then, in place of its first component, what of the losses is heat.
    pub(crate) const SPRING: [usize; 3] = [38, 39, 40];
    /// Of a book of losses: velocity along the normal at mid-step.
    pub(crate) const VELOCITY: usize = 41;
    /// Of impacts: what is lost along the normal and across it.
    pub(crate) const LOST: [usize; 2] = [42, 43];
    /// Radius of the circle of contact; then the conductance.
    pub(crate) const CONDUCTANCE: usize = 44;
    /// How many there are.
    pub(crate) const COUNT: usize = 45;
}
use column as at;

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

    /// Overlap and radius of an entry \[m\].
    pub(crate) fn depth(&self, place: usize) -> [f64; 2] {
        [self.columns[at::OVERLAP][place], self.columns[at::RADIUS][place]]
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

    /// Overlaps and effective radii of a register's worth of contacts \[m\].
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn depths<N: Lane>(&self, place: usize) -> [N; 2] {
        // SAFETY: the caller's promise.
        unsafe { [self.load(at::OVERLAP, place), self.load(at::RADIUS, place)] }
    }

    /// A register's worth of contacts as heat sees them, with the radii of both bodies where they are asked for.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn spot<N: Lane>(&self, place: usize, with_radii: bool) -> Spot<N> {
        // SAFETY: the caller's promise.
        unsafe {
            let [overlap, radius] = self.depths(place);
            let at_wall = Spot::at_wall(radius, overlap, self.load(at::CONDUCTANCE, place));
            if !with_radii {
                return at_wall;
            }
            let half = N::splat(0.5) * overlap;
            let arms: [N; 2] = [self.load(at::FIRST_ARM, place), self.load(at::SECOND_ARM, place)];
            let spheres = Spot::of_spheres(arms.map(|arm| arm + half), overlap, at_wall.contact_radius);
            // A wall has no arm.
            let are_spheres = || arms[1].greater(N::zero());
            Spot {
                radii: [
                    N::select(are_spheres(), spheres.radii[0], at_wall.radii[0]),
                    N::select(are_spheres(), spheres.radii[1], at_wall.radii[1]),
                ],
                share: N::select(are_spheres(), spheres.share, at_wall.share),
                per_reach: N::select(are_spheres(), spheres.per_reach, at_wall.per_reach),
                ..at_wall
            }
        }
    }

    /// Stores the radii of the circles of contact of a register's worth of contacts \[m\], or their conductances \[W/K\].
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put_conductance<N: Lane>(&mut self, place: usize, conductance: N) {
        // SAFETY: the caller's promise.
        unsafe { self.store(at::CONDUCTANCE, place, conductance) };
    }

    /// The conductances of the contacts, contact by contact \[W/K\].
    pub(crate) fn conductance(&self) -> &[f64] {
        &self.columns[at::CONDUCTANCE][..self.ready]
    }

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

    /// Overlap and offset of an entry of the batch \[m\].
    pub(crate) fn overlap_and_offset(&self, place: usize) -> [f64; 2] {
        [self.columns[at::OVERLAP][place], self.columns[at::OFFSET][place]]
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
