//! A simulation at rest whose bodies are displaced a little: how forces answer, however slowly that is done.

use super::{RunError, Simulation};
use crate::base::geometry::{Quaternion, rotation};
use crate::base::number::Vector;
use crate::base::quantity::BoundaryIndex;
use crate::base::threads::Context;
use crate::engine::bodies::{RigidBody, boundary};
use crate::engine::contacts::{Link, SearchLimits};
use crate::engine::state::{BoundaryState, Clumps, Orientation, State};
use std::sync::Arc;

/// Time that a displacement takes, over the stable time step: so long that no dashpot feels it.
const SLOWLY: f64 = (1_u64 << 40) as f64;

/// A small motion of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement {
    /// Which body.
    pub body: ProbeBody,
    /// Along x, y, z (0 to 2), about them (3 to 5). Of the cell: the component of its strain.
    pub axis: usize,
    /// How far \[m, rad, 1\].
    pub amount: f64,
}

/// What is displaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProbeBody {
    /// The particle in this slot.
    Particle(u32),
    /// A boundary, with the particles of a group.
    Boundary(BoundaryIndex),
    /// A clump, with its spheres.
    Clump(u32),
    /// The periodic cell, with the particles in it.
    Cell,
}

impl ProbeBody {
    /// The slot of a particle, of a clump in a state that of its first sphere.
    pub(crate) fn slot(self, state: &State) -> Option<u32> {
        match self {
            Self::Particle(slot) => Some(slot),
            Self::Clump(clump) => Some(state.particles.slot[state.clumps.spheres_of(clump as usize)[0] as usize]),
            Self::Boundary(_) | Self::Cell => None,
        }
    }
}

/// Two bodies that act on each other: slots of particles; `None` for anything else.
pub(crate) type Neighbours = (u32, Option<u32>);

/// A simulation of its own, from whose state at rest bodies are displaced.
pub struct Probe {
    /// The simulation that is displaced.
    simulation: Simulation,
    /// Its state at rest.
    rest: State,
    /// Time that a displacement takes \[s\].
    slowly: f64,
}

impl Probe {
    /// The present state of a simulation with everything at rest.
    pub fn of(simulation: &Simulation) -> Self {
        let mut rest = simulation.state.clone();
        rest.ledger = None;
        stop(&mut rest);
        let stable = simulation.state.clock.stable;
        let slowly = SLOWLY * if stable > 0.0 && stable.is_finite() { stable } else { 1.0 };
        let mut simulation = Simulation::with(Arc::clone(&simulation.scene), rest.clone());
        simulation.fields.without_damping();
        simulation.choose_stages();
        Self { simulation, rest, slowly }
    }

    /// Leaves out some particles (slots) from here on.
    pub(crate) fn leave_out(&mut self, slots: impl Iterator<Item = u32>) {
        let Self { simulation, rest, .. } = self;
        let mut goes = vec![false; rest.particles.len()];
        slots.for_each(|slot| goes[slot as usize] = true);
        simulation.state.clone_from(rest);
        simulation.state.remove(&goes);
        simulation.rebuild(&simulation.standing());
        rest.clone_from(&simulation.state);
    }

    /// The state at rest.
    pub fn rest(&self) -> &State {
        &self.rest
    }

    /// Whether anything turns the particles.
    pub fn turns(&self) -> bool {
        self.simulation.turning
    }

    /// Boundaries that turn or that forces move.
    pub(crate) fn bodies(&self) -> &[Option<RigidBody>] {
        &self.simulation.bodies
    }

    /// Which bodies act on each other.
    pub(crate) fn neighbours(&self) -> Vec<Neighbours> {
        let mut all = Vec::new();
        for pass in &self.simulation.passes {
            pass.stiffness(&self.rest, &SearchLimits::default(), &Context::ALONE, &mut |link: Link| {
                all.push((link.first, link.second));
            });
        }
        all
    }

    /// The state after these displacements, with the loads on particles and boundaries that come of them.
    pub fn displaced(&mut self, displacements: impl Iterator<Item = Displacement>) -> Result<&State, RunError> {
        let Self { simulation, rest, slowly } = self;
        let slowly = *slowly;
        simulation.state.clone_from(rest);
        for Displacement { body, axis, amount } in displacements {
            match body {
                ProbeBody::Particle(slot) => displace(&mut simulation.state, slot as usize, axis, (amount, slowly)),
                ProbeBody::Boundary(boundary) => {
                    let boundary = &mut simulation.state.boundaries[boundary.index()];
                    displace_boundary(boundary, axis, (amount, slowly));
                }
                ProbeBody::Clump(clump) => {
                    displace_clump(&mut simulation.state.clumps, clump as usize, axis, (amount, slowly));
                }
                ProbeBody::Cell => {
                    if let Some(cell) = &simulation.cell {
                        cell.displace(&mut simulation.state, axis, (amount, slowly));
                    }
                }
            }
        }
        if let Some(shapes) = &simulation.shapes {
            shapes.place(&mut simulation.state);
        }
        if let Some(cell) = &simulation.cell {
            cell.place_images(&mut simulation.state);
        }
        let Simulation { scene, bodies, state, .. } = &mut *simulation;
        boundary::place_groups(scene, bodies, state);
        let context = Context { step: slowly, ..simulation.standing() };
        simulation.evaluate_interactions(&context)?;
        Ok(&simulation.state)
    }

