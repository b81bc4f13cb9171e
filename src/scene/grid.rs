//! Grids: boxes divided into cells, each of which is looked at.

use crate::base::document::{Mistake, keys};
use crate::base::quantity::{Corners, Counts};
use crate::laws::region;
use crate::scene::{Cell, SceneDraft};
use serde::Deserialize;

/// Numbers of cells that a grid may have outputs for, all outputs counted: each is a variable of the unit.
const MOST_NUMBERS: u64 = 500_000;

/// `[grid.<name>]`: a box divided evenly into cells.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Its name in the scene and in the unit's variables.
    pub name: String,
    /// Where it stands.
    pub shape: region::Grid,
    /// What is told of each cell, each once.
    pub outputs: Vec<GridOutput>,
}

/// What may be told of each cell of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GridOutput {
    /// The part of the cell that no particle fills.
    Porosity,
    /// Mass over the volume of the cell.
    Density,
    /// Mean velocity of the mass.
    Velocity,
    /// Of contacts, bonds and velocities less their mean.
    Stress,
    /// A third of the mean square of the velocity less the mean velocity.
    GranularTemperature,
    /// Mean temperature by heat capacity.
    Temperature,
    /// Particles whose centre is inside.
    Count,
    /// Those of each set.
    CountBySet,
    /// How far each set is mixed with the others, a number of the whole grid.
    MixingIndex,
}

keys! {
    /// `[grid.<name>]` as a scene writes it.
    #[derive(Clone, Debug)]
    pub(crate) struct GridKeys {
        /// Lower and upper corner \[m\].
        r#box: Corners = "required",
        /// `[nx, ny, nz]`: cells along each axis, each ≥ 1.
        counts: Counts = "required",
        /// Any of the words below; `[]`: none.
        outputs: Option<Vec<GridOutput>> = "`[\"porosity\"]`",
    }
}

impl Grid {
    /// The grid that is written so.
    pub(crate) fn of(name: &str, keys: &GridKeys) -> Self {
        let (Corners(corners), Counts(counts)) = (keys.r#box, keys.counts);
        let shape = region::Grid { corners, counts, repeats: [false; 3] };
        let outputs = keys.outputs.clone().unwrap_or_else(|| vec![GridOutput::Porosity]);
        Self { name: name.to_owned(), shape, outputs }
    }

    /// Whether this is told of each cell.
    pub fn tells(&self, output: GridOutput) -> bool {
        self.outputs.contains(&output)
    }

    /// What cannot be of it, in a scene with so many sets and so many numbers of a fluid for each cell, with or without heat: the key, what
    /// was found and what is expected.
    pub(crate) fn objections(&self, sets: usize, of_fluid: u64, has_heat: bool) -> Vec<(&'static str, Mistake)> {
        let refused = |key, found: String, expected: String| (key, Mistake::Unexpected { found, expected });
        let mut found = Vec::new();
        let cells: u64 = self.shape.counts.iter().fold(1, |all, &count| all.saturating_mul(u64::from(count)));
        let each = (self.outputs.iter().map(|output| output.numbers(sets)).sum::<u64>() + of_fluid).max(1);
        if cells.saturating_mul(each) > MOST_NUMBERS {
            let [nx, ny, nz] = self.shape.counts;
            let what = if each == 1 { "one number".to_owned() } else { format!("{each} numbers") };
            let expected = format!("cells with at most {MOST_NUMBERS} numbers in sum");
            found.push(refused("counts", format!("{nx} × {ny} × {nz} cells of {what}"), expected));
        } else if !self.shape.cell_volume().is_normal() {
            let expected = "cells of a volume that 64 bits hold".to_owned();
            found.push(refused("box", format!("cells of {:?} m³", self.shape.cell_volume()), expected));
        } else if !self.shape.is_divided() {
            let expected = "cells whose faces 64 bits tell apart".to_owned();
            found.push(refused("counts", "more cells than there are numbers between the faces".to_owned(), expected));
        }
        let twice = |place: usize| self.outputs[..place].contains(&self.outputs[place]);
        if let Some(place) = (0..self.outputs.len()).find(|place| twice(*place)) {
            let found_twice = format!("{:?} twice", self.outputs[place].name());
            found.push(refused("outputs", found_twice, "each output once".to_owned()));
        }
        if self.tells(GridOutput::MixingIndex) && sets < 2 {
            let expected = "two sets of particles or more, between which it is a measure".to_owned();
            found.push(refused("outputs", format!("\"mixing_index\" in a scene of {sets} set"), expected));
        }
        if self.tells(GridOutput::Temperature) && !has_heat {
            let expected = "a contact law with [contact.<law>.heat] beside it".to_owned();
            found.push(refused("outputs", "\"temperature\" in a scene where no heat flows".to_owned(), expected));
        }
        found
    }
}

impl GridOutput {
    /// Its name in a scene.
    pub fn name(self) -> &'static str {
        match self {
            Self::Porosity => "porosity",
            Self::Density => "density",
            Self::Velocity => "velocity",
            Self::Stress => "stress",
            Self::GranularTemperature => "granular_temperature",
            Self::Temperature => "temperature",
            Self::Count => "count",
            Self::CountBySet => "count_by_set",
            Self::MixingIndex => "mixing_index",
        }
    }

    /// How many numbers it has for a cell, in a scene with so many sets.
    fn numbers(self, sets: usize) -> u64 {
        match self {
            Self::Velocity => 3,
            Self::Stress => 6,
            Self::CountBySet => sets as u64,
            Self::MixingIndex => 0,
            Self::Porosity | Self::Density | Self::GranularTemperature | Self::Temperature | Self::Count => 1,
        }
    }
}

/// Lets grids that reach through a periodic cell from face to face go on beyond its faces.
pub(crate) fn repeat(grids: &mut [Grid], cell: Option<&Cell>) {
    let Some(lattice) = cell.map(|cell| cell.lattice) else { return };
    for grid in grids {
        let [lower, upper] = grid.shape.corners;
        let repeats = |axis: usize| {
            let edge = lattice.edges[axis];
            let (length, near) = (edge[axis], |one: f64, other: f64| (one - other).abs() <= 1e-9 * edge[axis]);
            let alone = (0..3).all(|other| other == axis || edge[other] == 0.0);
            lattice.periodic[axis]
                && alone
                && near(lower[axis], lattice.origin[axis])
                && near(upper[axis] - lower[axis], length)
        };
        grid.shape.repeats = [0, 1, 2].map(repeats);
    }
}

/// What cannot be of the grids of a scene: table, key and mistake.
pub(crate) fn objections(scene: &SceneDraft) -> Vec<(String, &'static str, Mistake)> {
    let of = |(place, grid): (usize, &Grid)| {
        let table = format!("grid.{}", grid.name);
        let fluid = scene.fluid.as_ref().filter(|fluid| fluid.grid == Some(place));
        grid.objections(scene.sets.len(), fluid.map_or(0, super::Fluid::numbers), scene.has_heat())
            .into_iter()
            .map(move |(key, mistake)| (table.clone(), key, mistake))
    };
    scene.grids.iter().enumerate().flat_map(of).collect()
}
