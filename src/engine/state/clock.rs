//! Time and counters.

use serde::{Deserialize, Serialize};

/// Time as a compensated sum, the time step, and what was counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Time \[s\].
    pub time: f64,
    /// What the sum of steps has lost to rounding so far \[s\] (Kahan).
    pub lost: f64,
    /// The time step \[s\].
    pub step: f64,
    /// Length of the last step made, 0 before the first \[s\]: an interval that is not a whole number of time steps
    /// is divided into shorter ones.
    pub last_step: f64,
    /// A stable time step, as last found \[s\]: the largest one unless the given step is far below it.
    pub stable: f64,
    /// Largest speed of a particle expected in the middle of the next step \[m/s\].
    pub speed: f64,
    /// Time steps made since time 0.
    pub steps: u64,
    /// Those of them that were made shorter than the scene says, as the stable step was below that.
    pub divided: u64,
    /// Times the neighbour lists were made.
    pub rebuilds: u64,
}

/// Time steps of an interval that there may be: beyond, a clock of 53 bits no longer tells one from the next.
pub(crate) const MOST_STEPS: f64 = 1e15;

/// A communication step of which a part has been made.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Underway {
    /// Number of the time step with which it began.
    pub begun: u64,
    /// Time steps done since it was divided last.
    pub done: u64,
    /// Time steps in all since then.
    pub count: u64,
    /// Length of each \[s\].
    pub step: f64,
    /// Share of its time that had passed when it was divided last.
    pub passed: f64,
    /// Its length \[s\].
    pub length: f64,
    /// Largest speed of a boundary, as foreseen for it \[m/s\].
    pub boundary_speed: f64,
}

impl Underway {
    /// How much of its time has passed \[s\].
    pub fn elapsed(&self) -> f64 {
        self.passed * self.length + self.done as f64 * self.step
    }
}

impl Clock {
    /// Moves on by `interval` \[s\].
    pub fn advance(&mut self, interval: f64) {
        let small = interval - self.lost;
        let sum = self.time + small;
        self.lost = (sum - self.time) - small;
        self.time = sum;
    }
}
