//! The law on several bonds at once, and its results on the bodies one by one.
//!
//! Bonds of a slab pass four stages, as many at a time as there are lanes:
//!
//! 1. *meet*: rows of the bodies are loaded and transposed; ends with roots (lengths);
//! 2. *open*: how the pair turned, and what the formulation does before it divides; ends with divisions;
//! 3. *react*: the rest of the law, new state, loads as rows;
//! 4. *spread*: the rows are added to the bodies, one by one, in the order of the list.
//!
//! Each turn of the loop does one stage of four successive registers' worth. A root or a quotient is thus needed a whole
//! turn after it was asked for: the processor, which looks only some hundred instructions ahead, does not wait for it.

use super::book::Done;
use super::pipeline_buffer::PipelineBuffer;
use crate::bond::{
    Body, BondLaw, Coefficients, Law, Lengths, MOST_ROWS, Motion, Opening, Pair, Quaternion, Reaction, Rows,
};
use crate::interactions::batch::{add, subtract};
use crate::lanes::{self, Kernel, Lane, Shared, Width, columns, prefetch, vector};
use crate::state::Row;
use std::marker::PhantomData;

/// Energies of the bonds of a slab, summed in eight places in turn: the sum does not depend on the lane width, and no
/// addition waits for the one before.
type Energies = [f64; 8];

/// What all slabs share.
pub(crate) struct Work<'a, L> {
    /// The law in numbers.
    pub(crate) numbers: &'a Law,
    /// Body i of each bond.
    pub(crate) first: &'a [u32],
    /// Body j of each bond.
    pub(crate) second: &'a [u32],
    /// State of each bond, row by row.
    pub(crate) rows: [Shared<Row>; MOST_ROWS],
    /// Energy that each bond lost; empty where none does.
    pub(crate) lost: Shared<f64>,
    /// Positions and radii.
    pub(crate) position: &'a [Row],
    /// Velocities and masses.
    pub(crate) velocity: &'a [Row],
    /// Angular velocities and moments of inertia.
    pub(crate) angular_velocity: &'a [Row],
    /// Attitudes; empty where no law needs them.
    pub(crate) attitude: &'a [Row],
    /// Forces.
    pub(crate) force: Shared<Row>,
    /// Torques.
    pub(crate) torque: Shared<Row>,
    /// Time since bonds were last advanced.
    pub(crate) step: f64,
    /// The law.
    pub(crate) law: PhantomData<fn() -> L>,
}

impl<L: BondLaw> Work<'_, L> {
    /// Works through a slab.
    pub(crate) fn slab(&self, from: usize, to: usize, width: Width) -> Done {
        let mut done = Done::default();
        if from < to {
            let (mut ring, mut energies) = (PipelineBuffer::new(), [[0.0; 8]; 2]);
            let (ring, lost, told) = (&mut ring, &mut energies, &mut done);
            lanes::run(width, Slab { work: self, from, to, ring, energies: lost, done: told });
            done.relaxed = energies[0].iter().sum();
            done.damped = energies[1].iter().sum();
        }
        done
    }
}

/// The stages on one slab.
struct Slab<'a, 'b, L> {
    /// What all slabs share.
    work: &'a Work<'a, L>,
    /// First bond.
    from: usize,
    /// Behind the last bond.
    to: usize,
    /// What is under way.
    ring: &'b mut PipelineBuffer,
    /// What relaxation and damping took.
    energies: &'b mut [Energies; 2],
    /// What else it came to.
    done: &'b mut Done,
}

