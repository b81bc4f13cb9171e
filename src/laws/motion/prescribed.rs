//! `prescribed`: the scene says how the axis moves.

use super::{AxisPath, Motion, Progress, ShownVariables};

/// An axis that moves at a constant velocity \[m/s, rad/s\].
impl Motion for f64 {
    fn words(&self, unit: &str) -> Option<String> {
        Some(format!("at {self} {unit}"))
    }

    fn seen(&self) -> ShownVariables {
        ShownVariables::Place
    }

    fn at(&self, time: f64) -> Option<[f64; 2]> {
        Some([self * time, *self])
    }

    fn lead(&self, path: &AxisPath, progress: &Progress) -> Option<[f64; 2]> {
        Some([path.target + self * progress.time, *self])
    }
}
