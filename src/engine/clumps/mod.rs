//! Clumps during a time step.
//!
//! Their spheres are rows among the particles, whose owner is the clump (behind the boundaries): lists and passes need not know. A clump
//! gathers the loads of its spheres, moves as a rigid body, and puts its spheres where they belong.
//!
//! ```text
//! v += Δt/2 F/m    L += Δt/2 M    x += Δt v    q ← q (1, g)/|..|        w = w₀ − J⁻¹ (g × J w)    g = w Δt/2 · tan(|w| Δt/2)/(|w| Δt/2)
//! ```
//!
//! w is the mean of the angular velocities before and after the drift, in principal axes. A turn about it leaves kinetic energy and
//! angular momentum as they are (Simo and Wong 1991), as [`crate::engine::boundaries::rigid_body`] does; in principal axes an
//! iteration costs a dozen operations.

mod energy;
mod loads;
mod strikers;

pub(crate) use energy::{book_losses, book_work, kinetic, note_loads};
pub(crate) use loads::{force_on, mass_of};
pub(crate) use strikers::Striker;

use crate::base::geometry::Quaternion;
use crate::base::lanes::{self, Kernel, Lane, Shared, vector};
use crate::base::number::{Number, Vector};
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::{Clumps, Particles, Row, State, StateFault, demand};
use crate::scene::{Clump, Scene};
use nalgebra::Matrix6;

/// Most iterations in which the rotation of a time step is found. Each gains a factor of about the angle of the step.
const ITERATIONS: usize = 40;

/// Square of the change of an angular velocity, over that of its length, at which the iteration ends.
const STANDS: f64 = 16.0 * f64::EPSILON * f64::EPSILON;

/// Square of half an angle of a step beyond which it is no longer followed exactly \[rad²\].
const FOLLOWED: f64 = 1.0;

/// Clumps in one piece of work.
const PIECE: usize = CHUNK / 4;

/// What never changes of the clumps of a scene.
pub(crate) struct ClumpBodies {
    /// First sphere of each (index of the particle), and behind the last one where the last ends.
    starts: Vec<u32>,
    /// First sphere of each among the arms, and their number.
    arm_starts: Vec<u32>,
    /// From the mass centre to each sphere, in principal axes \[m\], clump by clump.
    arms: Vec<Row>,
    /// Principal axes at time 0, where spheres have an orientation.
    begun: Vec<Row>,
    /// What stands for them where impacts are foreseen.
    strikers: Vec<Striker>,
}

/// The spheres of a clump: the first particle, and their arms.
type Spheres<'a> = (usize, &'a [Row]);

