//! What the outside may give and know: one row for each kind of variable.
//!
//! A row says everything of its variables: name, unit, when a scene has them, how they are read and written. The unit's
//! description, the unit, its page and `history.csv` follow from the rows; nothing else lists variables.

mod array;
mod boundaries;
mod cell;
mod exchange;
mod fluid;
mod grids;
mod heat;
mod probes;
mod regions;
mod row;
mod scene;
mod traces;

use crate::base::quantity::BoundaryIndex;
use crate::interface::{Causality, Variable};
use crate::scene::Scene;
pub(super) use array::ArrayForm;
use boundaries::{OF_BOUNDARIES, OF_NODES};
use cell::OF_CELLS;
use exchange::{OF_DOMAIN, OF_INSERTIONS, OF_METERS, OF_OUTLETS};
use fluid::{OF_FLUID, OF_FLUID_CELLS};
pub use grids::{Field, fields};
use grids::{OF_GRIDS, OF_WHOLE_GRIDS};
use heat::{OF_HEAT, OF_HEATED, OF_HEATED_NODES};
use probes::OF_PROBES;
use regions::OF_REGIONS;
use row::Each;
pub(super) use row::{At, Present, ReadRate, Row};
use scene::{OF_LOSSES, OF_SCENE};
use traces::OF_TRACES;

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

/// The variables of a scene, boundary by boundary, then region by region, grid by grid, of what comes, goes and passes, then of the whole.
pub(super) fn variables(scene: &Scene) -> Vec<Variable> {
    let boundaries = (0..scene.boundaries.len()).map(|index| BoundaryIndex(u32::try_from(index).unwrap_or(u32::MAX)));
    let none = At::NOWHERE;
    let of_boundaries = boundaries.flat_map(|boundary| {
        let nodes = 0..scene.boundaries[boundary.index()].driven_nodes();
        let of_nodes = OF_NODES
            .iter()
            .chain(&OF_HEATED_NODES)
            .flat_map(move |row| nodes.clone().map(move |node| (row, none.at_boundary(boundary).at_element(node))));
        let all = OF_BOUNDARIES.iter().chain(&OF_HEATED).chain(&OF_TRACES);
        all.map(move |row| (row, none.at_boundary(boundary))).chain(of_nodes)
    });
    let each = |rows: &'static [Row], count: usize| {
        (0..count).flat_map(move |place| rows.iter().map(move |row| (row, none.at_place(place))))
    };
    // By kind, as those of nodes, so that one call reads a field.
    let of_cells = scene.grids.iter().enumerate().flat_map(|(place, grid)| {
        let at = none.at_place(place);
        OF_GRIDS
            .iter()
            .filter(move |row| (row.exists)(scene, at))
            .flat_map(move |row| (0..grid.shape.cells()).map(move |cell| (row, at.at_element(cell))))
    });
    let cells_of_fluid = scene.fluid.iter().filter(|fluid| fluid.grid.is_some()).flat_map(|fluid| {
        let cells = fluid.cells(&scene.grids);
        OF_FLUID_CELLS.iter().flat_map(move |row| (0..cells).map(move |cell| (row, none.at_element(cell))))
    });
    let exchange = each(&OF_INSERTIONS, scene.insertions.len())
        .chain(each(&OF_OUTLETS, scene.outlets.len()))
        .chain(each(&OF_METERS, scene.meters.len()))
        .chain(each(&OF_PROBES, scene.probes.len()));
    let of_scene =
        OF_CELLS.iter().chain(&OF_SCENE).chain(&OF_DOMAIN).chain(&OF_LOSSES).chain(&OF_HEAT).map(|row| (row, none));
    let places = of_boundaries
        .chain(each(&OF_FLUID, usize::from(scene.fluid.is_some())))
        .chain(cells_of_fluid)
        .chain(each(&OF_REGIONS, scene.regions.len()))
        .chain(each(&OF_WHOLE_GRIDS, scene.grids.len()))
        .chain(of_cells)
        .chain(exchange)
        .chain(of_scene)
        .flat_map(|(row, at)| (0..row.each.names(scene).len()).map(move |axis| Source { row, at: at.along(axis) }));
    places.filter(|source| (source.row.exists)(scene, source.at)).map(|source| source.variable(scene)).collect()
}

