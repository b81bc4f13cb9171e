//! Bonds between particles: one pass for each bond law.
//!
//! As the contacts, slab by slab and batch by batch: the law on several bonds at once, results added one by one in the
//! order of the list. Every listed bond lives; what breaks is taken out, in order, when the pass is
//! through.

use super::batch;
use super::error::RunError;
use super::lanes::{self, Kernel, Lane, Shared, Width, columns, vector};
use super::near::Near;
use super::neighbours::near_pairs;
use super::observe::{BondRecord, ContactRecord};
use super::pass::{Context, Link, Pass};
use crate::bond::creation::{Creation, Moment, near_pair};
use crate::bond::{Body, BondLaw, Carried, Law, MOST_ROWS, Pair, Quaternion, Reaction, Rows};
use crate::contact::Response;
use crate::number::Vector;
use crate::quantity::SetIndex;
use crate::scene::Scene;
use crate::state::bonds::Break;
use crate::state::ledger::Source;
use crate::state::{BondList, Particles, Row, State};
use std::cmp::Ordering;
use std::marker::PhantomData;
use std::sync::{Mutex, PoisonError};

/// Bonds in one batch.
const BATCH: usize = 64;

/// The pass of one bond law between particles.
pub(super) struct BondPass<L> {
    /// Which list of the state is its own; also the law's index in the scene.
    pub index: usize,
    /// The law in numbers.
    pub numbers: Law,
    /// When bonds are made.
    pub creation: Creation,
    /// Centres nearer than this are bonded \[m\].
    pub create_distance: f64,
    /// Set of each of the scene's particles.
    pub sets: Vec<SetIndex>,
    /// Between which sets.
    pub between: [SetIndex; 2],
    /// Listed pairs: indices into the scene's particles.
    pub pairs: Vec<[u32; 2]>,
    /// Pairs that may be near, where bonds are made in every step.
    pub near: Mutex<Near>,
    /// The law.
    pub law: PhantomData<fn() -> L>,
}

impl<L: BondLaw> BondPass<L> {
    /// The pass of this bond of the scene.
    pub(super) fn of(scene: &Scene, index: usize) -> Self {
        let bond = &scene.bonds[index];
        Self {
            index,
            numbers: bond.law,
            creation: bond.create.clone(),
            create_distance: bond.create_distance.unwrap_or(0.0),
            sets: scene.particles.iter().map(|particle| particle.set).collect(),
            between: bond.between,
            pairs: bond.pairs.clone(),
            near: Mutex::default(),
            law: PhantomData,
        }
    }

    /// Whether these two particles (indices into the scene's) may be bonded by this law.
    fn may_bond(&self, a: u32, b: u32) -> bool {
        let (a, b) = (self.sets[a as usize], self.sets[b as usize]);
        [a, b] == self.between || [b, a] == self.between
    }

    /// What a bond carries.
    fn carried(&self, state: &State, bond: usize) -> Carried {
        let list = &state.bonds[self.index];
        let mut rows = Rows::default();
        for (row, column) in rows.iter_mut().zip(&list.rows) {
            *row = column[bond];
        }
        let [i, j] = [list.first[bond], list.second[bond]].map(|slot| slot as usize);
        L::carried(&self.numbers, &pair_of(&state.particles, i, j), &rows)
    }

