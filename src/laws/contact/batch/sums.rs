//! What the contacts of a piece of a list lose while it is worked on.

use super::trace::Followed;
use crate::laws::contact::LossKind;

/// Twice the losses of a piece of a list, while it is worked on.
#[derive(Default)]
#[repr(C)]
pub(crate) struct Sums {
    /// Of the contacts whose place in the batch is 0, 1, … 7 beyond a multiple of 8 \[J\].
    pub(crate) columns: [[f64; 8]; LossKind::COUNT],
    /// Springs of contacts that ended \[J\].
    parted: f64,
    /// What single contacts did, where they are followed.
    pub(crate) followed: Followed,
}

impl Sums {
    /// Begins a piece.
    pub(crate) fn begin(&mut self) {
        (self.columns, self.parted) = Default::default();
        self.followed.clear();
    }

    /// Adds twice what was lost with a contact that ended, by kind, and what its spring held \[J\].
    pub(crate) fn add_parted(&mut self, (lost, held): ([f64; LossKind::COUNT], f64)) {
        for (column, energy) in self.columns.iter_mut().zip(lost) {
            column[0] += energy;
        }
        self.parted += held;
    }

    /// What was lost, by kind, and springs of contacts that ended \[J\].
    pub(crate) fn end(&self) -> ([f64; LossKind::COUNT], f64) {
        (self.columns.map(|column| 0.5 * column.iter().sum::<f64>()), 0.5 * self.parted)
    }
}