/// All rows.
#[cfg(test)]
pub(super) fn all() -> impl Iterator<Item = &'static Row> {
    let exchange = OF_INSERTIONS.iter().chain(&OF_OUTLETS).chain(&OF_METERS).chain(&OF_DOMAIN).chain(&OF_PROBES);
    let of_parts = OF_BOUNDARIES
        .iter()
        .chain(&OF_HEATED)
        .chain(&OF_TRACES)
        .chain(&OF_NODES)
        .chain(&OF_HEATED_NODES)
        .chain(&OF_REGIONS)
        .chain(&OF_WHOLE_GRIDS)
        .chain(&OF_GRIDS)
        .chain(exchange);
    of_parts.chain(&OF_FLUID).chain(&OF_FLUID_CELLS).chain(&OF_CELLS).chain(&OF_SCENE).chain(&OF_LOSSES).chain(&OF_HEAT)
}

impl Source {
    /// The node of a mesh or the cell of a grid that it is of, from 0.
    pub(super) fn element(&self) -> Option<usize> {
        self.row.each.element().map(|_| self.at.element())
    }

    /// The boundary that it is of, from 0.
    pub(super) fn boundary(&self) -> Option<usize> {
        matches!(self.row.each, Each::Boundary | Each::Axis | Each::Node | Each::NodeScalar)
            .then(|| self.at.boundary.index())
    }

    /// Whether it is of a boundary and not of one of its nodes.
    pub(super) fn is_of_boundary(&self) -> bool {
        matches!(self.row.each, Each::Boundary | Each::Axis)
    }

    /// Name of what it is of; empty where it is of the whole scene.
    fn owner(self, scene: &Scene) -> &str {
        match self.row.each {
            Each::Scene | Each::Strain | Each::Tangent | Each::Shear => "",
            Each::Boundary | Each::Axis | Each::Node | Each::NodeScalar => {
                &scene.boundaries[self.at.boundary.index()].name
            }
            Each::Fluid | Each::FluidAxis | Each::FluidCell | Each::FluidCellAxis => {
                scene.fluid.as_ref().map_or("", |fluid| &fluid.name)
            }
            Each::Region | Each::RegionAxis | Each::Component | Each::RegionSet => &scene.regions[self.at.place()].name,
            Each::GridSet | Each::Cell | Each::CellAxis | Each::CellComponent | Each::CellSet => {
                &scene.grids[self.at.place()].name
            }
            Each::Insertion => &scene.insertions[self.at.place()].name,
            Each::Outlet => &scene.outlets[self.at.place()].name,
            Each::Meter => &scene.meters[self.at.place()].name,
            Each::Probe | Each::ProbeAxis => &scene.probes[self.at.place()].name,
        }
    }

    /// What it is: of the component and the node or other element with these names.
    fn description(self, scene: &Scene, component: &str, element: &str) -> String {
        let (owner, described) = (self.owner(scene), self.row.description.replace("{axis}", component));
        let described = described.replace("{element}", element);
        described.replace("{boundary}", owner).replace("{region}", owner).replace("{owner}", owner)
    }

    /// The variable.
    fn variable(self, scene: &Scene) -> Variable {
        let Self { row, at } = self;
        let owner = self.owner(scene);
        let own = row.each.names(scene)[at.axis()];
        let number = (at.element() + 1).to_string();
        let element = row.each.element().map(|kind| format!("{kind}[{number}]")).unwrap_or_default();
        let parts = [owner, &element, row.name, own].into_iter().filter(|part| !part.is_empty());
        Variable {
            name: parts.collect::<Vec<_>>().join("."),
            description: self.description(scene, own, &number),
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
