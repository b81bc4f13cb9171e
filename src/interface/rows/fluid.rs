//! Variables of the fluid: of all of it, and of each cell of its grid.

use super::row::{At, Each, OUTPUT, Present, Row, Write};
use crate::engine::simulation::Input;
use crate::engine::state::fluid::{Course, FluidField};
use crate::engine::state::{FluidState, State};
use crate::interface::{Quantity, Value};
use crate::scene::{Fluid, Scene};

/// How its velocity is given.
const VELOCITY_GIVEN: Option<Write> = Some(Write {
    set: |simulation, at, value| simulation.set_fluid(FluidField::Velocity, place(at), value),
    set_rate: |simulation, at, rate| simulation.set_fluid_rate(FluidField::Velocity, place(at), rate),
    held: |state, at| of_state(state, |fluid| input(&fluid.velocity, at)),
    start: |scene, at| scene.fluid.as_ref().map_or(0.0, |fluid| fluid.velocity.at_start()[at.axis()]),
    input: |at| Input::Fluid(FluidField::Velocity, at.element(), at.axis()),
});

/// How the gradient of its pressure is given.
const GRADIENT_GIVEN: Option<Write> = Some(Write {
    set: |simulation, at, value| simulation.set_fluid(FluidField::PressureGradient, place(at), value),
    set_rate: |simulation, at, rate| simulation.set_fluid_rate(FluidField::PressureGradient, place(at), rate),
    held: |state, at| of_state(state, |fluid| input(&fluid.pressure_gradient, at)),
    start: |scene, at| gradient_at_start(scene).map_or(0.0, |gradient| gradient[at.axis()]),
    input: |at| Input::Fluid(FluidField::PressureGradient, at.element(), at.axis()),
});

/// How its temperature is given.
const TEMPERATURE_GIVEN: Option<Write> = Some(Write {
    set: |simulation, at, value| simulation.set_fluid(FluidField::Temperature, place(at), value),
    set_rate: |simulation, at, rate| simulation.set_fluid_rate(FluidField::Temperature, place(at), rate),
    held: |state, at| of_state(state, |fluid| input(&fluid.temperature, at)),
    start: |scene, _| scene.fluid.as_ref().and_then(|fluid| fluid.heat).map_or(0.0, |heat| heat.temperature),
    input: |at| Input::Fluid(FluidField::Temperature, at.element(), at.axis()),
});

/// The cell and the axis of a variable.
fn place(at: At) -> (usize, usize) {
    (at.element(), at.axis())
}

/// The last input of what is given.
fn input(course: &Course, at: At) -> f64 {
    course.target[at.element()][at.axis()]
}

/// The gradient of the pressure at the start, where one is given.
fn gradient_at_start(scene: &Scene) -> Option<[f64; 3]> {
    scene.fluid.as_ref().and_then(|fluid| fluid.gradient_at_start(scene.gravity))
}

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

/// Its velocity, where it is an input.
const VELOCITY: Row = Row {
    name: "velocity",
    each: Each::FluidAxis,
    description: "velocity of {owner} between the particles along {axis}, to be reached at the end of the communication step; at \
                  initialisation taken at once",
    quantity: Quantity::Velocity,
    exists: |scene, _| is(scene, |fluid| fluid.grid.is_none() && fluid.velocity.is_driven()),
    write: VELOCITY_GIVEN,
    read: |now, at: At| of(now, |fluid| input(&fluid.velocity, at)),
    ..OUTPUT
};

/// The gradient of its pressure, where it is an input.
const GRADIENT: Row = Row {
    name: "pressure_gradient",
    each: Each::FluidAxis,
    description: "gradient of the pressure of {owner} along {axis} throughout the next communication step; at initialisation taken at \
                  once",
    quantity: Quantity::PressureGradient,
    exists: |scene, _| is(scene, |fluid| fluid.grid.is_none() && fluid.pressure.is_some()),
    write: GRADIENT_GIVEN,
    read: |now, at: At| of(now, |fluid| input(&fluid.pressure_gradient, at)),
    ..OUTPUT
};

/// Drag on it.
const MEAN_DRAG: Row = Row {
    name: "mean_drag",
    each: Each::FluidAxis,
    description: "drag of the particles on {owner} along {axis}, lift and added mass in it, mean over the last communication step, without \
                  the force of its pressure gradient (buoyancy)",
    quantity: Quantity::Force,
    exists: |scene, _| is(scene, |fluid| fluid.grid.is_none()),
    follows_inputs_at_start: false,
    read: |now, at: At| of(now, |fluid| fluid.mean_of(at.element(), 0)[at.axis()]),
    ..OUTPUT
};

/// Drag over the velocity.
const DRAG_COEFFICIENT: Row = Row {
    name: "drag_coefficient",
    each: Each::Fluid,
    description: "drag over the velocity of {owner} against that of each particle, in sum, mean over the last communication step",
    quantity: Quantity::Damping,
    exists: |scene, _| is(scene, |fluid| fluid.grid.is_none()),
    minimum: Some(0.0),
    follows_inputs_at_start: false,
    read: |now, at: At| of(now, |fluid| fluid.mean_of(at.element(), 0)[3]),
    ..OUTPUT
};

/// Its temperature, where it is an input.
const TEMPERATURE: Row = Row {
    name: "temperature",
    each: Each::Fluid,
    description: "temperature of {owner}, to be reached at the end of the communication step; at initialisation taken at once",
    quantity: Quantity::Temperature,
    exists: |scene, _| is(scene, |fluid| fluid.grid.is_none() && fluid.heat.is_some_and(|heat| heat.is_driven)),
    write: TEMPERATURE_GIVEN,
    read: |now, at: At| of(now, |fluid| input(&fluid.temperature, at)),
    ..OUTPUT
};

