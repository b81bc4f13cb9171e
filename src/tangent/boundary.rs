//! Slopes of a boundary.

use crate::dual::Slopes;
use crate::state::Row;

/// How a boundary changes.
pub(crate) struct BoundarySlopes {
    /// Of where it is to be at the end of the communication step, along and about x, y, z; of the force that is given, where
    /// forces move it.
    pub end: [[f64; 1]; 6],
    /// Of the rotation vector of the communication step.
    pub turn: [[f64; 1]; 3],
    /// Of its orientation.
    pub orientation: Row,
    /// Of its angular velocity.
    pub angular_velocity: [[f64; 1]; 3],
    /// Of the whole load that moves it.
    pub load: [[f64; 1]; 3],
    /// Of its displacement.
    pub displacement: [[f64; 1]; 3],
    /// Of its velocity.
    pub velocity: [[f64; 1]; 3],
    /// Of the force on it.
    pub force: [[f64; 1]; 3],
    /// Of the moment on it.
    pub moment: [[f64; 1]; 3],
    /// Of the impulse of the communication step.
    pub impulse: [[f64; 1]; 3],
    /// Of its angular impulse.
    pub angular_impulse: [[f64; 1]; 3],
}

impl Default for BoundarySlopes {
    fn default() -> Self {
        let none = [[0.0]; 3];
        Self {
            end: [[0.0]; 6],
            turn: none,
            orientation: [0.0; 4],
            angular_velocity: none,
            load: none,
            displacement: none,
            velocity: none,
            force: none,
            moment: none,
            impulse: none,
            angular_impulse: none,
        }
    }
}

impl BoundarySlopes {
    /// Whether an input moves it.
    pub(crate) fn is_moved(&self) -> bool {
        let moved = |slopes: &[[f64; 1]; 3]| slopes.iter().any(|each| each[0] != 0.0);
        moved(&self.displacement) || moved(&self.velocity) || moved(&self.turn)
    }

    /// Adds half a time step of the present load to the impulses \[s\].
    pub(crate) fn book(&mut self, half: f64) {
        for (impulses, loads) in [(&mut self.impulse, &self.force), (&mut self.angular_impulse, &self.moment)] {
            for (sum, part) in impulses.iter_mut().zip(loads) {
                *sum = sum.plus(part.times(half));
            }
        }
    }

    /// Adds to the slopes of the load on it.
    pub(crate) fn add_load(&mut self, force: [[f64; 1]; 3], moment: [[f64; 1]; 3]) {
        for (sums, parts) in [(&mut self.force, force), (&mut self.moment, moment)] {
            for (sum, part) in sums.iter_mut().zip(parts) {
                *sum = sum.plus(part);
            }
        }
    }
}