impl<L: BondLaw> Kernel for Slab<'_, '_, L> {
    #[inline(always)]
    fn run<N: Lane>(mut self) {
        let law = self.work.numbers.coefficients::<N>(self.work.step);
        let count = (self.to - self.from).div_ceil(N::WIDTH);
        let mut held = Held::of(self.work, self.from);
        let mut turn = 0;
        while turn < count + 3 {
            // SAFETY: bonds up to `to` are in the list. The oldest first: what they read must be there before others write.
            unsafe {
                if turn >= 3 {
                    self.spread::<N>(&mut held, turn - 3);
                }
                if turn.wrapping_sub(2) < count {
                    self.react::<N>(&law, turn - 2);
                }
                if turn.wrapping_sub(1) < count {
                    self.open::<N>(&law, turn - 1);
                }
                if turn < count {
                    self.meet::<N>(&law, turn);
                }
            }
            turn += 1;
        }
        held.put(self.work);
    }
}

/// Some bonds, as many as there are lanes; where the slab ends earlier, the first one is repeated.
struct Lanes {
    /// Bonds.
    bond: [u32; 8],
    /// Bodies i.
    first: [u32; 8],
    /// Bodies j.
    second: [u32; 8],
}

impl Lanes {
    /// Those from this bond on.
    ///
    /// # Safety
    /// Bonds from `from` up to `to` are in the list, and at least one.
    #[inline(always)]
    unsafe fn of<L, N: Lane>(work: &Work<L>, from: usize, to: usize) -> Self {
        let mut lanes = Self { bond: [0; 8], first: [0; 8], second: [0; 8] };
        let mut lane = 0;
        while lane < N::WIDTH {
            let bond = if from + lane < to { from + lane } else { from };
            lanes.bond[lane] = bond as u32;
            // SAFETY: the caller's promise.
            unsafe {
                lanes.first[lane] = *work.first.get_unchecked(bond);
                lanes.second[lane] = *work.second.get_unchecked(bond);
            }
            lane += 1;
        }
        lanes
    }
}

impl<L: BondLaw> Slab<'_, '_, L> {
    /// First of the bonds that are worked on together.
    #[inline(always)]
    fn bond<N: Lane>(&self, turn: usize) -> usize {
        self.from + turn * N::WIDTH
    }

    /// Where the bodies stand and how they move.
    ///
    /// # Safety
    /// The bonds are in the list.
    #[inline(always)]
    unsafe fn meet<N: Lane>(&mut self, law: &Coefficients<N>, turn: usize) {
        let (work, bond) = (self.work, self.bond::<N>(turn));
        let (mut first, mut second) = (work.first.as_ptr().wrapping_add(bond), work.second.as_ptr().wrapping_add(bond));
        let lanes;
        // SAFETY: both point to as many slots of particles as there are lanes.
        let pair = unsafe {
            if self.to - bond < N::WIDTH {
                lanes = Lanes::of::<L, N>(work, bond, self.to);
                (first, second) = (lanes.first.as_ptr(), lanes.second.as_ptr());
            }
            let mut pair = Pair::of_spheres(&load_body::<L, N>(work, first), &load_body::<L, N>(work, second));
            pair.velocity = vector(N::load_difference(work.velocity.as_ptr(), first, second));
            pair
        };
        let mut row = 0;
        while row < L::ROWS {
            let start = work.rows[row].pointer().wrapping_add(bond + AHEAD);
            let mut lane = 0;
            while lane < N::WIDTH {
                prefetch(start.wrapping_add(lane));
                lane += 2;
            }
            row += 1;
        }
        self.ring.put_pairs::<L, N>(turn, &pair, &Lengths::of(L::RATES, law, &pair));
    }

    /// State of the bonds.
    ///
    /// # Safety
    /// As for [`Slab::meet`].
    #[inline(always)]
    unsafe fn rows<N: Lane>(&self, bond: usize) -> Rows<N> {
        let mut rows: Rows<N> = [[N::zero(); 4]; MOST_ROWS];
        let mut row = 0;
        while row < L::ROWS {
            let column = self.work.rows[row].pointer();
            // SAFETY: each column has a row for each bond; these bonds belong to this slab alone.
            rows[row] = unsafe {
                if self.to - bond < N::WIDTH {
                    let lanes = Lanes::of::<L, N>(self.work, bond, self.to);
                    N::load_rows(column, lanes.bond.as_ptr())
                } else {
                    N::load_block(column.add(bond))
                }
            };
            row += 1;
        }
        rows
    }

