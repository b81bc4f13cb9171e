//! Contacts of particles with planes: one pass for each plane and contact law that meet.
//!
//! The phases are those of the contacts between particles. A particle stands once in a list, so pieces of a list
//! are worked on side by side; loads on the plane are summed piece by piece, in order.

use super::error::RunError;
use super::lanes::{self, Kernel, Lane, Shared, columns, vector};
use super::observe::{self, ContactRecord};
use super::pass::{CHUNK, Context, Link, Pass};
use super::table::{MOST_COEFFICIENTS, Table};
use crate::contact::{Contact, Law, Response};
use crate::number::{Number, Vector};
use crate::state::contacts::{SLIDING, TOUCHING};
use crate::state::ledger::Source;
use crate::state::{Particles, Row, State, WallContacts};
use std::f64::consts::PI;
use std::marker::PhantomData;

/// Listed particles in one batch.
const BATCH: usize = 128;

/// The pass of one plane and one contact law.
pub(super) struct WallPass<L> {
    /// Which list of the state is its own.
    pub index: usize,
    /// Name of the plane.
    pub name: String,
    /// The plane at time 0.
    pub plane: Plane,
    /// Index of the plane's material.
    pub material: u32,
    /// Point about which the moment is taken, at time 0 \[m\].
    pub reference: Vector,
    /// Coefficients of the law.
    pub table: Table,
    /// The law.
    pub law: PhantomData<fn() -> L>,
}

/// Where a plane stands and how it moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane<N = f64> {
    /// A point on it \[m\].
    pub point: Vector<N>,
    /// Unit normal towards the particles.
    pub normal: Vector<N>,
    /// Its velocity \[m/s\].
    pub velocity: Vector<N>,
}

impl<N: Number> Plane<N> {
    /// How far in front of the plane a centre is \[m\].
    #[inline(always)]
    pub(super) fn distance(&self, position: [N; 4]) -> N {
        (vector(position) - self.point).dot(self.normal)
    }

    /// Geometry and relative motion of a sphere at the plane, with the sphere's arm \[m\].
    #[inline(always)]
    pub(super) fn meet(&self, position: [N; 4], velocity: [N; 4], spin: [N; 4], pair_constant: N) -> (Contact<N>, N) {
        let radius = position[3];
        let overlap = radius - self.distance(position);
        let arm = radius - N::splat(0.5) * overlap;
        let relative = vector(velocity) - self.velocity;
        let normal_velocity = relative.dot(self.normal);
        let slip = relative - self.normal * normal_velocity - (vector(spin) * arm).cross(self.normal);
        let contact = Contact {
            overlap,
            radius,
            mass: velocity[3],
            section_area: N::splat(PI) * overlap * (radius + radius - overlap),
            section_radius: radius,
            normal: self.normal,
            normal_velocity,
            slip,
            relative_spin: vector(spin),
            pair_constant,
        };
        (contact, arm)
    }
}

impl Plane {
    /// The same plane in lanes.
    #[inline(always)]
    fn lanes<N: Number>(&self) -> Plane<N> {
        let splat = |v: Vector| Vector::new(N::splat(v.x), N::splat(v.y), N::splat(v.z));
        Plane { point: splat(self.point), normal: splat(self.normal), velocity: splat(self.velocity) }
    }
}

impl<L: Law> WallPass<L> {
    /// The plane where it stands in this state.
    pub(super) fn plane(&self, state: &State) -> Plane {
        let boundary = &state.boundaries[state.walls[self.index].boundary as usize];
        Plane {
            point: self.plane.point + boundary.displacement.into(),
            normal: self.plane.normal,
            velocity: boundary.velocity.into(),
        }
    }

    /// The contact of a listed particle and its arm, if it touches.
    pub(super) fn contact(&self, state: &State, entry: usize) -> Option<(Contact, f64)> {
        let list = &state.walls[self.index];
        let slot = list.particle[entry] as usize;
        let plane = self.plane(state);
        let particles = &state.particles;
        if plane.distance(particles.position[slot]) > particles.position[slot][3] {
            return None;
        }
        let constant = list.pair_constant.get(entry).copied().unwrap_or(0.0);
        Some(plane.meet(particles.position[slot], particles.velocity[slot], particles.angular_velocity[slot], constant))
    }
}

