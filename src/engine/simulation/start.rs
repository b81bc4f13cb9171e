//! Where a simulation starts: as the scene was built, with driven axes moved, or in a state that another one reached.

use super::{RunError, Simulation, assemble};
use crate::base::threads::Context;
use crate::engine::bodies::boundary;
use crate::engine::boundaries::{course, nodes, placing};
use crate::engine::flow;
use crate::engine::fluid;
use crate::engine::state::{BoundaryState, State};
use crate::engine::transfer;
use crate::scene::{AxisMotion, Scene};
use std::sync::Arc;

impl Simulation {
    /// The scene at time 0 with particles, contacts, springs and bonds as in a state that was reached before:
    /// boundaries stand where the scene has them, along free axes and those of servos where they have come to; every count and book begins
    /// anew, forces are evaluated.
    pub fn settled(scene: Arc<Scene>, reached: State) -> Result<Self, RunError> {
        let State { particles, clumps, mut neighbours, contacts, walls, bonds, exchange, cell, heat, .. } = reached;
        neighbours.made_at = 0;
        let mut state =
            State { particles, clumps, neighbours, contacts, walls, bonds, exchange, heat, ..assemble::state(&scene) };
        if let (Some(begun), Some(ended)) = (&mut state.cell, cell) {
            begun.stay(ended);
        }
        if let Some(exchange) = &mut state.exchange {
            flow::begin_anew(&scene, exchange);
        }
        for ((boundary, begun), ended) in scene.boundaries.iter().zip(&mut state.boundaries).zip(&reached.boundaries) {
            stay(&boundary.axes, begun, ended);
        }
        let mut simulation = Self::with(scene, state);
        simulation.state.clock.speed = reached.clock.speed;
        simulation.start()?;
        Ok(simulation)
    }

    /// Starts with driven axes where their inputs say, without motion. They act on the scene as it was built: bonds are
    /// made and springs unmoved where everything stands as the scene has it, then the boundaries are put; forces are
    /// evaluated and books begin there. `begun` is the state that the simulation began in, if it was not the scene's
    /// own. For use before the first interval only; if the scene cannot start so, nothing has changed.
    pub fn place(&mut self, begun: Option<&State>) -> Result<(), RunError> {
        self.rollback.forget();
        let (coefficients, tuned) = (self.state.coefficients.clone(), self.state.tuned.clone());
        let mut from = State { coefficients, tuned, ..begun.cloned().unwrap_or_else(|| assemble::state(&self.scene)) };
        take_rates(&mut from, &self.state);
        let before = std::mem::replace(&mut self.state, from);
        self.put(&before, begun.is_none()).inspect_err(|_| self.state = before)
    }

    /// Puts driven axes and nodes to the inputs of a state.
    fn put(&mut self, inputs: &State, unbuilt: bool) -> Result<(), RunError> {
        if unbuilt {
            self.build()?;
        }
        let (mut moves, mut loads) = (false, false);
        let boundaries = self.scene.boundaries.iter().zip(&mut self.state.boundaries);
        for ((boundary, moved), given) in boundaries.zip(&inputs.boundaries) {
            for axis in (0..6).filter(|&axis| boundary.axes[axis].takes_place()) {
                let place = if axis < 3 { moved.displacement[axis] } else { moved.rotation[axis - 3] };
                moves |= place != given.target[axis];
                placing::put(moved, axis, given.target[axis]);
                moved.target_rate[axis] = given.target_rate[axis];
            }
            moved.target_acceleration = given.target_acceleration;
            let others = |motion: &AxisMotion| motion.takes_force() || motion.takes_velocity();
            for axis in (0..6).filter(|&axis| others(&boundary.axes[axis])) {
                loads |= moved.target[axis] != given.target[axis];
                (moved.target[axis], moved.target_rate[axis]) = (given.target[axis], given.target_rate[axis]);
            }
            course::apply_inputs(boundary, moved);
        }
        for (moved, given) in self.state.nodes.iter_mut().zip(&inputs.nodes) {
            moves |= nodes::put(moved, given);
        }
        if let (Some(cell), Some(given)) = (&self.cell, &inputs.cell) {
            moves |= cell.put(&mut self.state, given);
        }
        loads |= transfer::put(&self.scene, self.state.heat.as_mut(), inputs.heat.as_ref());
        loads |= fluid::put(&self.scene, self.state.fluid.as_mut(), inputs.fluid.as_ref());
        if moves {
            boundary::place_groups(&self.scene, &self.bodies, &mut self.state);
            self.rebuild(&self.standing());
        }
        if moves || loads || unbuilt { self.start() } else { Ok(()) }
    }

