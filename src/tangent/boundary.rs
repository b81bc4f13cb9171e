//! Slopes of a boundary.

use super::Inputs;
use crate::dual::Slopes;

/// How a boundary changes.
pub(crate) struct BoundarySlopes<I: Inputs> {
    /// Of where it is to be at the end of the communication step, along and about x, y, z; of the force that is given, where
    /// forces move it.
    pub end: [I::Each; 6],
    /// Of the rotation vector of the communication step.
    pub turn: [I::Each; 3],
    /// Of its orientation.
    pub orientation: I::Row,
    /// Of its angular velocity.
    pub angular_velocity: [I::Each; 3],
    /// Of the whole load that moves it.
    pub load: [I::Each; 3],
    /// Of its displacement.
    pub displacement: [I::Each; 3],
    /// Of its velocity.
    pub velocity: [I::Each; 3],
    /// Of the force on it.
    pub force: [I::Each; 3],
    /// Of the moment on it.
    pub moment: [I::Each; 3],
    /// Of the impulse of the communication step.
    pub impulse: [I::Each; 3],
    /// Of its angular impulse.
    pub angular_impulse: [I::Each; 3],
}

impl<I: Inputs> Default for BoundarySlopes<I> {
    fn default() -> Self {
        let none = [I::Each::none(); 3];
        Self {
            end: [I::Each::none(); 6],
            turn: none,
            orientation: I::NONE,
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

impl<I: Inputs> BoundarySlopes<I> {
    /// Whether an input moves it.
    pub(crate) fn is_moved(&self) -> bool {
        let moved = |slopes: &[I::Each; 3]| slopes.iter().any(|each| (0..I::COUNT).any(|d| each[d] != 0.0));
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
    pub(crate) fn add_load(&mut self, force: [I::Each; 3], moment: [I::Each; 3]) {
        for (sums, parts) in [(&mut self.force, force), (&mut self.moment, moment)] {
            for (sum, part) in sums.iter_mut().zip(parts) {
                *sum = sum.plus(part);
            }
        }
    }
}
