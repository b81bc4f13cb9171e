//! What a run writes.

use crate::base::document::keys;
use crate::base::quantity::Positive;
use serde::{Deserialize, Deserializer};
use std::num::NonZeroU32;

keys! {
    /// `[output]`: what a run writes; what is absent is not computed.
    #[derive(Clone, Debug, Default)]
    #[serde(default)]
    pub struct Output {
        /// Time between rows of `history.csv` \[s\], > 0.
        #[serde(deserialize_with = "positive")]
        pub history_interval: Option<f64> = "no history",
        /// Names of outputs and inputs in `history.csv`, in this order; `*` stands for any characters.
        pub columns: Option<Vec<String>> = "all but those of nodes and of cells of grids; of more than 1,000 not those of groups",
        /// Time between `.vtu` frames of the particles \[s\], > 0.
        #[serde(deserialize_with = "positive")]
        pub frame_interval: Option<f64> = "no frames",
        /// Whether each frame has a file of contacts: point, normal, overlap, forces.
        pub contacts: bool = "`false`",
        /// Whether each frame has a file of the boundaries, with displacement and load on each facet.
        pub boundaries: bool = "`false`",
        /// Whether files of frames are compressed, by zlib.
        pub compressed: bool = "`false`",
        /// Whether the algorithmic energy book is kept.
        pub energy: bool = "`false`",
        /// Whether losses are booked by cause: outputs `energy.lost.<cause>`.
        pub losses: bool = "`false`",
        /// Output `contacts.near_switch`: contacts (of particles and planes) that a ten-thousandth of their overlap more or less would
        /// let begin or end to slide, or to touch.
        pub near_switch: bool = "`false`",
        /// Outputs `<boundary>.stiffness.<axis>` \[N/m\], the condensed static stiffness, and `cell.stiffness.<component>.<component>`
        /// \[Pa\], the tangent of a cell: some hundred evaluations for each value that is read; where the particles come to no rest an
        /// empty field, and the unit refuses to tell it.
        pub stiffness: bool = "`false`",
        /// Follows single impacts: `{ histogram = { bins_per_decade = 5 }, events = false }`; `events` writes each to `impacts.csv`; keeps
        /// `losses`.
        pub impacts: Option<Impacts> = "none",
        /// Time between checkpoints \[s\], > 0.
        #[serde(deserialize_with = "positive")]
        pub checkpoint_interval: Option<f64> = "none",
    }
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
