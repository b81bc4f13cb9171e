//! What a session counts as it goes.

use crate::engine::simulation::{RunError, Simulation};
use std::time::{Duration, Instant};

/// Wall time of a part of a communication step: how long a request to stop may wait, if a time step does not take longer.
const PART: Duration = Duration::from_millis(100);

/// How many times as many time steps the next part may have as the one before.
const FASTER: u64 = 16;

/// How many time steps make a part of a communication step, by what they took so far. Results do not depend on it.
#[derive(Debug)]
pub(super) struct Pace {
    /// Time steps of the next part.
    most: u64,
}

impl Default for Pace {
    fn default() -> Self {
        Self { most: 1 }
    }
}

impl Pace {
    /// Makes a part of a communication step. Returns whether its end is reached.
    pub(super) fn part(&mut self, simulation: &mut Simulation, interval: f64) -> Result<bool, RunError> {
        self.part_of(simulation, interval, u64::MAX)
    }

    /// The same of so many time steps at most.
    pub(super) fn part_of(&mut self, simulation: &mut Simulation, interval: f64, most: u64) -> Result<bool, RunError> {
        let (begun, before) = (Instant::now(), simulation.state().clock.steps);
        let result = simulation.advance_part(interval, self.most.min(most));
        let made = simulation.state().clock.steps - before;
        let fitting = PART.as_secs_f64() / begun.elapsed().as_secs_f64().max(1e-9) * made as f64;
        self.most = (fitting as u64).clamp(1, FASTER * self.most);
        result
    }
}

/// Counts what a session does.
pub(crate) struct Meter {
    /// When the session began.
    pub(super) begun: Instant,
    /// Time spent in time steps.
    pub(super) stepping: Duration,
    /// Time steps of earlier sessions.
    pub(super) steps_before: u64,
    /// Contacts summed over the time steps of the session.
    pub(super) contact_steps: f64,
    /// Bonds summed over the time steps of the session.
    pub(super) bond_steps: f64,
    /// Contacts at the last count.
    pub(super) contacts: usize,
    /// Time steps made at the last count.
    counted: u64,
    /// Largest overlap over radius at any look.
    pub(super) largest_overlap: f64,
    /// How long parts of communication steps are.
    pace: Pace,
}

impl Meter {
    /// Begins to count.
    pub(crate) fn start(simulation: &Simulation) -> Self {
        Self {
            begun: Instant::now(),
            stepping: Duration::ZERO,
            steps_before: simulation.state().clock.steps,
            contact_steps: 0.0,
            bond_steps: 0.0,
            contacts: simulation.contact_count(),
            counted: simulation.state().clock.steps,
            largest_overlap: simulation.largest_overlap(),
            pace: Pace::default(),
        }
    }

    /// Makes a part of a communication step. At its end the step is counted: parts depend on the clock, means must not. Returns whether
    /// the end is reached.
    pub(crate) fn part(&mut self, simulation: &mut Simulation, interval: f64) -> Result<bool, RunError> {
        let begun = Instant::now();
        let result = self.pace.part(simulation, interval);
        self.stepping += begun.elapsed();
        if let Ok(true) = result {
            self.count(simulation);
        }
        result
    }

    /// Counts the time steps since the last count.
    fn count(&mut self, simulation: &Simulation) {
        let (steps, contacts) = (simulation.state().clock.steps, simulation.contact_count());
        let made = (steps - self.counted) as f64;
        self.contact_steps += 0.5 * made * (self.contacts + contacts) as f64;
        self.bond_steps += made * intact_bonds(simulation) as f64;
        (self.counted, self.contacts) = (steps, contacts);
    }

    /// Counts what is left, and looks at the overlaps.
    pub(crate) fn look(&mut self, simulation: &Simulation) {
        self.count(simulation);
        self.largest_overlap = self.largest_overlap.max(simulation.largest_overlap());
    }
}

/// Bonds that live.
pub(super) fn intact_bonds(simulation: &Simulation) -> usize {
    simulation.state().bonds.iter().map(|list| list.first.len()).sum()
}
