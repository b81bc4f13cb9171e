//! The algorithmic energy book.

use serde::{Deserialize, Serialize};

/// Work of each kind of force on the moving particles since time 0, as the integrator does it: each half kick
/// times the mean of the velocities before and after. Their sum is the change of kinetic energy, to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Kinetic energy at time 0 \[J\].
    pub initial_kinetic: f64,
    /// Of contacts between particles \[J\].
    pub contacts: f64,
    /// Of planes on particles \[J\].
    pub walls: f64,
    /// Of bonds \[J\].
    pub bonds: f64,
    /// Of gravity \[J\].
    pub gravity: f64,
    /// Of applied forces \[J\].
    pub applied: f64,
    /// Of global damping \[J\].
    pub damping: f64,
}

impl Ledger {
    /// Work of all forces \[J\].
    pub fn total(&self) -> f64 {
        self.contacts + self.walls + self.bonds + self.gravity + self.applied + self.damping
    }
}
