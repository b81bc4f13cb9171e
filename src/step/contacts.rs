//! Contacts between particles: one pass for each contact law.
//!
//! Three phases on each batch of listed pairs. A: which pairs touch, several at a time; the touching ones are
//! compacted. B: the law on the touching ones, several at a time, results in a buffer that stays in the cache.
//! C: results added to the particles, one by one, in the order of the list. Slabs of even and odd number follow
//! each other; within one parity no two slabs share a particle.

use super::error::RunError;
use super::lanes::{self, Kernel, Lane, Shared, Width, columns, vector};
use super::observe::{self, ContactRecord};
use super::pass::{Context, Link, Pass};
use super::table::{MOST_COEFFICIENTS, Table};
use crate::contact::{Contact, Law, Response};
use crate::number::{Number, Vector};
use crate::state::contacts::{SLIDING, TOUCHING};
use crate::state::ledger::Source;
use crate::state::{ContactList, Particles, Row, State};
use std::marker::PhantomData;

/// Listed pairs in one batch; its buffers fill about half of a first-level cache.
const BATCH: usize = 128;

/// The pass of one contact law.
pub(super) struct ContactPass<L> {
    /// Which list of the state is its own.
    pub index: usize,
    /// Its coefficients.
    pub table: Table,
    /// The law.
    pub law: PhantomData<fn() -> L>,
}

impl<L: Law> Pass for ContactPass<L> {
    fn apply(&self, state: &mut State, context: &Context) -> Result<(), RunError> {
        let list = &mut state.contacts[self.index];
        let particles = &mut state.particles;
        let slabs = list.slabs.len().saturating_sub(1);
        let shared = Pairs {
            first: &list.first,
            second: &list.second,
            position: &particles.position,
            velocity: &particles.velocity,
            angular_velocity: &particles.angular_velocity,
            material: &particles.material,
            force: Shared::new(&mut particles.force),
            torque: Shared::new(&mut particles.torque),
        };
        let work = Work::<L> {
            shared: &shared,
            table: &self.table,
            flags: Shared::new(&mut list.flags),
            spring: Shared::new(&mut list.spring),
            pair_constant: &list.pair_constant,
            step: context.step,
            law: PhantomData,
        };
        let ends = &list.slabs;
        for parity in 0..2 {
            let count = (slabs + 1 - parity) / 2;
            context.each(count, |piece| {
                let slab = 2 * piece + parity;
                let (from, to) = (ends[slab] as usize, ends[slab + 1] as usize);
                Slab { work, from, to }.run(context.width);
            });
        }
        self.apply_hidden(state, context.step);
        Ok(())
    }

    fn has_torque(&self) -> bool {
        L::HAS_TORQUE
    }

    fn source(&self) -> Source {
        Source::Contacts
    }

    fn prepare(&self, state: &mut State) {
        self.prepare_hidden(state);
        let list = &mut state.contacts[self.index];
        if !L::HAS_SPRING {
            list.spring.clear();
        }
        list.pair_constant.clear();
        if L::HAS_PAIR_CONSTANT {
            let particles = &state.particles;
            list.pair_constant.extend(list.first.iter().zip(&list.second).map(|(&i, &j)| {
                let (radius, mass) = effective(particles, i, j);
                let row = self.table.row(particles.material[i as usize], particles.material[j as usize]);
                L::pair_constant(row, radius, mass)
            }));
        }
    }

    fn stiffness(&self, state: &State, tell: &mut dyn FnMut(Link)) {
        self.hidden_stiffness(state, tell);
        let list = &state.contacts[self.index];
        for pair in 0..list.first.len() {
            let (i, j) = (list.first[pair], list.second[pair]);
            if let Some((contact, arms)) = pair_contact(&state.particles, list, pair) {
                let row = self.table.row(state.particles.material[i as usize], state.particles.material[j as usize]);
                let response = L::stiffness(row, &contact);
                let [first_arm, second_arm] = arms;
                tell(Link {
                    first: i,
                    second: Some(j),
                    response,
                    first_arm,
                    second_arm,
                    normal: contact.normal,
                    torsion: 0.0,
                    bending: 0.0,
                });
            }
        }
    }

    fn impact(&self, radius: f64, mass: f64, speed: f64) -> Option<Response> {
        self.table.stiffest::<L>(radius, mass, speed)
    }

