//! The momentum balance of the particles and bodies that move freely.

use crate::engine::simulation::Simulation;
use crate::engine::state::boundaries::Inertial;
use crate::engine::state::exchange::NetExchange;
use crate::engine::state::{IMAGE, State};
use crate::scene::Scene;
use serde::Serialize;

/// Momentum and the impulses that make it, at one time.
#[derive(Clone, Copy, Debug)]
struct Account {
    /// Momentum of the free particles and clumps, and of groups along their free axes \[kg m/s\].
    momentum: [f64; 3],
    /// Impulse on them since time 0 of the boundaries, along axes that are not free \[N s\].
    boundaries: [f64; 3],
    /// Impulse of global damping since time 0 \[N s\].
    damping: [f64; 3],
    /// Impulses since time 0 of inputs, and of springs and dashpots to the ground \[N s\].
    of_bodies: [[f64; 3]; 2],
    /// Impulse of the fluid since counting began \[N s\].
    fluid: [f64; 3],
    /// What came less what went.
    net: NetExchange,
    /// Time \[s\].
    time: f64,
}

/// Change of momentum and the impulses that should make it \[N s\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MomentumBalance {
    /// Change of momentum of the particles, clumps and groups that move freely \[N s\].
    pub change: [f64; 3],
    /// Impulse of gravity \[N s\].
    pub gravity: [f64; 3],
    /// Impulse of applied forces \[N s\].
    pub applied: [f64; 3],
    /// Impulse of the boundaries on the particles \[N s\].
    pub boundaries: [f64; 3],
    /// Impulse of global damping \[N s\].
    pub damping: [f64; 3],
    /// Impulse of springs and dashpots from bodies to the ground \[N s\].
    pub support: [f64; 3],
    /// Impulse of drag and pressure of the fluid, where there is one \[N s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fluid: Option<[f64; 3]>,
    /// Momentum that came with particles less what went with others, where the number of particles changes \[N s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exchanged: Option<[f64; 3]>,
    /// What the impulses leave of the change, over the largest of all these numbers.
    pub relative_residual: f64,
}

impl MomentumBalance {
    /// Whether every number is finite.
    pub(super) fn is_finite(&self) -> bool {
        let Self { change, gravity, applied, boundaries, damping, support, fluid, exchanged, relative_residual } = self;
        let impulses = [change, gravity, applied, boundaries, damping, support];
        impulses
            .into_iter()
            .chain(fluid)
            .chain(exchanged)
            .flatten()
            .chain([relative_residual])
            .all(|number| number.is_finite())
    }
}

/// The account at the start of a session, to compare with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start(Account);

impl Start {
    /// The account at the present time.
    pub(crate) fn of(simulation: &Simulation) -> Self {
        Self(account(simulation.scene(), simulation.state()))
    }

    /// The balance from then to the present time.
    pub(crate) fn balance(&self, simulation: &Simulation) -> MomentumBalance {
        let (start, end) = (self.0, account(simulation.scene(), simulation.state()));
        let less = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let (weight, applied) = constant_forces(simulation.scene(), simulation.state());
        let duration = end.time - start.time;
        // What was there for a part of the time only: its mass, or the force on it, times that part.
        let part = |now: f64, then: f64, times: [f64; 2]| (now - then) * start.time - (times[1] - times[0]);
        let [begun, ended] = [&start.net, &end.net];
        let mass_time = part(ended.mass, begun.mass, [begun.mass_time, ended.mass_time]);
        let gravity = simulation.scene().gravity;
        let change = less(end.momentum, start.momentum);
        let exchanged = less(ended.momentum, begun.momentum);
        let [inputs, support] = [0, 1].map(|term| less(end.of_bodies[term], start.of_bodies[term]));
        let terms = [
            [0, 1, 2].map(|axis| weight[axis] * duration + gravity[axis] * mass_time),
            [0, 1, 2].map(|axis| {
                let times = [begun.applied_time[axis], ended.applied_time[axis]];
                let gone = part(ended.applied[axis], begun.applied[axis], times);
                applied[axis] * duration + gone + inputs[axis]
            }),
            less(end.boundaries, start.boundaries),
            less(end.damping, start.damping),
            support,
            less(end.fluid, start.fluid),
            exchanged,
        ];
        let rest = terms.iter().fold(change, |rest, &term| less(rest, term));
        let largest = |numbers: &[f64]| numbers.iter().fold(0.0, |most: f64, number| most.max(number.abs()));
        let scale = largest(terms.as_flattened()).max(largest(&change));
        let [gravity, applied, boundaries, damping, support, fluid, _] = terms;
        let relative_residual = if scale > 0.0 { largest(&rest) / scale } else { 0.0 };
        let fluid = simulation.scene().fluid.is_some().then_some(fluid);
        let exchanged = simulation.scene().changes_number().then_some(exchanged);
        MomentumBalance { change, gravity, applied, boundaries, damping, support, fluid, exchanged, relative_residual }
    }
}

