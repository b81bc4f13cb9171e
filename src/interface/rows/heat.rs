//! Variables of heat: of each boundary that has a temperature, and of the whole.

use super::row::{At, Each, OUTPUT, Present, Row, Write};
use crate::engine::simulation::Input;
use crate::engine::state::heat::BoundaryHeat;
use crate::engine::state::{Heat, State};
use crate::engine::transfer;
use crate::interface::{Quantity, Value};
use crate::scene::{BoundaryTemperature, Scene};

/// An output of each boundary into which heat flows.
const OF_BOUNDARY: Row = Row { each: Each::Boundary, exists: has_temperature, ..OUTPUT };

/// How a thermal input is given.
const GIVEN: Option<Write> = Some(Write {
    set: |simulation, at, value| simulation.set_heat(at.boundary, value),
    set_rate: |simulation, at, rate| simulation.set_heat_rate(at.boundary, rate),
    held: |state, at| of_state(state, at).target,
    start: |scene, at| match scene.boundaries[at.boundary.index()].temperature {
        BoundaryTemperature::Driven(temperature) => temperature,
        BoundaryTemperature::Body { applied, .. } => applied,
        BoundaryTemperature::None | BoundaryTemperature::Held(_) => 0.0,
    },
    input: |at| Input::Heat(at.boundary, None),
});

/// An output of each node that has a temperature.
const OF_NODE: Row = Row { each: Each::NodeScalar, exists: has_nodes, follows_inputs_at_start: false, ..OUTPUT };

/// The temperature of a boundary, as the scene has it.
fn temperature(scene: &Scene, at: At) -> BoundaryTemperature {
    scene.boundaries[at.boundary.index()].temperature
}

/// Whether heat flows into a boundary.
fn has_temperature(scene: &Scene, at: At) -> bool {
    scene.has_heat() && transfer::takes_heat(&scene.boundaries[at.boundary.index()])
}

/// Whether the outside gives its temperature: one of the whole.
fn is_driven(scene: &Scene, at: At) -> bool {
    matches!(temperature(scene, at), BoundaryTemperature::Driven(_)) && !has_nodes(scene, at)
}

/// Whether the outside gives the temperature of each of its nodes.
fn has_nodes(scene: &Scene, at: At) -> bool {
    let nodes = scene.boundaries[at.boundary.index()].driven_nodes();
    matches!(temperature(scene, at), BoundaryTemperature::Driven(_)) && nodes > 0
}

/// Heat of a node.
fn of_node(state: &State, at: At) -> BoundaryHeat {
    let nodes = state.heat.as_ref().and_then(|heat| heat.nodes_of(at.boundary.index()));
    nodes.map(|nodes| nodes[at.element()]).unwrap_or_default()
}

/// The same at the present time.
fn at_node(now: Present, at: At, read: fn(&BoundaryHeat) -> f64) -> Value {
    Value::Real(read(&of_node(now.simulation.state(), at)))
}

/// Whether it takes up heat.
fn takes_up(scene: &Scene, at: At) -> bool {
    matches!(temperature(scene, at), BoundaryTemperature::Body { .. })
}

/// Whether its temperature is a state.
fn has_state(scene: &Scene, at: At) -> bool {
    has_temperature(scene, at)
        && matches!(temperature(scene, at), BoundaryTemperature::None | BoundaryTemperature::Body { .. })
}

/// Heat of a boundary.
fn of_state(state: &State, at: At) -> BoundaryHeat {
    state.heat.as_ref().map(|heat| heat.boundaries[at.boundary.index()]).unwrap_or_default()
}

/// The same at the present time.
fn of(now: Present, at: At) -> BoundaryHeat {
    of_state(now.simulation.state(), at)
}

/// A value of the heat of a scene.
fn whole(now: Present, read: fn(&Heat) -> f64) -> Value {
    Value::Real(now.simulation.state().heat.as_ref().map_or(0.0, read))
}