    fn contacts(&self, state: &State, step: f64, tell: &mut dyn FnMut(ContactRecord)) {
        let list = &state.contacts[self.index];
        let before = |slot: u32| observe::half_step_back(state, slot as usize, step);
        for pair in (0..list.first.len()).filter(|&pair| list.flags[pair] & TOUCHING != 0) {
            let (i, j) = (list.first[pair], list.second[pair]);
            let ((v, w), (u, z)) = (before(i), before(j));
            let positions = &state.particles.position;
            let constant = list.pair_constant.get(pair).copied().unwrap_or(0.0);
            let (contact, arm, _) = meet(positions[i as usize], positions[j as usize], v, u, w, z, constant);
            let row = self.table.row(state.particles.material[i as usize], state.particles.material[j as usize]);
            let spring = list.spring.get(pair).copied().unwrap_or([0.0; 4]);
            let (reaction, sliding) = observe::react::<L>(row, &contact, spring, list.flags[pair]);
            let point = Vector::from(positions[i as usize]) - contact.normal * arm;
            let ids = (state.particles.id[i as usize], Some(state.particles.id[j as usize]));
            tell(ContactRecord::new(ids, None, point, &contact, &reaction, sliding));
        }
        self.hidden_records(state, tell);
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        let list = &state.contacts[self.index];
        let material = |slot: u32| state.particles.material[slot as usize];
        let energy = |pair: usize| {
            let (contact, _) = pair_contact(&state.particles, list, pair)?;
            let row = self.table.row(material(list.first[pair]), material(list.second[pair]));
            let spring = list.spring.get(pair).copied().unwrap_or([0.0; 4]);
            Some(L::elastic_energy(row, &contact, 0.0, spring.into()))
        };
        let touching = (0..list.first.len()).filter(|&pair| list.flags[pair] & TOUCHING != 0);
        touching.filter_map(energy).sum::<f64>() + self.hidden_energy(state)
    }
}

/// Effective radius \[m\] and mass \[kg\] of two particles.
pub(super) fn effective(particles: &Particles, i: u32, j: u32) -> (f64, f64) {
    let (i, j) = (i as usize, j as usize);
    let (r, s) = (particles.position[i][3], particles.position[j][3]);
    let (m, n) = (particles.velocity[i][3], particles.velocity[j][3]);
    (r * s / (r + s), m * n / (m + n))
}

/// The contact of a listed pair and its arms, if the two touch.
pub(super) fn pair_contact(particles: &Particles, list: &ContactList, pair: usize) -> Option<(Contact, [f64; 2])> {
    let (i, j) = (list.first[pair] as usize, list.second[pair] as usize);
    let reach = particles.position[i][3] + particles.position[j][3];
    let apart = Vector::from(particles.position[i]) - Vector::from(particles.position[j]);
    if apart.dot(apart) >= reach * reach {
        return None;
    }
    let constant = list.pair_constant.get(pair).copied().unwrap_or(0.0);
    let (contact, first_arm, second_arm) = meet(
        particles.position[i],
        particles.position[j],
        particles.velocity[i],
        particles.velocity[j],
        particles.angular_velocity[i],
        particles.angular_velocity[j],
        constant,
    );
    Some((contact, [first_arm, second_arm]))
}

/// Geometry and relative motion of two overlapping spheres, with the arms at i and j \[m\].
#[inline(always)]
pub(super) fn meet<N: Number>(
    position_i: [N; 4],
    position_j: [N; 4],
    velocity_i: [N; 4],
    velocity_j: [N; 4],
    spin_i: [N; 4],
    spin_j: [N; 4],
    pair_constant: N,
) -> (Contact<N>, N, N) {
    let half = N::splat(0.5);
    let apart = vector(position_i) - vector(position_j);
    let distance = apart.length();
    let normal = apart * (N::splat(1.0) / distance);
    let (radius_i, radius_j) = (position_i[3], position_j[3]);
    let reach = radius_i + radius_j;
    let overlap = reach - distance;
    let radius = radius_i * radius_j / reach;
    let (mass_i, mass_j) = (velocity_i[3], velocity_j[3]);
    let arm_i = radius_i - half * overlap;
    let arm_j = radius_j - half * overlap;
    let relative = vector(velocity_i) - vector(velocity_j);
    let normal_velocity = relative.dot(normal);
    let turning = vector(spin_i) * arm_i + vector(spin_j) * arm_j;
    let slip = relative - normal * normal_velocity - turning.cross(normal);
    let difference = radius_i - radius_j;
    let section_area = N::splat(std::f64::consts::FRAC_PI_4)
        * overlap
        * (distance + difference)
        * (distance - difference)
        * (distance + reach)
        / (distance * distance);
    let contact = Contact {
        overlap,
        radius,
        mass: mass_i * mass_j / (mass_i + mass_j),
        section_area,
        section_radius: radius + radius,
        normal,
        normal_velocity,
        slip,
        relative_spin: vector(spin_i) - vector(spin_j),
        pair_constant,
    };
    (contact, arm_i, arm_j)
}

