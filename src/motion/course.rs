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
}

impl InputCourse {
    /// Which share of its way a driven axis has gone after a share of the time.
    fn at(self, share: f64) -> f64 {
        match self {
            Self::Ramp => share,
            Self::Smooth => share * share * (3.0 - 2.0 * share),
            Self::Hold => 1.0,
        }
    }
}

/// Where a communication step stands: the time steps done with the present one, of how many.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress {
    /// Time steps done, the present one included.
    pub done: u64,
    /// Time steps in all.
    pub count: u64,
    /// Length of each \[s\].
    pub step: f64,
    /// Time at the end of the present one \[s\].
    pub time: f64,
}

impl Progress {
    /// Length of the communication step \[s\].
    pub(crate) fn length(&self) -> f64 {
        self.count as f64 * self.step
    }

    /// Whether the present time step is the last one.
    pub(crate) fn is_last(&self) -> bool {
        self.done == self.count
    }

    /// Which share of its way a driven axis has gone at the end of the present time step.
    pub(crate) fn share(&self, course: InputCourse) -> f64 {
        course.at(self.done as f64 / self.count as f64)
    }

    /// Which share it had gone before.
    pub(crate) fn share_before(&self, course: InputCourse) -> f64 {
        match self.done {
            0 | 1 => 0.0,
            done => course.at((done - 1) as f64 / self.count as f64),
        }
    }
}
