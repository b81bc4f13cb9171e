//! For which motion the stable time step holds, and hence when it is computed again.

use super::check::{MOST, StateFault, demand};
use serde::{Deserialize, Serialize};

/// Limits of motion and bonds within which the stable time step that was computed last holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Foresight {
    /// Angular frequency 2/Δt of the contacts and bonds that were counted, as found last \[1/s\]; 0 without any.
    pub root: f64,
    /// How many eigenvalue iterations were started: it seeds the next one.
    pub counter: u64,
    /// How often the stable step was computed.
    pub looks: u64,
    /// An upper bound of the distance that any body has moved since \[m\].
    pub travel: f64,
    /// The distance at which it is computed again \[m\].
    pub reach: f64,
    /// By how much a cell that is deformed has brought neighbours nearer since, at most \[m\].
    pub strained: f64,
    /// By how much it may until it is computed again \[m\].
    pub strain_reach: f64,
    /// The speed at which it is computed again \[m/s\].
    pub speed: f64,
    /// The largest speed of a particle when it was computed \[m/s\].
    pub fastest: f64,
    /// Bonds made and bonds broken when it was computed.
    pub bonds: [u64; 2],
    /// Number of the last time step whose new bonds were counted.
    pub until: u64,
    /// Time up to which new bonds were counted \[s\].
    pub to: f64,
}

impl Foresight {
    /// Whether this can be one. What is not foreseen may be infinite.
    pub(super) fn check(&self) -> Result<(), StateFault> {
        let Self { root, counter, looks, travel, reach, strained, strain_reach, speed, fastest, bonds, until: _, to } =
            *self;
        let numbers =
            [root, travel, reach, strained, strain_reach, speed, fastest, to].iter().all(|number| !number.is_nan());
        demand(numbers, "foresight", 0, "numbers")?;
        let counts = [counter, looks, bonds[0], bonds[1]].iter().all(|&count| count < MOST);
        demand(counts, "foresight", 1, "a count that can be reached")
    }
}