/// Pairs and particles: what all phases share, whatever the law.
struct Pairs<'a> {
    /// First particle of each pair.
    first: &'a [u32],
    /// Second particle of each pair.
    second: &'a [u32],
    /// Positions and radii.
    position: &'a [Row],
    /// Velocities and masses.
    velocity: &'a [Row],
    /// Angular velocities.
    angular_velocity: &'a [Row],
    /// Materials.
    material: &'a [u32],
    /// Forces.
    force: Shared<Row>,
    /// Torques.
    torque: Shared<Row>,
}

/// What all slabs of a pass share.
struct Work<'a, L> {
    /// Pairs and particles.
    shared: &'a Pairs<'a>,
    /// Coefficients.
    table: &'a Table,
    /// Bits of each pair.
    flags: Shared<u8>,
    /// Spring of each pair.
    spring: Shared<Row>,
    /// Pair constant of each pair.
    pair_constant: &'a [f64],
    /// Time since springs were last advanced.
    step: f64,
    /// The law.
    law: PhantomData<fn() -> L>,
}

impl<L> Clone for Work<'_, L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L> Copy for Work<'_, L> {}

/// The pairs of one slab.
struct Slab<'a, L> {
    /// What it shares with the others.
    work: Work<'a, L>,
    /// First pair.
    from: usize,
    /// Behind the last pair.
    to: usize,
}

/// Results of a batch, in the order of its touching pairs.
struct Buffer {
    /// Touching pairs, with room for a register beyond the end.
    touching: [u32; BATCH + 8],
    /// Force on the first particle.
    force: [Row; BATCH + 8],
    /// n × F_t.
    couple: [Row; BATCH + 8],
    /// Rolling torque.
    rolling: [Row; BATCH + 8],
    /// Arm at the first particle.
    first_arm: [f64; BATCH + 8],
    /// Arm at the second particle.
    second_arm: [f64; BATCH + 8],
}

impl Buffer {
    /// An empty buffer.
    fn new() -> Self {
        Self {
            touching: [0; BATCH + 8],
            force: [[0.0; 4]; BATCH + 8],
            couple: [[0.0; 4]; BATCH + 8],
            rolling: [[0.0; 4]; BATCH + 8],
            first_arm: [0.0; BATCH + 8],
            second_arm: [0.0; BATCH + 8],
        }
    }
}

impl<L: Law> Slab<'_, L> {
    /// Works through the slab, batch by batch.
    fn run(self, width: Width) {
        let Self { work, from, to } = self;
        let mut buffer = Buffer::new();
        let mut batch = from;
        while batch < to {
            let end = (batch + BATCH).min(to);
            let (shared, flags) = (&work.shared, work.flags);
            let mut count = 0;
            let (buffer, count) = (&mut buffer, &mut count);
            if L::HAS_SPRING {
                lanes::run(
                    width,
                    Touch::<true> { shared, flags, spring: work.spring, from: batch, to: end, buffer, count },
                );
            } else {
                lanes::run(
                    width,
                    Touch::<false> { shared, flags, spring: work.spring, from: batch, to: end, buffer, count },
                );
            }
            let count = *count;
            lanes::run(width, React { work, count, buffer });
            match (L::HAS_TORQUE, L::HAS_ROLLING) {
                (false, _) => lanes::run(width, Scatter::<false, false> { shared, count, buffer }),
                (true, false) => lanes::run(width, Scatter::<true, false> { shared, count, buffer }),
                (true, true) => lanes::run(width, Scatter::<true, true> { shared, count, buffer }),
            }
            batch = end;
        }
    }
}