/// Heat that flows into it.
const MEAN_HEAT_FLOW: Row = Row {
    name: "mean_heat_flow",
    each: Each::Fluid,
    description: "heat flow of the particles into {owner}, mean over the last communication step",
    quantity: Quantity::HeatFlow,
    exists: |scene, _| is(scene, |fluid| fluid.grid.is_none() && fluid.heat.is_some()),
    follows_inputs_at_start: false,
    read: |now, at: At| of(now, |fluid| fluid.mean_heat[at.element()][0]),
    ..OUTPUT
};

/// Conductance to it.
const HEAT_CONDUCTANCE: Row = Row {
    name: "heat_conductance",
    each: Each::Fluid,
    description: "conductance between the particles and {owner}, in sum, mean over the last communication step",
    quantity: Quantity::Conductance,
    exists: |scene, _| is(scene, |fluid| fluid.grid.is_none() && fluid.heat.is_some()),
    minimum: Some(0.0),
    follows_inputs_at_start: false,
    read: |now, at: At| of(now, |fluid| fluid.mean_heat[at.element()][1]),
    ..OUTPUT
};

/// Whether somebody solves for its flow: its pressure gradient is given.
fn is_solved(scene: &Scene) -> bool {
    is(scene, |fluid| fluid.pressure.is_some())
}

/// Variables of the fluid, inputs first.
pub(super) static OF_FLUID: [Row; 9] = [
    VELOCITY,
    GRADIENT,
    TEMPERATURE,
    Row {
        name: "velocity",
        each: Each::FluidAxis,
        description: "velocity of {owner} between the particles along {axis}",
        quantity: Quantity::Velocity,
        exists: |scene, _| is(scene, |fluid| fluid.velocity.changes() && !fluid.velocity.is_driven()),
        read: |now, at: At| of(now, |fluid| fluid.velocity.now[0][at.axis()]),
        ..OUTPUT
    },
    MEAN_DRAG,
    DRAG_COEFFICIENT,
    MEAN_HEAT_FLOW,
    HEAT_CONDUCTANCE,
    Row {
        name: "work",
        each: Each::Fluid,
        description: "work of {owner} since the start: of drag along its own velocity, of other forces along those of the particles",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        read: |now, _| of(now, |fluid| fluid.work),
        ..OUTPUT
    },
];

/// Variables of each cell of its grid, inputs first.
pub(super) static OF_FLUID_CELLS: [Row; 10] = [
    Row {
        each: Each::FluidCellAxis,
        description: "velocity of {owner} between the particles at the centre of cell {element} along {axis}, to be reached at the end of \
                      the communication step; at initialisation taken at once",
        exists: |scene, _| is(scene, |fluid| fluid.velocity.is_driven()),
        ..VELOCITY
    },
    Row {
        each: Each::FluidCellAxis,
        description: "gradient of the pressure of {owner} at the centre of cell {element} along {axis} throughout the next communication \
                      step; at initialisation taken at once",
        exists: |scene, _| is(scene, |fluid| fluid.pressure.is_some()),
        ..GRADIENT
    },
    Row {
        each: Each::FluidCell,
        description: "temperature of {owner} at the centre of cell {element}, to be reached at the end of the communication step; at \
                      initialisation taken at once",
        exists: |scene, _| is(scene, |fluid| fluid.heat.is_some_and(|heat| heat.is_driven)),
        ..TEMPERATURE
    },
    Row {
        name: "porosity",
        each: Each::FluidCell,
        description: "part of the volume of cell {element} of {owner} that no particle fills; overlaps of particles count twice",
        read: |now, at: At| of(now, |fluid| fluid.porosity[at.element()]),
        ..OUTPUT
    },
    Row {
        each: Each::FluidCellAxis,
        description: "drag of the particles on {owner} in cell {element} along {axis}, lift and added mass in it, by their weights between \
                      centres, mean over the last communication step, without the force of its pressure gradient (buoyancy)",
        exists: |_, _| true,
        ..MEAN_DRAG
    },
    Row {
        each: Each::FluidCell,
        description: "drag over the velocity of {owner} against that of each particle, in sum over their weights in cell {element}, mean \
                      over the last communication step",
        exists: |_, _| true,
        ..DRAG_COEFFICIENT
    },
    Row {
        each: Each::FluidCell,
        description: "heat flow of the particles into {owner} in cell {element}, by their weights between centres, mean over the last \
                      communication step",
        exists: |scene, _| is(scene, |fluid| fluid.heat.is_some()),
        ..MEAN_HEAT_FLOW
    },
    Row {
        each: Each::FluidCell,
        description: "conductance between the particles and {owner}, in sum over their weights in cell {element}, mean over the last \
                      communication step",
        exists: |scene, _| is(scene, |fluid| fluid.heat.is_some()),
        ..HEAT_CONDUCTANCE
    },
    Row {
        name: "mean_pressure_force",
        each: Each::FluidCellAxis,
        description: "force of the particles on {owner} in cell {element} along {axis} that answers that of the whole gradient of its \
                      pressure on them, by their weights between centres, mean over the last communication step",
        exists: |scene, _| is_solved(scene),
        read: |now, at: At| of(now, |fluid| fluid.mean_of(at.element(), 1)[at.axis()]),
        ..MEAN_DRAG
    },
    Row {
        name: "mean_solid_flux",
        each: Each::FluidCellAxis,
        description: "superficial velocity of the particles in cell {element} of {owner} along {axis}: their volume flow over the whole \
                      section, by their weights between centres, mean over the last communication step",
        quantity: Quantity::Velocity,
        exists: |scene, _| is_solved(scene),
        read: |now, at: At| of(now, |fluid| fluid.mean_of(at.element(), 2)[at.axis()]),
        ..MEAN_DRAG
    },
];
