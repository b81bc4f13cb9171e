//! The law on several bonds at once, and its results on the bodies one by one.
//!
//! Bonds of a slab pass four stages, as many at a time as there are lanes:
//!
//! 1. *meet*: rows of the bodies are loaded and transposed; ends with roots (lengths);
//! 2. *open*: how the pair turned, and what the formulation does before it divides; ends with divisions;
//! 3. *react*: the rest of the law, new state, loads as rows;
//! 4. *spread*: the rows are added to the bodies, one by one, in the order of the list.
//!
//! Damping and breakage follow the third stage where a law has them (`after.rs`).
//!
//! Each turn of the loop does one stage of four successive registers' worth. A root or a quotient is thus needed a whole
//! turn after it was asked for: the processor, which looks only some hundred instructions ahead, does not wait for it.

use super::after::{After, Bonds};
use super::book::{Broken, Done};
use super::pipeline_buffer::{PipelineBuffer, start_of};
use crate::base::lanes::{self, Kernel, Lane, Shared, Width, vector};
use crate::base::memory::prefetch;
use crate::base::number::{add, subtract};
use crate::engine::state::Row;
use crate::laws::bond::damping::{DampingLoad, LastDamping};
use crate::laws::bond::formulation::{Formulation, TakeFormulation};
use crate::laws::bond::{
    Body, Coefficients, Elastic, Elasticity, Lengths, MOST_ROWS, Motion, Opening, Pair, Quaternion, Rates, Rows,
};
use std::marker::PhantomData;

/// Energies of the bonds of a slab, summed in eight places in turn: the sum does not depend on the lane width, and no
/// addition waits for the one before.
type Energies = [f64; 8];

/// What all slabs share.
pub(super) struct Work<'a> {
    /// Section and stiffnesses of the law.
    pub(super) elasticity: &'a Elasticity,
    /// Damping and breakage.
    pub(super) after: &'a After,
    /// Body i of each bond.
    pub(crate) first: &'a [u32],
    /// Body j of each bond.
    pub(crate) second: &'a [u32],
    /// State of each bond, row by row.
    pub(crate) rows: [Shared<Row>; MOST_ROWS],
    /// What damping left in the last evaluation, row by row; empty where there is nothing.
    pub(crate) damping: [Shared<Row>; LastDamping::MOST_ROWS],
    /// Energy that each bond lost; empty where none does.
    pub(crate) lost: Shared<f64>,
    /// Positions and radii.
    pub(crate) position: &'a [Row],
    /// Velocities and masses.
    pub(crate) velocity: &'a [Row],
    /// Angular velocities and moments of inertia.
    pub(crate) angular_velocity: &'a [Row],
    /// Orientations; empty where no law needs them.
    pub(crate) orientation: &'a [Row],
    /// Forces.
    pub(crate) force: Shared<Row>,
    /// Torques.
    pub(crate) torque: Shared<Row>,
    /// Time since bonds were last advanced.
    pub(crate) step: f64,
}

/// Works through a slab of a list: bonds from one up to another, in this lane width.
pub(super) type SlabOf = fn(&Work, usize, usize, Width) -> Done;

/// Takes what works through slabs with a formulation.
pub(super) struct TakeSlabs;

impl TakeFormulation for TakeSlabs {
    type Output = SlabOf;
    fn take<F: Formulation>(self) -> SlabOf {
        slab::<F>
    }
}

/// Works through a slab.
fn slab<F: Formulation>(work: &Work, from: usize, to: usize, width: Width) -> Done {
    let mut done = Done::default();
    if from < to {
        let mut buffer = PipelineBuffer::new();
        let mut energies = [[0.0; 8]; 2];
        let (buffer, lost, told) = (&mut buffer, &mut energies, &mut done);
        let formulation = PhantomData::<F>;
        lanes::run(width, Slab { work, from, to, width, buffer, energies: lost, done: told, formulation });
        done.relaxed = energies[0].iter().sum();
        done.damped = energies[1].iter().sum();
    }
    done
}

/// The stages on one slab.
struct Slab<'a, 'b, F> {
    /// What all slabs share.
    work: &'a Work<'a>,
    /// First bond.
    from: usize,
    /// Behind the last bond.
    to: usize,
    /// Lane width.
    width: Width,
    /// What is under way.
    buffer: &'b mut PipelineBuffer,
    /// What relaxation and damping took.
    energies: &'b mut [Energies; 2],
    /// The other results.
    done: &'b mut Done,
    /// The formulation.
    formulation: PhantomData<F>,
}

