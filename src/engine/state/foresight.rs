//! For which motion the stable time step holds, and hence when it is computed again.

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
