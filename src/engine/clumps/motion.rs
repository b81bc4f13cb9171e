//! How clumps move: half kicks and the drift of rigid bodies, as many at once as a register has numbers, and the motion of their spheres.
//!
//! ```text
//! v += Δt/2 F/m    L += Δt/2 M    x += Δt v    q ← q (1, g)/|..|        w = w₀ − J⁻¹ (g × J w)    g = w Δt/2 · tan(|w| Δt/2)/(|w| Δt/2)
//! ```
//!
//! w is the mean of the angular velocities before and after the drift, in principal axes. A turn about it leaves kinetic energy and
//! angular momentum as they are (Simo and Wong 1991), as [`crate::engine::boundaries::rigid_body`] does; in principal axes an
//! iteration costs a dozen operations.
//!
//! Functions, not closures: what is not inlined into a kernel is compiled without its registers.

use super::{ClumpBodies, piece, pieces};
use crate::base::geometry::Quaternion;
use crate::base::lanes::{self, Kernel, Lane, Shared, vector};
use crate::base::number::{Number, Vector, larger};
use crate::base::threads::Context;
use crate::engine::state::{Clumps, Particles, Row, State};

/// Most iterations in which the rotation of a time step is found. Each gains a factor of about the angle of the step.
const ITERATIONS: usize = 40;

/// Square of the change of an angular velocity, over that of its length, at which the iteration ends.
const STANDS: f64 = 16.0 * f64::EPSILON * f64::EPSILON;

/// Square of half an angle of a step beyond which it is no longer followed exactly \[rad²\].
const FOLLOWED: f64 = 1.0;

impl ClumpBodies {
    /// Makes half a kick and the drift, and puts the spheres where they belong; they do not move by themselves. Returns the largest speed of
    /// a sphere, or above \[m/s\].
    pub(crate) fn kick_and_drift(&self, state: &mut State, step: f64, context: &Context) -> f64 {
        self.sweep(state, (step, true), context)
    }

    /// Makes the second half of the kick, and gives the spheres their motion. Returns the largest speed of a sphere at the middle of the
    /// next step, or above, or something that is not finite where a load is not \[m/s\].
    pub(crate) fn kick_again(&self, state: &mut State, step: f64, context: &Context) -> f64 {
        self.sweep(state, (step, false), context)
    }

    /// Makes half a kick of a step of this length \[s\], and the drift if it is the first half.
    fn sweep(&self, state: &mut State, (step, drifts): (f64, bool), context: &Context) -> f64 {
        let State { clumps, particles, .. } = state;
        let (rows, members) = Rows::of(clumps);
        let (spheres, slots) = (SphereRows::of(particles), &particles.slot);
        let of_piece = |number: usize| {
            let (clumps, mut fastest) = (piece(number, members.count()), 0.0);
            let kick =
                HalfKick { bodies: self, rows, members, spheres, slots, clumps, step, drifts, fastest: &mut fastest };
            lanes::run(context.width, kick);
            fastest
        };
        context.fold(pieces(members.count()), of_piece, 0.0, larger)
    }

    /// Puts the spheres where their clumps are.
    pub(crate) fn place(&self, state: &mut State) {
        let State { clumps, particles, .. } = state;
        let (rows, members) = Rows::of(clumps);
        let (spheres, slots) = (SphereRows::of(particles), &particles.slot);
        (0..members.count()).for_each(|clump| self.put(clump, (rows, members), spheres, slots));
    }

    /// Puts the spheres of a clump where they belong, and gives them its motion.
    #[inline(always)]
    fn put(&self, clump: usize, (rows, members): (Rows, Members), spheres: SphereRows, slots: &[u32]) {
        // SAFETY: each clump is worked on by one thread.
        let (position, velocity, turn, spin) = unsafe {
            let turn = Quaternion::from_row(*rows.orientation.at(clump));
            (*rows.position.at(clump), *rows.velocity.at(clump), turn, *rows.spin.at(clump))
        };
        let ([ex, ey, ez], spin) = (axes(turn), Vector::of_row(spin));
        let (centre, velocity) = (Vector::of_row(position), Vector::of_row(velocity));
        let (shape, scale) = (members.shape[clump], members.scale[clump]);
        let turned = (spheres.orientation.length() > 0).then(|| turn * self.frames[shape as usize]);
        for (sphere, arm) in members.spheres_of(clump).iter().zip(self.arms(shape)) {
            let slot = slots[*sphere as usize] as usize;
            let arm = ex * (scale * arm[0]) + ey * (scale * arm[1]) + ez * (scale * arm[2]);
            // SAFETY: each sphere belongs to one clump.
            let (place, moving, turning) =
                unsafe { (spheres.position.at(slot), spheres.velocity.at(slot), spheres.spin.at(slot)) };
            *place = (centre + arm).row_with(place[3]);
            *moving = (velocity + spin.cross(arm)).row_with(moving[3]);
            *turning = spin.row_with(turning[3]);
            if let Some(turned) = turned {
                // SAFETY: as above.
                unsafe { *spheres.orientation.at(slot) = turned.to_row() };
            }
        }
    }
}

