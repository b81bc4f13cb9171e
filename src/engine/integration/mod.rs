//! Velocity Verlet: half a step of velocity (a kick), a step of position (the drift), forces, the other half of the kick.
//!
//! Behind each load stands its dashpot to the ground, which a fluid writes; 0 without one. A load F that holds −β v gives in half a kick
//! Δt/2 F/(m + Δt/2 β): both half kicks together see the mean of the velocities before and after, whatever the step.

mod braking;
mod damped;
mod fields;

pub(crate) use braking::brakes;
pub(crate) use fields::{Fields, Load};

use crate::base::geometry::Quaternion;
use crate::base::lanes::{self, Kernel, Lane, Shared};
use crate::base::number::{Vector, larger};
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::{Particles, Row};

/// Moves free particles by half a kick and a drift of `step` \[s\] and sets all loads to zero. Returns the largest
/// speed \[m/s\].
pub(crate) fn kick_and_drift(
    particles: &mut Particles,
    step: f64,
    Sweep { turning, in_fluid }: Sweep,
    context: &Context,
) -> f64 {
    let rows = Rows::of(particles);
    match in_fluid {
        true => sweep(First::<true> { rows, step, turning }, context),
        false => sweep(First::<false> { rows, step, turning }, context),
    }
}

/// Half a kick of some particles.
trait HalfKick: Copy + Send + Sync {
    /// The particles.
    fn rows(&self) -> &Rows<'_>;

    /// Makes it for [`Lane::WIDTH`] consecutive particles that move by the forces on them. Notes their largest squared speed
    /// \[m²/s²\], and beside it something that is not finite where a velocity or force is not.
    ///
    /// # Safety
    /// All are particles, and no other thread reads or writes their rows meanwhile.
    unsafe fn free<N: Lane>(&self, slot: usize, found: &mut [N; 2]);

    /// What becomes of a particle that something else moves.
    ///
    /// # Safety
    /// As for [`HalfKick::free`].
    unsafe fn held(&self, slot: usize);
}

/// Makes half a kick of all particles. Returns the largest speed, or something that is not finite \[m/s\].
fn sweep<K: HalfKick>(kick: K, context: &Context) -> f64 {
    let square = |piece| {
        let mut fastest = 0.0;
        lanes::run(context.width, Piece { kick, piece, fastest: &mut fastest });
        fastest
    };
    context.fold(kick.rows().pieces(), square, 0.0, larger).sqrt()
}

/// Half a kick of one piece.
struct Piece<'a, K> {
    /// What is done.
    kick: K,
    /// Which piece.
    piece: usize,
    /// Largest squared speed, or something that is not finite \[m²/s²\].
    fastest: &'a mut f64,
}

impl<K: HalfKick> Kernel for Piece<'_, K> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { kick, piece, fastest } = self;
        let slots = kick.rows().slots(piece);
        let owner = &kick.rows().owner[..slots.end];
        let (mut several, mut single) = ([N::zero(); 2], [0.0; 2]);
        let mut slot = slots.start;
        while slot < slots.end {
            let some = &owner[slot..];
            // SAFETY: pieces do not overlap, and each is worked on by one thread.
            unsafe {
                if some.len() >= N::WIDTH && some[..N::WIDTH].iter().fold(0, |any, owner| any | owner) == 0 {
                    kick.free(slot, &mut several);
                    slot += N::WIDTH;
                    continue;
                }
                if some[0] == 0 {
                    kick.free(slot, &mut single);
                } else {
                    kick.held(slot);
                }
            }
            slot += 1;
        }
        let mut columns = [[0.0; 8]; 2];
        lanes::put(&mut columns, 0, several);
        let [most, finite] = single;
        *fastest =
            columns[0].into_iter().fold(most, larger) + columns[1].into_iter().fold(finite, |sum, one| sum + one);
    }
}

