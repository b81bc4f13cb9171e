//! What a run writes.

use crate::base::quantity::Positive;
use serde::{Deserialize, Deserializer};

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
    /// Time between checkpoints \[s\].
    #[serde(deserialize_with = "positive")]
    pub checkpoint_interval: Option<f64>,
}

/// A number above 0, where one is given.
fn positive<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Ok(Some(Positive::deserialize(deserializer)?.get()))
}