/// Gives the spheres of a clump its motion where they are.
#[inline(always)]
fn give_motion(clump: usize, (rows, members): (Rows, Members), spheres: SphereRows, slots: &[u32]) {
    // SAFETY: each clump is worked on by one thread.
    let (position, velocity, spin) =
        unsafe { (*rows.position.at(clump), *rows.velocity.at(clump), *rows.spin.at(clump)) };
    let (centre, velocity, spin) = (Vector::of_row(position), Vector::of_row(velocity), Vector::of_row(spin));
    for sphere in members.spheres_of(clump) {
        let slot = slots[*sphere as usize] as usize;
        // SAFETY: each sphere belongs to one clump.
        let (place, moving, turning) =
            unsafe { (spheres.position.at(slot), spheres.velocity.at(slot), spheres.spin.at(slot)) };
        let arm = Vector::of_row(*place) - centre;
        *moving = (velocity + spin.cross(arm)).row_with(moving[3]);
        *turning = spin.row_with(turning[3]);
    }
}

/// Where a turn takes the axes.
#[inline(always)]
pub(super) fn axes(turn: Quaternion) -> [Vector; 3] {
    let (w, Vector { x, y, z }) = (turn.scalar, turn.vector);
    [
        Vector::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
        Vector::new(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
        Vector::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
    ]
}

/// The angular velocity that an angular momentum gives to a body so turned, with these moments of inertia, in principal axes.
#[inline(always)]
fn inside<N: Number>(turn: Quaternion<N>, inertia: Vector<N>, momentum: Vector<N>) -> Vector<N> {
    let inside = turn.conjugate().turn(momentum);
    Vector::new(inside.x / inertia.x, inside.y / inertia.y, inside.z / inertia.z)
}

/// The same in global axes.
#[inline(always)]
pub(super) fn turning<N: Number>(turn: Quaternion<N>, inertia: Vector<N>, momentum: Vector<N>) -> Vector<N> {
    turn.turn(inside(turn, inertia, momentum))
}

/// The rows of clumps that the steps read and write.
#[derive(Clone, Copy)]
struct Rows {
    /// Mass centres.
    position: Shared<Row>,
    /// Velocities and masses.
    velocity: Shared<Row>,
    /// Moments of inertia.
    inertia: Shared<Row>,
    /// Principal axes.
    orientation: Shared<Row>,
    /// Angular momenta.
    momentum: Shared<Row>,
    /// Angular velocities.
    spin: Shared<Row>,
    /// Forces.
    force: Shared<Row>,
    /// Moments.
    moment: Shared<Row>,
}

/// What the steps only read: who belongs to which clump.
#[derive(Clone, Copy)]
struct Members<'a> {
    /// Shapes.
    shape: &'a [u32],
    /// All lengths over those of the shapes.
    scale: &'a [f64],
    /// Indices of the spheres, clump by clump.
    spheres: &'a [u32],
    /// Where those of each clump end.
    ends: &'a [u32],
}

impl<'a> Members<'a> {
    /// How many clumps there are.
    fn count(self) -> usize {
        self.shape.len()
    }

    /// Indices of the spheres of a clump.
    #[inline(always)]
    fn spheres_of(self, clump: usize) -> &'a [u32] {
        let start = if clump == 0 { 0 } else { self.ends[clump - 1] };
        &self.spheres[start as usize..self.ends[clump] as usize]
    }
}