/// Reads consecutive rows: a vector and a fourth number for each.
///
/// # Safety
/// As for [`Shared::load_block`].
#[inline(always)]
unsafe fn load<N: Lane>(rows: Shared<Row>, slot: usize) -> (Vector<N>, N) {
    // SAFETY: the caller's promise.
    let columns = unsafe { rows.load_block(slot) };
    (Vector::of_row(columns), columns[3])
}

/// Writes consecutive rows.
///
/// # Safety
/// As for [`Shared::store_block`].
#[inline(always)]
unsafe fn store<N: Lane>(rows: Shared<Row>, slot: usize, vector: Vector<N>, rest: N) {
    // SAFETY: the caller's promise.
    unsafe { rows.store_block(vector.row_with(rest), slot) }
}

/// What half a kick gives to a velocity for a unit load. Nobody pays for dashpots to the ground who has none.
#[inline(always)]
fn gain<N: Lane, const IN_FLUID: bool>(half: N, inertia: N, drag: N) -> N {
    if IN_FLUID { half / (inertia + half * drag) } else { half / inertia }
}

/// What a sweep over the particles has to do beside translation.
#[derive(Clone, Copy)]
pub(crate) struct Sweep {
    /// Whether particles turn.
    pub turning: bool,
    /// Whether dashpots to the ground stand behind loads.
    pub in_fluid: bool,
}

/// The first half of a kick, and the drift.
#[derive(Clone, Copy)]
struct First<'a, const IN_FLUID: bool> {
    /// The particles.
    rows: Rows<'a>,
    /// The time step \[s\].
    step: f64,
    /// Whether particles turn.
    turning: bool,
}

impl<const IN_FLUID: bool> First<'_, IN_FLUID> {
    /// Sets loads to zero.
    ///
    /// # Safety
    /// As for [`HalfKick::free`].
    #[inline(always)]
    unsafe fn clear(&self, slot: usize, count: usize) {
        // SAFETY: the caller's promise.
        unsafe {
            self.rows.force.part(slot, slot + count).fill([0.0; 4]);
            if self.turning {
                self.rows.torque.part(slot, slot + count).fill([0.0; 4]);
            }
        }
    }
}

impl<const IN_FLUID: bool> HalfKick for First<'_, IN_FLUID> {
    #[inline(always)]
    fn rows(&self) -> &Rows<'_> {
        &self.rows
    }

    #[inline(always)]
    unsafe fn free<N: Lane>(&self, slot: usize, [most, _]: &mut [N; 2]) {
        let (Rows { position, velocity, spin, force, torque, .. }, step) = (self.rows, N::splat(self.step));
        let half = N::splat(0.5 * self.step);
        // SAFETY: the caller's promise.
        unsafe {
            let ((v, mass), (f, drag)) = (load::<N>(velocity, slot), load(force, slot));
            let v = v + f * (gain::<N, IN_FLUID>(half, mass, drag));
            store(velocity, slot, v, mass);
            let (place, radius) = load(position, slot);
            store(position, slot, place + v * step, radius);
            if self.turning {
                let ((w, inertia), (t, drag)) = (load::<N>(spin, slot), load(torque, slot));
                store(spin, slot, w + t * (gain::<N, IN_FLUID>(half, inertia, drag)), inertia);
            }
            self.clear(slot, N::WIDTH);
            let square = v.dot(v);
            *most = N::select(square.greater(*most), square, *most);
        }
    }

    #[inline(always)]
    unsafe fn held(&self, slot: usize) {
        // SAFETY: the caller's promise.
        unsafe { self.clear(slot, 1) }
    }
}

/// Turns the orientations by a drift of `step` \[s\], where particles have one.
pub(crate) fn turn(particles: &mut Particles, step: f64, context: &Context) {
    let orientation = Shared::new(&mut particles.orientation);
    let (count, spin) = (orientation.length(), &particles.angular_velocity);
    context.each(count.div_ceil(CHUNK), |piece| {
        for slot in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
            // SAFETY: pieces do not overlap.
            let row = unsafe { orientation.at(slot) };
            *row = Quaternion::from_row(*row).turned(spin[slot].into(), step).to_row();
        }
    });
}

