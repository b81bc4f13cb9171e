//! Kinetic energy, and the algorithmic energy book for the scenes that ask for it.

pub(crate) mod losses;

use crate::boundaries::RigidBody;
use crate::integration::Fields;
use crate::lanes::{self, Kernel, Lane};
use crate::number::Vector;
use crate::state::ledger::{Ledger, Loads, Source};
use crate::state::{BoundaryState, Particles, Row, State};
use crate::threads::{CHUNK, Context};

/// Kinetic energy of the particles and groups that move by the forces on them \[J\].
pub(crate) fn kinetic(state: &State, bodies: &[Option<RigidBody>], context: &Context) -> f64 {
    let groups = bodies.iter().zip(&state.boundaries).filter_map(|(body, moved)| Some(body.as_ref()?.kinetic(moved)));
    groups.fold(of_particles(&state.particles, context), |sum, group| sum + group)
}

/// Kinetic energy of the particles that move by the forces on them \[J\].
fn of_particles(particles: &Particles, context: &Context) -> f64 {
    let count = particles.len();
    let of_piece = |piece: usize| {
        let mut sum = 0.0;
        for slot in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
            if particles.owner[slot] == 0 {
                let (v, w) = (&particles.velocity[slot], &particles.angular_velocity[slot]);
                sum += 0.5 * v[3] * dot(v, v) + 0.5 * w[3] * dot(w, w);
            }
        }
        sum
    };
    context.fold(count.div_ceil(CHUNK), of_piece, 0.0, |sum, part| sum + part)
}

/// Scalar product of the first three numbers of two rows.
#[inline(always)]
fn dot(a: &Row, b: &Row) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Remembers all loads so far, of which those that came since the last call are of this kind.
pub(crate) fn record(state: &mut State, source: Source) {
    let Some(ledger) = &mut state.ledger else { return };
    let Loads { force, torque } = &mut ledger.loads_so_far[source as usize];
    force.clone_from(&state.particles.force);
    torque.clone_from(&state.particles.torque);
}

/// The recorded kinds of force that a scene has, in the order in which their passes add them, with all loads so far.
type Recorded<'a> = [Option<&'a Loads>; Source::RECORDED];

/// Those of a book.
fn recorded(ledger: &Ledger) -> Recorded<'_> {
    ledger.loads_so_far.each_ref().map(|loads| (!loads.force.is_empty()).then_some(loads))
}

/// Books the half kick that is about to be made with the present loads, and with gravity \[m/s²\] where that is not yet among
/// them.
pub(crate) fn book(
    state: &mut State,
    (fields, gravity): (&Fields, Option<[f64; 3]>),
    bodies: &[Option<RigidBody>],
    step: f64,
    context: &Context,
) {
    let Some(ledger) = &state.ledger else { return };
    let (particles, loads) = (&state.particles, recorded(ledger));
    let of_piece = |piece: usize| {
        let mut powers = Powers::default();
        lanes::run(context.width, PiecePowers { particles, loads, fields, gravity, step, piece, powers: &mut powers });
        powers.work(&loads, fields, step)
    };
    let groups = bodies.iter().zip(&state.boundaries).filter_map(|(body, moved)| {
        let body = body.as_ref().filter(|body| body.is_free())?;
        Some(of_body(body, moved, particles, &loads, fields, step))
    });
    let add = |(mut work, mut turnover): ([f64; Source::COUNT], f64), sum: [f64; Source::COUNT]| {
        for (work, part) in work.iter_mut().zip(sum) {
            *work += part;
            turnover += part.abs();
        }
        (work, turnover)
    };
    let pieces = particles.len().div_ceil(CHUNK);
    let booked = context.fold(pieces, of_piece, (ledger.work, ledger.turnover), add);
    let booked = groups.fold(booked, add);
    if let Some(ledger) = &mut state.ledger {
        (ledger.work, ledger.turnover) = booked;
    }
}

/// Powers on some particles: sums of products with the mean velocities of a half kick, number by number of the rows.
#[derive(Default)]
struct Powers {
    /// Of all loads so far of each recorded kind \[W\].
    loads: [Row; Source::RECORDED],
    /// Momentum \[N s\].
    momentum: Row,
    /// Of applied forces \[W\].
    applied: f64,
}

impl Powers {
    /// Work of each kind of force in the half kick \[J\].
    fn work(&self, loads: &Recorded, fields: &Fields, step: f64) -> [f64; Source::COUNT] {
        let (half, whole) = (0.5 * step, |row: &Row| row[0] + row[1] + row[2]);
        let [x, y, z] = fields.weight(1.0);
        let mut work = [0.0; Source::COUNT];
        work[Source::Gravity as usize] = half * dot(&[x, y, z, 0.0], &self.momentum);
        work[Source::Applied as usize] = half * self.applied;
        let mut before = 0.0;
        for (place, power) in self.loads.iter().enumerate().filter(|(place, _)| loads[*place].is_some()) {
            let power = whole(power);
            work[place] = half * (power - before);
            before = power;
        }
        if loads[Source::Damping as usize].is_some() {
            // Weight and applied forces came with the damping.
            work[Source::Damping as usize] -= work[Source::Gravity as usize] + work[Source::Applied as usize];
        }
        work
    }
}

