//! What the automatic time step knows of the contacts.

use super::check::{MOST, StateFault, demand};
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

impl Pace {
    /// Whether this can be one.
    pub(super) fn check(&self) -> Result<(), StateFault> {
        let Self { share, packed, whole_at, until, rebuilds, speed, vibration } = *self;
        demand((0.0..=1.0).contains(&share), "pace", 0, "a share from 0 to 1")?;
        demand([packed, speed, until, vibration].iter().all(|it| *it >= 0.0), "pace", 1, "numbers of 0 or above")?;
        demand(whole_at < MOST && rebuilds < MOST, "pace", 2, "a count that can be reached")
    }
}
