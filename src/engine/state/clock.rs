//! Time and counters.

use super::check::{MOST, StateFault, all_finite, demand};
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

impl Clock {
    /// Whether this can be one.
    pub(super) fn check(&self) -> Result<(), StateFault> {
        let numbers = [self.time, self.lost, self.step, self.last_step, self.speed];
        all_finite(&numbers, "clock")?;
        let lengths = self.step > 0.0 && self.last_step >= 0.0 && self.stable > 0.0 && self.speed >= 0.0;
        demand(lengths, "clock", 0, "a step above 0 and a speed of 0 or above")?;
        demand(
            [self.steps, self.rebuilds, self.divided].iter().all(|count| *count < MOST),
            "clock",
            1,
            "a count that can be reached",
        )
    }
}

impl Underway {
    /// Whether this can be one.
    pub(super) fn check(&self) -> Result<(), StateFault> {
        let Self { begun, done, count, step, passed, length, boundary_speed } = *self;
        all_finite(&[step, passed, length, boundary_speed], "underway")?;
        let lengths = step > 0.0 && length > 0.0 && (0.0..1.0).contains(&passed) && boundary_speed >= 0.0;
        demand(lengths, "underway", 0, "steps above 0 and a share from 0 to 1")?;
        demand(begun < MOST, "underway", 2, "a count that can be reached")?;
        demand(done < count, "underway", 1, "time steps that are left")
    }
}
