//! What the outside may give and know: one row for each kind of variable.
//!
//! A row says everything of its variables: name, unit, when a scene has them, how they are read and written. The unit's
//! description, the unit, its page and `history.csv` follow from the rows; nothing else lists variables.

use super::losses::{self, LOSSES};
use super::{Causality, Findings, Quantity, Value, Variability, Variable};
use crate::averages::Content;
use crate::dual::Slopes;
use crate::exchange::{Amount, Outside};
use crate::motion::Seen;
use crate::quantity::BoundaryIndex;
use crate::scene::Scene;
use crate::state::{BondList, BoundaryState, Exchange, Loss, Nodes, State};
use crate::step::{BoundaryDerivatives, Simulation};

/// Names of the axes in variables.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Names of the components of a symmetric tensor in variables.
const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "zx"];

/// Row and column of each.
const COMPONENT_PLACES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]];

/// How many variables a row stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Each {
    /// One: `<name>`.
    Scene,
    /// One for each boundary: `<boundary>.<name>`.
    Boundary,
    /// One for each boundary and axis: `<boundary>.<name>.<axis>`.
    Axis,
    /// One for each node that moves by itself and axis: `<boundary>.node[<number>].<name>.<axis>`.
    Node,
    /// One for each insertion: `<insertion>.<name>`.
    Insertion,
    /// One for each outlet: `<outlet>.<name>`.
    Outlet,
    /// One for each flow meter: `<flow_meter>.<name>`.
    Meter,
    /// One for each region: `<region>.<name>`.
    Region,
    /// One for each region and axis: `<region>.<name>.<axis>`.
    RegionAxis,
    /// One for each region and component of a symmetric tensor: `<region>.<name>.<component>`.
    Component,
}

impl Each {
    /// What tells the variables of a boundary or a region apart; one empty name where there is one.
    fn names(self) -> &'static [&'static str] {
        match self {
            Self::Axis | Self::Node | Self::RegionAxis => &AXES,
            Self::Component => &COMPONENTS,
            Self::Scene | Self::Boundary | Self::Region | Self::Insertion | Self::Outlet | Self::Meter => &[""],
        }
    }
}

/// Which of the variables of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct At {
    /// The boundary.
    boundary: BoundaryIndex,
    /// The node, from 0.
    node: usize,
    /// The region, insertion, outlet or flow meter.
    place: usize,
    /// The axis or component.
    axis: usize,
}

/// A simulation, and what has been found of it.
#[derive(Clone, Copy)]
pub(super) struct Present<'a> {
    /// The simulation.
    pub(super) simulation: &'a Simulation,
    /// What took a pass to find.
    pub(super) findings: &'a Findings,
}

impl Present<'_> {
    /// The state of a boundary.
    fn boundary(&self, at: At) -> &BoundaryState {
        &self.simulation.state().boundaries[at.boundary.index()]
    }

    /// A component of a row of a node.
    fn node(&self, at: At, rows: fn(&Nodes) -> &[[f64; 4]]) -> Value {
        let nodes = self.simulation.state().nodes_of(at.boundary.index());
        Value::Real(nodes.map_or(0.0, |nodes| rows(nodes)[at.node][at.axis]))
    }

    /// The particles in a region.
    fn content(&self, at: At) -> Content {
        self.findings.content(self.simulation, at.place)
    }

    /// What is known of particles that come and go, in a scene that has any.
    fn exchanged<T: Default>(&self, read: impl FnOnce(&Exchange) -> T) -> T {
        self.simulation.state().exchange.as_ref().map(read).unwrap_or_default()
    }

    /// The lists of bonds.
    fn bonds(&self) -> &[BondList] {
        &self.simulation.state().bonds
    }
}

/// How an input is given.
#[derive(Clone, Copy)]
pub(super) struct Write {
    /// Takes a value for the next communication step.
    pub(super) set: fn(&mut Simulation, At, f64),
    /// Takes the rate at which the value goes on in the next communication step.
    pub(super) set_rate: fn(&mut Simulation, At, f64),
    /// The value last given.
    pub(super) held: fn(&State, At) -> f64,
    /// The value before anything is given.
    start: fn(&Scene, At) -> f64,
    /// Which of the axes of its boundary: along x, y, z, then about them; none where it is of something else.
    pub(super) axis: fn(At) -> Option<(BoundaryIndex, usize)>,
}

