//! Variables of each cell of the grids, and the fields that they are together.

use super::row::{At, COUNT, Each, OUTPUT, Present, Row, count};
use crate::base::geometry::lattice::STRAIN_PLACES;
use crate::engine::averages::lacey_index;
use crate::engine::simulation::Simulation;
use crate::interface::{Findings, Quantity, Value};
use crate::scene::{GridOutput, Scene};

/// What most outputs of cells have in common.
const OF_CELL: Row = Row { each: Each::Cell, ..OUTPUT };

/// Variables of each cell of a grid.
pub(super) static OF_GRIDS: [Row; 8] = [
    Row {
        name: "porosity",
        description: "part of the volume of cell {element} of {owner} that no particle fills; overlaps of particles count twice",
        exists: |scene, at| tells(scene, at, GridOutput::Porosity),
        read: |now, at| Value::Real(1.0 - now.cell_content(at).solid / volume(now, at)),
        ..OF_CELL
    },
    Row {
        name: "density",
        description: "mass over the volume of cell {element} of {owner}, of each particle by the part of its volume inside",
        quantity: Quantity::Density,
        minimum: Some(0.0),
        exists: |scene, at| tells(scene, at, GridOutput::Density),
        read: |now, at| Value::Real(now.cell_content(at).mass / volume(now, at)),
        ..OF_CELL
    },
    Row {
        name: "velocity",
        each: Each::CellAxis,
        description: "mean velocity of the mass in cell {element} of {owner} along {axis}; 0 where there is none",
        quantity: Quantity::Velocity,
        exists: |scene, at| tells(scene, at, GridOutput::Velocity),
        read: |now, at| Value::Real(now.cell_content(at).velocity[at.axis()]),
        ..OF_CELL
    },
    Row {
        name: "stress",
        each: Each::CellComponent,
        description: "mean stress in cell {element} of {owner}, component {axis}, tension positive: of contacts and bonds by the part \
                      of their branch inside, and of the velocities less their mean",
        quantity: Quantity::Pressure,
        exists: |scene, at| tells(scene, at, GridOutput::Stress),
        read: |now, at| {
            let cells = now.findings.of_cells(now.simulation, at.place());
            Value::Real(cells.stress(now.simulation, at.element(), STRAIN_PLACES[at.axis()]))
        },
        ..OF_CELL
    },
    Row {
        name: "granular_temperature",
        description: "a third of the mean square of the velocity in cell {element} of {owner} less the mean velocity, by mass",
        quantity: Quantity::GranularTemperature,
        minimum: Some(0.0),
        exists: |scene, at| tells(scene, at, GridOutput::GranularTemperature),
        read: |now, at| Value::Real(now.cell_content(at).granular_temperature()),
        ..OF_CELL
    },
    Row {
        name: "temperature",
        description: "temperature in cell {element} of {owner}, mean by heat capacity; 0 where there is no particle",
        quantity: Quantity::Temperature,
        minimum: Some(0.0),
        exists: |scene, at| tells(scene, at, GridOutput::Temperature),
        read: |now, at| Value::Real(now.cell_content(at).temperature),
        ..OF_CELL
    },
    Row {
        name: "count",
        each: Each::Cell,
        description: "number of particles whose centre is in cell {element} of {owner}, a clump as one",
        exists: |scene, at| tells(scene, at, GridOutput::Count),
        read: |now, at| {
            count(now.findings.of_cells(now.simulation, at.place()).counts(now.simulation)[at.element()].all)
        },
        ..COUNT
    },
    Row {
        name: "count_by_set",
        each: Each::CellSet,
        description: "number of particles of the set {axis} whose centre is in cell {element} of {owner}, a clump as one",
        exists: |scene, at| tells(scene, at, GridOutput::CountBySet),
        read: |now, at| {
            let counts = now.findings.of_cells(now.simulation, at.place()).counts(now.simulation);
            count(counts[at.element()].of_set[at.axis()])
        },
        ..COUNT
    },
];

/// Variables of a grid as a whole.
pub(super) static OF_WHOLE_GRIDS: [Row; 1] = [Row {
    name: "mixing_index",
    each: Each::GridSet,
    description: "Lacey's index of how far the particles of the set {axis} are mixed with the others over the cells of {owner}: 0 \
                  apart, about 1 at random; 0 where cells cannot tell",
    exists: |scene, at| tells(scene, at, GridOutput::MixingIndex),
    read: |now, at| {
        let counts = now.findings.of_cells(now.simulation, at.place()).counts(now.simulation);
        Value::Real(lacey_index(counts.iter().map(|cell| [cell.of_set[at.axis()], cell.all])))
    },
    ..OUTPUT
}];

/// Whether a grid tells this of its cells.
fn tells(scene: &Scene, at: At, output: GridOutput) -> bool {
    scene.grids[at.place()].tells(output)
}

/// Volume of a cell \[m³\].
fn volume(now: Present, at: At) -> f64 {
    now.simulation.scene().grids[at.place()].shape.cell_volume()
}

/// A quantity in all cells of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name, that of the variables of the cells.
    pub name: &'static str,
    /// What is measured, and with it the unit and the type.
    pub quantity: Quantity,
    /// Names of its components; one empty name where it has one number.
    pub components: Vec<String>,
    /// Its numbers, cell by cell.
    pub values: Vec<f64>,
}

/// What the scene tells of the cells of a grid, as the variables have it.
pub fn fields(simulation: &Simulation, grid: usize) -> Vec<Field> {
    let (scene, findings, at) = (simulation.scene(), Findings::default(), At::NOWHERE.at_place(grid));
    let now = Present { simulation, findings: &findings };
    let field = |row: &Row| {
        let components: Vec<String> = row.each.names(scene).into_iter().map(str::to_owned).collect();
        let cells = 0..scene.grids[grid].shape.cells();
        let numbers = |cell: usize| (0..components.len()).map(move |axis| at.at_element(cell).along(axis));
        let values = cells.flat_map(numbers).map(|at| (row.read)(now, at).number()).collect();
        Field { name: row.name, quantity: row.quantity, components, values }
    };
    OF_GRIDS.iter().filter(|row| (row.exists)(scene, at)).map(field).collect()
}
