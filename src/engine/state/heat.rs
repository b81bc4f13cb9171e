//! Heat of particles and boundaries.

use super::check::{all_finite, demand, demand_all};
use super::in_place::clone_in_place;
use super::{Row, StateFault, plain};
use serde::{Deserialize, Serialize};

/// Heat of a scene in which it flows. Columns of particles go by their index, as their number never changes.
///
/// A temperature is kept as that at the start and the heat gained since, so that small heats are not lost in the digits of 300 K. The first
/// sphere of a clump stands for the clump, and a boundary for the particles of its group: the others have a capacity of 0.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Heat {
    /// Temperature when counting began \[K\].
    #[serde(with = "plain")]
    pub initial: Vec<f64>,
    /// Heat capacity \[J/K\].
    #[serde(with = "plain")]
    pub capacity: Vec<f64>,
    /// Heat gained since \[J\].
    #[serde(with = "plain")]
    pub gained: Vec<f64>,
    /// Heat flow into it in the last time step \[W\].
    #[serde(with = "plain")]
    pub flow: Vec<f64>,
    /// The boundaries, in the scene's order.
    pub boundaries: Vec<BoundaryHeat>,
    /// The meshes whose nodes have temperatures.
    pub nodes: Vec<NodesHeat>,
    /// Numbers of the particles that came, by index less the number of the scene's own: who each entry is of.
    #[serde(with = "plain")]
    pub numbers: Vec<u32>,
    /// What particles that have gone had gained since counting began \[J\].
    pub departed: f64,
    /// What heat sources gave since counting began \[J\].
    pub given: f64,
    /// What losses gave since counting began \[J\].
    pub by_losses: f64,
    /// Heat that losses give to what stands in each slot in the present time step \[J\]; empty between time steps.
    #[serde(skip)]
    pub of_losses: Vec<f64>,
    /// What stands in each slot in the present time step: temperature when counting began, by how much it is warmer now \[K\], heat flow into
    /// it \[W\], sum of the conductances at it \[W/K\]; empty between time steps.
    #[serde(skip)]
    pub slots: Vec<Row>,
    /// Largest sum of the conductances of a body over its heat capacity at the present time \[1/s\].
    pub rate: f64,
    /// Length of the next time step by the error of the last one, where nothing moves \[s\]; 0 before the first.
    pub stride: f64,
}

clone_in_place!(Heat {
    initial,
    capacity,
    gained,
    flow,
    boundaries,
    nodes,
    numbers,
    departed,
    given,
    by_losses,
    of_losses,
    slots,
    rate,
    stride
});

/// A temperature: that when counting began, and by how much the present one is above it \[K\].
pub(crate) type Level = [f64; 2];

/// Temperature of a boundary or a node, and heat that the particles gave to it. Zeros where it has no temperature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundaryHeat {
    /// Temperature when counting began \[K\].
    pub initial: f64,
    /// By how much the present one is above it \[K\].
    pub rise: f64,
    /// Heat capacity; 0 where the temperature is given \[J/K\].
    pub capacity: f64,
    /// The last input: temperature at the end of the communication step \[K\], or heat flow from the outside \[W\].
    pub target: f64,
    /// Its rate at the start of the communication step; 0 where none was given.
    pub target_rate: f64,
    /// What the input was where the present communication step began, and what it is to be at its end.
    pub course: [f64; 2],
    /// Heat flow of the particles into it in the last time step \[W\].
    pub flow: f64,
    /// Heat of the particles into it before the present communication step, since counting began \[J\].
    pub before: f64,
    /// The same in the present communication step \[J\].
    pub present: f64,
    /// Heat flow of the particles into it, mean over the last communication step \[W\].
    pub mean_flow: f64,
    /// Heat from the outside into what has a capacity since counting began \[J\].
    pub applied: f64,
    /// Heat that losses give to it in the present time step \[J\]; 0 between time steps.
    #[serde(skip)]
    pub of_losses: f64,
    /// Heat flow into it in the present time step \[W\], and the sum of the conductances at it \[W/K\]; 0 between time steps.
    #[serde(skip)]
    pub into: [f64; 2],
}

/// Temperatures of the nodes of one mesh, in the order of its vertices, and what of the heat into the mesh is theirs.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NodesHeat {
    /// The boundary.
    pub boundary: u32,
    /// The nodes.
    pub each: Vec<BoundaryHeat>,
}

clone_in_place!(NodesHeat { boundary, each });

/// Lets heat flow between two bodies over a conductance \[W/K\]: rows of [`Heat::slots`].
#[inline(always)]
pub(crate) fn exchange([first, second]: [&mut Row; 2], conductance: f64) {
    let flow = conductance * difference([second[0], second[1]], [first[0], first[1]]);
    (first[2], first[3]) = (first[2] + flow, first[3] + conductance);
    (second[2], second[3]) = (second[2] - flow, second[3] + conductance);
}

/// Difference of two temperatures, in which small rises are not lost \[K\].
#[inline(always)]
pub(crate) fn difference([t, rise]: Level, [u, other]: Level) -> f64 {
    (t - u) + (rise - other)
}

impl BoundaryHeat {
    /// Temperature \[K\].
    pub fn temperature(&self) -> f64 {
        self.initial + self.rise
    }

