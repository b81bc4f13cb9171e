//! Heat of particles and boundaries.

use super::check::{all_finite, demand, demand_all};
use super::in_place::clone_in_place;
use super::{StateFault, plain};
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
    /// Largest sum of the conductances of a body over its heat capacity at the present time \[1/s\].
    pub rate: f64,
}

clone_in_place!(Heat {
    initial,
    capacity,
    gained,
    flow,
    boundaries,
    numbers,
    departed,
    given,
    by_losses,
    of_losses,
    rate
});

/// Temperature of a boundary, and heat that the particles gave to it. Zeros where it has no temperature.
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
}

impl BoundaryHeat {
    /// Temperature \[K\].
    pub fn temperature(&self) -> f64 {
        self.initial + self.rise
    }

    /// Heat of the particles into it since counting began \[J\].
    pub fn heat(&self) -> f64 {
        self.before + self.present
    }
}

impl Heat {
    /// Temperature of a particle by its index \[K\]; of spheres of a clump that of its first.
    pub fn temperature(&self, index: usize) -> f64 {
        self.initial[index] + self.rise(index)
    }

    /// By how much a particle is warmer than when counting began \[K\].
    #[inline(always)]
    pub fn rise(&self, index: usize) -> f64 {
        if self.capacity[index] > 0.0 { self.gained[index] / self.capacity[index] } else { 0.0 }
    }

    /// Heat that particles and clumps gained since counting began, or since they came, those that have gone included \[J\].
    pub fn energy(&self) -> f64 {
        self.gained.iter().sum::<f64>() + self.departed
    }

    /// Begins to collect heat of losses, for so many slots.
    pub(crate) fn collect(&mut self, slots: usize) {
        self.of_losses.clear();
        self.of_losses.resize(slots, 0.0);
        self.boundaries.iter_mut().for_each(|boundary| boundary.of_losses = 0.0);
    }

    /// Counts heat from here.
    pub(super) fn begin_counting(&mut self) {
        for index in 0..self.gained.len() {
            self.initial[index] = self.temperature(index);
        }
        self.gained.fill(0.0);
        for boundary in &mut self.boundaries {
            boundary.initial = boundary.temperature();
            (boundary.rise, boundary.before, boundary.present, boundary.applied) = (0.0, 0.0, 0.0, 0.0);
        }
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
        let numbers = boundaries.iter().flat_map(|it| {
            let [start, end] = it.course;
            let given = [it.initial, it.rise, it.capacity, it.target, it.target_rate, start, end];
            given.into_iter().chain([it.flow, it.before, it.present, it.mean_flow, it.applied])
        });
        let numbers: Vec<f64> = numbers.chain([self.given, self.by_losses, self.departed, self.rate]).collect();
        all_finite(&numbers, "heat")?;
        let same = boundaries.iter().zip(&other.boundaries).map(|(it, other)| it.capacity == other.capacity);
        demand_all(same, "heat", "the heat capacities of the boundaries")
    }
}
