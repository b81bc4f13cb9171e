//! The conditions for which the stable time step was computed, and when it is computed again.

use serde::{Deserialize, Serialize};

/// When the stable time step was found last, and what for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Foresight {
    /// Root 2/Δt of the network that was foreseen \[1/s\]; 0 where there is none.
    pub root: f64,
    /// Starts of iterations so far.
    pub counter: u64,
    /// Times it was found.
    pub looks: u64,
    /// A bound of how far anything has moved since \[m\].
    pub travel: f64,
    /// How far everything may move until it is found again \[m\].
    pub reach: f64,
    /// How fast everything may become until then \[m/s\].
    pub speed: f64,
    /// Bonds made and bonds broken until then.
    pub bonds: [u64; 2],
    /// Number of the last time step whose new bonds were foreseen.
    pub until: u64,
    /// Time up to which new bonds were foreseen \[s\].
    pub to: f64,
}
