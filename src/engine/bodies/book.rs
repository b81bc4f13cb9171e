//! Work on bodies in a half kick: for the books of energy.

use super::{Body, RigidBody, each};
use crate::base::number::Vector;
use crate::engine::integration::{Fields, Load};
use crate::engine::state::ledger::Source;
use crate::engine::state::{Loss, Particles, State};

/// Force \[N\] and moment \[N m\] on the spheres of each body when those of each kind that passes make have been added; empty where
/// the scene has no such kind.
type OnBodies = [Vec<[f64; 6]>; Source::PASSES];

/// Notes the loads on the spheres of bodies so far, of which the last are of this kind.
pub(crate) fn note(state: &mut State, bodies: &[Option<RigidBody>], source: Source) {
    let Some(mut ledger) = state.ledger.take() else { return };
    let noted = &mut ledger.on_bodies[source as usize];
    noted.clear();
    noted.resize(state.owners(), [0.0; 6]);
    for body in each(bodies, state) {
        let [force, moment] = body.on_spheres(&state.particles);
        noted[body.number] = [force.x, force.y, force.z, moment.x, moment.y, moment.z];
    }
    state.ledger = Some(ledger);
}

/// Books what forces do to bodies in the half kick of a step of this length \[s\] that is about to be made.
pub(crate) fn book_work(state: &mut State, fields: &Fields, bodies: &[Option<RigidBody>], step: f64) {
    let Some(mut ledger) = state.ledger.take() else { return };
    for body in each(bodies, state) {
        let works = work(&body, &state.particles, &ledger.on_bodies, fields, step);
        for (sum, work) in ledger.work.iter_mut().zip(works) {
            *sum += work;
            ledger.turnover += work.abs();
        }
    }
    state.ledger = Some(ledger);
}

/// Books what the outside and global damping do to bodies in the half kick that is about to be made.
pub(crate) fn book_losses(state: &mut State, fields: &Fields, bodies: &[Option<RigidBody>], step: f64) {
    let Some(mut losses) = state.losses.take() else { return };
    for body in each(bodies, state) {
        let nothing = [const { Vec::new() }; Source::PASSES];
        let work = work(&body, &state.particles, &nothing, fields, step);
        let of = |source: Source| work[source as usize];
        // The potential of clumps is known: they rest on nothing but what passes do.
        if body.boundary.is_some() {
            let given = [Source::Gravity, Source::Applied, Source::Support];
            losses.given_to_bodies += given.into_iter().map(of).sum::<f64>();
        }
        losses.add(Loss::GlobalDamping, -of(Source::Damping));
    }
    state.losses = Some(losses);
}

/// Mean of the motion of a body before and after half a kick with the present load, and the work of what dashpots to the ground do in
/// following it \[J\].
fn mean_motion(body: &Body, step: f64) -> ([Vector; 2], f64) {
    let mean = |after: [Vector; 2]| {
        let before = [body.rigid.velocity, body.rigid.spin()];
        [0, 1].map(|part| (before[part] + after[part]) * 0.5)
    };
    let Some((rigid_body, moved)) = body.boundary else {
        let after = body.kicked(step);
        return (mean([after.velocity, after.spin()]), 0.0);
    };
    let kick = rigid_body.kicked(moved, step);
    let [drift, turn] = mean([kick.after.velocity, kick.after.spin()]);
    ([drift, turn], drift.dot(kick.following[0]) + turn.dot(kick.following[1]))
}

/// Work of each kind of force on the free axes of a body in the half kick that is about to be made \[J\].
fn work(body: &Body, particles: &Particles, on_bodies: &OnBodies, fields: &Fields, step: f64) -> [f64; Source::COUNT] {
    let ([drift, turn], following) = mean_motion(body, step);
    let power = |[force, moment]: Load| 0.5 * step * (force.dot(drift) + moment.dot(turn));
    let of_six = |[x, y, z, a, b, c]: [f64; 6]| power([Vector::new(x, y, z), Vector::new(a, b, c)]);
    let mut sum = [0.0; Source::COUNT];
    let mut before = 0.0;
    for (sum, loads) in sum.iter_mut().zip(on_bodies) {
        let Some(&load) = loads.get(body.number) else { continue };
        let so_far = of_six(load);
        *sum = so_far - before;
        before = so_far;
    }
    if let Some((_, moved)) = body.boundary {
        if body.members.is_empty() && on_bodies.iter().any(|loads| !loads.is_empty()) {
            // What touches a surface has not been booked particle by particle: bonds to it stand here, too.
            sum[Source::Walls as usize] = power([moved.force.into(), moved.moment.into()]);
        }
        sum[Source::Support as usize] = of_six(moved.inertial.support) + following;
    }
    let [weight, applied] = body.own_loads(fields, particles);
    sum[Source::Damping as usize] = power(body.braking);
    sum[Source::Gravity as usize] = power(weight);
    sum[Source::Applied as usize] = power(applied);
    sum
}
