//! How driven axes go through a communication step.

use serde::Deserialize;

/// How a driven axis moves inside a communication step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InputCourse {
    /// At constant velocity, arriving at the end of the step.
    #[default]
    Ramp,
    /// A cubic in time with the velocity continuous.
    Smooth,
    /// At once, in the first time step of the communication step.
    Hold,
    /// At the constant acceleration that the outside gives, arriving at the end of the step; it is then asked how the force
    /// changed on the way.
    Quadratic,
}

impl InputCourse {
    /// Which share of its way a driven axis has gone after a share of the time.
    fn at(self, share: f64) -> f64 {
        match self {
            Self::Ramp | Self::Quadratic => share,
            Self::Smooth => share * share * (3.0 - 2.0 * share),
            Self::Hold => 1.0,
        }
    }
}

impl InputCourse {
    /// Its largest rate, over the mean one.
    pub(crate) fn steepest(self) -> f64 {
        match self {
            // One that holds its new place jumps there: no speed of its own.
            Self::Hold => 0.0,
            Self::Ramp | Self::Quadratic => 1.0,
            // The slope of 3 s² − 2 s³ at its middle.
            Self::Smooth => 1.5,
        }
    }
}

/// Where a communication step stands: the time steps done with the present one, of how many since it was divided last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress {
    /// Time steps done since then, the present one included.
    pub done: u64,
    /// Time steps in all since then.
    pub count: u64,
    /// Length of each \[s\].
    pub step: f64,
    /// Time at the end of the present one \[s\].
    pub time: f64,
    /// Share of the time of the communication step that had passed when it was divided last.
    pub passed: f64,
    /// Length of the communication step \[s\].
    pub length: f64,
}

impl Progress {
    /// Whether the present time step is the last one.
    pub(crate) fn is_last(&self) -> bool {
        self.done == self.count
    }

    /// Which share of its way a driven axis has gone at the end of the present time step.
    pub(crate) fn share(&self, course: InputCourse) -> f64 {
        course.at(self.share_of_time(self.done))
    }

    /// Which share it had gone before.
    pub(crate) fn share_before(&self, course: InputCourse) -> f64 {
        if self.done <= 1 && self.passed <= 0.0 {
            return 0.0;
        }
        course.at(self.share_of_time(self.done.saturating_sub(1)))
    }

    /// Time from the middle of the communication step to that of the present time step \[s\].
    pub(crate) fn since_the_middle(&self) -> f64 {
        let (before, after) = (self.share_of_time(self.done.saturating_sub(1)), self.share_of_time(self.done));
        0.5 * (before + after - 1.0) * self.length
    }

    /// The share of the time that has passed after so many time steps.
    fn share_of_time(&self, done: u64) -> f64 {
        self.passed + (1.0 - self.passed) * (done as f64 / self.count as f64)
    }
}