    /// Takes over what was given to the driven axes of another simulation of these boundaries.
    pub fn take_inputs(&mut self, other: &Self) {
        let boundaries = self.scene.boundaries.iter().zip(&mut self.state.boundaries);
        for ((boundary, moved), given) in boundaries.zip(&other.state.boundaries) {
            for axis in (0..6).filter(|&axis| boundary.axes[axis].is_driven()) {
                moved.target[axis] = given.target[axis];
                moved.target_rate[axis] = given.target_rate[axis];
            }
            moved.target_acceleration = given.target_acceleration;
        }
        for (moved, given) in self.state.nodes.iter_mut().zip(&other.state.nodes) {
            nodes::take_inputs(moved, given);
        }
        if let (Some(cell), Some(given)) = (&mut self.state.cell, &other.state.cell) {
            (cell.target, cell.target_rate) = (given.target, given.target_rate);
        }
        if let (Some(heat), Some(given)) = (&mut self.state.heat, &other.state.heat) {
            for (surface, given) in heat.surfaces_mut().zip(given.surfaces()) {
                (surface.target, surface.target_rate) = (given.target, given.target_rate);
            }
        }
        if let (Some(fluid), Some(given)) = (&mut self.state.fluid, &other.state.fluid) {
            fluid.velocity.take_inputs(&given.velocity);
            fluid.pressure_gradient.take_inputs(&given.pressure_gradient);
            fluid.temperature.take_inputs(&given.temperature);
        }
        take_rates(&mut self.state, &other.state);
    }

    /// Lets every count and book begin anew at the present state.
    pub fn open_books(&mut self) {
        self.rollback.forget();
        self.state.begin_counting();
        self.open_energy_book();
    }

    /// Lets mean loads, rates of loads and the energy book begin at the present state.
    pub(super) fn open_energy_book(&mut self) {
        let energies = self.state.ledger.is_some().then(|| (self.kinetic_energy(), self.elastic_energy()));
        for boundary in &mut self.state.boundaries {
            boundary.mean_force = boundary.force;
            boundary.mean_moment = boundary.moment;
            for axis in 0..3 {
                boundary.force_before[axis] = boundary.force[axis];
                boundary.moment_before[axis] = boundary.moment[axis];
            }
        }
        if let Some(cell) = &self.cell {
            cell.begin_mean(&mut self.state, &Context { step: 0.0, width: self.width, threads: None, watch: None });
        }
        for nodes in &mut self.state.nodes {
            nodes.mean_force.clone_from(&nodes.force);
        }
        if let (Some(ledger), Some((kinetic, elastic))) = (&mut self.state.ledger, energies) {
            ledger.initial_kinetic = kinetic;
            ledger.initial_elastic = elastic;
        }
        self.open_losses();
    }
}

/// Gives insertions the rates that they were given in another state.
fn take_rates(state: &mut State, other: &State) {
    let feeds = state.exchange.iter_mut().flat_map(|exchange| &mut exchange.feeds);
    let given = other.exchange.iter().flat_map(|exchange| &exchange.feeds);
    for (feed, given) in feeds.zip(given) {
        (feed.rate, feed.rate_of_rate) = (given.rate, given.rate_of_rate);
    }
}

/// Leaves the free axes of a boundary where they have come to, and as fast as they are.
fn stay(axes: &[AxisMotion; 6], begun: &mut BoundaryState, ended: &BoundaryState) {
    let is_free = |axis: usize| axes[axis].is_free();
    for axis in (0..3).filter(|&axis| axes[axis].servo().is_some()) {
        begun.displacement[axis] = ended.displacement[axis];
        begun.pivot[axis] = ended.pivot[axis];
    }
    for axis in (0..3).filter(|&axis| is_free(axis)) {
        begun.displacement[axis] = ended.displacement[axis];
        begun.velocity[axis] = ended.velocity[axis];
        begun.pivot[axis] = ended.pivot[axis];
    }
    if (3..6).any(is_free) {
        begun.rotation = ended.rotation;
        begun.angular_velocity = ended.angular_velocity;
        begun.orientation = ended.orientation;
        begun.start_orientation = ended.orientation;
        begun.inertial.angular_momentum = ended.inertial.angular_momentum;
    }
}
