//! Texts that are parameters of the unit and no numbers of the scene: one row for each.
//!
//! They say what an instance does beside the simulation. So they are no part of the simulation's scene nor of its state:
//! whoever holds the simulation holds them, too.

use super::{Causality, Quantity, Source, Variability, Variable};

/// A text.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Text {
    /// Its name.
    name: &'static str,
    /// Its value before anything is set.
    pub(super) start: &'static str,
    /// What it is.
    about: &'static str,
}

/// The folder of the frames.
pub const FRAMES: &str = "run.frames";

/// All of them.
static ROWS: [Text; 1] = [Text {
    name: FRAMES,
    start: "",
    about: "folder in which the unit writes frames at the scene's frame_interval, or at every communication point if it has none; \
            empty: no frames",
}];

/// The texts as variables.
pub(super) fn variables() -> impl Iterator<Item = Variable> {
    ROWS.iter().map(|row| Variable {
        name: row.name.to_owned(),
        description: row.about.to_owned(),
        quantity: Quantity::Text,
        causality: Causality::Parameter,
        variability: Variability::Fixed,
        start: None,
        minimum: None,
        maximum: None,
        follows_inputs_at_start: false,
        source: Source::Text(row),
    })
}