/// Momentum and impulses in a state.
fn account(scene: &Scene, state: &State) -> Account {
    let mut momentum = [0.0; 3];
    let particles = &state.particles;
    for (slot, velocity) in particles.velocity.iter().enumerate().filter(|(slot, _)| state.clump(*slot).is_none()) {
        let free = free_axes(scene, particles.owner[slot]);
        // The spheres of a group that turns have further velocities, whose momenta cancel.
        let along = match particles.group(slot) {
            None => [velocity[0], velocity[1], velocity[2]],
            Some(group) => state.boundaries[group].velocity,
        };
        for axis in (0..3).filter(|&axis| free[axis]) {
            momentum[axis] += velocity[3] * along[axis];
        }
    }
    for [x, y, z, mass] in &state.clumps.velocity {
        momentum.iter_mut().zip([x, y, z]).for_each(|(sum, part)| *sum += mass * part);
    }
    let (mut boundaries, mut of_bodies) = ([0.0; 3], [[0.0; 3]; 2]);
    for (boundary, moved) in scene.boundaries.iter().zip(&state.boundaries) {
        let Inertial { applied_impulse, support_impulse, .. } = &moved.inertial;
        for axis in 0..3 {
            boundaries[axis] -= moved.total_impulse[axis];
            for (sum, part) in of_bodies.iter_mut().zip([applied_impulse, support_impulse]) {
                sum[axis] += part[axis];
            }
            if boundary.axes[axis].is_free() {
                momentum[axis] += boundary.body.mass * moved.velocity[axis];
            }
        }
    }
    if let Some(cell) = &state.cell {
        boundaries.iter_mut().zip(cell.impulse).for_each(|(sum, part)| *sum += part);
    }
    let net = state.exchange.as_ref().map_or_else(NetExchange::default, |exchange| exchange.net);
    let fluid = state.fluid.as_ref().map_or([0.0; 3], |fluid| fluid.impulse);
    Account { momentum, boundaries, damping: state.damping_impulse, of_bodies, fluid, net, time: state.clock.time }
}

/// Along which axes forces move a particle with this owner.
fn free_axes(scene: &Scene, owner: u32) -> [bool; 3] {
    match (owner as usize).checked_sub(1) {
        _ if owner == IMAGE => [false; 3],
        None => [true; 3],
        // A clump, behind the boundaries, moves freely.
        Some(group) => [0, 1, 2].map(|axis| scene.boundaries.get(group).is_none_or(|it| it.axes[axis].is_free())),
    }
}

/// Weight of what moves freely and the constant forces on it \[N\].
fn constant_forces(scene: &Scene, state: &State) -> ([f64; 3], [f64; 3]) {
    let particles = &state.particles;
    let (mut weight, mut applied) = ([0.0; 3], [0.0; 3]);
    let masses = state.clumps.velocity.iter().map(|row| row[3]);
    masses.for_each(|mass| weight.iter_mut().zip(scene.gravity).for_each(|(sum, part)| *sum += mass * part));
    for (slot, velocity) in particles.velocity.iter().enumerate().filter(|(slot, _)| state.clump(*slot).is_none()) {
        let free = free_axes(scene, particles.owner[slot]);
        for axis in (0..3).filter(|&axis| free[axis]) {
            weight[axis] += velocity[3] * scene.gravity[axis];
        }
    }
    for boundary in &scene.boundaries {
        for axis in (0..3).filter(|&axis| boundary.axes[axis].is_free()) {
            weight[axis] += boundary.body.mass * scene.gravity[axis];
        }
    }
    for force in &scene.forces {
        for &member in &force.members {
            let Some(slot) = particles.slot_of(member) else { continue };
            let free = free_axes(scene, particles.owner[slot]);
            for axis in (0..3).filter(|&axis| free[axis]) {
                applied[axis] += force.force[axis];
            }
        }
    }
    (weight, applied)
}
