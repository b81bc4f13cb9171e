//! `conveying`: the axis stays, and the surface runs along it in itself, as a conveyor belt does.

use super::{Motion, ShownVariables};

/// An axis that stays while the surface runs along it.
pub(super) struct Conveying {
    /// How fast it runs \[m/s\].
    pub velocity: f64,
}

impl Motion for Conveying {
    fn words(&self, unit: &str) -> Option<String> {
        Some(format!("conveying at {} {unit}", self.velocity))
    }

    fn seen(&self) -> ShownVariables {
        ShownVariables::Nothing
    }
}
