//! Sweeps over the dashpots of bonds that are integrated by themselves (`bond/damping/split.rs`).
//!
//! What does not depend on velocities is found for a batch of bonds, several at a time; the bonds then change their bodies one after the
//! other. Slabs of one parity share no particle: those of even number come first, and last in a sweep backwards, whichever thread works.

use super::{body_of, pair_of};
use crate::bond::damping::split::{Decay, Impulse, Moving};
use crate::bond::damping::viscous::Viscous;
use crate::bond::{Body, Coefficients, Elasticity, Law, Pair, Quaternion};
use crate::boundaries::felt::Swept;
use crate::interactions::Sweep;
use crate::lanes::{self, Kernel, Lane, Shared, vector};
use crate::number::Vector;
use crate::state::{BondList, BoundaryState, Particles, Row, State};
use crate::threads::Context;
use std::sync::{Mutex, PoisonError};

/// Bonds whose columns are found together: they fit the first-level cache.
const BATCH: usize = 64;

/// Columns of a batch: axis, arms, gains, losses, lightness, across.
const COLUMNS: usize = 18;

/// The sweeps of a bond law.
#[derive(Default)]
pub(super) struct Sweeps {
    /// Whether bodies of its bonds may belong to groups.
    groups: bool,
    /// Working space: what each slab found, and what it did to each boundary.
    room: Mutex<(Vec<Found>, Vec<Swept>)>,
}

/// What a sweep over a slab found.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    /// Energy that dashpots took of all bodies \[J\].
    taken: f64,
    /// Energy that they gave to bodies that are led \[J\].
    led: f64,
}

/// What all slabs share.
struct Work<'a> {
    /// The dashpots.
    dashpots: Viscous,
    /// Section and stiffnesses of the law.
    elasticity: &'a Elasticity,
    /// The sweep.
    sweep: Sweep,
    /// Bodies of each bond.
    bodies: [&'a [u32]; 2],
    /// Positions and radii.
    position: &'a [Row],
    /// Velocities and masses.
    velocity: Shared<Row>,
    /// Angular velocities and moments of inertia.
    spin: Shared<Row>,
    /// Energy that each bond lost.
    lost: Shared<f64>,
    /// What moves each particle.
    owner: &'a [u32],
    /// The boundaries; none where no group is concerned.
    boundaries: &'a [BoundaryState],
}

impl Sweeps {
    /// Those of a law in a scene with groups or without.
    pub(super) fn of(groups: bool) -> Self {
        Self { groups, room: Mutex::default() }
    }

    /// Sweeps over a list. Returns the kinetic energy that particles moved by forces gained \[J\].
    pub(super) fn run(
        &self,
        (law, index): (&Law, usize),
        state: &mut State,
        sweep: Sweep,
        felt: &mut [Swept],
        context: &Context,
    ) -> f64 {
        let Some(dashpots) = law.split else { return 0.0 };
        let State { bonds, particles, boundaries, .. } = state;
        let list = &mut bonds[index];
        let slabs = list.slabs.len().saturating_sub(1);
        let work = Work {
            dashpots,
            elasticity: &law.elasticity,
            sweep,
            bodies: [&list.first, &list.second],
            position: &particles.position,
            velocity: Shared::new(&mut particles.velocity),
            spin: Shared::new(&mut particles.angular_velocity),
            lost: Shared::new(&mut list.lost),
            owner: &particles.owner,
            boundaries: if self.groups { boundaries } else { &[] },
        };
        let (ends, count) = (&list.slabs, work.boundaries.len());
        let mut room = self.room.lock().unwrap_or_else(PoisonError::into_inner);
        let (found, loads) = &mut *room;
        found.clear();
        found.resize(slabs, Found::default());
        loads.clear();
        loads.resize(slabs * count, Swept::default());
        let (places, parts) = (Shared::new(found), Shared::new(loads));
        let slab = |slab: usize| {
            // SAFETY: each slab is done once, and has places of its own; slabs worked on at the same time share no particle.
            unsafe {
                let felt = parts.part(slab * count, (slab + 1) * count);
                *places.at(slab) = work.slab([ends[slab] as usize, ends[slab + 1] as usize], felt, context);
            }
        };
        match sweep.backwards {
            false => context.slabs(slabs, slab),
            // Those of odd number come first where each is one further.
            true => context.slabs(slabs + 1, |turn| {
                if turn > 0 {
                    slab(turn - 1)
                }
            }),
        }
        for part in loads.chunks(count.max(1)) {
            felt.iter_mut().zip(part).for_each(|(sum, part)| sum.add(part));
        }
        let taken: f64 = found.iter().map(|found| found.taken).sum();
        list.damped += taken;
        -(taken + found.iter().map(|found| found.led).sum::<f64>())
    }

