//! The way back to the beginning of a communication step that fails.
//!
//! A time step that fails spoils positions, springs, bonds and lists. To copy the state before each communication step
//! would cost as much as several time steps. Instead an earlier state is kept, with what was asked for since then: the
//! same steps give the same bits, so going them again leads to where the failed one began.

use super::{RunError, Simulation};
use crate::engine::state::cell::Strains;
use crate::engine::state::{BoundaryState, Heat, Row, State};

/// Time steps after which a new state is kept: what going back may cost, and what the copy is shared by.
const MOST_STEPS: u64 = 64;

/// What the outside gave for a communication step.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepInputs {
    /// Values of the axes of a boundary.
    target: [f64; 6],
    /// Their rates.
    rate: [f64; 6],
    /// Their second derivatives.
    acceleration: [f64; 3],
}

impl StepInputs {
    /// What was given to a boundary.
    pub(super) fn of(boundary: &BoundaryState) -> Self {
        Self { target: boundary.target, rate: boundary.target_rate, acceleration: boundary.target_acceleration }
    }

    /// Gives it again.
    pub(super) fn give_to(self, boundary: &mut BoundaryState) {
        (boundary.target, boundary.target_rate) = (self.target, self.rate);
        boundary.target_acceleration = self.acceleration;
    }
}

/// An earlier state and the communication steps since then.
#[derive(Debug, Default)]
pub(super) struct Rollback {
    /// The state.
    earlier: Option<State>,
    /// Whether it is one of the present course.
    holds: bool,
    /// Length of each communication step since then \[s\].
    intervals: Vec<f64>,
    /// What was given for them, boundary by boundary.
    given: Vec<StepInputs>,
    /// The same of the nodes of meshes: values and rates.
    nodes: Vec<[Row; 2]>,
    /// The same of the strains of a periodic cell.
    strains: Vec<[Strains; 2]>,
    /// Thermal inputs of boundaries and nodes that were given for them, and their rates.
    heat: Vec<[f64; 2]>,
    /// Rates of insertions that were given for them, and how they change, insertion by insertion.
    rates: Vec<[f64; 2]>,
    /// Whether the beginning of the last communication step is asked for again and again: then it is kept itself.
    close: bool,
    /// Memory of a state that is worked on meanwhile.
    pub(super) room: Option<State>,
}

impl Rollback {
    /// The simulation has changed otherwise than by its communication steps.
    pub(super) fn forget(&mut self) {
        self.holds = false;
    }

    /// Length of the last communication step, if one can be made again \[s\].
    pub(super) fn last_length(&self) -> Option<f64> {
        self.intervals.last().copied().filter(|_| self.holds)
    }

    /// Notes that a communication step of this length \[s\] begins.
    fn note(&mut self, state: &State, interval: f64) {
        let recent = |earlier: &State| state.clock.steps - earlier.clock.steps < MOST_STEPS;
        if self.close || !(self.holds && self.earlier.as_ref().is_some_and(recent)) {
            match &mut self.earlier {
                Some(earlier) => earlier.clone_from(state),
                None => {
                    self.earlier = Some(state.clone());
                    self.intervals.reserve(MOST_STEPS as usize);
                    self.given.reserve(MOST_STEPS as usize * state.boundaries.len());
                }
            }
            self.intervals.clear();
            self.given.clear();
            self.nodes.clear();
            self.strains.clear();
            self.rates.clear();
            self.heat.clear();
            self.holds = true;
        }
        self.intervals.push(interval);
        self.given.extend(state.boundaries.iter().map(StepInputs::of));
        let nodes = state.nodes.iter().flat_map(|nodes| nodes.target.iter().zip(&nodes.target_rate));
        self.nodes.extend(nodes.map(|(target, rate)| [*target, *rate]));
        self.strains.extend(state.cell.iter().map(|cell| [cell.target, cell.target_rate]));
        let thermal = state.heat.iter().flat_map(Heat::surfaces);
        self.heat.extend(thermal.map(|it| [it.target, it.target_rate]));
        let feeds = state.exchange.iter().flat_map(|exchange| &exchange.feeds);
        self.rates.extend(feeds.map(|feed| [feed.rate, feed.rate_of_rate]));
    }
}

impl Simulation {
    /// Runs one communication step of `interval` \[s\] as [`Simulation::advance`] does. If it fails, the state is that of
    /// its beginning.
    pub fn advance_or_roll_back(&mut self, interval: f64) -> Result<(), RunError> {
        self.rollback.note(&self.state, interval);
        self.advance(interval).inspect_err(|_| self.go_back())
    }

    /// Goes back to the beginning of the communication step that was noted last, and gives its length \[s\]. From now on the beginning
    /// of each one is kept.
    pub(super) fn return_to_last(&mut self) -> f64 {
        self.rollback.close = true;
        let length = self.rollback.intervals.last().copied().expect("a communication step was made");
        self.go_back();
        self.rollback.holds = true;
        length
    }

    /// Goes back to the beginning of the communication step that was noted last.
    fn go_back(&mut self) {
        let mut way = std::mem::take(&mut self.rollback);
        let stop = self.stop.take();
        if let Some(earlier) = &way.earlier {
            self.state.clone_from(earlier);
        }
        let last = way.intervals.len() - 1;
        for (number, &interval) in way.intervals.iter().enumerate() {
            let count = self.state.boundaries.len();
            for (boundary, given) in self.state.boundaries.iter_mut().zip(&way.given[number * count..]) {
                given.give_to(boundary);
            }
            let count = self.state.nodes.iter().map(|nodes| nodes.target.len()).sum::<usize>();
            let nodes =
                self.state.nodes.iter_mut().flat_map(|nodes| nodes.target.iter_mut().zip(&mut nodes.target_rate));
            for ((target, rate), given) in nodes.zip(&way.nodes[number * count..]) {
                [*target, *rate] = *given;
            }
            if let Some(cell) = &mut self.state.cell {
                [cell.target, cell.target_rate] = way.strains[number];
            }
            let count = self.state.heat.iter().flat_map(Heat::surfaces).count();
            let thermal = self.state.heat.iter_mut().flat_map(Heat::surfaces_mut);
            for (surface, given) in thermal.zip(&way.heat[number * count..]) {
                [surface.target, surface.target_rate] = *given;
            }
            let feeds = self.state.exchange.iter_mut().flat_map(|exchange| &mut exchange.feeds);
            let count = self.scene.insertions.len();
            for (feed, rates) in feeds.zip(&way.rates[number * count..]) {
                [feed.rate, feed.rate_of_rate] = *rates;
            }
            if number < last {
                self.advance(interval).expect("steps that were made before can be made again");
            }
        }
        self.stop = stop;
        way.forget();
        self.rollback = way;
    }
}
