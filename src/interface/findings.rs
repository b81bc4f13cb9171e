//! Quantities that need a pass over particles or contacts: each is computed once at a communication point.

use crate::base::quantity::BoundaryIndex;
use crate::engine::averages::{self, Content, Coordination, Count, Sight, Tensor};
use crate::engine::simulation::{ElasticEnergy, Fabric, Simulation};
use crate::engine::state::Loss;
use crate::engine::statics;
use std::cell::OnceCell;

/// What has been found of a simulation since it last changed. Nothing is looked for before it is asked for, and
/// nothing twice. It is not part of the state; code that changes the simulation clears it.
#[derive(Debug, Default)]
pub struct Findings {
    /// Kinetic energy \[J\].
    kinetic: OnceCell<f64>,
    /// Elastic energy \[J\].
    elastic: OnceCell<ElasticEnergy>,
    /// What each loss took \[J\].
    losses: OnceCell<[f64; Loss::COUNT]>,
    /// Number of contacts.
    contacts: OnceCell<u64>,
    /// Number of contacts near a switch.
    near_switch: OnceCell<u64>,
    /// Largest overlap over the smaller radius.
    largest_overlap: OnceCell<f64>,
    /// Static stiffness of the boundaries along x, y, z, where it can be found \[N/m\].
    stiffness: OnceCell<Vec<[f64; 3]>>,
    /// Tangent of the cell, where it can be found \[Pa\].
    cell_stiffness: OnceCell<Option<[[f64; 6]; 6]>>,
    /// The particles in each region.
    contents: OnceCell<Vec<Content>>,
    /// What contacts and bonds carry in each region.
    carried: OnceCell<Vec<Tensor>>,
    /// Contacts of the particles in each region.
    coordination: OnceCell<Vec<Coordination>>,
    /// Particles whose centre is in each region.
    counts: OnceCell<Vec<Count>>,
    /// What is in the cells of each grid.
    grids: OnceCell<Vec<OfCells>>,
    /// Stress of the cell \[Pa\].
    cell_stress: OnceCell<[f64; 6]>,
    /// Contacts between the particles of the cell.
    cell_fabric: OnceCell<Fabric>,
    /// What each probe sees.
    sights: OnceCell<Vec<Sight>>,
}

impl Findings {
    /// Kinetic energy \[J\].
    pub(super) fn kinetic(&self, simulation: &Simulation) -> f64 {
        *self.kinetic.get_or_init(|| simulation.kinetic_energy())
    }

    /// Elastic energy.
    pub(super) fn elastic(&self, simulation: &Simulation) -> ElasticEnergy {
        *self.elastic.get_or_init(|| simulation.elastic_energies())
    }

    /// What each loss took \[J\].
    pub(super) fn losses(&self, simulation: &Simulation) -> &[f64; Loss::COUNT] {
        self.losses.get_or_init(|| simulation.losses().unwrap_or_default())
    }

    /// Number of contacts.
    pub(super) fn contacts(&self, simulation: &Simulation) -> u64 {
        *self.contacts.get_or_init(|| simulation.contact_count() as u64)
    }

    /// Number of contacts near a switch.
    pub(super) fn near_switch(&self, simulation: &Simulation) -> u64 {
        *self.near_switch.get_or_init(|| simulation.contacts_near_switch())
    }

    /// Static stiffness of a boundary along x, y, z, if it can be found \[N/m\].
    pub(super) fn stiffness(&self, simulation: &Simulation, boundary: BoundaryIndex) -> Option<[f64; 3]> {
        let all = self.stiffness.get_or_init(|| stiffnesses(simulation));
        all.get(boundary.index()).copied()
    }

    /// How a component of the stress of the cell follows one of the strain, if it can be found \[Pa\].
    pub(super) fn cell_stiffness(&self, simulation: &Simulation, [row, column]: [usize; 2]) -> Option<f64> {
        let found = || statics::stiffness(simulation, &[], None).ok()?.cell.map(|cell| cell.matrix);
        self.cell_stiffness.get_or_init(found).map(|matrix| matrix[row][column])
    }

    /// The particles in a region.
    pub(super) fn content(&self, simulation: &Simulation, region: usize) -> Content {
        self.contents.get_or_init(|| averages::contents(simulation))[region]
    }

