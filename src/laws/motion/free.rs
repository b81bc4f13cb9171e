//! `free`: the axis is moved by the forces on the boundary.

use super::{Motion, ShownVariables};

/// An axis that forces move.
pub(super) struct Free;

impl Motion for Free {
    fn words(&self, _unit: &str) -> Option<String> {
        Some("free".to_owned())
    }

    fn seen(&self) -> ShownVariables {
        ShownVariables::PlaceAndRate
    }

    fn is_free(&self) -> bool {
        true
    }
}
