//! `fixed`: the axis stays.

use super::{Motion, ShownVariables};

/// An axis that stays.
pub(super) struct Fixed;

impl Motion for Fixed {
    fn words(&self, _unit: &str) -> Option<String> {
        None
    }

    fn seen(&self) -> ShownVariables {
        ShownVariables::Nothing
    }
}