/// Adds the weight, where gravity \[m/s²\] is given, and moves free particles by the second half of the kick. Returns
/// the largest speed at the middle of the next step, or something that is not finite where a force or velocity is not
/// \[m/s\].
pub(crate) fn kick_again(
    particles: &mut Particles,
    gravity: Option<[f64; 3]>,
    step: f64,
    Sweep { turning, in_fluid }: Sweep,
    context: &Context,
) -> f64 {
    let rows = Rows::of(particles);
    match in_fluid {
        true => sweep(Second::<true> { rows, gravity, step, turning }, context),
        false => sweep(Second::<false> { rows, gravity, step, turning }, context),
    }
}

/// The second half of a kick.
#[derive(Clone, Copy)]
struct Second<'a, const IN_FLUID: bool> {
    /// The particles.
    rows: Rows<'a>,
    /// Gravity that is not yet among the forces \[m/s²\].
    gravity: Option<[f64; 3]>,
    /// The time step \[s\].
    step: f64,
    /// Whether particles turn.
    turning: bool,
}

impl<const IN_FLUID: bool> Second<'_, IN_FLUID> {
    /// Loads the forces, with the weight, and their dashpots to the ground.
    ///
    /// # Safety
    /// As for [`HalfKick::free`].
    #[inline(always)]
    unsafe fn weigh<N: Lane>(&self, slot: usize, mass: N) -> (Vector<N>, N) {
        // SAFETY: the caller's promise.
        unsafe {
            let (mut force, rest) = load::<N>(self.rows.force, slot);
            if let Some([x, y, z]) = self.gravity {
                force += Vector::new(N::splat(x), N::splat(y), N::splat(z)) * mass;
                store(self.rows.force, slot, force, rest);
            }
            (force, rest)
        }
    }
}

impl<const IN_FLUID: bool> HalfKick for Second<'_, IN_FLUID> {
    #[inline(always)]
    fn rows(&self) -> &Rows<'_> {
        &self.rows
    }

    /// The speed is that at the middle of the next step.
    #[inline(always)]
    unsafe fn free<N: Lane>(&self, slot: usize, [most, check]: &mut [N; 2]) {
        let (Rows { velocity, spin, torque, .. }, half) = (self.rows, N::splat(0.5 * self.step));
        // SAFETY: the caller's promise.
        unsafe {
            let (v, mass) = load::<N>(velocity, slot);
            let (force, drag) = self.weigh(slot, mass);
            let change = force * (gain::<N, IN_FLUID>(half, mass, drag));
            let v = v + change;
            store(velocity, slot, v, mass);
            let next = v + change;
            let square = next.dot(next);
            *most = N::select(square.greater(*most), square, *most);
            // Zero times what is finite is zero; times anything else it is not a number.
            *check = *check + square * N::zero();
            if self.turning {
                let ((w, inertia), (t, drag)) = (load::<N>(spin, slot), load(torque, slot));
                let w = w + t * (gain::<N, IN_FLUID>(half, inertia, drag));
                store(spin, slot, w, inertia);
                *check = *check + (w.x + w.y + w.z) * N::zero();
            }
        }
    }

    #[inline(always)]
    unsafe fn held(&self, slot: usize) {
        // SAFETY: the caller's promise.
        unsafe {
            let (_, mass) = load::<f64>(self.rows.velocity, slot);
            self.weigh(slot, mass);
        }
    }
}

/// Largest speed of a free particle at the middle of a step of this length \[s\], from rest or not \[m/s\].
pub(crate) fn coming_speed(particles: &Particles, step: f64) -> f64 {
    let free = (0..particles.len()).filter(|&slot| particles.owner[slot] == 0);
    let squares = free.map(|slot| {
        let velocity = particles.velocity[slot];
        let force = particles.force[slot];
        let next = plus(velocity, force, kick(&velocity, &force, 0.5 * step));
        next[0] * next[0] + next[1] * next[1] + next[2] * next[2]
    });
    squares.fold(0.0, f64::max).sqrt()
}