impl<L: Law> Pass for WallPass<L> {
    fn apply(&self, state: &mut State, context: &Context) -> Result<(), RunError> {
        let plane = self.plane(state);
        let list = &mut state.walls[self.index];
        let boundary = &mut state.boundaries[list.boundary as usize];
        let particles = &mut state.particles;
        let count = list.particle.len();
        let work = Work::<L> {
            table: &self.table,
            wall_material: self.material,
            plane,
            reference: self.reference + boundary.displacement.into(),
            particle: &list.particle,
            flags: Shared::new(&mut list.flags),
            spring: Shared::new(&mut list.spring),
            pair_constant: &list.pair_constant,
            position: &particles.position,
            velocity: &particles.velocity,
            angular_velocity: &particles.angular_velocity,
            material: &particles.material,
            force: Shared::new(&mut particles.force),
            torque: Shared::new(&mut particles.torque),
            step: context.step,
            law: PhantomData,
        };
        let loads = context.collect(count.div_ceil(CHUNK), |piece| {
            let mut load = Load::default();
            let (from, to) = (piece * CHUNK, ((piece + 1) * CHUNK).min(count));
            lanes::run_least(Piece { work, from, to, load: &mut load });
            load
        });
        let mut behind = None;
        for load in loads {
            for axis in 0..3 {
                boundary.force[axis] += load.force[axis];
                boundary.moment[axis] += load.moment[axis];
            }
            behind = behind.or(load.behind);
        }
        let behind = behind.or(self.apply_hidden(state, context.step));
        match behind {
            None => Ok(()),
            Some(slot) => Err(RunError::Behind {
                id: state.particles.id[slot as usize],
                boundary: self.name.clone(),
                time: state.clock.time,
            }),
        }
    }

    fn has_torque(&self) -> bool {
        L::HAS_TORQUE
    }

    fn source(&self) -> Source {
        Source::Walls
    }

    fn prepare(&self, state: &mut State) {
        self.prepare_hidden(state);
        let list = &mut state.walls[self.index];
        if !L::HAS_SPRING {
            list.spring.clear();
        }
        list.pair_constant.clear();
        if L::HAS_PAIR_CONSTANT {
            let particles = &state.particles;
            list.pair_constant.extend(list.particle.iter().map(|&slot| {
                let slot = slot as usize;
                let row = self.table.row(particles.material[slot], self.material);
                L::pair_constant(row, particles.position[slot][3], particles.velocity[slot][3])
            }));
        }
    }

    fn stiffness(&self, state: &State, tell: &mut dyn FnMut(Link)) {
        self.hidden_stiffness(state, tell);
        let list = &state.walls[self.index];
        for entry in 0..list.particle.len() {
            if let Some((contact, arm)) = self.contact(state, entry) {
                let row = self.table.row(state.particles.material[list.particle[entry] as usize], self.material);
                let response = L::stiffness(row, &contact);
                let (first, normal) = (list.particle[entry], contact.normal);
                tell(Link {
                    first,
                    second: None,
                    response,
                    first_arm: arm,
                    second_arm: 0.0,
                    normal,
                    torsion: 0.0,
                    bending: 0.0,
                });
            }
        }
    }

    fn impact(&self, radius: f64, mass: f64, speed: f64) -> Option<Response> {
        // Against a plane the effective radius and mass are the particle's own, twice those of an equal pair.
        self.table.stiffest::<L>(2.0 * radius, 2.0 * mass, speed)
    }

    fn contacts(&self, state: &State, step: f64, tell: &mut dyn FnMut(ContactRecord)) {
        let list = &state.walls[self.index];
        let plane = self.plane(state);
        for entry in (0..list.particle.len()).filter(|&entry| list.flags[entry] & TOUCHING != 0) {
            let slot = list.particle[entry] as usize;
            let (velocity, spin) = observe::half_step_back(state, slot, step);
            let position = state.particles.position[slot];
            let constant = list.pair_constant.get(entry).copied().unwrap_or(0.0);
            let (contact, arm) = plane.meet(position, velocity, spin, constant);
            let row = self.table.row(state.particles.material[slot], self.material);
            let spring = list.spring.get(entry).copied().unwrap_or([0.0; 4]);
            let (reaction, sliding) = observe::react::<L>(row, &contact, spring, list.flags[entry]);
            let point = Vector::from(position) - contact.normal * arm;
            let ids = (state.particles.id[slot], None);
            tell(ContactRecord::new(ids, Some(list.boundary), point, &contact, &reaction, sliding));
        }
        self.hidden_records(state, tell);
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        let list = &state.walls[self.index];
        let energy = |entry: usize| {
            let (contact, _) = self.contact(state, entry)?;
            let row = self.table.row(state.particles.material[list.particle[entry] as usize], self.material);
            let spring = list.spring.get(entry).copied().unwrap_or([0.0; 4]);
            Some(L::elastic_energy(row, &contact, 0.0, spring.into()))
        };
        let touching = (0..list.particle.len()).filter(|&entry| list.flags[entry] & TOUCHING != 0);
        touching.filter_map(energy).sum::<f64>() + self.hidden_energy(state)
    }
}

