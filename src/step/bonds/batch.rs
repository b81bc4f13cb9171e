//! The law on several bonds at once, batch by batch, and its results on the bodies one by one.

use super::book::Done;
use crate::bond::{Body, BondLaw, Law, MOST_ROWS, Pair, Quaternion, Rows};
use crate::state::Row;
use crate::step::batch::{add, subtract};
use crate::step::lanes::{self, Kernel, Lane, Shared, Width, columns, vector};
use std::marker::PhantomData;

/// Bonds in one batch.
const BATCH: usize = 64;

/// Room for a batch and what a register writes beyond it.
const ROOM: usize = BATCH + 8;

/// Energies of the bonds of a slab, summed in eight places in turn: the sum does not depend on the lane width, and no
/// addition waits for the one before.
type Energies = [f64; 8];

/// What all slabs share.
pub(super) struct Work<'a, L> {
    /// The law in numbers.
    pub(super) numbers: &'a Law,
    /// Body i of each bond.
    pub(super) first: &'a [u32],
    /// Body j of each bond.
    pub(super) second: &'a [u32],
    /// State of each bond, row by row.
    pub(super) rows: [Shared<Row>; MOST_ROWS],
    /// Energy that each bond lost; empty where none does.
    pub(super) lost: Shared<f64>,
    /// Positions and radii.
    pub(super) position: &'a [Row],
    /// Velocities and masses.
    pub(super) velocity: &'a [Row],
    /// Angular velocities and moments of inertia.
    pub(super) angular_velocity: &'a [Row],
    /// Attitudes; empty where no law needs them.
    pub(super) attitude: &'a [Row],
    /// Forces.
    pub(super) force: Shared<Row>,
    /// Torques.
    pub(super) torque: Shared<Row>,
    /// Time since bonds were last advanced.
    pub(super) step: f64,
    /// The law.
    pub(super) law: PhantomData<fn() -> L>,
}

/// Results of a batch.
#[repr(align(64))]
struct Buffer {
    /// Force on i.
    force: [Row; ROOM],
    /// Torque on i.
    first_torque: [Row; ROOM],
    /// Torque on j.
    second_torque: [Row; ROOM],
    /// 0, or why the bond broke.
    cause: [f64; ROOM],
    /// Elastic energy that relaxation took.
    relaxed: [f64; ROOM],
    /// Energy that damping took.
    damped: [f64; ROOM],
    /// Whether a bond of the batch broke.
    broken: bool,
    /// A bond bent beyond what can be followed.
    overbent: Option<u32>,
}

impl Buffer {
    /// An empty one.
    fn new() -> Self {
        let (rows, numbers) = ([[0.0; 4]; ROOM], [0.0; ROOM]);
        Self {
            force: rows,
            first_torque: rows,
            second_torque: rows,
            cause: numbers,
            relaxed: numbers,
            damped: numbers,
            broken: false,
            overbent: None,
        }
    }

    /// Notes the bonds that broke and sums what the bonds lost of a batch of `count` bonds
    /// from `first`.
    fn sum<L: BondLaw>(&mut self, first: usize, count: usize, energies: &mut [Energies; 2], done: &mut Done) {
        if self.broken {
            for place in (0..count).filter(|&place| self.cause[place] != 0.0) {
                done.broken.push(((first + place) as u32, self.cause[place], 0.0));
            }
        }
        if !L::RELAXES && !L::DAMPS {
            return;
        }
        let filled = count.next_multiple_of(8);
        let [relaxed, damped] = energies;
        for (sum, energy) in [(relaxed, &mut self.relaxed), (damped, &mut self.damped)] {
            energy[count..filled].fill(0.0);
            for part in energy[..filled].chunks_exact(8) {
                for (sum, part) in sum.iter_mut().zip(part) {
                    *sum += part;
                }
            }
        }
    }
}

impl<L: BondLaw> Work<'_, L> {
    /// Works through a slab, batch by batch.
    pub(super) fn slab(&self, from: usize, to: usize, width: Width) -> Done {
        let mut done = Done::default();
        let mut buffer = Buffer::new();
        let mut energies = [[0.0; 8]; 2];
        let mut batch = from;
        while batch < to {
            let end = (batch + BATCH).min(to);
            buffer.broken = false;
            lanes::run(width, React { work: self, from: batch, to: end, buffer: &mut buffer });
            lanes::run(width, Spread { work: self, from: batch, to: end, buffer: &buffer });
            buffer.sum::<L>(batch, end - batch, &mut energies, &mut done);
            self.lose(batch, end, &buffer);
            batch = end;
        }
        done.relaxed = energies[0].iter().sum();
        done.damped = energies[1].iter().sum();
        done.overbent = buffer.overbent;
        done
    }

    /// Notes what each bond of a batch lost, where any does.
    fn lose(&self, from: usize, to: usize, buffer: &Buffer) {
        if self.lost.length() == 0 {
            return;
        }
        for bond in from..to {
            let place = bond - from;
            // SAFETY: there is one for each bond, and this bond belongs to this slab alone.
            unsafe { *self.lost.at(bond) += buffer.relaxed[place] + buffer.damped[place] };
        }
    }
}