impl<F: Formulation> Kernel for Slab<'_, '_, F> {
    #[inline(always)]
    fn run<N: Lane>(mut self) {
        let law = self.work.elasticity.at_step::<N>(self.work.step);
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

/// Asks for the rows of a column that are needed soon, as many as there are lanes from one on.
#[inline(always)]
fn fetch<N: Lane>(column: Shared<Row>, from: usize) {
    let start = column.pointer().wrapping_add(from);
    let mut lane = 0;
    while lane < N::WIDTH {
        prefetch(start.wrapping_add(lane));
        lane += 2;
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
    unsafe fn of<N: Lane>(work: &Work, from: usize, to: usize) -> Self {
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

impl<F: Formulation> Slab<'_, '_, F> {
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
                lanes = Lanes::of::<N>(work, bond, self.to);
                (first, second) = (lanes.first.as_ptr(), lanes.second.as_ptr());
            }
            let mut pair = Pair::of_spheres(&load_body::<F, N>(work, first), &load_body::<F, N>(work, second));
            pair.velocity = vector(N::load_difference(work.velocity.as_ptr(), first, second));
            if work.after.needs_masses {
                self.buffer.put_masses(turn, [pair.mass_i, pair.mass_j, pair.inertia_i, pair.inertia_j]);
            }
            pair
        };
        let mut row = 0;
        while row < F::ROWS {
            fetch::<N>(work.rows[row], bond + AHEAD);
            row += 1;
        }
        if work.after.damping.is_some() {
            for column in work.damping.into_iter().filter(|column| column.length() > 0) {
                fetch::<N>(column, bond + AHEAD);
            }
        }
        self.buffer.put_pairs::<F, N>(turn, &pair, &Lengths::of(F::RATES, law, &pair));
    }

    /// A row of the bonds from one on, out of its column.
    ///
    /// # Safety
    /// As for [`Slab::meet`]; the column has a row for each bond.
    #[inline(always)]
    unsafe fn load<N: Lane>(&self, column: Shared<Row>, bond: usize) -> [N; 4] {
        // SAFETY: the caller's promise; these bonds belong to this slab alone.
        unsafe {
            if self.to - bond < N::WIDTH {
                let lanes = Lanes::of::<N>(self.work, bond, self.to);
                N::load_rows(column.pointer(), lanes.bond.as_ptr())
            } else {
                column.load_block(bond)
            }
        }
    }

    /// Writes a row of the bonds from one on to its column.
    ///
    /// # Safety
    /// As for [`Slab::load`].
    #[inline(always)]
    unsafe fn store<N: Lane>(&self, row: [N; 4], column: Shared<Row>, bond: usize) {
        // SAFETY: as for `load`; a repeated row is written twice with the same.
        unsafe {
            if self.to - bond < N::WIDTH {
                let lanes = Lanes::of::<N>(self.work, bond, self.to);
                N::store_rows(row, column.pointer(), lanes.bond.as_ptr());
            } else {
                column.store_block(row, bond);
            }
        }
    }

    /// State of the bonds.
    ///
    /// # Safety
    /// As for [`Slab::meet`].
    #[inline(always)]
    unsafe fn rows<N: Lane>(&self, bond: usize) -> Rows<N> {
        let mut rows: Rows<N> = [[N::zero(); 4]; MOST_ROWS];
        let mut row = 0;
        while row < F::ROWS {
            // SAFETY: the caller's promise.
            rows[row] = unsafe { self.load(self.work.rows[row], bond) };
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
        let (pair, lengths) = self.buffer.pairs::<F, N>(turn);
        let opening = Opening::of(F::RATES, law, &pair, &lengths);
        let mut rows: Rows<N> = [[N::zero(); 4]; MOST_ROWS];
        if F::HALFWAY > 0 {
            // SAFETY: the caller's promise.
            rows = unsafe { self.rows(self.bond::<N>(turn)) };
        }
        let halfway = F::halfway(&pair, lengths.distance, &rows);
        self.buffer.put_opened::<F, N>(turn, &opening, &halfway);
    }

    /// The formulation, and what follows it.
    ///
    /// # Safety
    /// As for [`Slab::meet`].
    #[inline(always)]
    unsafe fn react<N: Lane>(&mut self, law: &Coefficients<N>, turn: usize) {
        let (work, bond) = (self.work, self.bond::<N>(turn));
        let (pair, lengths) = self.buffer.pairs::<F, N>(turn);
        let (opening, halfway) = self.buffer.opened::<F, N>(turn);
        let motion = Motion::after(F::RATES, law, &pair, &lengths, &opening);
        // SAFETY: the caller's promise.
        let rows = unsafe { self.rows(bond) };
        let elastic = F::finish(law, &pair, &motion, &halfway, &rows);
        let mut row = F::FIXED_ROWS;
        while row < F::ROWS && work.step > 0.0 {
            // SAFETY: the caller's promise.
            unsafe { self.store(elastic.rows[row], work.rows[row], bond) };
            row += 1;
        }
        if F::RELAXES {
            self.buffer.answer.put_relaxed(elastic.relaxed);
        }
        if N::any(elastic.overbent) && self.done.overbent.is_none() {
            // Lanes behind the last bond repeat the first one.
            self.done.overbent = Some((bond + N::bits(elastic.overbent).trailing_zeros() as usize) as u32);
        }
        if work.after.damping.is_none() {
            self.buffer.put_loads(turn, [elastic.force, elastic.torque_i, elastic.torque_j]);
        }
        if !work.after.is_empty() {
            self.buffer.answer.loaded.put(&pair, &motion, &elastic);
            // SAFETY: the caller's promise.
            unsafe { self.follow::<N>(turn, &motion, &elastic) };
        }
        if F::RELAXES || work.after.damping.is_some() {
            self.sum_losses(bond, usize::min(self.to - bond, N::WIDTH));
        }
    }

    /// Damping and breakage.
    ///
    /// # Safety
    /// As for [`Slab::meet`].
    #[inline(always)]
    unsafe fn follow<N: Lane>(&mut self, turn: usize, motion: &Motion<N>, elastic: &Elastic<N>) {
        let Work { after, elasticity, step, .. } = *self.work;
        let (start, bond) = (start_of::<F>(turn), self.bond::<N>(turn));
        if let (Some(damping), true) = (&after.damping, F::RATES != Rates::Unseen) {
            let [force, torque_i, torque_j, across, about] = self.work.damping;
            let mut motion = motion.settled();
            // SAFETY: the caller's promise; a bond that is damped has these rows.
            let last = unsafe {
                if after.foresees && step > 0.0 {
                    let rates = motion.rates();
                    motion = motion.foreseen([self.load(across, bond), self.load(about, bond)]);
                    self.store(rates[0], across, bond);
                    self.store(rates[1], about, bond);
                }
                [force, torque_i, torque_j].map(|column| self.load::<N>(column, bond))
            };
            self.buffer.answer.put_damping(&DampingLoad::from_rows(last));
            self.buffer.answer.put_motion(&motion, elastic);
            damping.run(self.width, Bonds { elasticity, step, buffer: self.buffer, turn, start });
            let rows = self.buffer.answer.damping::<N>().to_rows();
            for (column, row) in [force, torque_i, torque_j].into_iter().zip(rows) {
                // SAFETY: as above.
                unsafe { self.store(row, column, bond) };
            }
        }
        for (rule, before) in &after.breakage {
            let loaded = &mut self.buffer.answer.loaded;
            rule.judge_several(self.width, loaded, elasticity.radius_multiplier, *before);
        }
        if self.buffer.answer.loaded.breaks {
            self.break_bonds(turn, bond, usize::min(self.to - bond, N::WIDTH));
        }
    }

    /// Notes which of so many bonds from one on broke; they act no more.
    #[cold]
    fn break_bonds(&mut self, turn: usize, bond: usize, count: usize) {
        for lane in 0..count {
            let cause = self.buffer.answer.loaded.cause[0][lane];
            if cause != 0.0 {
                self.buffer.clear(turn, lane);
                self.done.broken.push(Broken::new((bond + lane) as u32, cause));
            }
        }
    }

    /// Notes what so many bonds from one on lost.
    #[inline(always)]
    fn sum_losses(&mut self, bond: usize, count: usize) {
        for lane in 0..count {
            let place = (bond - self.from + lane) % 8;
            let [relaxed, damped] = self.buffer.answer.taken(lane);
            self.energies[0][place] += relaxed;
            self.energies[1][place] += damped;
            if self.work.lost.length() > 0 {
                // SAFETY: there is one for each bond, and this bond belongs to this slab alone.
                unsafe { *self.work.lost.at(bond + lane) += relaxed + damped };
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
        let loads = self.buffer.loads(turn);
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

/// How many bonds ahead of the loaded ones the state is fetched.
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
    fn of(work: &Work, bond: usize) -> Self {
        Self::at(work, work.first[bond].min(work.second[bond]) as usize)
    }

    /// Of this particle.
    #[inline(always)]
    fn at(work: &Work, slot: usize) -> Self {
        // SAFETY: slabs worked on at the same time do not share particles.
        unsafe { Self { slot, force: *work.force.at(slot), torque: *work.torque.at(slot) } }
    }

    /// Back to where they are kept.
    #[inline(always)]
    fn put(&self, work: &Work) {
        // SAFETY: as above.
        unsafe { (*work.force.at(self.slot), *work.torque.at(self.slot)) = (self.force, self.torque) };
    }
}

/// Loads a body in each lane.
///
/// # Safety
/// `slots` points to [`Lane::WIDTH`] slots of the list.
#[inline(always)]
unsafe fn load_body<F: Formulation, N: Lane>(work: &Work, slots: *const u32) -> Body<N> {
    // SAFETY: a list holds slots of particles, below their number; orientations are there where a law needs them.
    unsafe {
        let position = N::load_rows(work.position.as_ptr(), slots);
        let velocity = N::load_rows(work.velocity.as_ptr(), slots);
        let spin = N::load_rows(work.angular_velocity.as_ptr(), slots);
        let orientation = if F::NEEDS_ORIENTATIONS {
            Quaternion::from_row(N::load_rows(work.orientation.as_ptr(), slots))
        } else {
            Quaternion::identity()
        };
        Body {
            position: vector(position),
            velocity: vector(velocity),
            spin: vector(spin),
            orientation,
            radius: position[3],
            mass: velocity[3],
            inertia: spin[3],
        }
    }
}
