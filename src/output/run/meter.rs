//! What a session counts as it goes.

use crate::engine::simulation::{RunError, Simulation};
use std::time::{Duration, Instant};

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
    /// Contacts at the last look.
    pub(super) contacts: usize,
    /// Largest overlap over radius at any look.
    pub(super) largest_overlap: f64,
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
            largest_overlap: simulation.largest_overlap(),
        }
    }

    /// Makes a communication step and counts it.
    pub(crate) fn step(&mut self, simulation: &mut Simulation, interval: f64) -> Result<(), RunError> {
        let (begun, before) = (Instant::now(), simulation.state().clock.steps);
        let result = simulation.advance(interval);
        self.stepping += begun.elapsed();
        let contacts = simulation.contact_count();
        let steps = (simulation.state().clock.steps - before) as f64;
        self.contact_steps += 0.5 * steps * (self.contacts + contacts) as f64;
        self.contacts = contacts;
        self.bond_steps += steps * intact_bonds(simulation) as f64;
        result
    }

    /// Looks at the overlaps.
    pub(crate) fn look(&mut self, simulation: &Simulation) {
        self.largest_overlap = self.largest_overlap.max(simulation.largest_overlap());
    }
}

/// Bonds that live.
pub(super) fn intact_bonds(simulation: &Simulation) -> usize {
    simulation.state().bonds.iter().map(|list| list.first.len()).sum()
}
