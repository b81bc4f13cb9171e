//! What a scene passes through, sampled at equal intervals, and how far two runs of it are apart.

use crate::stage::Stage;
use cograin_chart::ChartError;

/// A run that is sampled.
pub(crate) struct Sampled {
    /// Time between samples \[s\].
    pub interval: f64,
    /// How many there are.
    pub count: u32,
    /// What is looked at.
    pub observe: fn(&Stage) -> Vec<f64>,
}

impl Sampled {
    /// The samples of a scene, and its time steps; a given step is to divide the interval.
    pub(crate) fn of(&self, text: &str) -> Result<(Vec<f64>, u64), ChartError> {
        let mut stage = Stage::of(text)?;
        let mut samples = Vec::new();
        for _ in 0..self.count {
            stage.advance(self.interval)?;
            samples.extend((self.observe)(&stage));
        }
        Ok((samples, stage.simulation.state().clock.steps))
    }

    /// The time step that divides the interval and is this long at most \[s\].
    pub(crate) fn dividing(&self, step: f64) -> f64 {
        self.interval / (self.interval / step).ceil()
    }
}

/// The largest difference of two runs.
pub(crate) fn apart(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The lines of `[run]` that give a step \[s\].
pub(crate) fn given(step: f64) -> String {
    format!("threads = 1\nstep = {step:?}\nallow_unstable = true\n")
}
