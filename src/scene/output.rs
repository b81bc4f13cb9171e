//! What a run writes.

use crate::base::quantity::Positive;
use serde::{Deserialize, Deserializer};
use std::num::NonZeroU32;

/// `[output]`: what a run writes; what is absent is not computed.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Time between rows of `history.csv` \[s\].
    #[serde(deserialize_with = "positive")]
    pub history_interval: Option<f64>,
    /// Names of the columns of `history.csv`, `*` for any characters; none: all outputs but those of nodes and of cells of grids.
    pub columns: Option<Vec<String>>,
    /// Time between `.vtu` frames of the particles \[s\].
    #[serde(deserialize_with = "positive")]
    pub frame_interval: Option<f64>,
    /// Whether each frame has a file of the contacts: point, normal, overlap, forces.
    pub contacts: bool,
    /// Whether each frame has a file of the boundaries: their surfaces, displacement, and the load on each facet.
    pub boundaries: bool,
    /// Whether the algorithmic energy book is kept.
    pub energy: bool,
    /// Whether the physical energy book is kept: losses, each by itself.
    pub losses: bool,
    /// Whether contacts near a switch are counted.
    pub near_switch: bool,
    /// Whether the static stiffness of boundaries is an output.
    pub stiffness: bool,
    /// Whether single impacts are followed, from touch to parting, and how they are told.
    pub impacts: Option<Impacts>,
    /// Time between checkpoints \[s\].
    #[serde(deserialize_with = "positive")]
    pub checkpoint_interval: Option<f64>,
}

/// `[output] impacts`: single impacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Impacts {
    /// How they are counted by the energy that they lose.
    pub histogram: EnergyBins,
    /// Whether each is told by itself, in a file.
    pub events: bool,
}

/// Bins of energies: the same number in each decade, from any energy to any other.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnergyBins {
    /// How many there are between an energy and ten times as much.
    pub bins_per_decade: NonZeroU32,
}

impl Default for EnergyBins {
    fn default() -> Self {
        Self { bins_per_decade: NonZeroU32::MIN.saturating_add(4) }
    }
}

impl EnergyBins {
    /// The bin of an energy above 0 \[J\]: how many lie between 1 J and its lower end.
    pub(crate) fn of(self, energy: f64) -> i32 {
        (libm::log10(energy) * f64::from(self.bins_per_decade.get())).floor() as i32
    }

    /// The ends of a bin \[J\].
    pub(crate) fn ends(self, bin: i32) -> [f64; 2] {
        [bin, bin.saturating_add(1)].map(|end| libm::exp10(f64::from(end) / f64::from(self.bins_per_decade.get())))
    }
}

/// A number above 0, where one is given.
fn positive<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Ok(Some(Positive::deserialize(deserializer)?.get()))
}
