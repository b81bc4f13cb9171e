//! Variables of the fluid.

use super::row::{At, Each, OUTPUT, Present, Row, Write};
use crate::engine::simulation::Input;
use crate::engine::state::{FluidState, State};
use crate::interface::{Quantity, Value};
use crate::scene::{Fluid, Scene};

/// How its velocity is given.
const GIVEN: Option<Write> = Some(Write {
    set: |simulation, at, value| simulation.set_fluid(at.axis(), value),
    set_rate: |simulation, at, rate| simulation.set_fluid_rate(at.axis(), rate),
    held: |state, at| of_state(state, |fluid| fluid.target[at.axis()]),
    start: |scene, at| scene.fluid.as_ref().map_or(0.0, |fluid| fluid.velocity.at_start()[at.axis()]),
    input: |at| Input::Fluid(at.axis()),
});

/// Whether something holds of the fluid of a scene.
fn is(scene: &Scene, holds: fn(&Fluid) -> bool) -> bool {
    scene.fluid.as_ref().is_some_and(holds)
}

/// A number of the fluid in a state.
fn of_state(state: &State, read: impl FnOnce(&FluidState) -> f64) -> f64 {
    state.fluid.as_ref().map_or(0.0, read)
}

/// The same at the present time.
fn of(now: Present, read: impl FnOnce(&FluidState) -> f64) -> Value {
    Value::Real(of_state(now.simulation.state(), read))
}

/// Variables of the fluid, inputs first.
pub(super) static OF_FLUID: [Row; 4] = [
    Row {
        name: "velocity",
        each: Each::FluidAxis,
        description: "velocity of {owner} between the particles along {axis}, to be reached at the end of the communication step; at \
                      initialisation taken at once",
        quantity: Quantity::Velocity,
        exists: |scene, _| is(scene, |fluid| fluid.velocity.is_driven()),
        write: GIVEN,
        read: |now, at: At| of(now, |fluid| fluid.target[at.axis()]),
        ..OUTPUT
    },
    Row {
        name: "velocity",
        each: Each::FluidAxis,
        description: "velocity of {owner} between the particles along {axis}",
        quantity: Quantity::Velocity,
        exists: |scene, _| is(scene, |fluid| fluid.velocity.changes() && !fluid.velocity.is_driven()),
        read: |now, at: At| of(now, |fluid| fluid.velocity[at.axis()]),
        ..OUTPUT
    },
    Row {
        name: "mean_drag",
        each: Each::FluidAxis,
        description: "drag of the particles on {owner} along {axis}, mean over the last communication step, without the force of its \
                      pressure gradient (buoyancy)",
        quantity: Quantity::Force,
        follows_inputs_at_start: false,
        read: |now, at: At| of(now, |fluid| fluid.mean_drag[at.axis()]),
        ..OUTPUT
    },
    Row {
        name: "work",
        each: Each::Fluid,
        description: "work of {owner} since the start: of drag along its own velocity, of buoyancy along those of the particles",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        read: |now, _| of(now, |fluid| fluid.work),
        ..OUTPUT
    },
];