    /// Adds the present loads of dashpots on groups.
    pub(super) fn add_loads(&self, (law, index): (&Law, usize), state: &State, felt: &mut [Swept]) {
        let (Some(dashpots), true) = (law.split, self.groups) else { return };
        let State { bonds, particles, boundaries, .. } = state;
        let coefficients = law.elasticity.at_step::<f64>(0.0);
        for (&i, &j) in bonds[index].first.iter().zip(&bonds[index].second) {
            let slots = [i, j].map(|slot| slot as usize);
            if slots.iter().all(|&slot| particles.owner[slot] == 0) {
                continue;
            }
            let impulse = dashpots.loads(&coefficients, &pair_of(particles, slots[0], slots[1]));
            for (body, &slot) in slots.iter().enumerate() {
                let Some(owner) = (particles.owner[slot] as usize).checked_sub(1) else { continue };
                let arm = Vector::from(particles.position[slot]) - boundaries[owner].pivot.into();
                felt[owner].add(&Swept::at(&impulse, body, arm, [Vector::zero(); 2]));
            }
        }
    }
}

impl Work<'_> {
    /// Sweeps over the bonds of a slab.
    ///
    /// # Safety
    /// The bonds are in the list, and no other thread reads or writes their bodies meanwhile.
    unsafe fn slab(&self, [from, to]: [usize; 2], felt: &mut [Swept], context: &Context) -> Found {
        let mut found = Found::default();
        if from < to {
            lanes::run(context.width, Slab { work: self, from, to, felt, found: &mut found });
        }
        found
    }
}

/// A sweep over a slab.
struct Slab<'a, 'b> {
    /// What all slabs share.
    work: &'a Work<'a>,
    /// First bond.
    from: usize,
    /// Behind the last bond.
    to: usize,
    /// What it does to each boundary.
    felt: &'b mut [Swept],
    /// What it found.
    found: &'b mut Found,
}

impl Kernel for Slab<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(mut self) {
        let law = self.work.elasticity.at_step::<N>(0.0);
        let mut columns = [[0.0; BATCH]; COLUMNS];
        let batches = (self.to - self.from).div_ceil(BATCH);
        let backwards = self.work.sweep.backwards;
        let mut turn = 0;
        while turn < batches {
            let batch = if backwards { batches - 1 - turn } else { turn };
            let start = self.from + batch * BATCH;
            let count = usize::min(self.to - start, BATCH);
            // SAFETY: the bonds are in the list.
            unsafe { self.fill::<N>(&law, start, count, &mut columns) };
            let mut next = 0;
            while next < count {
                let place = if backwards { count - 1 - next } else { next };
                // SAFETY: as above.
                unsafe { self.damp(start + place, &decay_at(&columns, place)) };
                next += 1;
            }
            turn += 1;
        }
    }
}

/// One bond of a batch.
#[inline(always)]
fn decay_at(columns: &[[f64; BATCH]; COLUMNS], place: usize) -> Decay {
    let [x, y, z, arm_i, arm_j, rest @ ..] = columns;
    let [a, b, c, d, e, f, g, h, k, l, m, n, across] = rest;
    Decay {
        axis: Vector::new(x[place], y[place], z[place]),
        arms: [arm_i[place], arm_j[place]],
        gains: [a[place], b[place], c[place], d[place]],
        losses: [e[place], f[place], g[place], h[place]],
        lightness: [k[place], l[place], m[place], n[place]],
        across: across[place],
    }
}