    /// Pairs without a bond that are to be bonded at this moment, as slots of i and j; i has the smaller id.
    fn wanted(&self, state: &State, moment: &Moment) -> Vec<[u32; 2]> {
        let particles = &state.particles;
        let mut pairs = Vec::new();
        if moment.number == 0 {
            pairs.extend(self.pairs.iter().map(|pair| pair.map(|index| particles.slot[index as usize])));
        }
        let list = &state.bonds[self.index];
        let hand = |a: u32, b: u32, distance: f64| {
            let ids = [particles.id[a as usize], particles.id[b as usize]];
            if near_pair(distance, self.create_distance) && self.may_bond(ids[0], ids[1]) && !is_bonded(list, a, b) {
                pairs.push([a, b]);
            }
        };
        if self.creation == Creation::Always && moment.number > 0 {
            let mut near = self.near.lock().unwrap_or_else(PoisonError::into_inner);
            near.pairs(particles, self.create_distance, hand);
        } else if self.creation.bonds_near_pairs(moment) {
            near_pairs(particles, self.create_distance, hand);
        }
        for pair in &mut pairs {
            pair.sort_unstable_by_key(|&slot| particles.id[slot as usize]);
        }
        pairs.sort_unstable_by_key(|pair| pair.map(|slot| particles.id[slot as usize]));
        pairs.dedup();
        pairs
    }
}

impl<L: BondLaw> Pass for BondPass<L> {
    fn apply(&self, state: &mut State, context: &Context) -> Result<(), RunError> {
        let list = &mut state.bonds[self.index];
        let particles = &mut state.particles;
        let slabs = list.slabs.len().saturating_sub(1);
        let mut columns = list.rows.iter_mut();
        let mut column = || columns.next().map_or(Shared::new(&mut []), |column| Shared::new(column));
        let work = Work::<L> {
            numbers: &self.numbers,
            first: &list.first,
            second: &list.second,
            rows: [column(), column(), column()],
            lost: Shared::new(&mut list.lost),
            position: &particles.position,
            velocity: &particles.velocity,
            angular_velocity: &particles.angular_velocity,
            attitude: &particles.attitude,
            force: Shared::new(&mut particles.force),
            torque: Shared::new(&mut particles.torque),
            step: context.step,
            law: PhantomData,
        };
        let ends = &list.slabs;
        let mut results = vec![Done::default(); slabs];
        let places = Shared::new(&mut results);
        context.slabs(slabs, |slab| {
            let done = work.slab(ends[slab] as usize, ends[slab + 1] as usize, context.width);
            // SAFETY: each slab is done once, and has a place of its own.
            unsafe { *places.at(slab) = done };
        });
        for done in &mut results {
            done.release(context.step, |bond| self.carried(state, bond).power);
        }
        book(state, self.index, results)
    }

    fn create(&self, state: &mut State, moment: &Moment, step: f64) -> bool {
        let wanted = self.wanted(state, moment);
        let law = self.numbers.coefficients::<f64>(step);
        let list = &mut state.bonds[self.index];
        list.rows.resize(L::ROWS, Vec::new());
        for &[i, j] in &wanted {
            let pair = pair_of(&state.particles, i as usize, j as usize);
            let rows = L::create(&law, &pair);
            list.first.push(i);
            list.second.push(j);
            if self.numbers.dissipates() {
                list.lost.push(0.0);
            }
            for (column, row) in list.rows.iter_mut().zip(rows) {
                column.push(row);
            }
            let bodies = [i, j].map(|slot| state.particles.id[slot as usize]);
            state.particles.count_bond(bodies);
        }
        list.made += wanted.len() as u64;
        !wanted.is_empty()
    }

    fn has_torque(&self) -> bool {
        true
    }

    fn needs_attitudes(&self) -> bool {
        L::NEEDS_ATTITUDES
    }

    fn source(&self) -> Source {
        Source::Bonds
    }

    fn prepare(&self, _state: &mut State) {}

    fn stiffness(&self, state: &State, tell: &mut dyn FnMut(Link)) {
        let list = &state.bonds[self.index];
        for (&i, &j) in list.first.iter().zip(&list.second) {
            let pair = pair_of(&state.particles, i as usize, j as usize);
            let distance = pair.connection.length();
            let [normal, shear, torsion, bending] = self.numbers.stiffness(pair.least_radius);
            let response = Response {
                normal_stiffness: normal,
                tangential_stiffness: shear,
                normal_damping: 0.0,
                tangential_damping: 0.0,
            };
            tell(Link {
                first: i,
                second: Some(j),
                response,
                first_arm: pair.share_i * distance,
                second_arm: pair.share_j * distance,
                normal: pair.connection * (1.0 / distance),
                torsion,
                bending,
            });
        }
    }

