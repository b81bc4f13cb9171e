//! Variables of the periodic cell.

use super::row::{At, Each, OUTPUT, Row, Write};
use crate::engine::simulation::Input;
use crate::interface::{Quantity, Value};
use crate::scene::{CellMotion, Scene};

/// How the input of a component is given.
const GIVEN: Option<Write> = Some(Write {
    set: |simulation, at, value| simulation.set_strain(at.axis(), value),
    set_rate: |simulation, at, rate| simulation.set_strain_rate(at.axis(), rate),
    held: |state, at| state.cell.as_ref().map_or(0.0, |cell| cell.target[at.axis()]),
    start: |scene, at| motion(scene, at).map_or(0.0, CellMotion::first_input),
    input: |at| Input::Strain(at.axis()),
});

/// What a component does, where there is a cell.
fn motion(scene: &Scene, at: At) -> Option<CellMotion> {
    scene.cell.as_ref().map(|cell| cell.motion[at.axis()])
}

/// Whether the outside gives the strain under its own name.
fn is_driven(scene: &Scene, at: At) -> bool {
    motion(scene, at) == Some(CellMotion::Driven) && !is_endless(scene, at)
}

/// Whether it reaches a stress.
fn is_served(scene: &Scene, at: At) -> bool {
    motion(scene, at).is_some_and(|motion| motion.servo().is_some())
}

/// Whether it is the shear without end.
fn is_endless(scene: &Scene, at: At) -> bool {
    scene.cell.as_ref().is_some_and(|cell| cell.shear == Some(at.axis()))
}

/// An output of the cell.
const OF_CELL: Row = Row { exists: |scene, _| scene.cell.is_some(), ..OUTPUT };

/// An output of each component.
const OF_COMPONENT: Row = Row { each: Each::Strain, ..OF_CELL };

/// Component of the stress, and that of the strain.
fn tangent(at: At) -> [usize; 2] {
    [at.axis() / 6, at.axis() % 6]
}

/// Variables of the periodic cell, inputs first.
pub(super) static OF_CELLS: [Row; 15] = [
    Row {
        name: "cell.strain",
        description: "strain {axis} of the cell since the scene's time 0, to be reached at the end of the communication step at a \
                      constant rate; logarithmic along an axis, otherwise shear over height; at initialisation taken without motion",
        exists: is_driven,
        write: GIVEN,
        read: |now, at| Value::Real(now.cell(|cell| cell.target[at.axis()])),
        ..OF_COMPONENT
    },
    Row {
        name: "cell.shear",
        each: Each::Shear,
        description: "shear without end of the cell since the scene's time 0, over its height, to be reached at the end of the \
                      communication step at a constant rate",
        exists: is_endless,
        write: GIVEN,
        read: |now, at| Value::Real(now.cell(|cell| cell.target[at.axis()])),
        ..OUTPUT
    },
    Row {
        name: "cell.target_stress",
        description: "stress {axis} of the cell, or mean of the normal ones, that its servo is to reach, tension positive; held in a \
                      communication step, or changing at its rate",
        quantity: Quantity::Pressure,
        exists: is_served,
        write: GIVEN,
        read: |now, at| Value::Real(now.cell(|cell| cell.target[at.axis()])),
        ..OF_COMPONENT
    },
    Row {
        name: "cell.strain",
        description: "strain {axis} of the cell since the scene's time 0: logarithmic along an axis, otherwise shear over height",
        exists: |scene, at| motion(scene, at).is_some_and(|motion| motion != CellMotion::Driven),
        read: |now, at| Value::Real(now.cell(|cell| cell.strain[at.axis()])),
        ..OF_COMPONENT
    },
    Row {
        name: "cell.stress",
        description: "Cauchy stress {axis} of the cell, tension positive: of contacts and bonds between particles, and of velocities \
                      relative to the streaming motion",
        quantity: Quantity::Pressure,
        read: |now, at| Value::Real(now.findings.cell_stress(now.simulation)[at.axis()]),
        ..OF_COMPONENT
    },
    Row {
        name: "cell.servo_error",
        description: "what the stress {axis} of the cell, or the mean stress, lacks of its target",
        quantity: Quantity::Pressure,
        exists: is_served,
        read: |now, at| {
            let stresses = now.findings.cell_stress(now.simulation);
            let served = motion(now.simulation.scene(), at).map_or(0.0, |motion| motion.served(at.axis(), stresses));
            Value::Real(now.cell(|cell| cell.target[at.axis()]) - served)
        },
        ..OF_COMPONENT
    },
    Row {
        name: "cell.mean_stress",
        description: "mean of the Cauchy stress {axis} of the cell over the last communication step",
        quantity: Quantity::Pressure,
        read: |now, at| Value::Real(now.cell(|cell| cell.mean_stress[at.axis()])),
        ..OF_COMPONENT
    },
    Row {
        name: "cell.conjugate_stress",
        description: "mean over the last communication step of the stress that is conjugate to strain {axis}: times the change of a \
                      driven strain and the volume at the start it is the work",
        quantity: Quantity::Pressure,
        read: |now, at| Value::Real(now.cell(|cell| cell.conjugate_stress[at.axis()])),
        ..OF_COMPONENT
    },
    Row {
        name: "cell.work",
        description: "work done by the deformation of the cell on the particles since the start",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        read: |now, _| Value::Real(now.cell(|cell| cell.work)),
        ..OF_CELL
    },
    Row {
        name: "cell.volume",
        description: "volume of the cell",
        quantity: Quantity::Volume,
        minimum: Some(0.0),
        read: |now, _| Value::Real(now.simulation.cell_volume()),
        ..OF_CELL
    },
    Row {
        name: "cell.porosity",
        description: "part of the volume of the cell that no particle fills; overlaps of particles count twice",
        read: |now, _| Value::Real(now.simulation.cell_porosity()),
        ..OF_CELL
    },
    Row {
        name: "cell.coordination",
        description: "contacts of a particle with others in the mean",
        minimum: Some(0.0),
        read: |now, _| Value::Real(now.findings.cell_fabric(now.simulation).coordination),
        ..OF_CELL
    },
    Row {
        name: "cell.fabric",
        description: "mean over the contacts between particles of the product {axis} of the components of their normals",
        read: |now, at| Value::Real(now.findings.cell_fabric(now.simulation).tensor[at.axis()]),
        ..OF_COMPONENT
    },
    Row {
        name: "cell.unbalanced_force",
        description: "mean unbalanced force of the particles over the mean normal force of their contacts, or, where none presses, \
                      the mean force of the bonds: near 0 at rest; 0, too, where nothing holds together",
        minimum: Some(0.0),
        read: |now, _| {
            Value::Real(Some(now.simulation.unbalanced_force()).filter(|ratio| ratio.is_finite()).unwrap_or(0.0))
        },
        ..OF_CELL
    },
    Row {
        name: "cell.stiffness",
        each: Each::Tangent,
        description: "condensed static tangent of the cell: change of its Cauchy stress for each unit of strain ({axis}: the component of \
                      the stress, that of the strain), when everything has come to rest again",
        quantity: Quantity::Pressure,
        follows_inputs_at_start: false,
        exists: |scene, at| {
            let repeats = |component| scene.cell.as_ref().is_some_and(|cell| cell.repeats(component));
            scene.output.stiffness && tangent(at).into_iter().all(repeats)
        },
        read: |now, at| Value::Real(now.findings.cell_stiffness(now.simulation, tangent(at)).unwrap_or(f64::NAN)),
        ..OF_CELL
    },
];
