//! A sweep over the slabs of a list of bonds.
//!
//! What does not depend on velocities is found for a batch of bonds, several at a time; the bonds then change their bodies one after the
//! other. Slabs of one parity share no particle: those of even number come first, and last in a sweep backwards, whichever thread works.

use crate::bond::damping::split::{Decay, Impulse, Moving};
use crate::bond::damping::viscous::Viscous;
use crate::bond::{Body, Coefficients, Elasticity, Pair, Quaternion};
use crate::boundaries::felt::Swept;
use crate::interactions::Sweep;
use crate::lanes::{self, Kernel, Lane, Shared, vector};
use crate::number::Vector;
use crate::state::{BoundaryState, Row};
use crate::threads::Context;

/// Bonds whose columns are found together: they fit the first-level cache.
const BATCH: usize = 64;

/// Columns of a batch: axis, arms, gains, losses, lightness, across.
const COLUMNS: usize = 18;

/// What each slab found, and what it did to each boundary.
pub(super) type Room = (Vec<Found>, Vec<Swept>);

/// What a sweep over a slab found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    /// Energy that dashpots took of all bodies \[J\].
    taken: f64,
    /// Energy that they gave to bodies that are led \[J\].
    led: f64,
}

/// What all slabs share.
pub(super) struct Work<'a> {
    /// The dashpots.
    pub(super) dashpots: Viscous,
    /// Section and stiffnesses of the law.
    pub(super) elasticity: &'a Elasticity,
    /// The sweep.
    pub(super) sweep: Sweep,
    /// Bodies of each bond.
    pub(super) bodies: [&'a [u32]; 2],
    /// Positions and radii.
    pub(super) position: &'a [Row],
    /// Velocities and masses.
    pub(super) velocity: Shared<Row>,
    /// Angular velocities and moments of inertia.
    pub(super) spin: Shared<Row>,
    /// Energy that each bond lost.
    pub(super) lost: Shared<f64>,
    /// What moves each particle.
    pub(super) owner: &'a [u32],
    /// The boundaries; none where no group is concerned.
    pub(super) boundaries: &'a [BoundaryState],
}

impl Work<'_> {
    /// Sweeps over all slabs, which end at these places. Returns the energy that dashpots took of all bodies, and what bodies that are led
    /// got \[J\].
    pub(super) fn slabs(
        &self,
        ends: &[u32],
        (found, loads): &mut Room,
        felt: &mut [Swept],
        context: &Context,
    ) -> [f64; 2] {
        let (slabs, count) = (ends.len().saturating_sub(1), self.boundaries.len());
        found.clear();
        found.resize(slabs, Found::default());
        loads.clear();
        loads.resize(slabs * count, Swept::default());
        let (places, parts) = (Shared::new(found), Shared::new(loads));
        let slab = |slab: usize| {
            // SAFETY: each slab is done once, and has places of its own; slabs worked on at the same time share no particle.
            unsafe {
                let felt = parts.part(slab * count, (slab + 1) * count);
                *places.at(slab) = self.slab([ends[slab] as usize, ends[slab + 1] as usize], felt, context);
            }
        };
        match self.sweep.backwards {
            false => context.slabs(slabs, slab),
            // Those of odd number come first where each is one further.
            true => context.slabs(slabs + 1, |turn| {
                if turn > 0 {
                    slab(turn - 1);
                }
            }),
        }
        for part in loads.chunks(count.max(1)) {
            felt.iter_mut().zip(part).for_each(|(sum, part)| sum.add(part));
        }
        found.iter().fold([0.0; 2], |[taken, led], found| [taken + found.taken, led + found.led])
    }

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
            unsafe {
                self.fill::<N>(&law, start, count, &mut columns);
                let mut next = 0;
                while next < count {
                    let place = if backwards { count - 1 - next } else { next };
                    self.damp(start + place, &decay_at(&columns, place));
                    next += 1;
                }
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
            let free = [work.free(&slots[0]), work.free(&slots[1])];
            // SAFETY: the caller's promise; a batch holds a whole number of registers, of which none has more than eight lanes.
            unsafe {
                let pair = Pair::of_spheres(&work.body::<N>(&slots[0]), &work.body::<N>(&slots[1]));
                let free = [N::load(free[0].as_ptr()), N::load(free[1].as_ptr())];
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

    /// 1 for particles that forces move, 0 for the others.
    #[inline(always)]
    fn free(&self, slots: &[u32; 8]) -> [f64; 8] {
        let mut free = [1.0; 8];
        if !self.boundaries.is_empty() {
            let mut lane = 0;
            while lane < free.len() {
                if self.owner[slots[lane] as usize] != 0 {
                    free[lane] = 0.0;
                }
                lane += 1;
            }
        }
        free
    }
}