    fn impact(&self, _radius: f64, _mass: f64, _speed: f64) -> Option<Response> {
        None
    }

    fn contacts(&self, _state: &State, _step: f64, _tell: &mut dyn FnMut(ContactRecord)) {}

    fn elastic_energy(&self, state: &State) -> f64 {
        state.bonds[self.index].elastic
    }

    fn bonds(&self, state: &State, tell: &mut dyn FnMut(BondRecord)) {
        let (list, particles) = (&state.bonds[self.index], &state.particles);
        for (bond, (&i, &j)) in list.first.iter().zip(&list.second).enumerate() {
            let carried = self.carried(state, bond);
            let [first, second] = [i, j].map(|slot| particles.id[slot as usize]);
            let other = Vector::from(particles.position[j as usize]).to_array();
            let dissipated = list.lost.get(bond).copied().unwrap_or(0.0);
            tell(BondRecord { law: self.index as u32, first, second: Some(second), other, carried, dissipated });
        }
    }
}

/// Whether these two particles (slots) have a bond in this list, which is ascending by the slots of its bonds.
fn is_bonded(list: &BondList, a: u32, b: u32) -> bool {
    let wanted = (a.min(b), a.max(b));
    let (mut from, mut to) = (0, list.first.len());
    while from < to {
        let middle = from.midpoint(to);
        let (i, j) = (list.first[middle], list.second[middle]);
        match (i.min(j), i.max(j)).cmp(&wanted) {
            Ordering::Equal => return true,
            Ordering::Less => from = middle + 1,
            Ordering::Greater => to = middle,
        }
    }
    false
}

/// Sums energies of the bonds of a law, takes out what broke and tells of it.
pub(super) fn book(state: &mut State, law: usize, results: Vec<Done>) -> Result<(), RunError> {
    let (list, particles, time) = (&mut state.bonds[law], &state.particles, state.clock.time);
    list.elastic = 0.0;
    let mut outcome = Ok(());
    let mut gone = Vec::new();
    let told = state.breaks.len();
    let id = |slot: u32| particles.id[slot as usize];
    for done in results {
        list.elastic += done.elastic;
        list.relaxed += done.relaxed;
        list.damped += done.damped;
        gone.extend(done.broken);
        if let Some(bond) = done.overbent {
            let (first, second) = (id(list.first[bond as usize]), list.second.get(bond as usize).copied().map(id));
            outcome = outcome.and(Err(RunError::Overbent { first, second, time }));
        }
    }
    for &(bond, cause, energy) in &gone {
        let (first, second) = (id(list.first[bond as usize]), list.second.get(bond as usize).copied().map(id));
        state.breaks.push(Break { time, law: law as u32, first, second, cause, energy });
        list.released += energy;
        list.broken += 1;
    }
    for broken in &state.breaks[told..] {
        state.particles.count_break([broken.first].into_iter().chain(broken.second));
    }
    if !gone.is_empty() {
        remove(list, &gone);
    }
    outcome
}

/// Takes bonds out of a list, keeping the order of the others.
fn remove(list: &mut BondList, gone: &[(u32, f64, f64)]) {
    let mut dead = vec![false; list.first.len()];
    for &(bond, ..) in gone {
        dead[bond as usize] = true;
    }
    let mut slabs = vec![0_u32; list.slabs.len()];
    for slab in 1..list.slabs.len() {
        let (from, to) = (list.slabs[slab - 1] as usize, list.slabs[slab] as usize);
        let living = dead[from..to].iter().filter(|dead| !**dead).count() as u32;
        slabs[slab] = slabs[slab - 1] + living;
    }
    list.slabs = slabs;
    for slots in [&mut list.first, &mut list.second] {
        keep(slots, &dead);
    }
    for column in list.rows.iter_mut().chain([&mut list.foot]) {
        keep(column, &dead);
    }
    keep(&mut list.lost, &dead);
}

