//! How clumps move: half kicks and the drift, as many clumps at once as a register has numbers, and the motion of their spheres.
//!
//! Functions, not closures: what is not inlined into a kernel is compiled without its registers.

use super::{ClumpBodies, piece, pieces};
use crate::base::geometry::Quaternion;
use crate::base::lanes::{self, Kernel, Lane, Shared, vector};
use crate::base::number::{Vector, larger};
use crate::base::threads::Context;
use crate::engine::bodies::Rigid;
use crate::engine::bodies::rigid::axes;
use crate::engine::state::{Clumps, Particles, Row, State};

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

/// Mass centres and reaches of some clumps, lane by lane, and how they move.
///
/// # Safety
/// As many clumps as there are lanes stand from `first` on, and no other thread writes their rows meanwhile.
#[inline(always)]
unsafe fn read<N: Lane>(rows: Rows, first: usize) -> ([N; 4], Rigid<N>) {
    // SAFETY: the caller's promise.
    unsafe {
        let velocity = rows.velocity.load_block(first);
        let (force, moment) = (rows.force.load_block(first), rows.moment.load_block(first));
        let rigid = Rigid {
            velocity: vector(velocity),
            mass: velocity[3],
            turn: Quaternion::from_row(rows.orientation.load_block(first)),
            inertia: vector(rows.inertia.load_block(first)),
            momentum: vector(rows.momentum.load_block(first)),
            force: vector(force),
            moment: vector(moment),
            dashpots: [force[3], moment[3]],
        };
        (rows.position.load_block(first), rigid)
    }
}

/// Kicks and drifts a block of clumps. Returns their largest speeds \[m/s\].
///
/// # Safety
/// As for [`read`]; no other thread reads the rows meanwhile either.
#[inline(always)]
unsafe fn drift<N: Lane>(rows: Rows, first: usize, step: f64) -> [f64; 8] {
    // SAFETY: the caller's promise.
    let (position, rigid) = unsafe { read::<N>(rows, first) };
    let half = N::splat(0.5 * step);
    let kicked = rigid.kicked(half);
    let mean = kicked.mean_spin(half);
    let turned = kicked.turned(mean, half);
    let place = vector(position) + kicked.velocity * N::splat(step);
    let mut speeds = [0.0; 8];
    // SAFETY: the caller's promise.
    unsafe {
        rows.position.store_block(place.row_with(position[3]), first);
        rows.velocity.store_block(kicked.velocity.row_with(rigid.mass), first);
        rows.orientation.store_block(turned.turn.to_row(), first);
        rows.momentum.store_block(kicked.momentum.row_with(N::zero()), first);
        rows.spin.store_block(turned.spin().row_with(N::zero()), first);
        N::store(kicked.velocity.length() + mean.length() * position[3], speeds.as_mut_ptr());
    }
    speeds
}

/// Kicks a block of clumps. Returns their largest speeds at the middle of the next step \[m/s\].
///
/// # Safety
/// As for [`drift`].
#[inline(always)]
unsafe fn kick<N: Lane>(rows: Rows, first: usize, step: f64) -> [f64; 8] {
    // SAFETY: the caller's promise.
    let (position, rigid) = unsafe { read::<N>(rows, first) };
    let half = N::splat(0.5 * step);
    let kicked = rigid.kicked(half);
    let mut speeds = [0.0; 8];
    // SAFETY: the caller's promise.
    unsafe {
        rows.velocity.store_block(kicked.velocity.row_with(rigid.mass), first);
        rows.momentum.store_block(kicked.momentum.row_with(N::zero()), first);
        rows.spin.store_block(kicked.spin().row_with(N::zero()), first);
        N::store(kicked.kicked(half).fastest(position[3]), speeds.as_mut_ptr());
    }
    speeds
}
