//! The momentum balance of the particles that move freely.

use crate::scene::Scene;
use crate::state::State;
use crate::step::Simulation;
use serde::Serialize;

/// Momentum and the impulses that make it, at one time.
#[derive(Clone, Copy, Debug)]
struct Account {
    /// Momentum of the free particles \[kg m/s\].
    momentum: [f64; 3],
    /// Impulse of the boundaries on them since time 0 \[N s\].
    boundaries: [f64; 3],
    /// Impulse of global damping since time 0 \[N s\].
    damping: [f64; 3],
    /// Time \[s\].
    time: f64,
}

/// Change of momentum and the impulses that should make it \[N s\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MomentumBalance {
    /// Change of momentum of the particles that move freely \[N s\].
    pub change: [f64; 3],
    /// Impulse of gravity \[N s\].
    pub gravity: [f64; 3],
    /// Impulse of applied forces \[N s\].
    pub applied: [f64; 3],
    /// Impulse of the boundaries on the particles \[N s\].
    pub boundaries: [f64; 3],
    /// Impulse of global damping \[N s\].
    pub damping: [f64; 3],
    /// What the impulses leave of the change, over the largest of all these numbers.
    pub relative_residual: f64,
}

/// The account at the start of a session, to compare with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start(Account);

impl Start {
    /// The account at the present time.
    pub(super) fn of(simulation: &Simulation) -> Self {
        Self(account(simulation.state()))
    }

    /// The balance from then to the present time.
    pub(super) fn balance(&self, simulation: &Simulation) -> MomentumBalance {
        let (start, end) = (self.0, account(simulation.state()));
        let less = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let (weight, applied) = constant_forces(simulation.scene(), simulation.state());
        let duration = end.time - start.time;
        let over_time = |force: [f64; 3]| force.map(|force| force * duration);
        let change = less(end.momentum, start.momentum);
        let terms = [
            over_time(weight),
            over_time(applied),
            less(end.boundaries, start.boundaries),
            less(end.damping, start.damping),
        ];
        let rest = terms.iter().fold(change, |rest, &term| less(rest, term));
        let largest = |numbers: &[f64]| numbers.iter().fold(0.0, |most: f64, number| most.max(number.abs()));
        let scale = largest(terms.as_flattened()).max(largest(&change));
        let [gravity, applied, boundaries, damping] = terms;
        let relative_residual = if scale > 0.0 { largest(&rest) / scale } else { 0.0 };
        MomentumBalance { change, gravity, applied, boundaries, damping, relative_residual }
    }
}

/// Momentum and impulses in a state.
fn account(state: &State) -> Account {
    let mut momentum = [0.0; 3];
    let particles = &state.particles;
    for (velocity, _) in particles.velocity.iter().zip(&particles.owner).filter(|(_, owner)| **owner == 0) {
        for axis in 0..3 {
            momentum[axis] += velocity[3] * velocity[axis];
        }
    }
    let mut boundaries = [0.0; 3];
    for boundary in &state.boundaries {
        for axis in 0..3 {
            boundaries[axis] -= boundary.total_impulse[axis];
        }
    }
    Account { momentum, boundaries, damping: state.damping_impulse, time: state.clock.time }
}

/// Weight of the free particles and the constant forces on them \[N\].
fn constant_forces(scene: &Scene, state: &State) -> ([f64; 3], [f64; 3]) {
    let particles = &state.particles;
    let owned = |slot: usize| particles.owner[slot] != 0;
    let mass: f64 = (0..particles.len()).filter(|&slot| !owned(slot)).map(|slot| particles.velocity[slot][3]).sum();
    let mut applied = [0.0; 3];
    for force in &scene.forces {
        let count = force.members.iter().filter(|&&member| !owned(particles.slot[member as usize] as usize)).count();
        for axis in 0..3 {
            applied[axis] += count as f64 * force.force[axis];
        }
    }
    (scene.gravity.map(|gravity| gravity * mass), applied)
}
