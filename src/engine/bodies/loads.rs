//! What acts on bodies: the loads on their spheres, weight, applied forces, springs and dashpots to the ground, and damping in its place.

use super::clumps::{self, piece, pieces};
use super::{Body, RigidBody};
use crate::base::lanes::Shared;
use crate::base::number::Vector;
use crate::base::threads::Context;
use crate::engine::fluid::{Medium, Stream};
use crate::engine::integration::{Fields, Load, brakes};
use crate::engine::state::{CellState, Clumps, Particles, State};
use crate::scene::Scene;

/// Where one of the scene's particles, which stands there \[m\], has come to without being brought back into a periodic cell.
#[inline(always)]
pub(crate) fn came_to(cell: Option<&CellState>, member: u32, place: Vector) -> Vector {
    cell.map_or(place, |cell| place + cell.displacement(member).into())
}

/// Force and moment about a point of the loads on some particles, which came there in a cell without being brought back into it.
#[inline(always)]
pub(crate) fn on_members(members: &[u32], point: Vector, particles: &Particles, cell: Option<&CellState>) -> Load {
    let (mut force, mut moment) = (Vector::zero(), Vector::zero());
    for &member in members {
        let slot = particles.slot[member as usize] as usize;
        let arm = came_to(cell, member, Vector::from(particles.position[slot])) - point;
        let load = Vector::from(particles.force[slot]);
        force += load;
        moment += arm.cross(load) + Vector::from(particles.torque[slot]);
    }
    [force, moment]
}

impl Body<'_> {
    /// Force and moment of the loads on its spheres.
    #[inline(always)]
    pub(super) fn on_spheres(&self, particles: &Particles) -> Load {
        on_members(self.members, self.point, particles, self.cell)
    }

    /// Its weight, and the forces that are applied to it and to its spheres.
    pub(super) fn own_loads(&self, fields: &Fields, particles: &Particles) -> [Load; 2] {
        let weight = Vector::from(fields.weight(self.boundary.map_or(self.rigid.mass, |(body, _)| body.mass)));
        let mut applied = self.boundary.map_or([Vector::zero(); 2], |(_, moved)| halves(moved.inertial.applied));
        for &member in self.members.iter().filter(|_| fields.applies()) {
            let slot = particles.slot[member as usize] as usize;
            let arm = came_to(self.cell, member, Vector::from(particles.position[slot])) - self.point;
            let force = Vector::from(fields.applied(member));
            applied[0] += force;
            applied[1] += arm.cross(force);
        }
        [[weight, self.mass_centre.cross(weight)], applied]
    }

    /// The whole load, and the damping in it, where passes and the ground load it so. The motion is that of all its axes.
    fn whole(&self, fields: &Fields, particles: &Particles, (load, motion): (Load, [Vector; 2])) -> [Load; 2] {
        let ([weight, applied], damped) = (self.own_loads(fields, particles), fields.of_body(self.members));
        let part = |is: bool, load: Load| if is { load } else { [Vector::zero(); 2] };
        let fractions = [damped.linear, damped.angular];
        let before: Load = [0, 1].map(|k| load[k] + part(damped.gravity, weight)[k] + part(damped.applied, applied)[k]);
        let braking: Load = [0, 1].map(|k| {
            let braking = Vector::from(brakes(fractions[k], before[k], motion[k].to_array()));
            let Some((body, _)) = self.boundary else { return braking };
            if k == 0 { body.along_free(braking.to_array()) } else { body.about_free(braking.to_array()) }
        });
        let whole = [0, 1]
            .map(|k| before[k] + braking[k] + part(!damped.gravity, weight)[k] + part(!damped.applied, applied)[k]);
        [whole, braking]
    }
}

/// Puts the whole load on each body. Returns the sum of the damping forces \[N\].
pub(crate) fn load(
    (fields, medium): (&Fields, Option<&Medium>),
    bodies: &[Option<RigidBody>],
    state: &mut State,
    context: &Context,
) -> [f64; 3] {
    let none = state.clumps.is_empty();
    let on_clumps = if none { Vector::zero() } else { load_clumps((fields, medium), state, context) };
    (on_clumps + load_boundaries(fields, bodies, state)).to_array()
}

/// The same of boundaries, whose loads of particles have been summed. Returns the sum of the damping forces.
fn load_boundaries(fields: &Fields, bodies: &[Option<RigidBody>], state: &mut State) -> Vector {
    let mut sum = Vector::zero();
    let State { boundaries, particles, cell, .. } = state;
    for (number, body) in bodies.iter().enumerate() {
        let Some(body) = body.as_ref().filter(|body| body.is_free()) else { continue };
        let moved = &mut boundaries[number];
        body.support(moved);
        let held = halves(moved.inertial.support);
        let load = [Vector::from(moved.force) + held[0], Vector::from(moved.moment) + held[1]];
        let motion = [moved.velocity.into(), moved.angular_velocity.into()];
        let [whole, braking] = body.of_boundary(number, moved, cell.as_ref()).whole(fields, particles, (load, motion));
        sum += braking[0];
        let inertial = &mut moved.inertial;
        [inertial.load, inertial.couple] = whole.map(Vector::to_array);
        [inertial.braking_force, inertial.braking_moment] = braking.map(Vector::to_array);
    }
    sum
}

