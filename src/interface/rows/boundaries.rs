//! Variables of each boundary and of its nodes.

use super::exchange::{EXCHANGED, EXCHANGED_CLUMPS, EXCHANGED_MASS};
use super::row::{At, Each, OF_AXIS, OUTPUT, Row, Write, count};
use crate::engine::simulation::Input;
use crate::engine::state::State;
use crate::interface::{Quantity, Value, Variability};
use crate::laws::motion::ShownVariables;
use crate::scene::{InputCourse, Outside, Scene};

/// How the input of an axis is given: `FIRST` is 0 along axes and 3 about them.
const fn given<const FIRST: usize>() -> Option<Write> {
    Some(Write {
        set: |simulation, at, value| simulation.set_input(at.boundary, FIRST + at.axis(), value),
        set_rate: |simulation, at, rate| simulation.set_input_rate(at.boundary, FIRST + at.axis(), rate),
        held: |state, at| state.boundaries[at.boundary.index()].target[FIRST + at.axis()],
        start: |scene, at| scene.boundaries[at.boundary.index()].axes[FIRST + at.axis()].first_input(),
        input: |at| Input::Axis(at.boundary, FIRST + at.axis()),
    })
}

/// What the outside sees of an axis: 0 to 2 along x, y, z, 3 to 5 about them.
fn seen(scene: &Scene, at: At, first: usize) -> ShownVariables {
    let boundary = &scene.boundaries[at.boundary.index()];
    match boundary.axes[first + at.axis()].seen() {
        // The input is that of the boundary with which it moves.
        ShownVariables::Input | ShownVariables::Rate if boundary.moves_with.is_some() => ShownVariables::Place,
        seen => seen,
    }
}

/// Whether the outside moves it.
fn is_driven(scene: &Scene, at: At, first: usize) -> bool {
    seen(scene, at, first) == ShownVariables::Input
}

/// Whether it takes its acceleration, too.
fn bends(scene: &Scene, at: At) -> bool {
    scene.boundaries[at.boundary.index()].input == InputCourse::Quadratic
}

/// Whether its displacement follows from something else than an input of that name.
fn moves_by_itself(scene: &Scene, at: At, first: usize) -> bool {
    matches!(
        seen(scene, at, first),
        ShownVariables::Place
            | ShownVariables::PlaceAndRate
            | ShownVariables::Load
            | ShownVariables::Rate
            | ShownVariables::Servo
    )
}

/// Whether forces move it.
fn is_free(scene: &Scene, at: At, first: usize) -> bool {
    matches!(seen(scene, at, first), ShownVariables::PlaceAndRate | ShownVariables::Load)
}

/// Whether the outside loads it.
fn is_loaded(scene: &Scene, at: At, first: usize) -> bool {
    seen(scene, at, first) == ShownVariables::Load
}

/// Whether the outside gives its velocity.
fn is_steered(scene: &Scene, at: At, first: usize) -> bool {
    seen(scene, at, first) == ShownVariables::Rate
}

/// Whether a servo moves it.
fn is_served(scene: &Scene, at: At) -> bool {
    seen(scene, at, 0) == ShownVariables::Servo
}

/// Whether it takes away what comes through it.
fn removes(scene: &Scene, at: At) -> bool {
    scene.boundaries[at.boundary.index()].outside == Outside::Remove
}

/// Mass of a boundary: of its particles, or as the scene gives it; 0 for one that has none \[kg\].
fn mass(scene: &Scene, at: At) -> f64 {
    let boundary = &scene.boundaries[at.boundary.index()];
    let members = boundary.shape.members().iter();
    let particles = members.filter_map(|&member| scene.particles.get(member as usize));
    particles.map(crate::scene::Particle::mass).sum::<f64>() + boundary.body.mass
}

/// Rate of the force on a boundary: what it changed by in the last time step, over its length \[N/s\].
fn force_rate(state: &State, at: At) -> f64 {
    state.boundaries[at.boundary.index()].rates(state.clock.last_step)[0][at.axis()]
}

/// Rate of the moment \[N m/s\].
fn moment_rate(state: &State, at: At) -> f64 {
    state.boundaries[at.boundary.index()].rates(state.clock.last_step)[1][at.axis()]
}

