//! The description of a kind of variable, and what many kinds have in common.

use crate::base::geometry::lattice::STRAINS;
use crate::base::quantity::BoundaryIndex;
use crate::engine::averages::{Content, Sight};
use crate::engine::simulation::{Input, Simulation};
use crate::engine::state::{BondList, BoundaryState, CellState, Exchange, Nodes, State};
use crate::interface::{Findings, Quantity, Value, Variability};
use crate::scene::Scene;

/// Names of the axes in variables.
pub(in crate::interface) const AXES: [&str; 3] = ["x", "y", "z"];

/// Names of the components of a tangent in variables: of the stress, of the strain.
#[rustfmt::skip]
const TANGENTS: [&str; 36] = [
    "xx.xx", "xx.yy", "xx.zz", "xx.xy", "xx.xz", "xx.yz",
    "yy.xx", "yy.yy", "yy.zz", "yy.xy", "yy.xz", "yy.yz",
    "zz.xx", "zz.yy", "zz.zz", "zz.xy", "zz.xz", "zz.yz",
    "xy.xx", "xy.yy", "xy.zz", "xy.xy", "xy.xz", "xy.yz",
    "xz.xx", "xz.yy", "xz.zz", "xz.xy", "xz.xz", "xz.yz",
    "yz.xx", "yz.yy", "yz.zz", "yz.xy", "yz.xz", "yz.yz",
];

/// How many variables a row stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::interface) enum Each {
    /// One: `<name>`.
    Scene,
    /// One for each boundary: `<boundary>.<name>`.
    Boundary,
    /// One for each boundary and axis: `<boundary>.<name>.<axis>`.
    Axis,
    /// One for each node that moves by itself and axis: `<boundary>.node[<number>].<name>.<axis>`.
    Node,
    /// One for the fluid: `<fluid>.<name>`.
    Fluid,
    /// One for the fluid and each axis: `<fluid>.<name>.<axis>`.
    FluidAxis,
    /// One for each cell of its grid: `<fluid>.cell[<number>].<name>`.
    FluidCell,
    /// One for each cell of its grid and axis: `<fluid>.cell[<number>].<name>.<axis>`.
    FluidCellAxis,
    /// One for each node that moves by itself: `<boundary>.node[<number>].<name>`.
    NodeScalar,
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
    /// One for each region and set of particles: `<region>.<name>.<set>`.
    RegionSet,
    /// One for each grid and set of particles: `<grid>.<name>.<set>`.
    GridSet,
    /// One for each cell of a grid: `<grid>.cell[<number>].<name>`.
    Cell,
    /// One for each cell of a grid and axis: `<grid>.cell[<number>].<name>.<axis>`.
    CellAxis,
    /// One for each cell of a grid and component of a symmetric tensor: `<grid>.cell[<number>].<name>.<component>`.
    CellComponent,
    /// One for each cell of a grid and set of particles: `<grid>.cell[<number>].<name>.<set>`.
    CellSet,
    /// One for each component of the strain of the cell: `<name>.<component>`.
    Strain,
    /// One for each component of its stress and each of its strain: `<name>.<component>.<component>`.
    Tangent,
    /// One for a component of the strain that is there once, without it in the name: `<name>`.
    Shear,
    /// One for each probe: `<probe>.<name>`.
    Probe,
    /// One for each probe and axis: `<probe>.<name>.<axis>`.
    ProbeAxis,
}

impl Each {
    /// What tells the variables of a boundary, a region or a cell of a grid apart; one empty name where there is one.
    pub(super) fn names(self, scene: &Scene) -> Vec<&str> {
        match self {
            Self::RegionSet | Self::GridSet | Self::CellSet => scene.sets.iter().map(String::as_str).collect(),
            _ => self.fixed_names().to_vec(),
        }
    }

    /// What an element of it is called, of which there are many, each with a number.
    pub(super) fn element(self) -> Option<&'static str> {
        match self {
            Self::Node | Self::NodeScalar => Some("node"),
            Self::Cell | Self::CellAxis | Self::CellComponent | Self::CellSet => Some("cell"),
            Self::FluidCell | Self::FluidCellAxis => Some("cell"),
            _ => None,
        }
    }

    /// The same where it is the same in every scene.
    fn fixed_names(self) -> &'static [&'static str] {
        match self {
            Self::Axis | Self::Node | Self::RegionAxis | Self::CellAxis | Self::ProbeAxis => &AXES,
            Self::FluidAxis | Self::FluidCellAxis => &AXES,
            Self::Component | Self::CellComponent | Self::Strain => &STRAINS,
            Self::Tangent => &TANGENTS,
            Self::Shear => &[""; 6],
            Self::Scene
            | Self::Boundary
            | Self::Fluid
            | Self::FluidCell
            | Self::NodeScalar
            | Self::Region
            | Self::Cell
            | Self::RegionSet
            | Self::GridSet
            | Self::CellSet
            | Self::Insertion
            | Self::Outlet
            | Self::Meter
            | Self::Probe => &[""],
        }
    }
}

/// Which of the variables of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::interface) struct At {
    /// The boundary.
    pub(super) boundary: BoundaryIndex,
    /// The node of a mesh or the cell of a grid, from 0.
    element: u32,
    /// The region, grid, insertion, outlet, flow meter or probe.
    place: u32,
    /// The axis or component.
    axis: u32,
}

impl At {
    /// The place of a variable that is of no row, or of the whole scene.
    pub(in crate::interface) const NOWHERE: Self = Self { boundary: BoundaryIndex(0), element: 0, place: 0, axis: 0 };