/// What a piece of a list does to the plane.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    /// Force on the plane \[N\].
    force: [f64; 3],
    /// Moment about the moved reference point \[N m\].
    moment: [f64; 3],
    /// A particle whose centre is behind the plane.
    behind: Option<u32>,
}

/// What all pieces share.
struct Work<'a, L> {
    /// Coefficients.
    table: &'a Table,
    /// The plane's material.
    wall_material: u32,
    /// The plane, where it stands.
    plane: Plane,
    /// The moved reference point.
    reference: Vector,
    /// Listed particles.
    particle: &'a [u32],
    /// Bits of each.
    flags: Shared<u8>,
    /// Spring of each.
    spring: Shared<Row>,
    /// Pair constant of each.
    pair_constant: &'a [f64],
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

/// A piece of the list.
struct Piece<'a, 'b, L> {
    /// What it shares with the others.
    work: Work<'a, L>,
    /// First entry.
    from: usize,
    /// Behind the last entry.
    to: usize,
    /// What it does to the plane.
    load: &'b mut Load,
}

/// Results of a batch, in the order of its touching entries.
struct Buffer {
    /// Touching entries, with room for a register beyond the end.
    touching: [u32; BATCH + 8],
    /// Force on the particle.
    force: [Row; BATCH + 8],
    /// n × F_t.
    couple: [Row; BATCH + 8],
    /// Rolling torque.
    rolling: [Row; BATCH + 8],
    /// Arm at the particle.
    arm: [f64; BATCH + 8],
}

impl<L: Law> Kernel for Piece<'_, '_, L> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { work, from, to, load } = self;
        let mut buffer = Buffer {
            touching: [0; BATCH + 8],
            force: [[0.0; 4]; BATCH + 8],
            couple: [[0.0; 4]; BATCH + 8],
            rolling: [[0.0; 4]; BATCH + 8],
            arm: [0.0; BATCH + 8],
        };
        let mut row = [N::zero(); MOST_COEFFICIENTS];
        if let Some(entry) = work.table.uniform_with(work.wall_material) {
            let mut k = 0;
            while k < L::COUNT {
                row[k] = N::splat(entry[k]);
                k += 1;
            }
        }
        let plane = work.plane.lanes::<N>();
        let mut batch = from;
        while batch < to {
            let end = if batch + BATCH < to { batch + BATCH } else { to };
            let count = find_touching::<L, N>(&work, &plane, batch, end, &mut buffer, load);
            react_batch::<L, N>(&work, &plane, &mut row, count, &mut buffer);
            spread::<L>(&work, count, &buffer, load);
            batch = end;
        }
    }
}

/// Writes the touching entries into the buffer and ends the contacts that came apart. Returns how many.
#[inline(always)]
fn find_touching<L: Law, N: Lane>(
    work: &Work<L>,
    plane: &Plane<N>,
    from: usize,
    to: usize,
    buffer: &mut Buffer,
    load: &mut Load,
) -> usize {
    let mut count = 0;
    let mut entry = from;
    while entry < to {
        let lanes = if to - entry < N::WIDTH { to - entry } else { N::WIDTH };
        let mut slots = [0_u32; 8];
        let mut lane = 0;
        while lane < N::WIDTH {
            slots[lane] = work.particle[if lane < lanes { entry + lane } else { entry }];
            lane += 1;
        }
        // SAFETY: a list holds slots of particles, below their number.
        let position = unsafe { N::load_rows(work.position.as_ptr(), slots.as_ptr()) };
        let distance = plane.distance(position);
        let apart = N::bits(distance.greater(position[3]));
        let behind = N::bits(N::zero().greater(distance));
        // SAFETY: these entries belong to this piece alone.
        let flags = unsafe { work.flags.part(entry, entry + lanes) };
        let mut lane = 0;
        while lane < lanes {
            let now = (!apart >> lane) as u8 & 1;
            buffer.touching[count] = (entry + lane) as u32;
            count += now as usize;
            if flags[lane] & TOUCHING > now {
                flags[lane] = 0;
                if L::HAS_SPRING {
                    // SAFETY: this entry belongs to this piece alone.
                    unsafe { *work.spring.at(entry + lane) = [0.0; 4] };
                }
            }
            if (behind >> lane) & 1 == 1 && load.behind.is_none() {
                load.behind = Some(slots[lane]);
            }
            lane += 1;
        }
        entry += N::WIDTH;
    }
    let last = buffer.touching[count.saturating_sub(1)];
    let mut lane = 0;
    while lane < 8 {
        buffer.touching[count + lane] = last;
        lane += 1;
    }
    count
}