/// Variables of boundaries, inputs first.
pub(super) static OF_HEATED: [Row; 6] = [
    Row {
        name: "temperature",
        description: "temperature of {boundary}, to be reached at the end of the communication step; at initialisation taken at \
                      once",
        quantity: Quantity::Temperature,
        minimum: Some(0.0),
        exists: is_driven,
        write: GIVEN,
        read: |now, at| Value::Real(of(now, at).target),
        ..OF_BOUNDARY
    },
    Row {
        name: "applied_heat",
        description: "heat flow from the outside into {boundary}, without that of the particles; held in a communication step, or \
                      changing at its rate",
        quantity: Quantity::HeatFlow,
        exists: takes_up,
        write: GIVEN,
        read: |now, at| Value::Real(of(now, at).target),
        ..OF_BOUNDARY
    },
    Row {
        name: "temperature",
        description: "temperature of {boundary}",
        quantity: Quantity::Temperature,
        minimum: Some(0.0),
        follows_inputs_at_start: false,
        exists: has_state,
        read: |now, at| Value::Real(of(now, at).temperature()),
        ..OF_BOUNDARY
    },
    Row {
        name: "heat_flow",
        description: "heat flow of the particles into {boundary} in the last time step; 0 before the first",
        quantity: Quantity::HeatFlow,
        follows_inputs_at_start: false,
        read: |now, at| Value::Real(of(now, at).flow),
        ..OF_BOUNDARY
    },
    Row {
        name: "mean_heat_flow",
        description: "heat flow of the particles into {boundary}, mean over the last communication step",
        quantity: Quantity::HeatFlow,
        follows_inputs_at_start: false,
        read: |now, at| Value::Real(of(now, at).mean_flow),
        ..OF_BOUNDARY
    },
    Row {
        name: "heat",
        description: "heat of the particles into {boundary} since the start",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        read: |now, at| Value::Real(of(now, at).heat()),
        ..OF_BOUNDARY
    },
];

/// Variables of nodes that have temperatures, inputs first.
pub(super) static OF_HEATED_NODES: [Row; 4] = [
    Row {
        name: "temperature",
        description: "temperature of node {element} of {boundary}, to be reached at the end of the communication step; at initialisation \
                      taken at once",
        quantity: Quantity::Temperature,
        minimum: Some(0.0),
        follows_inputs_at_start: OUTPUT.follows_inputs_at_start,
        write: Some(Write {
            set: |simulation, at, value| simulation.set_node_temperature(at.boundary, at.element(), value),
            set_rate: |simulation, at, rate| simulation.set_node_temperature_rate(at.boundary, at.element(), rate),
            held: |state, at| of_node(state, at).target,
            start: |scene, at| temperature(scene, at).at_start().unwrap_or(0.0),
            input: |at| Input::Heat(at.boundary, Some(at.element())),
        }),
        read: |now, at| at_node(now, at, |node| node.target),
        ..OF_NODE
    },
    Row {
        name: "heat_flow",
        description: "heat flow of the particles into {boundary} in the last time step, the part of node {element}; 0 before the first",
        quantity: Quantity::HeatFlow,
        read: |now, at| at_node(now, at, |node| node.flow),
        ..OF_NODE
    },
    Row {
        name: "mean_heat_flow",
        description: "heat flow of the particles into {boundary}, the part of node {element}, mean over the last communication step",
        quantity: Quantity::HeatFlow,
        read: |now, at| at_node(now, at, |node| node.mean_flow),
        ..OF_NODE
    },
    Row {
        name: "heat",
        description: "heat of the particles into {boundary} since the start, the part of node {element}",
        quantity: Quantity::Energy,
        read: |now, at| at_node(now, at, BoundaryHeat::heat),
        ..OF_NODE
    },
];

/// Variables of the whole.
pub(super) static OF_HEAT: [Row; 2] = [
    Row {
        name: "energy.heat",
        description: "heat that particles and clumps gained since the start; that of groups counts as their boundary's",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| scene.has_heat(),
        read: |now, _| whole(now, Heat::energy),
        ..OUTPUT
    },
    Row {
        name: "energy.heat_residual",
        description: "heat that particles and clumps gained and gave to boundaries since the start, less what heat sources and \
                      losses gave: rounding",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| scene.has_heat(),
        read: |now, _| whole(now, transfer::residual),
        ..OUTPUT
    },
];