/// The powers on one piece of the particles.
struct PiecePowers<'a, 'b> {
    /// The particles.
    particles: &'a Particles,
    /// The loads.
    loads: Recorded<'a>,
    /// Gravity and applied forces.
    fields: &'a Fields,
    /// Gravity that is not yet among the forces \[m/s²\].
    gravity: Option<[f64; 3]>,
    /// The time step \[s\].
    step: f64,
    /// Which piece.
    piece: usize,
    /// What is found.
    powers: &'b mut Powers,
}

impl Kernel for PiecePowers<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { particles, loads, fields, gravity, step, piece, powers } = self;
        let mut found = Powers::default();
        let [x, y, z] = gravity.unwrap_or_default();
        let slots = piece * CHUNK..((piece + 1) * CHUNK).min(particles.len());
        for slot in slots {
            if particles.owner[slot] != 0 {
                continue;
            }
            let velocity = &particles.velocity[slot];
            let mut force = particles.force[slot];
            if gravity.is_some() {
                force = [0, 1, 2, 3].map(|axis| force[axis] + velocity[3] * [x, y, z, 0.0][axis]);
            }
            let drift = mean(velocity, &force, step);
            let turn = mean(&particles.angular_velocity[slot], &particles.torque[slot], step);
            for (power, loads) in found.loads.iter_mut().zip(loads) {
                let Some(loads) = loads else { continue };
                // A particle that has just come bears no load yet.
                let (Some(force), Some(torque)) = (loads.force.get(slot), loads.torque.get(slot)) else { continue };
                for axis in 0..4 {
                    power[axis] += force[axis] * drift[axis] + torque[axis] * turn[axis];
                }
            }
            for axis in 0..4 {
                found.momentum[axis] += velocity[3] * drift[axis];
            }
            if fields.applies() {
                let [x, y, z] = fields.applied(particles.id[slot]);
                found.applied += dot(&[x, y, z, 0.0], &drift);
            }
        }
        *powers = found;
    }
}

/// Work of each kind of force on the free axes of a body in the half kick that is about to be made \[J\].
fn of_body(
    body: &RigidBody,
    moved: &BoundaryState,
    particles: &Particles,
    loads: &Recorded,
    fields: &Fields,
    step: f64,
) -> [f64; Source::COUNT] {
    let ([drift, turn], added_work) = body.mean_motion(moved, step);
    let power = |force: Vector, moment: Vector| 0.5 * step * (force.dot(drift) + moment.dot(turn));
    let mut sum = [0.0; Source::COUNT];
    for &member in &body.members {
        let slot = particles.slot[member as usize] as usize;
        let arm = Vector::from(particles.position[slot]) - moved.pivot.into();
        let mut before = 0.0;
        // Damping acts on the group as a whole.
        for (sum, loads) in sum.iter_mut().zip(loads).take(Source::Damping as usize) {
            let Some(loads) = loads else { continue };
            let (Some(&force), Some(&torque)) = (loads.force.get(slot), loads.torque.get(slot)) else { continue };
            let (force, torque) = (Vector::from(force), Vector::from(torque));
            let so_far = power(force, arm.cross(force) + torque);
            *sum += so_far - before;
            before = so_far;
        }
    }
    if body.members.is_empty() && loads.iter().any(Option::is_some) {
        // What touches a surface has not been booked particle by particle: bonds to it stand here, too.
        sum[Source::Walls as usize] = power(moved.force.into(), moved.moment.into());
    }
    let [weight, applied] = fields.on_body(body, moved, particles);
    let [x, y, z, a, b, c] = moved.inertial.support;
    sum[Source::Support as usize] = power(Vector::new(x, y, z), Vector::new(a, b, c));
    sum[Source::AddedInertia as usize] = added_work;
    sum[Source::Damping as usize] = power(moved.inertial.braking_force.into(), moved.inertial.braking_moment.into());
    sum[Source::Gravity as usize] = power(weight[0], weight[1]);
    sum[Source::Applied as usize] = power(applied[0], applied[1]);
    sum
}

/// Mean of the velocity before and after half a kick.
#[inline(always)]
fn mean(velocity: &Row, load: &Row, step: f64) -> Row {
    let factor = 0.5 * step / velocity[3];
    let middle = |k: usize| 0.5 * (velocity[k] + (velocity[k] + factor * load[k]));
    [middle(0), middle(1), middle(2), 0.0]
}