    /// At this boundary.
    pub(super) fn at_boundary(self, boundary: BoundaryIndex) -> Self {
        Self { boundary, ..self }
    }

    /// At this node or cell of a grid.
    pub(super) fn at_element(self, element: usize) -> Self {
        Self { element: element as u32, ..self }
    }

    /// At this region, grid, insertion, outlet, flow meter or probe.
    pub(super) fn at_place(self, place: usize) -> Self {
        Self { place: place as u32, ..self }
    }

    /// Along this axis.
    pub(super) fn along(self, axis: usize) -> Self {
        Self { axis: axis as u32, ..self }
    }

    /// The node of a mesh or the cell of a grid, from 0.
    pub(in crate::interface) fn element(self) -> usize {
        self.element as usize
    }

    /// The region, grid, insertion, outlet, flow meter or probe.
    pub(in crate::interface) fn place(self) -> usize {
        self.place as usize
    }

    /// The axis or component.
    pub(in crate::interface) fn axis(self) -> usize {
        self.axis as usize
    }
}

/// A simulation, and what has been found of it.
#[derive(Clone, Copy)]
pub(in crate::interface) struct Present<'a> {
    /// The simulation.
    pub(in crate::interface) simulation: &'a Simulation,
    /// What took a pass to find.
    pub(in crate::interface) findings: &'a Findings,
}

impl Present<'_> {
    /// The state of a boundary.
    pub(super) fn boundary(&self, at: At) -> &BoundaryState {
        &self.simulation.state().boundaries[at.boundary.index()]
    }

    /// A component of a row of a node.
    pub(super) fn node(&self, at: At, rows: fn(&Nodes) -> &[[f64; 4]]) -> Value {
        let nodes = self.simulation.state().nodes_of(at.boundary.index());
        Value::Real(nodes.map_or(0.0, |nodes| rows(nodes)[at.element()][at.axis()]))
    }

    /// The particles in a region.
    pub(super) fn content(&self, at: At) -> Content {
        self.findings.content(self.simulation, at.place())
    }

    /// The particles in a cell of a grid.
    pub(super) fn cell_content(&self, at: At) -> Content {
        self.findings.of_cells(self.simulation, at.place()).contents(self.simulation)[at.element()]
    }

    /// What a probe sees.
    pub(super) fn sight(&self, at: At) -> Sight {
        self.findings.sight(self.simulation, at.place())
    }

    /// What is known of particles that come and go, in a scene that has any.
    pub(super) fn exchanged<T: Default>(&self, read: impl FnOnce(&Exchange) -> T) -> T {
        self.simulation.state().exchange.as_ref().map(read).unwrap_or_default()
    }

    /// What is known of the cell, in a scene that has one.
    pub(super) fn cell(&self, read: impl FnOnce(&CellState) -> f64) -> f64 {
        self.simulation.state().cell.as_ref().map_or(0.0, read)
    }

    /// The lists of bonds.
    pub(super) fn bonds(&self) -> &[BondList] {
        &self.simulation.state().bonds
    }
}

/// How an input is given.
#[derive(Clone, Copy)]
pub(in crate::interface) struct Write {
    /// Takes a value for the next communication step.
    pub(in crate::interface) set: fn(&mut Simulation, At, f64),
    /// Takes the rate at which the value goes on in the next communication step.
    pub(in crate::interface) set_rate: fn(&mut Simulation, At, f64),
    /// The value last given.
    pub(in crate::interface) held: fn(&State, At) -> f64,
    /// The value before anything is given.
    pub(super) start: fn(&Scene, At) -> f64,
    /// Which input of the simulation it is.
    pub(in crate::interface) input: fn(At) -> Input,
}

/// Reads a rate at the present time, per second.
pub(in crate::interface) type ReadRate = fn(&State, At) -> f64;

/// A kind of variable.
pub(in crate::interface) struct Row {
    /// Its name, behind that of what it belongs to.
    pub(in crate::interface) name: &'static str,
    /// What it belongs to.
    pub(in crate::interface) each: Each,
    /// What it is, with its sign. `{boundary}`, `{region}`, `{owner}` and `{axis}` stand for the names,
    /// `{element}` for the number of a node or a cell.
    pub(super) description: &'static str,
    /// What is measured, and with it the unit and the type.
    pub(in crate::interface) quantity: Quantity,
    /// When it changes.
    pub(super) variability: Variability,
    /// Its lower bound, where nature sets one.
    pub(super) minimum: Option<f64>,
    /// Whether its value at the start follows from the start values of the inputs.
    pub(super) follows_inputs_at_start: bool,
    /// Whether the scene has it.
    pub(super) exists: fn(&Scene, At) -> bool,
    /// Its value, where it is a constant.
    pub(super) constant: Option<fn(&Scene, At) -> f64>,
    /// How it is given, where it is an input.
    pub(in crate::interface) write: Option<Write>,
    /// Its present value.
    pub(in crate::interface) read: fn(Present, At) -> Value,
    /// Its rate, where that is known.
    pub(in crate::interface) rate: Option<ReadRate>,
}

/// What most rows have in common: an output that every scene has.
pub(in crate::interface) const OUTPUT: Row = Row {
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
    rate: None,
};

/// An output of each boundary and axis.
pub(in crate::interface) const OF_AXIS: Row = Row { each: Each::Axis, ..OUTPUT };

/// A number of things.
pub(in crate::interface) const COUNT: Row =
    Row { quantity: Quantity::Count, variability: Variability::Discrete, minimum: Some(0.0), ..OUTPUT };

/// A number of things as a value.
pub(super) fn count(number: u64) -> Value {
    Value::Integer(i32::try_from(number).unwrap_or(i32::MAX))
}