impl Rows {
    /// Those of these clumps.
    fn of(clumps: &mut Clumps) -> (Self, Members<'_>) {
        let rows = Self {
            position: Shared::new(&mut clumps.position),
            velocity: Shared::new(&mut clumps.velocity),
            inertia: Shared::new(&mut clumps.moments),
            orientation: Shared::new(&mut clumps.orientation),
            momentum: Shared::new(&mut clumps.angular_momentum),
            spin: Shared::new(&mut clumps.angular_velocity),
            force: Shared::new(&mut clumps.force),
            moment: Shared::new(&mut clumps.moment),
        };
        let Clumps { shape, scale, spheres, ends, .. } = clumps;
        (rows, Members { shape, scale, spheres, ends })
    }
}

/// The rows of particles that clumps write to.
#[derive(Clone, Copy)]
struct SphereRows {
    /// Positions.
    position: Shared<Row>,
    /// Velocities.
    velocity: Shared<Row>,
    /// Angular velocities.
    spin: Shared<Row>,
    /// Orientations; empty where particles have none.
    orientation: Shared<Row>,
}

impl SphereRows {
    /// Those of these particles.
    fn of(particles: &mut Particles) -> Self {
        Self {
            position: Shared::new(&mut particles.position),
            velocity: Shared::new(&mut particles.velocity),
            spin: Shared::new(&mut particles.angular_velocity),
            orientation: Shared::new(&mut particles.orientation),
        }
    }
}

/// Half a kick of the clumps of one piece.
struct HalfKick<'a, 'b> {
    /// What never changes.
    bodies: &'a ClumpBodies,
    /// The clumps.
    rows: Rows,
    /// Their spheres.
    members: Members<'a>,
    /// The particles.
    spheres: SphereRows,
    /// Slots of the particles.
    slots: &'a [u32],
    /// Which clumps.
    clumps: std::ops::Range<usize>,
    /// The time step \[s\].
    step: f64,
    /// Whether it is the first half, which the drift follows.
    drifts: bool,
    /// Largest speed \[m/s\].
    fastest: &'b mut f64,
}

impl HalfKick<'_, '_> {
    /// Makes it for as many clumps as there are lanes.
    #[inline(always)]
    fn several<N: Lane>(&mut self, first: usize) {
        let Self { bodies, rows, members, spheres, slots, step, drifts, .. } = *self;
        // SAFETY: the clumps are there, and this thread alone works on them.
        let speeds = unsafe { if drifts { drift::<N>(rows, first, step) } else { kick::<N>(rows, first, step) } };
        for (lane, speed) in speeds.into_iter().enumerate().take(N::WIDTH) {
            *self.fastest = larger(*self.fastest, speed);
            if drifts {
                bodies.put(first + lane, (rows, members), spheres, slots);
            } else {
                give_motion(first + lane, (rows, members), spheres, slots);
            }
        }
    }
}

impl Kernel for HalfKick<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(mut self) {
        let clumps = self.clumps.clone();
        let mut clump = clumps.start;
        while clump + N::WIDTH <= clumps.end {
            self.several::<N>(clump);
            clump += N::WIDTH;
        }
        while clump < clumps.end {
            self.several::<f64>(clump);
            clump += 1;
        }
    }
}

/// The rows of some clumps, lane by lane.
struct Block<N> {
    /// Mass centre and reach.
    position: [N; 4],
    /// Velocity and mass.
    velocity: [N; 4],
    /// Principal axes.
    turn: Quaternion<N>,
    /// Angular momentum.
    momentum: Vector<N>,
    /// Force.
    force: Vector<N>,
    /// Moment.
    moment: Vector<N>,
    /// Moments of inertia.
    inertia: Vector<N>,
}

impl<N: Lane> Block<N> {
    /// Those of the clumps from `first` on.
    ///
    /// # Safety
    /// As many clumps as there are lanes stand from `first` on, and no other thread writes their rows meanwhile.
    #[inline(always)]
    unsafe fn of(rows: Rows, first: usize) -> Self {
        // SAFETY: the caller's promise.
        unsafe {
            Self {
                position: rows.position.load_block(first),
                velocity: rows.velocity.load_block(first),
                turn: Quaternion::from_row(rows.orientation.load_block(first)),
                momentum: vector(rows.momentum.load_block(first)),
                force: vector(rows.force.load_block(first)),
                moment: vector(rows.moment.load_block(first)),
                inertia: vector(rows.inertia.load_block(first)),
            }
        }
    }
}