/// Reads how a variable of a boundary changes with inputs.
pub(super) type ReadSlopes = fn(&[BoundaryDerivatives], At) -> Slopes;

/// A kind of variable.
pub(super) struct Row {
    /// Its name, behind that of what it belongs to.
    pub(super) name: &'static str,
    /// What it belongs to.
    pub(super) each: Each,
    /// What it is, with its sign. `{boundary}`, `{region}`, `{owner}` and `{axis}` stand for the names.
    description: &'static str,
    /// What is measured, and with it the unit and the type.
    pub(super) quantity: Quantity,
    /// When it changes.
    variability: Variability,
    /// Its lower bound, where nature sets one.
    minimum: Option<f64>,
    /// Whether its value at the start follows from the start values of the inputs.
    follows_inputs_at_start: bool,
    /// Whether the scene has it.
    exists: fn(&Scene, At) -> bool,
    /// Its value, where it is a constant.
    constant: Option<fn(&Scene, At) -> f64>,
    /// How it is given, where it is an input.
    pub(super) write: Option<Write>,
    /// Its present value.
    pub(super) read: fn(Present, At) -> Value,
    /// How it changes with inputs, where that is followed.
    pub(super) slopes: Option<ReadSlopes>,
    /// Whether its rate is known.
    pub(super) has_rate: bool,
}

/// What most rows have in common: an output that every scene has.
const OUTPUT: Row = Row {
    name: "",
    each: Each::Scene,
    description: "",
    quantity: Quantity::Ratio,
    variability: Variability::Continuous,
    minimum: None,
    follows_inputs_at_start: true,
    exists: |_, _| true,
    constant: None,
    write: None,
    read: |_, _| Value::Real(0.0),
    slopes: None,
    has_rate: false,
};

/// An output of each boundary and axis.
const OF_AXIS: Row = Row { each: Each::Axis, ..OUTPUT };

/// A number of things.
const COUNT: Row = Row { quantity: Quantity::Count, variability: Variability::Discrete, minimum: Some(0.0), ..OUTPUT };

/// How the input of an axis is given: `FIRST` is 0 along axes and 3 about them.
const fn given<const FIRST: usize>() -> Option<Write> {
    Some(Write {
        set: |simulation, at, value| simulation.set_input(at.boundary, FIRST + at.axis, value),
        set_rate: |simulation, at, rate| simulation.set_input_rate(at.boundary, FIRST + at.axis, rate),
        held: |state, at| state.boundaries[at.boundary.index()].target[FIRST + at.axis],
        start: |scene, at| scene.boundaries[at.boundary.index()].axes[FIRST + at.axis].first_input(),
        axis: |at| Some((at.boundary, FIRST + at.axis)),
    })
}

/// What the outside sees of an axis: 0 to 2 along x, y, z, 3 to 5 about them.
fn seen(scene: &Scene, at: At, first: usize) -> Seen {
    scene.boundaries[at.boundary.index()].axes[first + at.axis].seen()
}

/// Whether the outside moves it.
fn is_driven(scene: &Scene, at: At, first: usize) -> bool {
    seen(scene, at, first) == Seen::Input
}

/// Whether its displacement follows from something else than an input of that name.
fn moves_by_itself(scene: &Scene, at: At, first: usize) -> bool {
    matches!(seen(scene, at, first), Seen::Place | Seen::PlaceAndRate | Seen::Load | Seen::Rate | Seen::Servo)
}

/// Whether forces move it.
fn is_free(scene: &Scene, at: At, first: usize) -> bool {
    matches!(seen(scene, at, first), Seen::PlaceAndRate | Seen::Load)
}

/// Whether the outside loads it.
fn is_loaded(scene: &Scene, at: At, first: usize) -> bool {
    seen(scene, at, first) == Seen::Load
}

