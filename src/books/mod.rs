//! Kinetic energy, and the algorithmic energy book for the scenes that ask for it.

pub(crate) mod losses;

use crate::boundaries::RigidBody;
use crate::integration::Fields;
use crate::number::Vector;
use crate::state::ledger::{Loads, Source};
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
fn dot(a: &Row, b: &Row) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Remembers the loads that came since the last call as those of this kind. `seen` is what was there before.
pub(crate) fn record(state: &mut State, source: Source, seen: &mut Loads) {
    let Some(ledger) = &mut state.ledger else { return };
    let part = &mut ledger.loads[source as usize];
    difference(&state.particles.force, &mut seen.force, &mut part.force);
    difference(&state.particles.torque, &mut seen.torque, &mut part.torque);
}

/// Writes what was added to `seen` into `part`, and brings `seen` up to date.
fn difference(now: &[Row], seen: &mut Vec<Row>, part: &mut Vec<Row>) {
    seen.resize(now.len(), [0.0; 4]);
    part.clear();
    part.extend(now.iter().zip(seen.iter()).map(|(now, seen)| [0, 1, 2, 3].map(|k| now[k] - seen[k])));
    seen.copy_from_slice(now);
}

/// Takes weight and applied force out of the loads recorded for damping: what is left is damping.
pub(crate) fn settle_damping(state: &mut State, fields: &Fields) {
    let Some(ledger) = &mut state.ledger else { return };
    let particles = &state.particles;
    for (slot, row) in ledger.loads[Source::Damping as usize].force.iter_mut().enumerate() {
        let (weight, applied) = (fields.weight(particles.velocity[slot][3]), fields.applied(particles.id[slot]));
        for axis in 0..3 {
            row[axis] -= weight[axis] + applied[axis];
        }
    }
}

/// Books the half kick that is about to be made with the present loads.
pub(crate) fn book(state: &mut State, fields: &Fields, bodies: &[Option<RigidBody>], step: f64, context: &Context) {
    let Some(ledger) = &mut state.ledger else { return };
    let particles = &state.particles;
    let count = particles.len();
    let loads = &ledger.loads;
    let of_piece = |piece: usize| {
        let mut sum = [0.0; Source::COUNT];
        let slots = piece * CHUNK..((piece + 1) * CHUNK).min(count);
        for slot in slots.filter(|&slot| particles.owner[slot] == 0) {
            let drift = mean(&particles.velocity[slot], &particles.force[slot], step);
            let turn = mean(&particles.angular_velocity[slot], &particles.torque[slot], step);
            for (sum, loads) in sum.iter_mut().zip(loads) {
                if let (Some(force), Some(torque)) = (loads.force.get(slot), loads.torque.get(slot)) {
                    *sum += 0.5 * step * (dot(force, &drift) + dot(torque, &turn));
                }
            }
            let [x, y, z] = fields.weight(particles.velocity[slot][3]);
            sum[Source::Gravity as usize] += 0.5 * step * dot(&[x, y, z, 0.0], &drift);
            let [x, y, z] = fields.applied(particles.id[slot]);
            sum[Source::Applied as usize] += 0.5 * step * dot(&[x, y, z, 0.0], &drift);
        }
        sum
    };
    let groups = bodies.iter().zip(&state.boundaries).filter_map(|(body, moved)| {
        let body = body.as_ref().filter(|body| body.is_free())?;
        Some(of_body(body, moved, particles, loads, fields, step))
    });
    let add = |(mut work, mut turnover): ([f64; Source::COUNT], f64), sum: [f64; Source::COUNT]| {
        for (work, part) in work.iter_mut().zip(sum) {
            *work += part;
            turnover += part.abs();
        }
        (work, turnover)
    };
    let booked = context.fold(count.div_ceil(CHUNK), of_piece, (ledger.work, ledger.turnover), add);
    (ledger.work, ledger.turnover) = groups.fold(booked, add);
}

/// Work of each kind of force on the free axes of a body in the half kick that is about to be made \[J\].
fn of_body(
    body: &RigidBody,
    moved: &BoundaryState,
    particles: &Particles,
    loads: &[Loads],
    fields: &Fields,
    step: f64,
) -> [f64; Source::COUNT] {
    let ([drift, turn], added_work) = body.mean_motion(moved, step);
    let power = |force: Vector, moment: Vector| 0.5 * step * (force.dot(drift) + moment.dot(turn));
    let mut sum = [0.0; Source::COUNT];
    // Damping acts on the group as a whole.
    for (sum, loads) in sum.iter_mut().zip(loads).take(Source::Damping as usize) {
        for &member in &body.members {
            let slot = particles.slot[member as usize] as usize;
            if let (Some(&force), Some(&torque)) = (loads.force.get(slot), loads.torque.get(slot)) {
                let arm = Vector::from(particles.position[slot]) - moved.pivot.into();
                *sum += power(force.into(), arm.cross(force.into()) + torque.into());
            }
        }
    }
    if body.members.is_empty() && !loads.is_empty() {
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
fn mean(velocity: &Row, load: &Row, step: f64) -> Row {
    let factor = 0.5 * step / velocity[3];
    let middle = |k: usize| 0.5 * (velocity[k] + (velocity[k] + factor * load[k]));
    [middle(0), middle(1), middle(2), 0.0]
}
