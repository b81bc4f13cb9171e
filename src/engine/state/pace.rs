//! What the automatic time step knows of the contacts.

use serde::{Deserialize, Serialize};

/// What was found when contacts were last looked at, and when that was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pace {
    /// Energy of impacts of two bodies alone over that of all contacts.
    pub share: f64,
    /// Energy of contacts inside packings, when they were last looked at \[J\].
    pub packed: f64,
    /// Mean square of the angular frequency with which bonded bodies vibrate, less by what of the energy of bonds is at rest \[1/s²\].
    pub vibration: f64,
    /// Number of the time step after which they were.
    pub whole_at: u64,
    /// Contacts that come until then were foreseen \[s\].
    pub until: f64,
    /// How often neighbour lists had been made at the last look.
    pub rebuilds: u64,
    /// Largest speed of anything then \[m/s\].
    pub speed: f64,
}