/// The same of clumps, with the loads of their spheres as passes left them.
fn load_clumps((fields, medium): (&Fields, Option<&Medium>), state: &mut State, context: &Context) -> Vector {
    let State { particles, clumps, fluid, .. } = state;
    let mut lifts = fluid.as_mut().map_or_else(Vec::new, |fluid| std::mem::take(&mut fluid.lift));
    let lift = (!lifts.is_empty()).then(|| Shared::new(&mut lifts).from(particles.len()));
    let stream = medium.zip(fluid.as_ref()).map(|(medium, fluid)| Stream::of(medium, fluid));
    let count = clumps.len();
    let damps = fields.damps();
    clumps.braking.resize(if damps { count } else { 0 }, [[0.0; 4]; 2]);
    // What is written is lent out of the clumps meanwhile.
    let [mut forces, mut moments] = [&mut clumps.force, &mut clumps.moment].map(std::mem::take);
    let mut brakings = std::mem::take(&mut clumps.braking);
    let (force, moment) = (Shared::new(&mut forces), Shared::new(&mut moments));
    let (braking, clumps_now) = (Shared::new(&mut brakings), &*clumps);
    let of_piece = |number: usize| {
        let mut sum = Vector::zero();
        for clump in piece(number, count) {
            let body = clumps::unloaded(clumps_now, clump);
            let mut load = body.on_spheres(particles);
            let mut dashpots = [0.0; 2];
            if fields.act_beside_weight() {
                let motion = [body.rigid.velocity, Vector::from(clumps_now.angular_velocity[clump])];
                let flows = stream.and_then(|stream| {
                    let own = body.own_loads(fields, particles);
                    let other = [0, 1].map(|part| own.iter().fold(load[part], |sum, own| sum + own[part]));
                    let sphere = (clumps_now.position[clump].into(), stream.diameter(clumps_now, clump));
                    stream.on_clump(sphere, (&body.rigid, motion[1]), other, 0.5 * context.step)
                });
                if let Some((flow, lifted)) = flows {
                    load = [load[0] + flow.force, load[1] + flow.torque];
                    dashpots = [flow.drag, flow.turning];
                    // SAFETY: each clump is worked on by one thread, and has a row behind those of particles.
                    lift.iter().for_each(|rows| unsafe { *rows.at(clump) = lifted.row_with(0.0) });
                }
                let [whole, brake] = body.whole(fields, particles, (load, motion));
                (load, sum) = (whole, sum + brake[0]);
                if damps {
                    // SAFETY: each clump is worked on by one thread.
                    unsafe { *braking.at(clump) = brake.map(|part| part.row_with(0.0)) };
                }
            } else {
                load[0] += Vector::from(fields.weight(body.rigid.mass));
            }
            // SAFETY: as above.
            unsafe {
                *force.at(clump) = load[0].row_with(dashpots[0]);
                *moment.at(clump) = load[1].row_with(dashpots[1]);
            }
        }
        sum
    };
    let sum = context.fold(pieces(count), of_piece, Vector::zero(), |sum, part| sum + part);
    (clumps.force, clumps.moment, clumps.braking) = (forces, moments, brakings);
    fluid.iter_mut().for_each(|fluid| fluid.lift = std::mem::take(&mut lifts));
    sum
}

/// Force and moment of a load.
fn halves([x, y, z, a, b, c]: [f64; 6]) -> Load {
    [Vector::new(x, y, z), Vector::new(a, b, c)]
}

/// Force of contacts and bonds on a sphere of a clump, and force on any other particle \[N\]: among the rows of particles stands the weight
/// of the mass that laws see, which is that of the clump.
pub(crate) fn force_on(scene: &Scene, particles: &Particles, slot: usize) -> [f64; 3] {
    let [x, y, z, _] = particles.force[slot];
    if particles.group(slot).is_none_or(|group| group < scene.boundaries.len()) {
        return [x, y, z];
    }
    let mass = particles.velocity[slot][3];
    let weight = scene.gravity.map(|part| mass * part);
    [x - weight[0], y - weight[1], z - weight[2]]
}

/// Mass of a particle \[kg\]: of a sphere of a clump its share of the clump's.
pub(crate) fn mass_of(scene: &Scene, (particles, clumps): (&Particles, &Clumps), slot: usize) -> f64 {
    let mass = particles.velocity[slot][3];
    let Some(clump) = particles.group(slot).and_then(|group| group.checked_sub(scene.boundaries.len())) else {
        return mass;
    };
    if let Some(sphere) = scene.particles.get(particles.id[slot] as usize) {
        return sphere.mass();
    }
    let cube = |slot: usize| particles.position[slot][3].powi(3);
    let all = clumps.spheres_of(clump).iter().map(|&sphere| cube(particles.slot[sphere as usize] as usize));
    mass * (cube(slot) / all.sum::<f64>())
}