/// Keeps the entries of living bonds, in their order.
fn keep<T>(entries: &mut Vec<T>, dead: &[bool]) {
    let mut dead = dead.iter();
    entries.retain(|_| !dead.next().copied().unwrap_or(false));
}

/// Two particles as bodies of a bond.
pub(super) fn pair_of(particles: &Particles, i: usize, j: usize) -> Pair {
    Pair::of_spheres(&body_of(particles, i), &body_of(particles, j))
}

/// A particle as a body of a bond.
pub(super) fn body_of(particles: &Particles, slot: usize) -> Body {
    let attitude = particles.attitude.get(slot).copied().unwrap_or([1.0, 0.0, 0.0, 0.0]);
    Body {
        position: particles.position[slot].into(),
        velocity: particles.velocity[slot].into(),
        spin: particles.angular_velocity[slot].into(),
        attitude: Quaternion::from_row(attitude),
        radius: particles.position[slot][3],
        mass: particles.velocity[slot][3],
        inertia: particles.angular_velocity[slot][3],
    }
}

/// What a part of a list came to.
#[derive(Clone, Debug, Default)]
pub(super) struct Done {
    /// Elastic energy \[J\].
    elastic: f64,
    /// Elastic energy that relaxation took \[J\].
    relaxed: f64,
    /// Energy that damping took \[J\].
    damped: f64,
    /// Bonds that broke: bond, cause, released energy \[J\].
    broken: Vec<(u32, f64, f64)>,
    /// A bond bent beyond what can be followed.
    overbent: Option<u32>,
}

impl Done {
    /// Takes the energy of broken bonds to the middle of the step: up to there their force acted, and what they then held
    /// is what the books lose, to second order in the step. `power` says at which rate a bond worked on its bodies \[W\].
    pub(super) fn release(&mut self, step: f64, power: impl Fn(usize) -> f64) {
        for (bond, _, energy) in &mut self.broken {
            *energy += 0.5 * step * power(*bond as usize);
        }
    }

    /// Adds what one bond did.
    pub(super) fn add(&mut self, bond: u32, reaction: &Reaction<f64>) {
        self.relaxed += reaction.relaxed;
        self.damped += reaction.damped;
        if reaction.cause == 0.0 {
            self.elastic += reaction.elastic;
        } else {
            self.broken.push((bond, reaction.cause, reaction.elastic));
        }
        if reaction.overbent && self.overbent.is_none() {
            self.overbent = Some(bond);
        }
    }
}

/// What all slabs share.
struct Work<'a, L> {
    /// The law in numbers.
    numbers: &'a Law,
    /// Body i of each bond.
    first: &'a [u32],
    /// Body j of each bond.
    second: &'a [u32],
    /// State of each bond, row by row.
    rows: [Shared<Row>; MOST_ROWS],
    /// Energy that each bond lost; empty where none does.
    lost: Shared<f64>,
    /// Positions and radii.
    position: &'a [Row],
    /// Velocities and masses.
    velocity: &'a [Row],
    /// Angular velocities and moments of inertia.
    angular_velocity: &'a [Row],
    /// Attitudes; empty where no law needs them.
    attitude: &'a [Row],
    /// Forces.
    force: Shared<Row>,
    /// Torques.
    torque: Shared<Row>,
    /// Time since bonds were last advanced.
    step: f64,
    /// The law.
    law: PhantomData<fn() -> L>,
}

/// Room for a batch and what a register writes beyond it.
const ROOM: usize = BATCH + 8;

