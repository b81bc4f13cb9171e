//! `driven`: the axis follows an input, by displacement or by velocity.

use super::{AxisPath, InputCourse, Motion, Progress, ShownVariables};

/// An axis that follows the input `<boundary>.displacement.<axis>` or `<boundary>.rotation.<axis>`.
pub(super) struct Driven;

impl Motion for Driven {
    fn words(&self, _unit: &str) -> Option<String> {
        Some("driven".to_owned())
    }

    fn seen(&self) -> ShownVariables {
        ShownVariables::Input
    }

    fn lead(&self, path: &AxisPath, progress: &Progress) -> Option<[f64; 2]> {
        let AxisPath { start, target, before, course, .. } = *path;
        let share = progress.share(course);
        let bent = match course {
            InputCourse::Quadratic => {
                0.5 * path.acceleration * progress.length * progress.length * share * (1.0 - share)
            }
            InputCourse::Ramp | InputCourse::Smooth | InputCourse::Hold => 0.0,
        };
        let displacement = if progress.is_last() { target } else { start + (target - start) * share - bent };
        let velocity = match course {
            InputCourse::Ramp => (target - start) / progress.length,
            InputCourse::Smooth | InputCourse::Quadratic => (displacement - before) / progress.step,
            InputCourse::Hold => 0.0,
        };
        Some([displacement, velocity])
    }
}

/// An axis that moves at the input `<boundary>.velocity.<axis>` or `<boundary>.angular_velocity.<axis>`, in a communication step at
/// its mean.
pub(super) struct VelocityDriven;

impl Motion for VelocityDriven {
    fn words(&self, _unit: &str) -> Option<String> {
        Some("driven by velocity".to_owned())
    }

    fn seen(&self) -> ShownVariables {
        ShownVariables::Rate
    }

    fn lead(&self, path: &AxisPath, progress: &Progress) -> Option<[f64; 2]> {
        Driven.lead(path, progress)
    }
}