    /// What comes before the divisions.
    ///
    /// # Safety
    /// As for [`Slab::meet`].
    #[inline(always)]
    unsafe fn open<N: Lane>(&mut self, law: &Coefficients<N>, turn: usize) {
        let (pair, lengths) = self.ring.pairs::<L, N>(turn);
        let opening = Opening::of(L::RATES, law, &pair, &lengths);
        let mut rows: Rows<N> = [[N::zero(); 4]; MOST_ROWS];
        if L::HALFWAY > 0 {
            // SAFETY: the caller's promise.
            rows = unsafe { self.rows(self.bond::<N>(turn)) };
        }
        let halfway = L::halfway(&pair, lengths.distance, &rows);
        self.ring.put_opened::<L, N>(turn, &opening, &halfway);
    }

    /// The law.
    ///
    /// # Safety
    /// As for [`Slab::meet`].
    #[inline(always)]
    unsafe fn react<N: Lane>(&mut self, law: &Coefficients<N>, turn: usize) {
        let (work, bond) = (self.work, self.bond::<N>(turn));
        let (pair, lengths) = self.ring.pairs::<L, N>(turn);
        let (opening, halfway) = self.ring.opened::<L, N>(turn);
        let motion = Motion::after(L::RATES, law, &pair, &lengths, &opening);
        // SAFETY: the caller's promise.
        let rows = unsafe { self.rows(bond) };
        let reaction = L::act(law, &pair, &motion, &halfway, &rows);
        let loads = self.ring.loads_mut(turn);
        // SAFETY: there is room for a register; rows as in `rows`, a repeated one is written twice with the same.
        unsafe {
            N::store_block(columns(reaction.force), loads.force.as_mut_ptr());
            N::store_block(columns(reaction.torque_i), loads.first_torque.as_mut_ptr());
            N::store_block(columns(reaction.torque_j), loads.second_torque.as_mut_ptr());
            let mut row = L::FIXED_ROWS;
            while row < L::ROWS && work.step > 0.0 {
                let column = work.rows[row].pointer();
                if self.to - bond < N::WIDTH {
                    let lanes = Lanes::of::<L, N>(work, bond, self.to);
                    N::store_rows(reaction.rows[row], column, lanes.bond.as_ptr());
                } else {
                    N::store_block(reaction.rows[row], column.add(bond));
                }
                row += 1;
            }
        }
        self.note(bond, &reaction);
    }

    /// Notes what broke, what was bent too far, and what the bonds lost.
    #[inline(always)]
    fn note<N: Lane>(&mut self, bond: usize, reaction: &Reaction<N>) {
        let here = if self.to - bond < N::WIDTH { self.to - bond } else { N::WIDTH };
        if N::any(reaction.cause.greater(N::zero())) {
            let mut causes = [0.0; 8];
            // SAFETY: there is room for a register.
            unsafe { reaction.cause.store(causes.as_mut_ptr()) };
            for (lane, &cause) in causes[..here].iter().enumerate().filter(|(_, cause)| **cause != 0.0) {
                self.done.broken.push(((bond + lane) as u32, cause, 0.0));
            }
        }
        if N::any(reaction.overbent) && self.done.overbent.is_none() {
            // Lanes behind the last bond repeat the first one.
            self.done.overbent = Some((bond + N::bits(reaction.overbent).trailing_zeros() as usize) as u32);
        }
        if L::RELAXES || L::DAMPS {
            let (mut relaxed, mut damped) = ([0.0; 8], [0.0; 8]);
            // SAFETY: there is room for a register.
            unsafe {
                reaction.relaxed.store(relaxed.as_mut_ptr());
                reaction.damped.store(damped.as_mut_ptr());
            }
            for lane in 0..here {
                let place = (bond - self.from + lane) % 8;
                self.energies[0][place] += relaxed[lane];
                self.energies[1][place] += damped[lane];
                if self.work.lost.length() > 0 {
                    // SAFETY: there is one for each bond, and this bond belongs to this slab alone.
                    unsafe { *self.work.lost.at(bond + lane) += relaxed[lane] + damped[lane] };
                }
            }
        }
    }