/// Phase A on one batch: writes the touching pairs into the buffer and ends the contacts that came apart.
struct Touch<'a, 'b, const SPRING: bool> {
    /// Pairs and particles.
    shared: &'a Pairs<'a>,
    /// Bits of each pair.
    flags: Shared<u8>,
    /// Spring of each pair.
    spring: Shared<Row>,
    /// First pair.
    from: usize,
    /// Behind the last pair.
    to: usize,
    /// Where the touching pairs go.
    buffer: &'b mut Buffer,
    /// How many touch.
    count: &'b mut usize,
}

impl<const SPRING: bool> Kernel for Touch<'_, '_, SPRING> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { shared, flags, spring, from, to, buffer, count } = self;
        *count = find_touching::<N, SPRING>(shared, (flags, spring), (from, to), buffer);
    }
}

/// Phase B on one batch: the law.
struct React<'a, 'b, L> {
    /// What all slabs share.
    work: Work<'a, L>,
    /// How many pairs touch.
    count: usize,
    /// The touching pairs, and where their results go.
    buffer: &'b mut Buffer,
}

impl<L: Law> Kernel for React<'_, '_, L> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        react_batch::<L, N>(&self.work, self.count, self.buffer);
    }
}

/// Phase C on one batch: adds the results to both particles of each touching pair.
struct Scatter<'a, 'b, const TORQUE: bool, const ROLLING: bool> {
    /// Pairs and particles.
    shared: &'a Pairs<'a>,
    /// How many pairs touch.
    count: usize,
    /// Their results.
    buffer: &'b Buffer,
}

impl<const TORQUE: bool, const ROLLING: bool> Kernel for Scatter<'_, '_, TORQUE, ROLLING> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        scatter::<TORQUE, ROLLING>(self.shared, self.count, self.buffer);
    }
}

/// Phase A. Returns how many pairs touch.
#[inline(always)]
fn find_touching<N: Lane, const SPRING: bool>(
    work: &Pairs,
    (all_flags, spring): (Shared<u8>, Shared<Row>),
    (from, to): (usize, usize),
    buffer: &mut Buffer,
) -> usize {
    let positions = work.position.as_ptr();
    let mut count = 0;
    let mut pair = from;
    while pair < to {
        let lanes = if to - pair < N::WIDTH { to - pair } else { N::WIDTH };
        let mut first = [0_u32; 8];
        let mut second = [0_u32; 8];
        let mut lane = 0;
        while lane < N::WIDTH {
            let listed = if lane < lanes { pair + lane } else { pair };
            first[lane] = work.first[listed];
            second[lane] = work.second[listed];
            lane += 1;
        }
        // SAFETY: a list holds slots of particles, below their number.
        let (i, j) = unsafe { (N::load_rows(positions, first.as_ptr()), N::load_rows(positions, second.as_ptr())) };
        let apart = vector(i) - vector(j);
        let reach = i[3] + j[3];
        let touch = N::bits((reach * reach).greater(apart.dot(apart)));
        // SAFETY: these pairs belong to this slab alone.
        let flags = unsafe { all_flags.part(pair, pair + lanes) };
        let mut lane = 0;
        while lane < lanes {
            let now = ((touch >> lane) & 1) as u8;
            buffer.touching[count] = (pair + lane) as u32;
            count += now as usize;
            if flags[lane] & TOUCHING > now {
                flags[lane] = 0;
                if SPRING {
                    // SAFETY: this pair belongs to this slab alone.
                    unsafe { *spring.at(pair + lane) = [0.0; 4] };
                }
            }
            lane += 1;
        }
        pair += N::WIDTH;
    }
    let last = buffer.touching[count.saturating_sub(1)];
    let mut lane = 0;
    while lane < 8 {
        buffer.touching[count + lane] = last;
        lane += 1;
    }
    count
}

