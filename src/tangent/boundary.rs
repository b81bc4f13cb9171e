//! Slopes of a boundary.

use crate::dual::{RowSlopes, Slopes};

/// How a boundary changes.
#[derive(Clone, Debug, Default)]
pub(crate) struct BoundarySlopes {
    /// Of where it is to be at the end of the communication step, along and about x, y, z; of the force that is given, where
    /// forces move it.
    pub end: [Slopes; 6],
    /// Of the rotation vector of the communication step.
    pub turn: [Slopes; 3],
    /// Of its orientation.
    pub orientation: RowSlopes,
    /// Of its angular velocity.
    pub angular_velocity: [Slopes; 3],
    /// Of the whole load that moves it.
    pub load: [Slopes; 3],
    /// Of its displacement.
    pub displacement: [Slopes; 3],
    /// Of its velocity.
    pub velocity: [Slopes; 3],
    /// Of the force on it.
    pub force: [Slopes; 3],
    /// Of the moment on it.
    pub moment: [Slopes; 3],
    /// Of the impulse of the communication step.
    pub impulse: [Slopes; 3],
    /// Of its angular impulse.
    pub angular_impulse: [Slopes; 3],
}

impl BoundarySlopes {
    /// Whether an input moves it.
    pub(crate) fn is_moved(&self) -> bool {
        let moved = |slopes: &[Slopes; 3]| slopes.iter().flatten().any(|slope| *slope != 0.0);
        moved(&self.displacement) || moved(&self.velocity) || moved(&self.turn)
    }

    /// Adds to the slopes of the load on it.
    pub(crate) fn add_load(&mut self, force: &[Slopes; 3], moment: &[Slopes; 3]) {
        super::add_vector(&mut self.force, force);
        super::add_vector(&mut self.moment, moment);
    }

    /// Adds half a time step of the present load to the impulses \[s\].
    pub(crate) fn book(&mut self, half: f64) {
        for (impulses, loads) in [(&mut self.impulse, &self.force), (&mut self.angular_impulse, &self.moment)] {
            for (sum, part) in impulses.iter_mut().flatten().zip(loads.iter().flatten()) {
                *sum += half * part;
            }
        }
    }
}