impl ClumpBodies {
    /// Those of a scene, if it has any.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let clumps = &scene.clumps;
        let mut bodies = Self {
            starts: clumps.iter().map(|clump| clump.first).collect(),
            arm_starts: vec![0],
            arms: Vec::new(),
            begun: clumps.iter().map(|clump| clump.orientation).collect(),
            strikers: strikers::of(scene),
        };
        for clump in clumps {
            let shape = &scene.clump_shapes[clump.shape as usize];
            let spheres = scene.spheres_of(clump);
            bodies.arms.extend((0..spheres.len()).map(|sphere| {
                let [x, y, z] = clump.arm(shape, sphere);
                [x, y, z, 0.0]
            }));
            bodies.arm_starts.push(bodies.arms.len() as u32);
        }
        (!clumps.is_empty()).then_some(bodies)
    }

    /// The clumps of a scene at time 0.
    pub(crate) fn begun(scene: &Scene) -> Clumps {
        let mut begun = Clumps::default();
        for clump in &scene.clumps {
            let shape = &scene.clump_shapes[clump.shape as usize];
            let length = |sphere: usize| Vector::from(clump.arm(shape, sphere)).length();
            let farthest = (0..shape.spheres.len()).map(length).fold(0.0, f64::max);
            let Clump { position, velocity, orientation, angular_velocity, mass, .. } = *clump;
            let turn = Quaternion::from_row(orientation);
            let [a, b, c] = turn.conjugate().turn(angular_velocity.into()).to_array();
            let [x, y, z] = clump.moments;
            let momentum = turn.turn(Vector::new(x * a, y * b, z * c));
            let smallest =
                scene.particles[scene.spheres_of(clump)].iter().map(|it| it.radius).fold(f64::INFINITY, f64::min);
            begun.position.push(Vector::from(position).row_with(farthest));
            begun.moments.push([x, y, z, smallest]);
            begun.velocity.push(Vector::from(velocity).row_with(mass));
            begun.orientation.push(orientation);
            begun.angular_momentum.push(momentum.row_with(0.0));
            begun.angular_velocity.push(Vector::from(angular_velocity).row_with(0.0));
            begun.force.push([0.0; 4]);
            begun.moment.push([0.0; 4]);
        }
        begun
    }

    /// Whether a state from outside has the clumps of the scene.
    pub(crate) fn check(&self, state: &State, first: &State) -> Result<(), StateFault> {
        let (clumps, begun) = (&state.clumps, &first.clumps);
        let same = |(one, other): (&Row, &Row)| one[3].to_bits() == other[3].to_bits();
        let moments = clumps.moments.iter().flatten().map(|it| it.to_bits());
        let kept = clumps.position.iter().zip(&begun.position).all(same)
            && clumps.velocity.iter().zip(&begun.velocity).all(same)
            && moments.eq(begun.moments.iter().flatten().map(|it| it.to_bits()));
        demand(kept, "clumps", 0, "the clumps of the scene")
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.starts.len()
    }

    /// The spheres of a clump.
    #[inline(always)]
    pub(crate) fn spheres(&self, clump: usize) -> Spheres<'_> {
        let (from, to) = (self.arm_starts[clump] as usize, self.arm_starts[clump + 1] as usize);
        (self.starts[clump] as usize, &self.arms[from..to])
    }

    /// Makes half a kick and the drift, and puts the spheres where they belong; they do not move by themselves. Returns the largest speed of
    /// a sphere, or above \[m/s\].
    pub(crate) fn kick_and_drift(&self, state: &mut State, step: f64, context: &Context) -> f64 {
        let rows = Rows::of(&mut state.clumps);
        let (spheres, slots) = (SphereRows::of(&mut state.particles), &state.particles.slot);
        let of_piece = |piece: usize| {
            let mut fastest = 0.0;
            let drift = Drift { bodies: self, rows, spheres, slots, piece, step, fastest: &mut fastest };
            lanes::run(context.width, drift);
            fastest
        };
        context.fold(self.pieces(), of_piece, 0.0, larger)
    }

    /// Makes the second half of the kick, and gives the spheres their motion. Returns the largest speed of a sphere at the middle of the
    /// next step, or above, or something that is not finite where a load is not \[m/s\].
    pub(crate) fn kick_again(&self, state: &mut State, step: f64, context: &Context) -> f64 {
        let rows = Rows::of(&mut state.clumps);
        let (spheres, slots) = (SphereRows::of(&mut state.particles), &state.particles.slot);
        let of_piece = |piece: usize| {
            let mut fastest = 0.0;
            lanes::run(context.width, Kick { bodies: self, rows, spheres, slots, piece, step, fastest: &mut fastest });
            fastest
        };
        context.fold(self.pieces(), of_piece, 0.0, larger)
    }

    /// Puts the spheres where their clumps are.
    pub(crate) fn place(&self, state: &mut State, context: &Context) {
        let rows = Rows::of(&mut state.clumps);
        let (spheres, slots) = (SphereRows::of(&mut state.particles), &state.particles.slot);
        context.each(self.pieces(), |piece| {
            for clump in self.piece(piece) {
                self.put(clump, rows, spheres, slots);
            }
        });
    }

    /// Largest speed of a sphere after half a kick of a step of this length \[s\], or above \[m/s\].
    pub(crate) fn coming_speed(&self, clumps: &Clumps, step: f64) -> f64 {
        (0..self.count()).map(|clump| self.speed_after(clumps, clump, step)).fold(0.0, larger)
    }

    /// The same of one clump.
    pub(crate) fn speed_after(&self, clumps: &Clumps, clump: usize, step: f64) -> f64 {
        let [velocity, spin] = self.motion_after(clumps, clump, step);
        velocity.length() + spin.length() * clumps.position[clump][3]
    }

    /// Velocity and angular velocity after half a kick of a step of this length \[s\].
    pub(crate) fn motion_after(&self, clumps: &Clumps, clump: usize, step: f64) -> [Vector; 2] {
        let half = 0.5 * step;
        let velocity = Vector::from(clumps.velocity[clump]);
        let kick = Vector::from(clumps.force[clump]) * (half / clumps.velocity[clump][3]);
        let momentum = Vector::from(clumps.angular_momentum[clump]) + Vector::from(clumps.moment[clump]) * half;
        [velocity + kick, spin(clumps, clump, momentum)]
    }

    /// What stands for all where impacts are foreseen.
    pub(crate) fn strikers(&self) -> &[Striker] {
        &self.strikers
    }

    /// L of the acceleration L Lᵀ that unit loads give to a clump, linear and angular ones larger by these factors.
    pub(crate) fn root(&self, clumps: &Clumps, clump: usize, [linear, angular]: [f64; 2]) -> Matrix6<f64> {
        let mut root = Matrix6::zeros();
        let axes = axes(Quaternion::from_row(clumps.orientation[clump]));
        for axis in 0..3 {
            root[(axis, axis)] = (linear / clumps.velocity[clump][3]).sqrt();
            let along = axes[axis] * (angular / clumps.moments[clump][axis]).sqrt();
            for (row, part) in along.to_array().into_iter().enumerate() {
                root[(3 + row, 3 + axis)] = part;
            }
        }
        root
    }

    /// How many pieces of work there are.
    fn pieces(&self) -> usize {
        self.count().div_ceil(PIECE)
    }

    /// The clumps of a piece.
    #[inline(always)]
    fn piece(&self, piece: usize) -> std::ops::Range<usize> {
        piece * PIECE..((piece + 1) * PIECE).min(self.count())
    }

    /// Puts the spheres of a clump where they belong, and gives them its motion.
    #[inline(always)]
    fn put(&self, clump: usize, rows: Rows, spheres: SphereRows, slots: &[u32]) {
        // SAFETY: each clump is worked on by one thread.
        let (position, velocity, turn, spin) = unsafe {
            let turn = Quaternion::from_row(*rows.orientation.at(clump));
            (*rows.position.at(clump), *rows.velocity.at(clump), turn, *rows.spin.at(clump))
        };
        let ([ex, ey, ez], spin) = (axes(turn), Vector::of_row(spin));
        let (centre, velocity) = (Vector::of_row(position), Vector::of_row(velocity));
        let (first, arms) = self.spheres(clump);
        let turned =
            (spheres.orientation.length() > 0).then(|| turn * Quaternion::from_row(self.begun[clump]).conjugate());
        for (sphere, arm) in arms.iter().enumerate() {
            let slot = slots[first + sphere] as usize;
            let arm = ex * arm[0] + ey * arm[1] + ez * arm[2];
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

    /// Gives the spheres of a clump its motion where they are.
    #[inline(always)]
    fn give_motion(&self, clump: usize, rows: Rows, spheres: SphereRows, slots: &[u32]) {
        // SAFETY: each clump is worked on by one thread.
        let (position, velocity, spin) =
            unsafe { (*rows.position.at(clump), *rows.velocity.at(clump), *rows.spin.at(clump)) };
        let (centre, velocity, spin) = (Vector::of_row(position), Vector::of_row(velocity), Vector::of_row(spin));
        let (first, arms) = self.spheres(clump);
        for sphere in 0..arms.len() {
            let slot = slots[first + sphere] as usize;
            // SAFETY: each sphere belongs to one clump.
            let (place, moving, turning) =
                unsafe { (spheres.position.at(slot), spheres.velocity.at(slot), spheres.spin.at(slot)) };
            let arm = Vector::of_row(*place) - centre;
            *moving = (velocity + spin.cross(arm)).row_with(moving[3]);
            *turning = spin.row_with(turning[3]);
        }
    }
}

/// The angular velocity that an angular momentum gives to a clump \[rad/s\].
fn spin(clumps: &Clumps, clump: usize, momentum: Vector) -> Vector {
    turning(Quaternion::from_row(clumps.orientation[clump]), Vector::from(clumps.moments[clump]), momentum)
}

/// Finds the angular velocity of a clump from its angular momentum.
pub(crate) fn set_spin(clumps: &mut Clumps, clump: usize) {
    let momentum = Vector::from(clumps.angular_momentum[clump]);
    clumps.angular_velocity[clump] = spin(clumps, clump, momentum).row_with(0.0);
}

/// What half a kick of a step of this length \[s\] with the present load gives to the motion of a clump \[m/s, rad/s\].
pub(crate) fn last_kick(clumps: &Clumps, clump: usize, step: f64) -> [Vector; 2] {
    let half = 0.5 * step;
    let kick = Vector::from(clumps.force[clump]) * (half / clumps.velocity[clump][3]);
    [kick, spin(clumps, clump, Vector::from(clumps.moment[clump]) * half)]
}

/// Where a turn takes the axes.
#[inline(always)]
fn axes(turn: Quaternion) -> [Vector; 3] {
    let (w, Vector { x, y, z }) = (turn.scalar, turn.vector);
    [
        Vector::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
        Vector::new(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
        Vector::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
    ]
}

/// The larger of two numbers, or the second if it is NaN.
fn larger(most: f64, one: f64) -> f64 {
    if one > most || one.is_nan() { one } else { most }
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

impl Rows {
    /// Those of these clumps.
    fn of(clumps: &mut Clumps) -> Self {
        Self {
            position: Shared::new(&mut clumps.position),
            velocity: Shared::new(&mut clumps.velocity),
            inertia: Shared::new(&mut clumps.moments),
            orientation: Shared::new(&mut clumps.orientation),
            momentum: Shared::new(&mut clumps.angular_momentum),
            spin: Shared::new(&mut clumps.angular_velocity),
            force: Shared::new(&mut clumps.force),
            moment: Shared::new(&mut clumps.moment),
        }
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

/// Hands out the clumps of a piece in blocks of as many as there are lanes, and what is left one by one.
macro_rules! blocks {
    ($range:expr, $lanes:ident, $block:ident) => {{
        let range: std::ops::Range<usize> = $range;
        let mut clump = range.start;
        while clump + $lanes::WIDTH <= range.end {
            $block!($lanes, clump);
            clump += $lanes::WIDTH;
        }
        while clump < range.end {
            $block!(f64, clump);
            clump += 1;
        }
    }};
}

/// Half a kick and the drift of one piece.
struct Drift<'a, 'b> {
    /// What never changes.
    bodies: &'a ClumpBodies,
    /// The clumps.
    rows: Rows,
    /// The particles.
    spheres: SphereRows,
    /// Slots of the particles.
    slots: &'a [u32],
    /// Which piece.
    piece: usize,
    /// The time step \[s\].
    step: f64,
    /// Largest speed \[m/s\].
    fastest: &'b mut f64,
}

impl Kernel for Drift<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { bodies, rows, spheres, slots, piece, step, fastest } = self;
        macro_rules! block {
            ($lanes:ident, $clump:expr) => {
                // SAFETY: the clumps of a block are there, and this thread alone works on them.
                let speeds = unsafe { drift::<$lanes>(rows, $clump, step) };
                *fastest = speeds.into_iter().take($lanes::WIDTH).fold(*fastest, larger);
                for lane in 0..$lanes::WIDTH {
                    bodies.put($clump + lane, rows, spheres, slots);
                }
            };
        }
        blocks!(bodies.piece(piece), N, block);
    }
}

// Functions, not closures: what is not inlined into a kernel is compiled without its registers.

/// A block of rows.
///
/// # Safety
/// As for [`drift`].
#[inline(always)]
unsafe fn load<N: Lane>(rows: Shared<Row>, first: usize) -> [N; 4] {
    // SAFETY: the caller's promise.
    unsafe { N::load_block(rows.pointer().add(first)) }
}

/// Puts a block of rows in their place.
///
/// # Safety
/// As for [`drift`].
#[inline(always)]
unsafe fn store<N: Lane>(values: [N; 4], rows: Shared<Row>, first: usize) {
    // SAFETY: the caller's promise.
    unsafe { N::store_block(values, rows.pointer().add(first)) };
}

/// The angular velocity that an angular momentum gives to a body so turned, with these moments of inertia.
#[inline(always)]
fn turning<N: Number>(turn: Quaternion<N>, inertia: Vector<N>, momentum: Vector<N>) -> Vector<N> {
    let inside = turn.conjugate().turn(momentum);
    turn.turn(Vector::new(inside.x / inertia.x, inside.y / inertia.y, inside.z / inertia.z))
}

/// Kicks and drifts a block of clumps. Returns their largest speeds \[m/s\].
///
/// # Safety
/// As many clumps as there are lanes stand from `first` on, and no other thread reads or writes their rows meanwhile.
#[inline(always)]
unsafe fn drift<N: Lane>(rows: Rows, first: usize, step: f64) -> [f64; 8] {
    // SAFETY: the caller's promise.
    let (position, velocity, orientation, momentum, force, moment, inertia) = unsafe {
        (
            load(rows.position, first),
            load(rows.velocity, first),
            load(rows.orientation, first),
            load(rows.momentum, first),
            load(rows.force, first),
            load(rows.moment, first),
            load(rows.inertia, first),
        )
    };
    let (half, step) = (N::splat(0.5 * step), N::splat(step));
    let moving = vector(velocity) + vector(force) * (half / velocity[3]);
    let momentum = vector(momentum) + vector(moment) * half;
    let place = vector(position) + moving * step;
    let before = Quaternion::from_row(orientation);
    let inertia = vector(inertia);
    let inside = before.conjugate().turn(momentum);
    let begun = Vector::new(inside.x / inertia.x, inside.y / inertia.y, inside.z / inertia.z);
    let mean = mean_spin(begun, inertia, half);
    let (above, below) = tangent(mean, half);
    let turn = before * Quaternion { scalar: below, vector: mean * (half * above) };
    let turn = turn.normalised();
    let spin = turning(turn, inertia, momentum);
    let mut speeds = [0.0; 8];
    // SAFETY: the caller's promise.
    unsafe {
        store(place.row_with(position[3]), rows.position, first);
        store(moving.row_with(velocity[3]), rows.velocity, first);
        store(turn.to_row(), rows.orientation, first);
        store(momentum.row_with(N::zero()), rows.momentum, first);
        store(spin.row_with(N::zero()), rows.spin, first);
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

/// The second half of the kick of one piece.
struct Kick<'a, 'b> {
    /// What never changes.
    bodies: &'a ClumpBodies,
    /// The clumps.
    rows: Rows,
    /// The particles.
    spheres: SphereRows,
    /// Slots of the particles.
    slots: &'a [u32],
    /// Which piece.
    piece: usize,
    /// The time step \[s\].
    step: f64,
    /// Largest speed at the middle of the next step \[m/s\].
    fastest: &'b mut f64,
}

impl Kernel for Kick<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { bodies, rows, spheres, slots, piece, step, fastest } = self;
        macro_rules! block {
            ($lanes:ident, $clump:expr) => {
                // SAFETY: the clumps of a block are there, and this thread alone works on them.
                let speeds = unsafe { kick::<$lanes>(rows, $clump, step) };
                *fastest = speeds.into_iter().take($lanes::WIDTH).fold(*fastest, larger);
                for lane in 0..$lanes::WIDTH {
                    bodies.give_motion($clump + lane, rows, spheres, slots);
                }
            };
        }
        blocks!(bodies.piece(piece), N, block);
    }
}

/// Kicks a block of clumps. Returns their largest speeds at the middle of the next step \[m/s\].
///
/// # Safety
/// As for [`drift`].
#[inline(always)]
unsafe fn kick<N: Lane>(rows: Rows, first: usize, step: f64) -> [f64; 8] {
    // SAFETY: the caller's promise.
    let (position, velocity, orientation, momentum, force, moment, inertia) = unsafe {
        (
            load(rows.position, first),
            load(rows.velocity, first),
            load(rows.orientation, first),
            load(rows.momentum, first),
            load(rows.force, first),
            load(rows.moment, first),
            load(rows.inertia, first),
        )
    };
    let half = N::splat(0.5 * step);
    let (kick, twist) = (vector(force) * (half / velocity[3]), vector(moment) * half);
    let (moving, momentum) = (vector(velocity) + kick, vector(momentum) + twist);
    let (turn, inertia) = (Quaternion::from_row(orientation), vector(inertia));
    let (now, next) = (turning(turn, inertia, momentum), turning(turn, inertia, momentum + twist));
    let mut speeds = [0.0; 8];
    // SAFETY: the caller's promise.
    unsafe {
        store(moving.row_with(velocity[3]), rows.velocity, first);
        store(momentum.row_with(N::zero()), rows.momentum, first);
        store(now.row_with(N::zero()), rows.spin, first);
        N::store((moving + kick).length() + next.length() * position[3], speeds.as_mut_ptr());
    }
    speeds
}