/// Energies of the bonds of a slab, summed in eight places in turn: the sum does not depend on the lane width, and no
/// addition waits for the one before.
type Energies = [f64; 8];

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
    /// Elastic energy, or what is released.
    elastic: [f64; ROOM],
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
            elastic: numbers,
            relaxed: numbers,
            damped: numbers,
            broken: false,
            overbent: None,
        }
    }

    /// Notes the bonds that broke and sums the energies, elastic ones of those that hold, of a batch of `count` bonds
    /// from `first`.
    fn sum(&mut self, first: usize, count: usize, energies: &mut [Energies; 3], done: &mut Done) {
        if self.broken {
            for place in (0..count).filter(|&place| self.cause[place] != 0.0) {
                done.broken.push(((first + place) as u32, self.cause[place], self.elastic[place]));
                self.elastic[place] = 0.0;
            }
        }
        let filled = count.next_multiple_of(8);
        let [elastic, relaxed, damped] = energies;
        for (sum, energy) in [(elastic, &mut self.elastic), (relaxed, &mut self.relaxed), (damped, &mut self.damped)] {
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
    fn slab(&self, from: usize, to: usize, width: Width) -> Done {
        let mut done = Done::default();
        let mut buffer = Buffer::new();
        let mut energies = [[0.0; 8]; 3];
        let mut batch = from;
        while batch < to {
            let end = (batch + BATCH).min(to);
            buffer.broken = false;
            lanes::run(width, React { work: self, from: batch, to: end, buffer: &mut buffer });
            lanes::run(width, Spread { work: self, from: batch, to: end, buffer: &buffer });
            buffer.sum(batch, end - batch, &mut energies, &mut done);
            self.lose(batch, end, &buffer);
            batch = end;
        }
        done.elastic = energies[0].iter().sum();
        done.relaxed = energies[1].iter().sum();
        done.damped = energies[2].iter().sum();
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
                batch::add(work.force.at(i as usize), force);
                batch::subtract(work.force.at(j as usize), force);
                batch::add(work.torque.at(i as usize), first_torque);
                batch::add(work.torque.at(j as usize), second_torque);
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
                reaction.elastic.store(buffer.elastic.as_mut_ptr().add(place));
                reaction.relaxed.store(buffer.relaxed.as_mut_ptr().add(place));
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

/// Brings the bonds of a list into the order of newly sorted particles.
pub(super) fn sort(list: &mut BondList, new_slot: &[u32], slabs: &[u32]) {
    let at_plane = list.second.is_empty();
    for slot in list.first.iter_mut().chain(&mut list.second) {
        *slot = new_slot[*slot as usize];
    }
    let mut order: Vec<u32> = (0..list.first.len() as u32).collect();
    let key = |&bond: &u32| {
        let i = list.first[bond as usize];
        let j = list.second.get(bond as usize).copied().unwrap_or(i);
        (i.min(j), i.max(j))
    };
    order.sort_unstable_by_key(key);
    let leading: Vec<u32> = order.iter().map(|bond| key(bond).0).collect();
    list.slabs = if at_plane { &[][..] } else { slabs }
        .iter()
        .map(|&slot| leading.partition_point(|&first| first < slot) as u32)
        .collect();
    list.first = order.iter().map(|&bond| list.first[bond as usize]).collect();
    list.second = order.iter().filter_map(|&bond| list.second.get(bond as usize).copied()).collect();
    for column in list.rows.iter_mut().chain([&mut list.foot]).filter(|column| !column.is_empty()) {
        *column = order.iter().map(|&bond| column[bond as usize]).collect();
    }
    if !list.lost.is_empty() {
        list.lost = order.iter().map(|&bond| list.lost[bond as usize]).collect();
    }
}

/// Length of the longest bond \[m\].
pub(super) fn longest(state: &State) -> f64 {
    let position = &state.particles.position;
    let bonds = state.bonds.iter().flat_map(|list| list.first.iter().zip(&list.second));
    let squares = bonds.map(|(&i, &j)| {
        let apart = Vector::from(position[i as usize]) - Vector::from(position[j as usize]);
        apart.dot(apart)
    });
    squares.fold(0.0, f64::max).sqrt()
}