/// Phase B.
#[inline(always)]
fn react_batch<L: Law, N: Lane>(work: &Work<L>, count: usize, buffer: &mut Buffer) {
    let mut row = [N::zero(); MOST_COEFFICIENTS];
    if let Some(entry) = work.table.uniform() {
        let mut k = 0;
        while k < L::COUNT {
            row[k] = N::splat(entry[k]);
            k += 1;
        }
    }
    let Pairs { first: firsts, second: seconds, position, velocity, angular_velocity, material, .. } = work.shared;
    let step = N::splat(work.step);
    let mut done = 0;
    while done < count {
        let mut first = [0_u32; 8];
        let mut second = [0_u32; 8];
        let mut lane = 0;
        while lane < N::WIDTH {
            let pair = buffer.touching[done + lane] as usize;
            first[lane] = firsts[pair];
            second[lane] = seconds[pair];
            lane += 1;
        }
        if work.table.uniform().is_none() {
            let mut materials = [0_u32; 8];
            let mut lane = 0;
            while lane < N::WIDTH {
                materials[lane] = material[second[lane] as usize];
                lane += 1;
            }
            work.table.gather::<L, N>(material, &first, &materials, &mut row);
        }
        let pairs = buffer.touching[done..].as_ptr();
        // SAFETY: a list holds slots of particles, below their number.
        let (contact, first_arm, second_arm) = unsafe {
            let (i, j) = (first.as_ptr(), second.as_ptr());
            let (x, v, w) = (position.as_ptr(), velocity.as_ptr(), angular_velocity.as_ptr());
            let constant =
                if L::HAS_PAIR_CONSTANT { N::gather(work.pair_constant.as_ptr(), pairs, 1) } else { N::zero() };
            meet(
                N::load_rows(x, i),
                N::load_rows(x, j),
                N::load_rows(v, i),
                N::load_rows(v, j),
                N::load_rows(w, i),
                N::load_rows(w, j),
                constant,
            )
        };
        let spring = if L::HAS_SPRING {
            // SAFETY: these pairs belong to this slab alone, and there is a spring for each.
            vector(unsafe { N::load_rows(work.spring.pointer(), pairs) })
        } else {
            Vector::zero()
        };
        let reaction = L::react(&row[..L::COUNT], &contact, spring, step);
        let here = if count - done < N::WIDTH { count - done } else { N::WIDTH };
        // SAFETY: the buffer has room for a register beyond the batch; springs as above.
        unsafe {
            N::store_block(columns(reaction.force), buffer.force.as_mut_ptr().add(done));
            if L::HAS_TORQUE {
                N::store_block(columns(reaction.couple), buffer.couple.as_mut_ptr().add(done));
                first_arm.store(buffer.first_arm.as_mut_ptr().add(done));
                second_arm.store(buffer.second_arm.as_mut_ptr().add(done));
            }
            if L::HAS_ROLLING {
                N::store_block(columns(reaction.rolling), buffer.rolling.as_mut_ptr().add(done));
            }
            if L::HAS_SPRING {
                N::store_rows(columns(reaction.spring), work.spring.pointer(), pairs, here);
            }
            let sliding = N::bits(reaction.sliding);
            let mut lane = 0;
            while lane < here {
                let slides = ((sliding >> lane) & 1) as u8 * SLIDING;
                *work.flags.at(buffer.touching[done + lane] as usize) = TOUCHING | slides;
                lane += 1;
            }
        }
        done += N::WIDTH;
    }
}

/// Phase C.
#[inline(always)]
fn scatter<const TORQUE: bool, const ROLLING: bool>(work: &Pairs, count: usize, buffer: &Buffer) {
    let mut done = 0;
    while done < count {
        let pair = buffer.touching[done] as usize;
        let (i, j) = (work.first[pair] as usize, work.second[pair] as usize);
        // SAFETY: slabs of one parity do not share particles.
        unsafe {
            add(work.force.at(i), &buffer.force[done], 1.0);
            add(work.force.at(j), &buffer.force[done], -1.0);
            if TORQUE {
                add(work.torque.at(i), &buffer.couple[done], -buffer.first_arm[done]);
                add(work.torque.at(j), &buffer.couple[done], -buffer.second_arm[done]);
            }
            if ROLLING {
                add(work.torque.at(i), &buffer.rolling[done], -1.0);
                add(work.torque.at(j), &buffer.rolling[done], 1.0);
            }
        }
        done += 1;
    }
}

/// Adds a multiple of one row to another.
#[inline(always)]
fn add(sum: &mut Row, row: &Row, factor: f64) {
    let mut k = 0;
    while k < 4 {
        sum[k] += factor * row[k];
        k += 1;
    }
}