    /// Contacts of a particle in a region, in the mean.
    pub(super) fn coordination(&self, simulation: &Simulation, region: usize) -> f64 {
        self.coordination.get_or_init(|| averages::coordination(simulation))[region].mean()
    }

    /// A component of the stress in a region \[Pa\]: of what contacts and bonds carry and of the velocities less their mean, symmetric.
    pub(super) fn stress(&self, simulation: &Simulation, region: usize, [row, column]: [usize; 2]) -> f64 {
        let carried = &self.carried.get_or_init(|| averages::carried(simulation))[region];
        let volume = simulation.scene().regions[region].shape.volume();
        self.content(simulation, region).stress(carried, volume, [row, column])
    }

    /// Particles whose centre is in a region.
    pub(super) fn counts(&self, simulation: &Simulation, region: usize) -> &Count {
        &self.counts.get_or_init(|| averages::counts_of_regions(simulation))[region]
    }

    /// What is in the cells of a grid.
    pub(super) fn of_cells(&self, simulation: &Simulation, grid: usize) -> &OfCells {
        let empty = || (0..simulation.scene().grids.len()).map(|grid| OfCells { grid, ..OfCells::default() }).collect();
        &self.grids.get_or_init(empty)[grid]
    }

    /// Stress of the periodic cell \[Pa\].
    pub(super) fn cell_stress(&self, simulation: &Simulation) -> &[f64; 6] {
        self.cell_stress.get_or_init(|| simulation.cell_stress())
    }

    /// Contacts between the particles of the periodic cell.
    pub(super) fn cell_fabric(&self, simulation: &Simulation) -> &Fabric {
        self.cell_fabric.get_or_init(|| simulation.cell_fabric())
    }

    /// What a probe sees.
    pub(super) fn sight(&self, simulation: &Simulation, probe: usize) -> Sight {
        self.sights.get_or_init(|| averages::sights(simulation))[probe]
    }

    /// Largest overlap over the smaller radius.
    pub(super) fn largest_overlap(&self, simulation: &Simulation) -> f64 {
        *self.largest_overlap.get_or_init(|| simulation.largest_overlap())
    }
}

/// What is in the cells of a grid, each found when it is asked for.
#[derive(Debug, Default)]
pub(super) struct OfCells {
    /// Which grid of the scene.
    grid: usize,
    /// The particles.
    contents: OnceCell<Vec<Content>>,
    /// What contacts and bonds carry.
    carried: OnceCell<Vec<Tensor>>,
    /// How many particles.
    counts: OnceCell<Vec<Count>>,
}

impl OfCells {
    /// The particles in each cell.
    pub(super) fn contents(&self, simulation: &Simulation) -> &[Content] {
        self.contents.get_or_init(|| averages::contents_of_cells(simulation, self.grid))
    }

    /// Particles whose centre is in each cell.
    pub(super) fn counts(&self, simulation: &Simulation) -> &[Count] {
        self.counts.get_or_init(|| averages::counts(simulation, self.grid))
    }

    /// A component of the stress in a cell \[Pa\], as in a region.
    pub(super) fn stress(&self, simulation: &Simulation, cell: usize, component: [usize; 2]) -> f64 {
        let carried = &self.carried.get_or_init(|| averages::carried_in_cells(simulation, self.grid))[cell];
        let volume = simulation.scene().grids[self.grid].shape.cell_volume();
        self.contents(simulation)[cell].stress(carried, volume, component)
    }
}

/// Static stiffness of all boundaries along x, y, z, each for itself; nothing where the network comes to no rest \[N/m\].
fn stiffnesses(simulation: &Simulation) -> Vec<[f64; 3]> {
    let all: Vec<BoundaryIndex> = (0..simulation.scene().boundaries.len() as u32).map(BoundaryIndex).collect();
    let Ok(found) = statics::stiffness(simulation, &all, None) else { return Vec::new() };
    let along = |matrix: &[[f64; 3]; 3]| std::array::from_fn(|axis| matrix[axis][axis]);
    found.boundaries.iter().map(|boundary| along(&boundary.matrix)).collect()
}