/// Variables of each boundary, inputs first.
pub(super) static OF_BOUNDARIES: [Row; 23] = [
    Row {
        name: "displacement",
        description: "displacement of {boundary} along {axis} since the scene's time 0, to be reached at the end of the \
                      communication step; at initialisation taken without motion",
        quantity: Quantity::Length,
        exists: |scene, at| is_driven(scene, at, 0),
        write: given::<0>(),
        read: |now, at| Value::Real(now.boundary(at).target[at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "rotation",
        description: "rotation of {boundary} about {axis} since the scene's time 0, to be reached at the end of the \
                      communication step; at initialisation taken without motion",
        quantity: Quantity::Angle,
        exists: |scene, at| is_driven(scene, at, 3),
        write: given::<3>(),
        read: |now, at| Value::Real(now.boundary(at).target[3 + at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "velocity",
        description: "velocity of {boundary} along {axis}; held in a communication step, or the mean of what changes at its rate",
        quantity: Quantity::Velocity,
        exists: |scene, at| is_steered(scene, at, 0),
        write: given::<0>(),
        read: |now, at| Value::Real(now.boundary(at).target[at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "angular_velocity",
        description: "angular velocity of {boundary} about {axis}; held in a communication step, or the mean of what changes \
                      at its rate",
        quantity: Quantity::AngularVelocity,
        exists: |scene, at| is_steered(scene, at, 3),
        write: given::<3>(),
        read: |now, at| Value::Real(now.boundary(at).target[3 + at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "target_force",
        description: "force of the particles on {boundary} along {axis} that its servo is to reach; held in a communication \
                      step, or changing at its rate",
        quantity: Quantity::Force,
        exists: |scene, at| is_served(scene, at),
        write: given::<0>(),
        read: |now, at| Value::Real(now.boundary(at).target[at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "applied_force",
        description: "force that the outside lays on {boundary} along {axis}, without its weight; held in a communication \
                      step, or changing at its rate",
        quantity: Quantity::Force,
        exists: |scene, at| is_loaded(scene, at, 0),
        write: given::<0>(),
        read: |now, at| Value::Real(now.boundary(at).target[at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "applied_moment",
        description: "moment that the outside lays on {boundary} about {axis} through its moved reference point; held in a \
                      communication step, or changing at its rate",
        quantity: Quantity::Torque,
        exists: |scene, at| is_loaded(scene, at, 3),
        write: given::<3>(),
        read: |now, at| Value::Real(now.boundary(at).target[3 + at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "displacement",
        description: "displacement of {boundary} along {axis} since the scene's time 0",
        quantity: Quantity::Length,
        follows_inputs_at_start: false,
        exists: |scene, at| moves_by_itself(scene, at, 0),
        read: |now, at| Value::Real(now.boundary(at).displacement[at.axis()]),
        rate: Some(|state, at| state.boundaries[at.boundary.index()].velocity[at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "rotation",
        description: "rotation of {boundary} about {axis} since the scene's time 0",
        quantity: Quantity::Angle,
        follows_inputs_at_start: false,
        exists: |scene, at| moves_by_itself(scene, at, 3),
        read: |now, at| Value::Real(now.boundary(at).rotation[at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "velocity",
        description: "velocity of {boundary} along {axis}",
        quantity: Quantity::Velocity,
        follows_inputs_at_start: false,
        exists: |scene, at| is_free(scene, at, 0),
        read: |now, at| Value::Real(now.boundary(at).velocity[at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "angular_velocity",
        description: "angular velocity of {boundary} about {axis}",
        quantity: Quantity::AngularVelocity,
        follows_inputs_at_start: false,
        exists: |scene, at| is_free(scene, at, 3),
        read: |now, at| Value::Real(now.boundary(at).angular_velocity[at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "force",
        description: "force of the particles on {boundary} along {axis}",
        quantity: Quantity::Force,
        read: |now, at| Value::Real(now.boundary(at).force[at.axis()]),
        rate: Some(force_rate),
        ..OF_AXIS
    },
    Row {
        name: "moment",
        description: "moment of the particles on {boundary} about {axis} through its moved reference point",
        quantity: Quantity::Torque,
        read: |now, at| Value::Real(now.boundary(at).moment[at.axis()]),
        rate: Some(moment_rate),
        ..OF_AXIS
    },
    Row {
        name: "servo_error",
        description: "what the force of the particles on {boundary} along {axis} lacks of its target",
        quantity: Quantity::Force,
        exists: |scene, at| is_served(scene, at),
        read: |now, at| Value::Real(now.boundary(at).target[at.axis()] - now.boundary(at).force[at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "mean_force",
        description: "force of the particles on {boundary} along {axis}, mean over the last communication step",
        quantity: Quantity::Force,
        read: |now, at| Value::Real(now.boundary(at).mean_force[at.axis()]),
        rate: Some(force_rate),
        ..OF_AXIS
    },
    Row {
        name: "force_slope",
        description: "slope of the straight line through the force of the particles on {boundary} along {axis} over the last \
                      communication step: 12 times the first moment of the force about the middle of the step over the cube of \
                      its length",
        quantity: Quantity::ForceRate,
        exists: |scene, at| is_driven(scene, at, 0) && bends(scene, at),
        read: |now, at| Value::Real(now.boundary(at).force_slope[at.axis()]),
        ..OF_AXIS
    },
    Row {
        name: "mean_moment",
        description: "moment of the particles on {boundary} about {axis}, mean over the last communication step",
        quantity: Quantity::Torque,
        read: |now, at| Value::Real(now.boundary(at).mean_moment[at.axis()]),
        rate: Some(moment_rate),
        ..OF_AXIS
    },
    Row {
        name: "work",
        each: Each::Boundary,
        description: "work done by {boundary} on the particles since the start",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        read: |now, at| Value::Real(now.boundary(at).work),
        ..OUTPUT
    },
    Row {
        name: "stiffness",
        description: "condensed static stiffness of {boundary} along {axis}: force it takes more for each metre further, when \
                      everything else has come to rest again",
        quantity: Quantity::Stiffness,
        follows_inputs_at_start: false,
        exists: |scene, at| scene.output.stiffness && !is_free(scene, at, 0),
        read: |now, at| {
            let found = now.findings.stiffness(now.simulation, at.boundary);
            Value::Real(found.map_or(f64::NAN, |stiffness| stiffness[at.axis()]))
        },
        ..OF_AXIS
    },
    Row {
        name: "mass",
        each: Each::Boundary,
        description: "mass of {boundary}; its weight and inertia are not in its force",
        quantity: Quantity::Mass,
        variability: Variability::Constant,
        minimum: Some(0.0),
        follows_inputs_at_start: false,
        exists: |scene, at| mass(scene, at) > 0.0,
        constant: Some(mass),
        read: |now, at| Value::Real(mass(now.simulation.scene(), at)),
        ..OUTPUT
    },
    Row {
        name: "outside.count",
        each: Each::Boundary,
        description: "number of particles taken away since the start because they came through {boundary}",
        exists: removes,
        read: |now, at| count(now.exchanged(|exchange| exchange.passed[at.boundary.index()].count)),
        ..EXCHANGED
    },
    Row {
        name: "outside.clumps",
        each: Each::Boundary,
        description: "number of clumps taken away since the start because they came through {boundary}",
        exists: |scene, at| scene.has_clumps() && removes(scene, at),
        read: |now, at| count(now.exchanged(|exchange| exchange.passed[at.boundary.index()].clumps)),
        ..EXCHANGED_CLUMPS
    },
    Row {
        name: "outside.mass",
        each: Each::Boundary,
        description: "mass of the particles taken away since the start because they came through {boundary}",
        minimum: Some(0.0),
        exists: removes,
        read: |now, at| Value::Real(now.exchanged(|exchange| exchange.passed[at.boundary.index()].mass)),
        ..EXCHANGED_MASS
    },
];

/// An output of each node and axis.
pub(super) const OF_NODE: Row = Row { each: Each::Node, quantity: Quantity::Force, ..OUTPUT };

/// Variables of each node that moves by itself, inputs first.
pub(super) static OF_NODES: [Row; 3] = [
    Row {
        name: "displacement",
        description: "displacement of node {element} of {boundary} along {axis} since the scene's time 0, to be reached at the end of \
                      the communication step; at initialisation taken without motion",
        quantity: Quantity::Length,
        write: Some(Write {
            set: |simulation, at, value| simulation.set_node(at.boundary, (at.element(), at.axis()), value),
            set_rate: |simulation, at, rate| simulation.set_node_rate(at.boundary, (at.element(), at.axis()), rate),
            held: |state, at| state.nodes_of(at.boundary.index()).map_or(0.0, |it| it.target[at.element()][at.axis()]),
            start: |_, _| 0.0,
            input: |at| Input::Node(at.boundary, at.element(), at.axis()),
        }),
        read: |now, at| now.node(at, |nodes| &nodes.target),
        ..OF_NODE
    },
    Row {
        name: "force",
        description: "force of the particles on {boundary} along {axis}, the part of node {element}",
        read: |now, at| now.node(at, |nodes| &nodes.force),
        ..OF_NODE
    },
    Row {
        name: "mean_force",
        description: "force of the particles on {boundary} along {axis}, the part of node {element}, mean over the last communication \
                      step",
        read: |now, at| now.node(at, |nodes| &nodes.mean_force),
        ..OF_NODE
    },
];