    /// Stress of the periodic cell as it was displaced last; zeros without one \[Pa\].
    pub(crate) fn stress(&self) -> [f64; 6] {
        self.simulation.cell_stress()
    }

    /// The simulation at rest, with all forces but those of global damping.
    pub(crate) fn loaded(&mut self) -> Result<&Simulation, RunError> {
        let Self { simulation, rest, slowly } = self;
        simulation.state.clone_from(rest);
        let context = Context { step: *slowly, ..simulation.standing() };
        simulation.evaluate(&context)?;
        Ok(simulation)
    }

    /// Lets everything rest where these displacements lead.
    pub(crate) fn follow(&mut self, displacements: impl Iterator<Item = Displacement>) -> Result<(), RunError> {
        self.displaced(displacements)?;
        let Self { simulation, rest, .. } = self;
        stop(&mut simulation.state);
        simulation.rebuild(&simulation.standing());
        rest.clone_from(&simulation.state);
        Ok(())
    }
}

/// Takes all motion out of a state.
fn stop(state: &mut State) {
    let (particles, clumps) = (&mut state.particles, &mut state.clumps);
    let of_particles = [&mut particles.velocity, &mut particles.angular_velocity];
    let of_clumps = [&mut clumps.velocity, &mut clumps.angular_velocity, &mut clumps.angular_momentum];
    for rows in of_particles.into_iter().chain(of_clumps) {
        rows.iter_mut().for_each(|row| row[..3].fill(0.0));
    }
    for boundary in &mut state.boundaries {
        (boundary.velocity, boundary.angular_velocity) = ([0.0; 3], [0.0; 3]);
        boundary.before = boundary.stand();
        boundary.inertial.angular_momentum = [0.0; 3];
    }
    state.nodes.iter_mut().for_each(|nodes| nodes.velocity.fill([0.0; 4]));
    if let Some(cell) = &mut state.cell {
        cell.gradient = Default::default();
    }
}

/// Displaces a boundary by so much \[m, rad\] in so long \[s\].
fn displace_boundary(moved: &mut BoundaryState, axis: usize, (amount, slowly): (f64, f64)) {
    if axis < 3 {
        moved.displacement[axis] += amount;
        moved.velocity[axis] = amount / slowly;
        return;
    }
    let mut turn = Vector::zero().to_array();
    turn[axis - 3] = amount;
    let turn = Vector::from(turn);
    let orientation = rotation::orientation(turn) * Quaternion::from(moved.orientation);
    moved.orientation = Orientation::from(orientation);
    moved.rotation = rotation::vector_near(orientation, Vector::from(moved.rotation) + turn).to_array();
    moved.angular_velocity[axis - 3] = amount / slowly;
}

/// Displaces a clump by so much \[m, rad\] in so long \[s\]; its spheres are to follow.
fn displace_clump(clumps: &mut Clumps, clump: usize, axis: usize, (amount, slowly): (f64, f64)) {
    if axis < 3 {
        clumps.position[clump][axis] += amount;
        clumps.velocity[clump][axis] = amount / slowly;
        return;
    }
    let mut turn = [0.0; 3];
    turn[axis - 3] = amount;
    let row = &mut clumps.orientation[clump];
    *row = (rotation::orientation(Vector::from(turn)) * Quaternion::from_row(*row)).to_row();
    clumps.angular_velocity[clump][axis - 3] = amount / slowly;
}

/// Displaces a particle by so much \[m, rad\] in so long \[s\].
fn displace(state: &mut State, slot: usize, axis: usize, (amount, slowly): (f64, f64)) {
    let particles = &mut state.particles;
    if axis < 3 {
        particles.position[slot][axis] += amount;
        particles.velocity[slot][axis] = amount / slowly;
        return;
    }
    particles.angular_velocity[slot][axis - 3] = amount / slowly;
    if let Some(row) = particles.orientation.get_mut(slot) {
        let mut turn = [0.0; 3];
        turn[axis - 3] = amount;
        *row = (rotation::orientation(Vector::from(turn)) * Quaternion::from_row(*row)).to_row();
    }
}