    /// The same as two numbers.
    pub(crate) fn level(&self) -> Level {
        [self.initial, self.rise]
    }

    /// Adds a heat flow into it \[W\] over a conductance \[W/K\].
    pub(crate) fn takes(&mut self, [flow, conductance]: [f64; 2]) {
        self.into = [self.into[0] + flow, self.into[1] + conductance];
    }

    /// Counts heat from here.
    fn begin_counting(&mut self) {
        self.initial = self.temperature();
        (self.rise, self.before, self.present, self.applied) = (0.0, 0.0, 0.0, 0.0);
    }

    /// Its numbers.
    fn numbers(&self) -> impl Iterator<Item = f64> {
        let [start, end] = self.course;
        let given = [self.initial, self.rise, self.capacity, self.target, self.target_rate, start, end];
        given.into_iter().chain([self.flow, self.before, self.present, self.mean_flow, self.applied])
    }

    /// Heat of the particles into it since counting began \[J\].
    pub fn heat(&self) -> f64 {
        self.before + self.present
    }
}

impl Heat {
    /// Temperature of a particle by its index \[K\], which stands for its grain.
    pub fn temperature(&self, index: usize) -> f64 {
        self.initial[index] + self.rise(index)
    }

    /// By how much a particle is warmer than when counting began \[K\].
    #[inline(always)]
    pub fn rise(&self, index: usize) -> f64 {
        if self.capacity[index] > 0.0 { self.gained[index] / self.capacity[index] } else { 0.0 }
    }

    /// Heat that grains gained since counting began, or since they came, those that have gone included \[J\].
    pub fn energy(&self) -> f64 {
        self.gained.iter().sum::<f64>() + self.departed
    }

    /// Boundaries and nodes.
    pub(crate) fn surfaces(&self) -> impl Iterator<Item = &BoundaryHeat> {
        self.boundaries.iter().chain(self.nodes.iter().flat_map(|nodes| &nodes.each))
    }

    /// The same.
    pub(crate) fn surfaces_mut(&mut self) -> impl Iterator<Item = &mut BoundaryHeat> {
        self.boundaries.iter_mut().chain(self.nodes.iter_mut().flat_map(|nodes| &mut nodes.each))
    }

    /// The nodes of a boundary, where these have temperatures.
    pub fn nodes_of(&self, boundary: usize) -> Option<&[BoundaryHeat]> {
        self.nodes.iter().find(|nodes| nodes.boundary as usize == boundary).map(|nodes| &*nodes.each)
    }

    /// The same.
    pub(crate) fn nodes_of_mut(&mut self, boundary: usize) -> Option<&mut [BoundaryHeat]> {
        self.nodes.iter_mut().find(|nodes| nodes.boundary as usize == boundary).map(|nodes| &mut *nodes.each)
    }

    /// A boundary or, where one is named, its node.
    pub(crate) fn surface_mut(&mut self, boundary: usize, node: Option<usize>) -> Option<&mut BoundaryHeat> {
        match node {
            None => self.boundaries.get_mut(boundary),
            Some(node) => self.nodes_of_mut(boundary)?.get_mut(node),
        }
    }

    /// Forgets what was collected in a time step.
    pub(crate) fn forget_step(&mut self) {
        self.of_losses.clear();
        self.slots.clear();
        self.surfaces_mut().for_each(|it| (it.of_losses, it.into) = (0.0, [0.0; 2]));
    }

    /// Counts heat from here.
    pub(super) fn begin_counting(&mut self) {
        for index in 0..self.gained.len() {
            self.initial[index] = self.temperature(index);
        }
        self.gained.fill(0.0);
        self.surfaces_mut().for_each(BoundaryHeat::begin_counting);
        (self.given, self.by_losses, self.departed) = (0.0, 0.0, 0.0);
    }

    /// Whether it can be that of a scene of which `other` is, with so many indices of particles; `stay`: no particle comes or goes.
    pub(super) fn check(&self, other: &Self, count: usize, stay: bool) -> Result<(), StateFault> {
        let columns = [&self.initial, &self.capacity, &self.gained, &self.flow];
        demand_all(columns.iter().map(|column| column.len() == count), "heat", "an entry for each particle")?;
        columns.iter().try_for_each(|column| all_finite(column, "heat"))?;
        demand(!stay || self.capacity == other.capacity, "heat", 1, "the heat capacities of the scene")?;
        let boundaries = &self.boundaries;
        demand(boundaries.len() == other.boundaries.len(), "heat", boundaries.len(), "one entry for each boundary")?;
        let sizes = |heat: &Self| heat.nodes.iter().map(|it| (it.boundary, it.each.len())).collect::<Vec<_>>();
        demand(sizes(self) == sizes(other), "heat", self.nodes.len(), "the nodes of the meshes of the scene")?;
        let numbers = self.surfaces().flat_map(BoundaryHeat::numbers);
        let numbers: Vec<f64> =
            numbers.chain([self.given, self.by_losses, self.departed, self.rate, self.stride]).collect();
        all_finite(&numbers, "heat")?;
        let same = self.surfaces().zip(other.surfaces()).map(|(it, other)| it.capacity == other.capacity);
        demand_all(same, "heat", "the heat capacities of the boundaries")
    }
}
