//! One communication step: how many time steps, and what is looked at between them.

use super::{RunError, Simulation};
use crate::base::threads::{Context, Threads};
use crate::engine::boundaries::{course, nodes};
use crate::laws::motion::Progress;

/// An interval this close to a whole number of time steps (over the time step) counts as that number.
const WHOLE: f64 = 1e-6;

impl Simulation {
    /// Runs one communication step of `interval` \[s\]: driven axes arrive at its end.
    ///
    /// An error that is found before a step ([`RunError::Runaway`]) leaves the state of the last good time step, at
    /// [`Simulation::time`]. An error that a step itself causes leaves the state after that step, which serves to find
    /// the cause only: to be able to go on, keep a copy of the state.
    pub fn advance(&mut self, interval: f64) -> Result<(), RunError> {
        if !interval.is_finite() || interval <= 0.0 {
            return Err(RunError::Interval { interval });
        }
        course::begin(&self.scene, &mut self.state, interval)?;
        nodes::begin(&self.scene, &mut self.state, interval);
        self.state.breaks.clear();
        if let Some(flow) = &self.flow {
            flow.begin(&mut self.state, interval);
        }
        let mut workers = std::mem::take(&mut self.workers);
        let (elapsed, result) = workers.run(|threads| self.run(interval, threads));
        self.workers = workers;
        course::end(&mut self.state, elapsed);
        nodes::end(&mut self.state, elapsed);
        if let Some(flow) = &self.flow {
            flow.end(&mut self.state, elapsed);
        }
        result.map_err(|error| self.named(error))
    }

    /// Makes the time steps of a communication step and looks at where they led. Returns how long they took \[s\], and why they
    /// ended early.
    fn run(&mut self, interval: f64, threads: Option<&Threads>) -> (f64, Result<(), RunError>) {
        let (elapsed, result) = self.make_steps(interval, threads);
        (elapsed, result.and_then(|()| self.check_domain()).and_then(|()| self.check_plane()))
    }

    /// Makes as many time steps as fit when a communication step begins; where the stable one becomes shorter on the way, the
    /// rest is divided again.
    fn make_steps(&mut self, interval: f64, threads: Option<&Threads>) -> (f64, Result<(), RunError>) {
        let standing = Context { threads, ..self.standing() };
        let mut boundaries = self.boundary_speed();
        let (_, step) = divide(interval, self.state.clock.step);
        if self.is_due(boundaries, step) {
            if let Err(error) = self.look(step, &Context { step, ..standing }) {
                return (0.0, Err(error));
            }
            self.shorten_step();
        }
        self.lengthen_step(interval);
        let (count, step) = divide(interval, self.state.clock.step);
        let length = count as f64 * step;
        let mut progress = Progress { done: 0, count, step, time: 0.0, passed: 0.0, length };
        while progress.done < progress.count {
            let (step, elapsed) = (progress.step, |done: u64| progress.passed * length + done as f64 * progress.step);
            if self.outruns(step) && self.shorten_step() {
                let passed = elapsed(progress.done);
                let (count, step) = divide(length - passed, self.state.clock.step);
                progress = Progress { done: 0, count, step, passed: passed / length, ..progress };
                continue;
            }
            if let Err(error) = self.check_displacement(step) {
                return (elapsed(progress.done), Err(error));
            }
            if self.is_stopped() {
                return (elapsed(progress.done), Err(RunError::Stopped { time: self.time() }));
            }
            progress.done += 1;
            let (context, elapsed) = (Context { step, ..standing }, elapsed(progress.done));
            if let Err(error) = self.step(progress, &context) {
                return (elapsed, Err(error));
            }
            if self.boundaries_change_speed() {
                boundaries = self.boundary_speed();
            }
            if !self.is_due(boundaries, step) {
                continue;
            }
            if let Err(error) = self.check_plane().and_then(|()| self.look(step, &Context { step, ..standing })) {
                return (elapsed, Err(error));
            }
            if self.shorten_step() && progress.done < progress.count {
                let (count, step) = divide(length - elapsed, self.state.clock.step);
                progress = Progress { done: 0, count, step, passed: elapsed / length, ..progress };
            }
        }
        (progress.passed * length + progress.done as f64 * progress.step, Ok(()))
    }
}

/// Divides an interval into equal time steps: of exactly `step`, where a whole number of them fits, otherwise shorter.
pub fn divide(interval: f64, step: f64) -> (u64, f64) {
    let ratio = interval / step;
    let whole = ratio.round();
    if whole >= 1.0 && (ratio - whole).abs() <= WHOLE {
        return (whole as u64, step);
    }
    let count = ratio.ceil().max(1.0);
    (count as u64, interval / count)
}