impl Slab<'_, '_> {
    /// Finds the columns of a batch.
    ///
    /// # Safety
    /// The bonds are in the list, and no other thread writes to their bodies meanwhile.
    #[inline(always)]
    unsafe fn fill<N: Lane>(
        &self,
        law: &Coefficients<N>,
        start: usize,
        count: usize,
        columns: &mut [[f64; BATCH]; COLUMNS],
    ) {
        let work = self.work;
        let mut place = 0;
        while place < count {
            let mut slots = [[0_u32; 8]; 2];
            let mut lane = 0;
            while lane < N::WIDTH {
                // Lanes behind the last bond repeat the first one.
                let bond = start + if place + lane < count { place + lane } else { place };
                slots[0][lane] = work.bodies[0][bond];
                slots[1][lane] = work.bodies[1][bond];
                lane += 1;
            }
            // SAFETY: the caller's promise; a batch holds a whole number of registers.
            unsafe {
                let pair = Pair::of_spheres(&work.body::<N>(&slots[0]), &work.body::<N>(&slots[1]));
                let free = [work.free::<N>(&slots[0]), work.free::<N>(&slots[1])];
                let decay = work.dashpots.decay(law, &pair, free, work.sweep.time);
                let Decay { axis, arms, gains, losses, lightness, across } = decay;
                let [a, b, c, d] = gains;
                let [e, f, g, h] = losses;
                let [k, l, m, n] = lightness;
                let all = [axis.x, axis.y, axis.z, arms[0], arms[1], a, b, c, d, e, f, g, h, k, l, m, n, across];
                let mut column = 0;
                while column < COLUMNS {
                    all[column].store(columns[column].as_mut_ptr().add(place));
                    column += 1;
                }
            }
            place += N::WIDTH;
        }
    }

    /// Lets the rates of a bond decay.
    ///
    /// # Safety
    /// As for [`Slab::fill`].
    #[inline(always)]
    unsafe fn damp(&mut self, bond: usize, decay: &Decay) {
        let work = self.work;
        let (i, j) = (work.bodies[0][bond] as usize, work.bodies[1][bond] as usize);
        // SAFETY: the caller's promise; a bond has two bodies, and its lost energy is its own.
        let (v, u, w, s, lost) =
            unsafe { (work.velocity.at(i), work.velocity.at(j), work.spin.at(i), work.spin.at(j), work.lost.at(bond)) };
        let mut moving = Moving {
            velocities: [Vector::of_row(*v), Vector::of_row(*u)],
            spins: [Vector::of_row(*w), Vector::of_row(*s)],
        };
        let before = moving;
        let impulse = decay.damp(&mut moving, work.sweep.backwards);
        *v = moving.velocities[0].row_with(v[3]);
        *u = moving.velocities[1].row_with(u[3]);
        *w = moving.spins[0].row_with(w[3]);
        *s = moving.spins[1].row_with(s[3]);
        *lost += impulse.taken;
        self.found.taken += impulse.taken;
        if !work.boundaries.is_empty() {
            self.feel([i, j], &impulse, &before);
        }
    }

    /// Notes what a bond did to groups.
    #[inline(never)]
    fn feel(&mut self, slots: [usize; 2], impulse: &Impulse, before: &Moving) {
        for (body, slot) in slots.into_iter().enumerate() {
            let Some(owner) = (self.work.owner[slot] as usize).checked_sub(1) else { continue };
            let arm = Vector::from(self.work.position[slot]) - self.work.boundaries[owner].pivot.into();
            let swept = Swept::at(impulse, body, arm, [before.velocities[body], before.spins[body]]);
            self.found.led += swept.energy;
            self.felt[owner].add(&swept);
        }
    }
}

impl Work<'_> {
    /// A body in each lane.
    ///
    /// # Safety
    /// The slots are those of particles, and no other thread writes to these meanwhile.
    #[inline(always)]
    unsafe fn body<N: Lane>(&self, slots: &[u32; 8]) -> Body<N> {
        // SAFETY: the caller's promise.
        let (position, velocity, spin) = unsafe {
            (
                N::load_rows(self.position.as_ptr(), slots.as_ptr()),
                N::load_rows(self.velocity.pointer().cast_const(), slots.as_ptr()),
                N::load_rows(self.spin.pointer().cast_const(), slots.as_ptr()),
            )
        };
        Body {
            position: vector(position),
            velocity: vector(velocity),
            spin: vector(spin),
            orientation: Quaternion::identity(),
            radius: position[3],
            mass: velocity[3],
            inertia: spin[3],
        }
    }

    /// 1 in the lanes of particles that forces move, 0 in the others.
    #[inline(always)]
    fn free<N: Lane>(&self, slots: &[u32; 8]) -> N {
        if self.boundaries.is_empty() {
            return N::splat(1.0);
        }
        let mut free = [1.0; 8];
        let mut lane = 0;
        while lane < N::WIDTH {
            if self.owner[slots[lane] as usize] != 0 {
                free[lane] = 0.0;
            }
            lane += 1;
        }
        // SAFETY: no register has more than eight lanes.
        unsafe { N::load(free.as_ptr()) }
    }
}