/// The law on the touching entries of the buffer.
#[inline(always)]
fn react_batch<L: Law, N: Lane>(
    work: &Work<L>,
    plane: &Plane<N>,
    row: &mut [N; MOST_COEFFICIENTS],
    count: usize,
    buffer: &mut Buffer,
) {
    let step = N::splat(work.step);
    let mut done = 0;
    while done < count {
        let mut slots = [0_u32; 8];
        let mut lane = 0;
        while lane < N::WIDTH {
            slots[lane] = work.particle[buffer.touching[done + lane] as usize];
            lane += 1;
        }
        if work.table.uniform_with(work.wall_material).is_none() {
            let wall = [work.wall_material; 8];
            work.table.gather::<L, N>(work.material, &slots, &wall, row);
        }
        let entries = buffer.touching[done..].as_ptr();
        // SAFETY: a list holds slots of particles, below their number.
        let (contact, arm) = unsafe {
            let slots = slots.as_ptr();
            let constant =
                if L::HAS_PAIR_CONSTANT { N::gather(work.pair_constant.as_ptr(), entries, 1) } else { N::zero() };
            plane.meet(
                N::load_rows(work.position.as_ptr(), slots),
                N::load_rows(work.velocity.as_ptr(), slots),
                N::load_rows(work.angular_velocity.as_ptr(), slots),
                constant,
            )
        };
        let spring = if L::HAS_SPRING {
            // SAFETY: these entries belong to this piece alone, and there is a spring for each.
            vector(unsafe { N::load_rows(work.spring.pointer(), entries) })
        } else {
            Vector::zero()
        };
        let reaction = L::react(&row[..L::COUNT], &contact, spring, step);
        let here = if count - done < N::WIDTH { count - done } else { N::WIDTH };
        // SAFETY: the buffer has room for a register beyond the batch; springs and flags as above.
        unsafe {
            N::store_block(columns(reaction.force), buffer.force.as_mut_ptr().add(done));
            arm.store(buffer.arm.as_mut_ptr().add(done));
            if L::HAS_TORQUE {
                N::store_block(columns(reaction.couple), buffer.couple.as_mut_ptr().add(done));
            }
            if L::HAS_ROLLING {
                N::store_block(columns(reaction.rolling), buffer.rolling.as_mut_ptr().add(done));
            }
            if L::HAS_SPRING {
                N::store_rows(columns(reaction.spring), work.spring.pointer(), entries, here);
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

/// Adds the results to the particles and to the load on the plane.
#[inline(always)]
fn spread<L: Law>(work: &Work<L>, count: usize, buffer: &Buffer, load: &mut Load) {
    let mut done = 0;
    while done < count {
        let slot = work.particle[buffer.touching[done] as usize] as usize;
        let (force, arm) = (Vector::from(buffer.force[done]), buffer.arm[done]);
        let point = Vector::from(work.position[slot]) - work.plane.normal * arm;
        let mut moment = -(point - work.reference).cross(force);
        // SAFETY: a particle stands once in a list.
        let (sum, turn) = unsafe { (work.force.at(slot), work.torque.at(slot)) };
        for axis in 0..3 {
            sum[axis] += buffer.force[done][axis];
            load.force[axis] -= buffer.force[done][axis];
            if L::HAS_TORQUE {
                turn[axis] -= buffer.couple[done][axis] * arm;
            }
            if L::HAS_ROLLING {
                turn[axis] -= buffer.rolling[done][axis];
            }
        }
        if L::HAS_ROLLING {
            moment += Vector::from(buffer.rolling[done]);
        }
        for (sum, part) in load.moment.iter_mut().zip(moment.to_array()) {
            *sum += part;
        }
        done += 1;
    }
}

/// The particles near a plane, with the springs of those that were listed before.
pub(super) fn list(
    old: &WallContacts,
    old_slot_to_new: &[u32],
    particles: &Particles,
    near: impl Fn(usize) -> bool,
) -> WallContacts {
    let mut list = WallContacts { boundary: old.boundary, law: old.law, ..WallContacts::default() };
    list.particle.extend((0..particles.len()).filter(|&slot| near(slot)).map(|slot| slot as u32));
    list.flags = vec![0; list.particle.len()];
    list.spring = vec![[0.0; 4]; list.particle.len()];
    for (entry, &slot) in old.particle.iter().enumerate().filter(|&(entry, _)| old.flags[entry] & TOUCHING != 0) {
        if let Ok(place) = list.particle.binary_search(&old_slot_to_new[slot as usize]) {
            list.flags[place] = old.flags[entry];
            if let Some(spring) = old.spring.get(entry) {
                list.spring[place] = *spring;
            }
        }
    }
    list
}
