//! `loaded`: the axis is moved by the forces on the boundary, one of which is an input.

use super::{Motion, ShownVariables};

/// An axis that forces move, those of the input `<boundary>.applied_force.<axis>` or `<boundary>.applied_moment.<axis>`
/// among them.
pub(super) struct Loaded {
    /// What the input starts with \[N, N m\].
    pub start: f64,
}

impl Motion for Loaded {
    fn words(&self, _unit: &str) -> Option<String> {
        Some(match self.start {
            0.0 => "loaded".to_owned(),
            start => format!("loaded, from {start} on"),
        })
    }

    fn seen(&self) -> ShownVariables {
        ShownVariables::Load
    }

    fn is_free(&self) -> bool {
        true
    }

    fn first_input(&self) -> f64 {
        self.start
    }
}