/// What a sweep over bonds at a plane works with.
pub(super) struct AtPlane<'a> {
    /// The law.
    pub(super) law: &'a Law,
    /// The feet of bonds, as bodies.
    pub(super) foot: &'a dyn Fn(Row) -> Body,
    /// Point about which the moment is taken, at time 0 \[m\].
    pub(super) reference: Vector,
    /// The plane's number.
    pub(super) boundary: usize,
}

impl AtPlane<'_> {
    /// Sweeps over a list. Each particle stands once in it. Returns the kinetic energy that particles moved by forces gained \[J\].
    pub(super) fn run(
        &self,
        list: &mut BondList,
        particles: &mut Particles,
        boundaries: &[BoundaryState],
        sweep: Sweep,
        felt: &mut [Swept],
    ) -> f64 {
        let Some(dashpots) = self.law.split else { return 0.0 };
        let (coefficients, mut gained) = (self.law.elasticity.at_step::<f64>(0.0), 0.0);
        for (bond, (&slot, &foot)) in list.first.iter().zip(&list.foot).enumerate() {
            let (slot, foot_body) = (slot as usize, (self.foot)(foot));
            let (owner, body) = (particles.owner[slot] as usize, body_of(particles, slot));
            let pair = Pair::at_wall(&body, &foot_body);
            let free = [f64::from(u8::from(owner == 0)), 0.0];
            let decay = dashpots.decay(&coefficients, &pair, free, sweep.time);
            let before = Moving { velocities: [body.velocity, foot_body.velocity], spins: [body.spin, foot_body.spin] };
            let mut moving = before;
            let impulse = decay.damp(&mut moving, sweep.backwards);
            particles.velocity[slot] = moving.velocities[0].row_with(body.mass);
            particles.angular_velocity[slot] = moving.spins[0].row_with(body.inertia);
            let motion = |body: usize| [before.velocities[body], before.spins[body]];
            let on_plane = Swept::at(&impulse, 1, Vector::from(foot) - self.reference, motion(1));
            let mut led = on_plane.energy;
            felt[self.boundary].add(&on_plane);
            if let Some(group) = owner.checked_sub(1) {
                let on_group = Swept::at(&impulse, 0, body.position - boundaries[group].pivot.into(), motion(0));
                led += on_group.energy;
                felt[group].add(&on_group);
            }
            list.lost[bond] += impulse.taken;
            list.damped += impulse.taken;
            gained -= impulse.taken + led;
        }
        gained
    }

    /// Adds the present loads of dashpots on the plane, and on groups.
    pub(super) fn add_loads(
        &self,
        list: &BondList,
        particles: &Particles,
        boundaries: &[BoundaryState],
        felt: &mut [Swept],
    ) {
        let Some(dashpots) = self.law.split else { return };
        let (coefficients, still) = (self.law.elasticity.at_step::<f64>(0.0), [Vector::zero(); 2]);
        for (&slot, &foot) in list.first.iter().zip(&list.foot) {
            let body = body_of(particles, slot as usize);
            let impulse = dashpots.loads(&coefficients, &Pair::at_wall(&body, &(self.foot)(foot)));
            felt[self.boundary].add(&Swept::at(&impulse, 1, Vector::from(foot) - self.reference, still));
            if let Some(group) = (particles.owner[slot as usize] as usize).checked_sub(1) {
                let arm = body.position - boundaries[group].pivot.into();
                felt[group].add(&Swept::at(&impulse, 0, arm, still));
            }
        }
    }
}
