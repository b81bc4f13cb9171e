//! Puts bodies where another program had them, in the middle of their motion.

use super::{RunError, Simulation, assemble};
use crate::base::number::Vector;
use crate::engine::bonds::{begin_losses, pair_of};
use crate::engine::boundaries::placing;
use crate::engine::contacts::PlacedSpring;
use crate::engine::state::contacts::TOUCHING;
use crate::engine::state::{Row, State};
use crate::laws::bond::Rows;
use crate::laws::contact::Law;
use crate::scene::{Scene, Step};
use std::sync::Arc;

/// A sphere as it is at the end of a time step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlacedParticle {
    /// Position \[m\].
    pub position: [f64; 3],
    /// Velocity \[m/s\].
    pub velocity: [f64; 3],
    /// Angular velocity \[rad/s\].
    pub angular_velocity: [f64; 3],
    /// Force \[N\].
    pub force: [f64; 3],
    /// Torque \[N m\].
    pub torque: [f64; 3],
}

/// A bond with its history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedBond {
    /// Bond law: index in the scene.
    pub law: usize,
    /// The bodies i and j: indices into the scene's particles, ascending.
    pub bodies: [u32; 2],
    /// Its state, as the law keeps it.
    pub rows: Rows,
}

/// Everything that a scene without planes remembers from one time step to the next.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placement {
    /// Time steps made so far.
    pub steps: u64,
    /// The particles, in the scene's order.
    pub particles: Vec<PlacedParticle>,
    /// Springs of contacts at work.
    pub springs: Vec<PlacedSpring>,
    /// Living bonds.
    pub bonds: Vec<PlacedBond>,
}

impl Simulation {
    /// The scene as it stands after some of its time steps, which have a given length. Orientations are those of time 0.
    ///
    /// What the placement does not name stays as at time 0; what is not in the scene is passed over. A scene with planes
    /// is refused: their springs and bonds would be lost.
    pub fn placed(scene: Arc<Scene>, placement: &Placement) -> Result<Self, RunError> {
        if let Some(plane) = scene.boundaries.iter().find(|boundary| boundary.shape.material().is_some()) {
            return Err(RunError::PutAtPlane { boundary: plane.name.clone() });
        }
        let mut state = assemble::state(&scene);
        if let Step::Given(step) = scene.run.step {
            state.clock.step = step;
            state.clock.last_step = step;
            state.clock.time = placement.steps as f64 * step;
        }
        state.clock.steps = placement.steps;
        let time = state.clock.time;
        placing::put_prescribed(&scene, &mut state, time);
        put_particles(&mut state, &placement.particles);
        for bond in &placement.bonds {
            put_bond(&scene, &mut state, bond);
        }
        let mut simulation = Self::with(scene, state);
        simulation.give_orientations();
        simulation.rebuild(&simulation.standing());
        let Self { scene, suppression, state, .. } = &mut simulation;
        suppression.begin_offsets(state);
        for spring in &placement.springs {
            suppression.put_offset(scene, state, spring);
            put_spring(scene, state, spring);
        }
        let context = simulation.standing();
        simulation.look(simulation.state.clock.step, &context)?;
        Ok(simulation)
    }
}

/// Puts particles where they are; slots are still those of the scene.
fn put_particles(state: &mut State, placed: &[PlacedParticle]) {
    let particles = &mut state.particles;
    for (slot, placed) in placed.iter().enumerate().take(particles.len()) {
        put(&mut particles.position[slot], placed.position);
        put(&mut particles.velocity[slot], placed.velocity);
        put(&mut particles.angular_velocity[slot], placed.angular_velocity);
        put(&mut particles.force[slot], placed.force);
        put(&mut particles.torque[slot], placed.torque);
    }
}

/// Sets the vector of a row.
fn put(row: &mut Row, vector: [f64; 3]) {
    row[..3].copy_from_slice(&vector);
}

/// Appends a bond to its list; slots are still those of the scene.
fn put_bond(scene: &Scene, state: &mut State, bond: &PlacedBond) {
    let Some(list) = state.bonds.get_mut(bond.law) else { return };
    let law = scene.bond_law(bond.law);
    list.rows.resize(bond.rows.len(), Vec::new());
    list.first.push(bond.bodies[0]);
    list.second.push(bond.bodies[1]);
    for (column, row) in list.rows.iter_mut().zip(bond.rows) {
        column.push(row);
    }
    let [i, j] = bond.bodies.map(|slot| slot as usize);
    let pair = pair_of(&state.particles, i, j);
    begin_losses(list, &law, &law.elasticity.at_step(0.0), &pair);
    list.made += 1;
    state.particles.count_bond(bond.bodies);
}

/// Gives a listed pair its spring, if it touches.
fn put_spring(scene: &Scene, state: &mut State, placed: &PlacedSpring) {
    let particles = &state.particles;
    let [a, b] = placed.bodies.map(|body| particles.slot[body as usize]);
    let [one, other] = [a, b].map(|slot| particles.position[slot as usize]);
    let distance = (Vector::from(one) - Vector::from(other)).length();
    if distance >= one[3] + other[3] {
        return;
    }
    for (law, list) in state.contacts.iter_mut().enumerate() {
        let spring = Law::of(&scene.contacts[law].choice).spring();
        for pair in 0..list.first.len() {
            let sign = match [list.first[pair], list.second[pair]] {
                found if found == [a, b] => 1.0,
                found if found == [b, a] => -1.0,
                _ => continue,
            };
            list.flags[pair] |= TOUCHING;
            if let Some(spring) = spring.and_then(|spring| list.history.get_mut(pair).get_mut(spring)) {
                put(spring, placed.spring.map(|part| sign * part));
            }
        }
    }
}