    /// Adds the loads to both bodies of each bond.
    ///
    /// # Safety
    /// As for [`Slab::meet`]; slabs worked on at the same time do not share particles.
    #[inline(always)]
    unsafe fn spread<N: Lane>(&mut self, held: &mut Held, turn: usize) {
        let (work, bond) = (self.work, self.bond::<N>(turn));
        let loads = self.ring.loads(turn);
        let here = if self.to - bond < N::WIDTH { self.to - bond } else { N::WIDTH };
        let mut lane = 0;
        while lane < here {
            // SAFETY: the caller's promise.
            unsafe {
                let (i, j) = (*work.first.get_unchecked(bond + lane), *work.second.get_unchecked(bond + lane));
                let (one, other) = (&loads.first_torque[lane], &loads.second_torque[lane]);
                let sign = if i < j { 1.0 } else { -1.0 };
                let (low, high) = if i < j { (i, j) } else { (j, i) };
                let (of_low, of_high) = if i < j { (one, other) } else { (other, one) };
                let push = loads.force[lane].map(|part| part * sign);
                if low as usize != held.slot {
                    held.put(work);
                    *held = Held::at(work, low as usize);
                }
                add(&mut held.force, &push);
                add(&mut held.torque, of_low);
                subtract(work.force.at(high as usize), &push);
                add(work.torque.at(high as usize), of_high);
            }
            lane += 1;
        }
    }
}

/// Bonds ahead of those that are loaded whose state is asked for.
const AHEAD: usize = 32;

/// Loads of the particle whose bonds are worked on. Bonds stand side by side by that of their bodies which comes first in
/// memory: its loads stay in registers until the next one comes, as adding in memory again and again is a chain.
struct Held {
    /// The particle.
    slot: usize,
    /// Force on it.
    force: Row,
    /// Torque on it.
    torque: Row,
}

impl Held {
    /// Of the first body of this bond.
    #[inline(always)]
    fn of<L>(work: &Work<L>, bond: usize) -> Self {
        Self::at(work, work.first[bond].min(work.second[bond]) as usize)
    }

    /// Of this particle.
    #[inline(always)]
    fn at<L>(work: &Work<L>, slot: usize) -> Self {
        // SAFETY: slabs worked on at the same time do not share particles.
        unsafe { Self { slot, force: *work.force.at(slot), torque: *work.torque.at(slot) } }
    }

    /// Back to where they are kept.
    #[inline(always)]
    fn put<L>(&self, work: &Work<L>) {
        // SAFETY: as above.
        unsafe { (*work.force.at(self.slot), *work.torque.at(self.slot)) = (self.force, self.torque) };
    }
}

/// Loads a body in each lane.
///
/// # Safety
/// `slots` points to [`Lane::WIDTH`] slots of the list.
#[inline(always)]
unsafe fn load_body<L: BondLaw, N: Lane>(work: &Work<L>, slots: *const u32) -> Body<N> {
    // SAFETY: a list holds slots of particles, below their number; attitudes are there where a law needs them.
    unsafe {
        let position = N::load_rows(work.position.as_ptr(), slots);
        let velocity = N::load_rows(work.velocity.as_ptr(), slots);
        let spin = N::load_rows(work.angular_velocity.as_ptr(), slots);
        let attitude = if L::NEEDS_ATTITUDES {
            Quaternion::from_row(N::load_rows(work.attitude.as_ptr(), slots))
        } else {
            Quaternion::identity()
        };
        Body {
            position: vector(position),
            velocity: vector(velocity),
            spin: vector(spin),
            attitude,
            radius: position[3],
            mass: velocity[3],
            inertia: spin[3],
        }
    }
}
