//! Work on bodies that forces move, in a half kick.

use crate::base::number::Vector;
use crate::engine::boundaries::RigidBody;
use crate::engine::boundaries::rigid_body::came_to;
use crate::engine::integration::Fields;
use crate::engine::state::ledger::Source;
use crate::engine::state::{BoundaryState, Particles, State};

/// Force \[N\] and moment \[N m\] on the spheres of each body when those of each kind that passes make have been added; empty where
/// the scene has no such kind.
pub(super) type OnBodies = [Vec<[f64; 6]>; Source::PASSES];

/// Notes the loads on the spheres of bodies so far, of which the last are of this kind.
pub(crate) fn note(state: &mut State, bodies: &[Option<RigidBody>], source: Source) {
    let State { particles, boundaries, cell, ledger: Some(ledger), .. } = state else { return };
    let of_body = |(body, moved): (&Option<RigidBody>, &BoundaryState)| {
        let (mut force, mut moment) = (Vector::zero(), Vector::zero());
        for &member in body.iter().filter(|body| body.is_free()).flat_map(|body| &body.members) {
            let slot = particles.slot[member as usize] as usize;
            let arm = came_to(cell.as_ref(), member, Vector::from(particles.position[slot])) - moved.pivot.into();
            let load = Vector::from(particles.force[slot]);
            force += load;
            moment += arm.cross(load) + particles.torque[slot].into();
        }
        [force.x, force.y, force.z, moment.x, moment.y, moment.z]
    };
    let on_bodies = &mut ledger.on_bodies[source as usize];
    on_bodies.clear();
    on_bodies.extend(bodies.iter().zip(&*boundaries).map(of_body));
}

/// Work of each kind of force on the free axes of a body, by its number, in the half kick that is about to be made \[J\].
pub(super) fn work(
    (number, body): (usize, &RigidBody),
    moved: &BoundaryState,
    particles: &Particles,
    on_bodies: &OnBodies,
    fields: &Fields,
    step: f64,
) -> [f64; Source::COUNT] {
    let ([drift, turn], following) = body.mean_motion(moved, step);
    let power = |force: Vector, moment: Vector| 0.5 * step * (force.dot(drift) + moment.dot(turn));
    let of_six = |[x, y, z, a, b, c]: [f64; 6]| power(Vector::new(x, y, z), Vector::new(a, b, c));
    let mut sum = [0.0; Source::COUNT];
    let mut before = 0.0;
    for (sum, loads) in sum.iter_mut().zip(on_bodies) {
        let Some(&load) = loads.get(number) else { continue };
        let so_far = of_six(load);
        *sum = so_far - before;
        before = so_far;
    }
    if body.members.is_empty() && on_bodies.iter().any(|loads| !loads.is_empty()) {
        // What touches a surface has not been booked particle by particle: bonds to it stand here, too.
        sum[Source::Walls as usize] = power(moved.force.into(), moved.moment.into());
    }
    let [weight, applied] = fields.on_body(body, moved, particles);
    sum[Source::Support as usize] = of_six(moved.inertial.support) + following;
    sum[Source::Damping as usize] = power(moved.inertial.braking_force.into(), moved.inertial.braking_moment.into());
    sum[Source::Gravity as usize] = power(weight[0], weight[1]);
    sum[Source::Applied as usize] = power(applied[0], applied[1]);
    sum
}
