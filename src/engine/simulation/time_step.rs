//! One time step by velocity Verlet: its stages, one after the other, and what they tell each other.

use super::stages::{Phase, Stages};
use super::{RunError, Simulation};
use crate::base::threads::Context;
use crate::engine::integration;
use crate::engine::state::Heat;
use crate::laws::bond::creation::Moment;
use crate::laws::motion::Progress;

/// What is done between time steps: looks, and what communication steps begin and end with.
const BETWEEN: &str = "between time steps";

/// What the stages of a time step, or of an evaluation of the forces alone, tell each other.
pub(super) struct TimeStep<'a> {
    /// Where the communication step stands when the time step ends.
    pub(super) progress: Progress,
    /// The moment that the step reaches.
    pub(super) moment: Moment,
    /// Step, lanes and threads of every loop.
    pub(super) context: &'a Context<'a>,
    /// Upper bound of how far any particle went by the forces on it \[m\].
    pub(super) way: f64,
    /// The same of anything, surfaces and nodes included \[m\].
    pub(super) farthest: f64,
    /// How far the periodic cell was strained.
    pub(super) strain: f64,
    /// Whether the lists are to be made anew.
    pub(super) outdated: bool,
    /// How many bonds had broken before the forces were evaluated.
    pub(super) broken: usize,
    /// The first error.
    found: Result<(), RunError>,
    /// Whether no further stage may run.
    ends: bool,
}

impl<'a> TimeStep<'a> {
    /// One in which time stands still: the forces alone.
    pub(super) fn standing(context: &'a Context<'a>) -> Self {
        let step = context.step;
        let progress = Progress { done: 0, count: 0, step, time: 0.0, passed: 0.0, length: 0.0 };
        Self::of(progress, Moment { number: 0, from: 0.0, to: 0.0 }, context)
    }

    /// One that reaches a moment.
    fn of(progress: Progress, moment: Moment, context: &'a Context<'a>) -> Self {
        let (way, farthest, strain) = (0.0, 0.0, 0.0);
        Self {
            progress,
            moment,
            context,
            way,
            farthest,
            strain,
            outdated: false,
            broken: 0,
            found: Ok(()),
            ends: false,
        }
    }

    /// Its length \[s\].
    pub(super) fn length(&self) -> f64 {
        self.context.step
    }

    /// Notes what a stage found. The stages that follow run all the same, and the first error is told.
    pub(super) fn note(&mut self, result: Result<(), RunError>) {
        if self.found.is_ok() {
            self.found = result;
        }
    }

    /// Ends the step here: no stage that follows could run.
    pub(super) fn stop(&mut self, error: RunError) {
        self.note(Err(error));
        self.ends = true;
    }
}

impl Simulation {
    /// Makes one time step: half a kick and the drift, the forces where everything stands then, the other half of the kick.
    ///
    /// An error leaves the state after the whole step.
    pub(super) fn step(&mut self, progress: Progress, context: &Context) -> Result<(), RunError> {
        let moment = self.advance_clock(context.step);
        self.tell_done(BETWEEN);
        let mut step = TimeStep::of(Progress { time: moment.to, ..progress }, moment, context);
        for phase in Phase::ALL {
            if phase != Phase::Forces || !self.scene.heat.frozen {
                self.run_stages(phase, &mut step);
            }
        }
        if step.ends || self.state.clock.speed.is_finite() { step.found } else { Err(self.not_finite()) }
    }

    /// Lets the clock go on by a step of this length \[s\]. Returns the moment that this reaches.
    fn advance_clock(&mut self, step: f64) -> Moment {
        let clock = &mut self.state.clock;
        let from = clock.time;
        clock.advance(step);
        clock.steps += 1;
        clock.last_step = step;
        Moment { number: clock.steps, from, to: clock.time }
    }

    /// Runs the stages of a phase, unless one of them ended the step.
    fn run_stages(&mut self, phase: Phase, step: &mut TimeStep) {
        for place in 0..self.stages.in_phase(phase).len() {
            if step.ends {
                return;
            }
            let stage = self.stages.in_phase(phase)[place];
            (stage.run)(self, step);
            self.tell_done(stage.name);
        }
    }

    /// Tells who watches, if anybody does, that this is done.
    fn tell_done(&mut self, part: &'static str) {
        if let Some(watch) = &mut self.watch {
            watch(part, &self.state);
        }
    }

    /// Evaluates all forces and torques where everything stands, the fields included.
    pub(super) fn evaluate(&mut self, context: &Context) -> Result<(), RunError> {
        let found = self.evaluate_interactions(context);
        self.apply_fields(context);
        found
    }

    /// Evaluates the forces of contacts, bonds and surfaces on particles, and the whole loads on other bodies.
    pub(super) fn evaluate_interactions(&mut self, context: &Context) -> Result<(), RunError> {
        integration::clear_loads(&mut self.state.particles);
        let mut step = TimeStep::standing(context);
        self.run_stages(Phase::Forces, &mut step);
        self.state.heat.iter_mut().for_each(Heat::forget_step);
        step.found
    }

    /// Chooses the stages, by what the scene and its damping need.
    pub(super) fn choose_stages(&mut self) {
        self.stages = Stages::of(self);
    }
}