/// Adds the results of a batch to both bodies of each bond.
struct Spread<'a, 'b, L> {
    /// What all slabs share.
    work: &'a Work<'a, L>,
    /// First bond.
    from: usize,
    /// Behind the last bond.
    to: usize,
    /// The results.
    buffer: &'b Buffer,
}

impl<L: BondLaw> Kernel for Spread<'_, '_, L> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { work, from, to, buffer } = self;
        let (firsts, seconds) = (&work.first[from..to], &work.second[from..to]);
        let results = buffer.force.iter().zip(&buffer.first_torque).zip(&buffer.second_torque);
        for ((&i, &j), ((force, first_torque), second_torque)) in firsts.iter().zip(seconds).zip(results) {
            // SAFETY: slabs worked on at the same time do not share particles.
            unsafe {
                add(work.force.at(i as usize), force);
                subtract(work.force.at(j as usize), force);
                add(work.torque.at(i as usize), first_torque);
                add(work.torque.at(j as usize), second_torque);
            }
        }
    }
}

/// The law on one batch.
struct React<'a, 'b, L> {
    /// What all slabs share.
    work: &'a Work<'a, L>,
    /// First bond.
    from: usize,
    /// Behind the last bond.
    to: usize,
    /// Where the results go.
    buffer: &'b mut Buffer,
}

impl<L: BondLaw> Kernel for React<'_, '_, L> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { work, from, to, buffer } = self;
        let law = work.numbers.coefficients::<N>(work.step);
        let mut bond = from;
        while bond < to {
            let here = if to - bond < N::WIDTH { to - bond } else { N::WIDTH };
            let mut index = [0_u32; 8];
            let (mut some_first, mut some_second) = ([0_u32; 8], [0_u32; 8]);
            // SAFETY: bonds up to `to` are in the list.
            let (mut first, mut second) = unsafe { (work.first.as_ptr().add(bond), work.second.as_ptr().add(bond)) };
            let mut lane = 0;
            while lane < N::WIDTH {
                index[lane] = (bond + lane) as u32;
                lane += 1;
            }
            if here < N::WIDTH {
                // The first one is repeated, and its rows are written twice with the same.
                let mut lane = 0;
                while lane < N::WIDTH {
                    let listed = if lane < here { lane } else { 0 };
                    index[lane] = (bond + listed) as u32;
                    // SAFETY: as above.
                    unsafe {
                        some_first[lane] = *first.add(listed);
                        some_second[lane] = *second.add(listed);
                    }
                    lane += 1;
                }
                (first, second) = (some_first.as_ptr(), some_second.as_ptr());
            }
            // SAFETY: both point to as many slots as there are lanes.
            let pair = unsafe { Pair::of_spheres(&load_body::<L, N>(work, first), &load_body::<L, N>(work, second)) };
            let mut rows: Rows<N> = [[N::zero(); 4]; MOST_ROWS];
            let mut row = 0;
            while row < L::ROWS {
                // SAFETY: each column has a row for each bond; these bonds belong to this slab alone.
                rows[row] = unsafe { N::load_rows(work.rows[row].pointer(), index.as_ptr()) };
                row += 1;
            }
            let reaction = L::react(&law, &pair, &rows);
            let place = bond - from;
            // SAFETY: the buffer has room for a register beyond the batch; rows as above.
            unsafe {
                N::store_block(columns(reaction.force), buffer.force.as_mut_ptr().add(place));
                N::store_block(columns(reaction.torque_i), buffer.first_torque.as_mut_ptr().add(place));
                N::store_block(columns(reaction.torque_j), buffer.second_torque.as_mut_ptr().add(place));
                reaction.cause.store(buffer.cause.as_mut_ptr().add(place));
                if L::RELAXES {
                    reaction.relaxed.store(buffer.relaxed.as_mut_ptr().add(place));
                }
                if L::DAMPS {
                    reaction.damped.store(buffer.damped.as_mut_ptr().add(place));
                }
                if work.step > 0.0 {
                    let mut row = L::FIXED_ROWS;
                    while row < L::ROWS {
                        N::store_rows(reaction.rows[row], work.rows[row].pointer(), index.as_ptr());
                        row += 1;
                    }
                }
            }
            buffer.broken |= N::any(reaction.cause.greater(N::zero()));
            if N::any(reaction.overbent) && buffer.overbent.is_none() {
                let lane = N::bits(reaction.overbent).trailing_zeros() as usize;
                buffer.overbent = Some(index[lane]);
            }
            bond += N::WIDTH;
        }
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