/// Whether the outside gives its velocity.
fn is_steered(scene: &Scene, at: At, first: usize) -> bool {
    seen(scene, at, first) == Seen::Rate
}

/// Whether a servo moves it.
fn is_served(scene: &Scene, at: At) -> bool {
    seen(scene, at, 0) == Seen::Servo
}

/// A number of things as a value.
fn count(number: u64) -> Value {
    Value::Integer(i32::try_from(number).unwrap_or(i32::MAX))
}

/// Mass of a boundary: of its particles, or as the scene gives it; 0 for one that has none \[kg\].
fn mass(scene: &Scene, at: At) -> f64 {
    let boundary = &scene.boundaries[at.boundary.index()];
    let members = boundary.shape.members().iter();
    let particles = members.filter_map(|&member| scene.particles.get(member as usize));
    particles.map(crate::scene::Particle::mass).sum::<f64>() + boundary.body.mass
}

/// Variables of each boundary, inputs first.
static OF_BOUNDARIES: [Row; 19] = [
    Row {
        name: "displacement",
        description: "displacement of {boundary} along {axis} since the scene's time 0, to be reached at the end of the \
                      communication step; at initialisation taken without motion",
        quantity: Quantity::Length,
        exists: |scene, at| is_driven(scene, at, 0),
        write: given::<0>(),
        read: |now, at| Value::Real(now.boundary(at).target[at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "rotation",
        description: "rotation of {boundary} about {axis} since the scene's time 0, to be reached at the end of the \
                      communication step; at initialisation taken without motion",
        quantity: Quantity::Angle,
        exists: |scene, at| is_driven(scene, at, 3),
        write: given::<3>(),
        read: |now, at| Value::Real(now.boundary(at).target[3 + at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "velocity",
        description: "velocity of {boundary} along {axis}; held in a communication step, or the mean of what changes at its rate",
        quantity: Quantity::Velocity,
        exists: |scene, at| is_steered(scene, at, 0),
        write: given::<0>(),
        read: |now, at| Value::Real(now.boundary(at).target[at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "angular_velocity",
        description: "angular velocity of {boundary} about {axis}; held in a communication step, or the mean of what changes \
                      at its rate",
        quantity: Quantity::AngularVelocity,
        exists: |scene, at| is_steered(scene, at, 3),
        write: given::<3>(),
        read: |now, at| Value::Real(now.boundary(at).target[3 + at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "target_force",
        description: "force of the particles on {boundary} along {axis} that its servo is to reach; held in a communication \
                      step, or changing at its rate",
        quantity: Quantity::Force,
        exists: |scene, at| is_served(scene, at),
        write: given::<0>(),
        read: |now, at| Value::Real(now.boundary(at).target[at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "applied_force",
        description: "force that the outside lays on {boundary} along {axis}, without its weight; held in a communication \
                      step, or changing at its rate",
        quantity: Quantity::Force,
        exists: |scene, at| is_loaded(scene, at, 0),
        write: given::<0>(),
        read: |now, at| Value::Real(now.boundary(at).target[at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "applied_moment",
        description: "moment that the outside lays on {boundary} about {axis} through its moved reference point; held in a \
                      communication step, or changing at its rate",
        quantity: Quantity::Torque,
        exists: |scene, at| is_loaded(scene, at, 3),
        write: given::<3>(),
        read: |now, at| Value::Real(now.boundary(at).target[3 + at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "displacement",
        description: "displacement of {boundary} along {axis} since the scene's time 0",
        quantity: Quantity::Length,
        follows_inputs_at_start: false,
        exists: |scene, at| moves_by_itself(scene, at, 0),
        read: |now, at| Value::Real(now.boundary(at).displacement[at.axis]),
        slopes: Some(|all, at| all[at.boundary.index()].displacement[at.axis]),
        has_rate: true,
        ..OF_AXIS
    },
    Row {
        name: "rotation",
        description: "rotation of {boundary} about {axis} since the scene's time 0",
        quantity: Quantity::Angle,
        follows_inputs_at_start: false,
        exists: |scene, at| moves_by_itself(scene, at, 3),
        read: |now, at| Value::Real(now.boundary(at).rotation[at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "velocity",
        description: "velocity of {boundary} along {axis}",
        quantity: Quantity::Velocity,
        follows_inputs_at_start: false,
        exists: |scene, at| is_free(scene, at, 0),
        read: |now, at| Value::Real(now.boundary(at).velocity[at.axis]),
        slopes: Some(|all, at| all[at.boundary.index()].velocity[at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "angular_velocity",
        description: "angular velocity of {boundary} about {axis}",
        quantity: Quantity::AngularVelocity,
        follows_inputs_at_start: false,
        exists: |scene, at| is_free(scene, at, 3),
        read: |now, at| Value::Real(now.boundary(at).angular_velocity[at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "force",
        description: "force of the particles on {boundary} along {axis}",
        quantity: Quantity::Force,
        read: |now, at| Value::Real(now.boundary(at).force[at.axis]),
        slopes: Some(|all, at| all[at.boundary.index()].force[at.axis]),
        has_rate: true,
        ..OF_AXIS
    },
    Row {
        name: "moment",
        description: "moment of the particles on {boundary} about {axis} through its moved reference point",
        quantity: Quantity::Torque,
        read: |now, at| Value::Real(now.boundary(at).moment[at.axis]),
        slopes: Some(|all, at| all[at.boundary.index()].moment[at.axis]),
        has_rate: true,
        ..OF_AXIS
    },
    Row {
        name: "servo_error",
        description: "what the force of the particles on {boundary} along {axis} lacks of its target",
        quantity: Quantity::Force,
        exists: |scene, at| is_served(scene, at),
        read: |now, at| Value::Real(now.boundary(at).target[at.axis] - now.boundary(at).force[at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "mean_force",
        description: "force of the particles on {boundary} along {axis}, mean over the last communication step",
        quantity: Quantity::Force,
        read: |now, at| Value::Real(now.boundary(at).mean_force[at.axis]),
        slopes: Some(|all, at| all[at.boundary.index()].mean_force[at.axis]),
        ..OF_AXIS
    },
    Row {
        name: "mean_moment",
        description: "moment of the particles on {boundary} about {axis}, mean over the last communication step",
        quantity: Quantity::Torque,
        read: |now, at| Value::Real(now.boundary(at).mean_moment[at.axis]),
        slopes: Some(|all, at| all[at.boundary.index()].mean_moment[at.axis]),
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
            Value::Real(found.map_or(f64::NAN, |stiffness| stiffness[at.axis]))
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
];

/// An output of each node and axis.
const OF_NODE: Row = Row { each: Each::Node, quantity: Quantity::Force, ..OUTPUT };

/// Variables of each node that moves by itself, inputs first.
static OF_NODES: [Row; 3] = [
    Row {
        name: "displacement",
        description: "displacement of node {node} of {boundary} along {axis} since the scene's time 0, to be reached at the end of \
                      the communication step; at initialisation taken without motion",
        quantity: Quantity::Length,
        write: Some(Write {
            set: |simulation, at, value| simulation.set_node(at.boundary, (at.node, at.axis), value),
            set_rate: |simulation, at, rate| simulation.set_node_rate(at.boundary, (at.node, at.axis), rate),
            held: |state, at| state.nodes_of(at.boundary.index()).map_or(0.0, |nodes| nodes.target[at.node][at.axis]),
            start: |_, _| 0.0,
            axis: |_| None,
        }),
        read: |now, at| now.node(at, |nodes| &nodes.target),
        ..OF_NODE
    },
    Row {
        name: "force",
        description: "force of the particles on {boundary} along {axis}, the part of node {node}",
        read: |now, at| now.node(at, |nodes| &nodes.force),
        ..OF_NODE
    },
    Row {
        name: "mean_force",
        description: "force of the particles on {boundary} along {axis}, the part of node {node}, mean over the last communication \
                      step",
        read: |now, at| now.node(at, |nodes| &nodes.mean_force),
        ..OF_NODE
    },
];

/// What most outputs of regions have in common.
const OF_REGION: Row = Row { each: Each::Region, ..OUTPUT };

/// Variables of each region.
static OF_REGIONS: [Row; 6] = [
    Row {
        name: "stress",
        each: Each::Component,
        description: "mean stress in {region}, component {axis}, tension positive: of contacts and bonds by the part of their \
                      branch inside, and of the velocities less their mean",
        quantity: Quantity::Pressure,
        read: |now, at| Value::Real(now.findings.stress(now.simulation, at.place, COMPONENT_PLACES[at.axis])),
        ..OF_REGION
    },
    Row {
        name: "porosity",
        description: "part of the volume of {region} that no particle fills; overlaps of particles count twice",
        read: |now, at| {
            let volume = now.simulation.scene().regions[at.place].shape.volume();
            Value::Real(1.0 - now.content(at).solid / volume)
        },
        ..OF_REGION
    },
    Row {
        name: "coordination",
        description: "contacts of a particle whose centre is in {region}, in the mean; those at boundaries count",
        minimum: Some(0.0),
        read: |now, at| Value::Real(now.findings.coordination(now.simulation, at.place)),
        ..OF_REGION
    },
    Row {
        name: "temperature",
        description: "a third of the mean square of the velocity in {region} less the mean velocity, by mass",
        quantity: Quantity::GranularTemperature,
        minimum: Some(0.0),
        read: |now, at| Value::Real(now.content(at).temperature()),
        ..OF_REGION
    },
    Row {
        name: "mass",
        description: "mass in {region}, of each particle by the part of its volume inside",
        quantity: Quantity::Mass,
        minimum: Some(0.0),
        read: |now, at| Value::Real(now.content(at).mass),
        ..OF_REGION
    },
    Row {
        name: "velocity",
        each: Each::RegionAxis,
        description: "mean velocity of the mass in {region} along {axis}; 0 where there is none",
        quantity: Quantity::Velocity,
        read: |now, at| Value::Real(now.content(at).velocity[at.axis]),
        ..OF_REGION
    },
];

/// The rate of an insertion, as it is given.
const RATE: Row = Row {
    name: "rate",
    each: Each::Insertion,
    quantity: Quantity::MassFlow,
    minimum: Some(0.0),
    write: Some(Write {
        set: |simulation, at, value| simulation.set_insertion_rate(at.place, value),
        set_rate: |simulation, at, rate| simulation.set_insertion_rate_of_rate(at.place, rate),
        held: |state, at| state.exchange.as_ref().map_or(0.0, |exchange| exchange.feeds[at.place].rate),
        start: |scene, at| scene.insertions[at.place].rate().unwrap_or(0.0),
        axis: |_| None,
    }),
    read: |now, at| Value::Real(now.exchanged(|exchange| exchange.feeds[at.place].rate)),
    ..OUTPUT
};

/// A number of particles that came, went or passed since the start.
const EXCHANGED: Row = Row { name: "count", follows_inputs_at_start: false, ..COUNT };

/// Their mass.
const EXCHANGED_MASS: Row = Row { name: "mass", quantity: Quantity::Mass, follows_inputs_at_start: false, ..OUTPUT };

/// Variables of each insertion.
static OF_INSERTIONS: [Row; 4] = [
    Row {
        description: "mass that comes by {owner} in each second, held in a communication step, or the mean of what changes at its rate",
        exists: |scene, at| matches!(scene.insertions[at.place].amount, Amount::MassRate(_)),
        ..RATE
    },
    Row {
        description: "number of particles that come by {owner} in each second, held in a communication step, or the mean of what \
                      changes at its rate",
        quantity: Quantity::CountRate,
        exists: |scene, at| matches!(scene.insertions[at.place].amount, Amount::CountRate(_)),
        ..RATE
    },
    Row {
        each: Each::Insertion,
        description: "number of particles that came by {owner} since the start",
        read: |now, at| count(now.exchanged(|exchange| exchange.feeds[at.place].came.count)),
        ..EXCHANGED
    },
    Row {
        each: Each::Insertion,
        description: "mass of the particles that came by {owner} since the start",
        minimum: Some(0.0),
        read: |now, at| Value::Real(now.exchanged(|exchange| exchange.feeds[at.place].came.mass)),
        ..EXCHANGED_MASS
    },
];

/// Variables of each outlet.
static OF_OUTLETS: [Row; 2] = [
    Row {
        each: Each::Outlet,
        description: "number of particles that {owner} took away since the start",
        read: |now, at| count(now.exchanged(|exchange| exchange.outlets[at.place].count)),
        ..EXCHANGED
    },
    Row {
        each: Each::Outlet,
        description: "mass of the particles that {owner} took away since the start",
        minimum: Some(0.0),
        read: |now, at| Value::Real(now.exchanged(|exchange| exchange.outlets[at.place].mass)),
        ..EXCHANGED_MASS
    },
];

/// Variables of each flow meter.
static OF_METERS: [Row; 3] = [
    Row {
        name: "mass_flow",
        each: Each::Meter,
        description: "mass that passed {owner} towards its front in a second, less what went back: mean over the last communication step",
        quantity: Quantity::MassFlow,
        follows_inputs_at_start: false,
        read: |now, at| Value::Real(now.exchanged(|exchange| exchange.meters[at.place].mass_flow)),
        ..OUTPUT
    },
    Row {
        each: Each::Meter,
        description: "mass that passed {owner} towards its front since the start, less what went back",
        read: |now, at| Value::Real(now.exchanged(|exchange| exchange.meters[at.place].mass)),
        ..EXCHANGED_MASS
    },
    Row {
        each: Each::Meter,
        description: "number of particles that passed {owner} towards its front since the start, less those that went back",
        minimum: None,
        read: |now, at| Value::Integer(now.exchanged(|exchange| exchange.meters[at.place].net_count())),
        ..EXCHANGED
    },
];

/// Variables of what lies outside of the domain.
static OF_DOMAIN: [Row; 2] = [
    Row {
        name: "domain.count",
        description: "number of particles taken away since the start because they were outside of the domain",
        exists: |scene, _| scene.domain.is_some() && scene.outside == Outside::Remove,
        read: |now, _| count(now.exchanged(|exchange| exchange.outside.count)),
        ..EXCHANGED
    },
    Row {
        name: "domain.mass",
        description: "mass of the particles taken away since the start because they were outside of the domain",
        minimum: Some(0.0),
        exists: |scene, _| scene.domain.is_some() && scene.outside == Outside::Remove,
        read: |now, _| Value::Real(now.exchanged(|exchange| exchange.outside.mass)),
        ..EXCHANGED_MASS
    },
];

/// The output of a loss, by its place.
const fn lost<const PLACE: usize>() -> Row {
    let (name, description) = LOSSES[PLACE];
    Row {
        name,
        description,
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| losses::is_booked(scene, Loss::ALL[PLACE]),
        read: |now, _| Value::Real(now.findings.losses(now.simulation)[PLACE]),
        ..OUTPUT
    }
}

/// What each loss took, and what they leave unaccounted.
static OF_LOSSES: [Row; Loss::COUNT + 1] = [
    lost::<0>(),
    lost::<1>(),
    lost::<2>(),
    lost::<3>(),
    lost::<4>(),
    lost::<5>(),
    lost::<6>(),
    lost::<7>(),
    lost::<8>(),
    lost::<9>(),
    lost::<10>(),
    lost::<11>(),
    lost::<12>(),
    Row {
        name: "energy.physical_residual",
        description: "kinetic, elastic and potential energy and all losses since the start, less what boundaries and forces \
                      gave: the error of the time stepping",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| scene.output.losses,
        read: |now, _| {
            let Present { simulation, findings } = now;
            let (kinetic, elastic) = (findings.kinetic(simulation), findings.elastic(simulation).all);
            let residual = simulation.physical_residual_beside(kinetic, elastic, findings.losses(simulation));
            Value::Real(residual.unwrap_or(0.0))
        },
        ..OUTPUT
    },
];

/// Variables of the scene as a whole.
static OF_SCENE: [Row; 13] = [
    Row {
        name: "energy.kinetic",
        description: "kinetic energy of the particles and groups that move freely",
        quantity: Quantity::Energy,
        minimum: Some(0.0),
        follows_inputs_at_start: false,
        read: |now, _| Value::Real(now.findings.kinetic(now.simulation)),
        ..OUTPUT
    },
    Row {
        name: "energy.elastic",
        description: "elastic energy of normal forces, tangential springs and bonds",
        quantity: Quantity::Energy,
        minimum: Some(0.0),
        exists: |scene, _| !(scene.contacts.is_empty() && scene.bonds.is_empty()),
        read: |now, _| Value::Real(now.findings.elastic(now.simulation).all),
        ..OUTPUT
    },
    Row {
        name: "energy.dissipated",
        description: "energy that contacts, bonds and global damping took in and do not hold as elastic energy, since \
                      the start",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| scene.output.energy,
        read: |now, _| {
            let elastic = now.findings.elastic(now.simulation).all;
            Value::Real(now.simulation.dissipated_energy_beside(elastic).unwrap_or(0.0))
        },
        ..OUTPUT
    },
    Row {
        name: "energy.residual",
        description: "change of the kinetic energy less the work of every force, as the time steps do it",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| scene.output.energy,
        read: |now, _| {
            let kinetic = now.findings.kinetic(now.simulation);
            Value::Real(now.simulation.energy_residual_beside(kinetic).unwrap_or(0.0))
        },
        ..OUTPUT
    },
    Row {
        name: "contacts.count",
        description: "number of contacts, those with boundaries included",
        read: |now, _| count(now.findings.contacts(now.simulation)),
        ..COUNT
    },
    Row {
        name: "contacts.near_switch",
        description: "number of contacts near a switch: a ten-thousandth of the overlap more or less would let them begin or end \
                      to slide, or to touch",
        exists: |scene, _| scene.output.near_switch,
        read: |now, _| count(now.findings.near_switch(now.simulation)),
        ..COUNT
    },
    Row {
        name: "overlap.max",
        description: "largest overlap over the smaller radius",
        minimum: Some(0.0),
        read: |now, _| Value::Real(now.findings.largest_overlap(now.simulation)),
        ..OUTPUT
    },
    Row {
        name: "bonds.intact",
        description: "number of living bonds",
        exists: |scene, _| !scene.bonds.is_empty(),
        read: |now, _| count(now.bonds().iter().map(|list| list.first.len() as u64).sum()),
        ..COUNT
    },
    Row {
        name: "bonds.broken",
        description: "number of bonds that broke since the start",
        exists: |scene, _| !scene.bonds.is_empty(),
        read: |now, _| count(now.bonds().iter().map(|list| list.broken).sum()),
        ..COUNT
    },
    Row {
        name: "bonds.elastic_energy",
        description: "elastic energy of the living bonds",
        quantity: Quantity::Energy,
        minimum: Some(0.0),
        exists: |scene, _| !scene.bonds.is_empty(),
        read: |now, _| Value::Real(now.findings.elastic(now.simulation).bonds),
        ..OUTPUT
    },
    Row {
        name: "bonds.dissipated_energy",
        description: "energy that damping and relaxation took of the bonds and that broken bonds released, since the \
                      start",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| !scene.bonds.is_empty(),
        read: |now, _| Value::Real(now.bonds().iter().map(BondList::dissipated).sum()),
        ..OUTPUT
    },
    Row {
        name: "time_step.current",
        description: "the time step",
        quantity: Quantity::Time,
        variability: Variability::Discrete,
        minimum: Some(0.0),
        read: |now, _| Value::Real(now.simulation.state().clock.step),
        ..OUTPUT
    },
    Row {
        name: "time_step.stable",
        description: "the largest stable time step, as last computed",
        quantity: Quantity::Time,
        variability: Variability::Discrete,
        minimum: Some(0.0),
        // where nothing is stiff there is no bound, and infinity is not a value of a variable
        read: |now, _| Value::Real(now.simulation.state().clock.stable.min(f64::MAX)),
        ..OUTPUT
    },
];

/// Where a variable's row stands, and which of the row's variables it is.
#[derive(Clone, Copy)]
pub(super) struct Source {
    /// The row.
    pub(super) row: &'static Row,
    /// Which of its variables.
    pub(super) at: At,
}

impl std::fmt::Debug for Source {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{} {:?}", self.row.name, self.at)
    }
}

impl PartialEq for Source {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.row, other.row) && self.at == other.at
    }
}

/// The variables of a scene, boundary by boundary, then region by region, of what comes, goes and passes, then of the whole.
pub(super) fn variables(scene: &Scene) -> Vec<Variable> {
    let boundaries = (0..scene.boundaries.len()).map(|index| BoundaryIndex(u32::try_from(index).unwrap_or(u32::MAX)));
    let none = At { boundary: BoundaryIndex(0), node: 0, place: 0, axis: 0 };
    let of_boundaries = boundaries.flat_map(|boundary| {
        let nodes = 0..scene.boundaries[boundary.index()].driven_nodes();
        let of_nodes =
            OF_NODES.iter().flat_map(move |row| nodes.clone().map(move |node| (row, At { boundary, node, ..none })));
        OF_BOUNDARIES.iter().map(move |row| (row, At { boundary, ..none })).chain(of_nodes)
    });
    let each = |rows: &'static [Row], count: usize| {
        (0..count).flat_map(move |place| rows.iter().map(move |row| (row, At { place, ..none })))
    };
    let exchange = each(&OF_INSERTIONS, scene.insertions.len())
        .chain(each(&OF_OUTLETS, scene.outlets.len()))
        .chain(each(&OF_METERS, scene.meters.len()));
    let of_scene = OF_SCENE.iter().chain(&OF_DOMAIN).chain(&OF_LOSSES).map(|row| (row, none));
    let places = of_boundaries
        .chain(each(&OF_REGIONS, scene.regions.len()))
        .chain(exchange)
        .chain(of_scene)
        .flat_map(|(row, at)| (0..row.each.names().len()).map(move |axis| Source { row, at: At { axis, ..at } }));
    places.filter(|source| (source.row.exists)(scene, source.at)).map(|source| source.variable(scene)).collect()
}

/// All rows.
#[cfg(test)]
pub(super) fn all() -> impl Iterator<Item = &'static Row> {
    let exchange = OF_INSERTIONS.iter().chain(&OF_OUTLETS).chain(&OF_METERS).chain(&OF_DOMAIN);
    let of_parts = OF_BOUNDARIES.iter().chain(&OF_NODES).chain(&OF_REGIONS).chain(exchange);
    of_parts.chain(&OF_SCENE).chain(&OF_LOSSES)
}

impl Source {
    /// The node that it is of, from 0.
    pub(super) fn node(&self) -> Option<usize> {
        (self.row.each == Each::Node).then_some(self.at.node)
    }

    /// The variable.
    fn variable(self, scene: &Scene) -> Variable {
        let Self { row, at } = self;
        let owner = match row.each {
            Each::Scene => "",
            Each::Boundary | Each::Axis | Each::Node => &scene.boundaries[at.boundary.index()].name,
            Each::Region | Each::RegionAxis | Each::Component => &scene.regions[at.place].name,
            Each::Insertion => &scene.insertions[at.place].name,
            Each::Outlet => &scene.outlets[at.place].name,
            Each::Meter => &scene.meters[at.place].name,
        };
        let own = row.each.names()[at.axis];
        let number = (at.node + 1).to_string();
        let node = if row.each == Each::Node { format!("node[{number}]") } else { String::new() };
        let parts = [owner, &node, row.name, own].into_iter().filter(|part| !part.is_empty());
        let described = row.description.replace("{axis}", own).replace("{node}", &number);
        Variable {
            name: parts.collect::<Vec<_>>().join("."),
            description: described.replace("{boundary}", owner).replace("{region}", owner).replace("{owner}", owner),
            quantity: row.quantity,
            causality: if row.write.is_some() { Causality::Input } else { Causality::Output },
            variability: row.variability,
            start: match row.write {
                Some(write) => Some((write.start)(scene, at)),
                None => row.constant.map(|constant| constant(scene, at)),
            },
            minimum: row.minimum,
            maximum: None,
            follows_inputs_at_start: row.follows_inputs_at_start && row.write.is_none(),
            source: super::Source::Row(self),
        }
    }
}