/// A row plus a multiple of the vector of another.
#[inline(always)]
fn plus(row: Row, other: Row, factor: f64) -> Row {
    [row[0] + factor * other[0], row[1] + factor * other[1], row[2] + factor * other[2], row[3]]
}

/// What a half kick of this length \[s\] gives to a velocity for a unit force \[s/kg\]: behind the velocity stands the mass, behind the force its
/// dashpot to the ground. The same of rotation.
#[inline(always)]
pub(crate) fn kick(motion: &Row, load: &Row, length: f64) -> f64 {
    length / (motion[3] + length * load[3])
}

/// The same for each unit of time \[1/kg\].
#[inline(always)]
pub(crate) fn mobility(motion: &Row, load: &Row, length: f64) -> f64 {
    1.0 / (motion[3] + length * load[3])
}

/// The rows that integration reads and writes.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'a> {
    /// Positions.
    position: Shared<Row>,
    /// Velocities and masses.
    velocity: Shared<Row>,
    /// Angular velocities and moments of inertia.
    spin: Shared<Row>,
    /// Forces.
    force: Shared<Row>,
    /// Torques.
    torque: Shared<Row>,
    /// What moves each particle.
    owner: &'a [u32],
}

/// One particle's rows.
pub(crate) struct ParticleRows<'a> {
    /// Position and radius.
    pub position: &'a mut Row,
    /// Velocity and mass.
    pub velocity: &'a mut Row,
    /// Angular velocity and moment of inertia.
    pub spin: &'a mut Row,
    /// Force.
    pub force: &'a mut Row,
    /// Torque.
    pub torque: &'a mut Row,
    /// Its slot.
    pub slot: usize,
    /// What moves it.
    pub owner: u32,
}

impl<'a> Rows<'a> {
    /// The rows of these particles.
    pub(crate) fn of(particles: &'a mut Particles) -> Self {
        Self {
            position: Shared::new(&mut particles.position),
            velocity: Shared::new(&mut particles.velocity),
            spin: Shared::new(&mut particles.angular_velocity),
            force: Shared::new(&mut particles.force),
            torque: Shared::new(&mut particles.torque),
            owner: &particles.owner,
        }
    }

    /// How many pieces of work there are.
    pub(crate) fn pieces(&self) -> usize {
        self.owner.len().div_ceil(CHUNK)
    }

    /// The slots of one piece.
    #[inline(always)]
    pub(crate) fn slots(&self, piece: usize) -> std::ops::Range<usize> {
        piece * CHUNK..((piece + 1) * CHUNK).min(self.owner.len())
    }

    /// One particle's rows.
    ///
    /// # Safety
    /// `slot` is a particle, and no other thread reads or writes its rows meanwhile.
    #[inline(always)]
    pub(crate) unsafe fn body(&self, slot: usize) -> ParticleRows<'a> {
        // SAFETY: the caller's promise.
        unsafe {
            ParticleRows {
                position: self.position.at(slot),
                velocity: self.velocity.at(slot),
                spin: self.spin.at(slot),
                force: self.force.at(slot),
                torque: self.torque.at(slot),
                slot,
                owner: self.owner[slot],
            }
        }
    }

    /// Hands out the particles of one piece, and whether each moves by the forces on it. Each piece is for one thread only.
    #[inline(always)]
    pub(crate) fn each(&self, piece: usize, mut hand: impl FnMut(ParticleRows, bool)) {
        for slot in self.slots(piece) {
            // SAFETY: pieces do not overlap, and each is worked on by one thread.
            hand(unsafe { self.body(slot) }, self.owner[slot] == 0);
        }
    }

    /// Hands out the particles of one piece that move by the forces on them. Each piece is for one thread only.
    #[inline(always)]
    pub(crate) fn each_free(&self, piece: usize, mut hand: impl FnMut(ParticleRows)) {
        self.each(piece, |body, free| {
            if free {
                hand(body);
            }
        });
    }
}

/// Sets all loads to zero.
pub(crate) fn clear_loads(particles: &mut Particles) {
    particles.force.fill([0.0; 4]);
    particles.torque.fill([0.0; 4]);
}