/// Kicks and drifts a block of clumps. Returns their largest speeds \[m/s\].
///
/// # Safety
/// As for [`Block::of`]; no other thread reads the rows meanwhile either.
#[inline(always)]
unsafe fn drift<N: Lane>(rows: Rows, first: usize, step: f64) -> [f64; 8] {
    // SAFETY: the caller's promise.
    let Block { position, velocity, turn, momentum, force, moment, inertia } = unsafe { Block::<N>::of(rows, first) };
    let (half, step) = (N::splat(0.5 * step), N::splat(step));
    let moving = vector(velocity) + force * (half / velocity[3]);
    let momentum = momentum + moment * half;
    let place = vector(position) + moving * step;
    let mean = mean_spin(inside(turn, inertia, momentum), inertia, half);
    let (above, below) = tangent(mean, half);
    let turn = (turn * Quaternion { scalar: below, vector: mean * (half * above) }).normalised();
    let spin = turning(turn, inertia, momentum);
    let mut speeds = [0.0; 8];
    // SAFETY: the caller's promise.
    unsafe {
        rows.position.store_block(place.row_with(position[3]), first);
        rows.velocity.store_block(moving.row_with(velocity[3]), first);
        rows.orientation.store_block(turn.to_row(), first);
        rows.momentum.store_block(momentum.row_with(N::zero()), first);
        rows.spin.store_block(spin.row_with(N::zero()), first);
        N::store(moving.length() + mean.length() * position[3], speeds.as_mut_ptr());
    }
    speeds
}

/// Numerator and denominator of tan|h|/|h| for h = w Δt/2 (as [`Quaternion::turned`]).
#[inline(always)]
fn tangent<N: Number>(spin: Vector<N>, half: N) -> (N, N) {
    let square = (spin.dot(spin) * (half * half)).min(N::splat(FOLLOWED));
    let above = N::splat(945.0) - square * (N::splat(105.0) - square);
    let below = N::splat(945.0) - square * (N::splat(420.0) - N::splat(15.0) * square);
    (above, below)
}

/// The mean of the angular velocities before and after a drift of twice `half` \[s\], in principal axes with these moments of inertia.
#[inline(always)]
fn mean_spin<N: Number>(begun: Vector<N>, inertia: Vector<N>, half: N) -> Vector<N> {
    let Vector { x: a, y: b, z: c } = inertia;
    let shares = Vector::new((b - c) / a, (c - a) / b, (a - b) / c);
    let mut mean = begun;
    for _ in 0..ITERATIONS {
        let (above, below) = tangent(mean, half);
        let factor = half * above / below;
        let x = begun.x + factor * shares.x * (mean.y * mean.z);
        let y = begun.y + factor * shares.y * (mean.z * x);
        let z = begun.z + factor * shares.z * (x * y);
        let next = Vector::new(x, y, z);
        let change = next - mean;
        let goes_on = change.dot(change).greater(N::splat(STANDS) * next.dot(next));
        // What stands is not touched again: the bits do not depend on who stands in the other lanes.
        mean = Vector::new(
            N::select(goes_on, next.x, mean.x),
            N::select(goes_on, next.y, mean.y),
            N::select(goes_on, next.z, mean.z),
        );
        if !N::any(goes_on) {
            break;
        }
    }
    mean
}

/// Kicks a block of clumps. Returns their largest speeds at the middle of the next step \[m/s\].
///
/// # Safety
/// As for [`drift`].
#[inline(always)]
unsafe fn kick<N: Lane>(rows: Rows, first: usize, step: f64) -> [f64; 8] {
    // SAFETY: the caller's promise.
    let Block { position, velocity, turn, momentum, force, moment, inertia } = unsafe { Block::<N>::of(rows, first) };
    let half = N::splat(0.5 * step);
    let (kick, twist) = (force * (half / velocity[3]), moment * half);
    let (moving, momentum) = (vector(velocity) + kick, momentum + twist);
    let (now, next) = (turning(turn, inertia, momentum), turning(turn, inertia, momentum + twist));
    let mut speeds = [0.0; 8];
    // SAFETY: the caller's promise.
    unsafe {
        rows.velocity.store_block(moving.row_with(velocity[3]), first);
        rows.momentum.store_block(momentum.row_with(N::zero()), first);
        rows.spin.store_block(now.row_with(N::zero()), first);
        N::store((moving + kick).length() + next.length() * position[3], speeds.as_mut_ptr());
    }
    speeds
}
