//! What a piece of a list lost, by kind.

use crate::contact::{Law, LossKind};
use crate::state::{Loss, Losses};

/// Twice the losses of a piece of a list, while it is worked on.
#[derive(Default)]
#[repr(C)]
pub(crate) struct Sums {
    /// Of the contacts whose place in the batch is 0, 1, … 7 beyond a multiple of 8 \[J\].
    pub(super) columns: [[f64; 8]; LossKind::COUNT],
    /// Springs of contacts that ended \[J\].
    parted: f64,
}

impl Sums {
    /// Begins a piece.
    pub(super) fn begin(&mut self) {
        *self = Self::default();
    }

    /// Adds twice what was lost with a contact that ended, by kind, and what its spring held \[J\].
    pub(super) fn add_parted(&mut self, (lost, held): ([f64; LossKind::COUNT], f64)) {
        for (column, energy) in self.columns.iter_mut().zip(lost) {
            column[0] += energy;
        }
        self.parted += held;
    }

    /// The losses of the piece.
    pub(super) fn end(&self) -> Lost {
        Lost { kinds: self.columns.map(|column| 0.5 * column.iter().sum::<f64>()), parted: 0.5 * self.parted }
    }
}

/// What a piece of a list lost.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lost {
    /// By kind \[J\].
    kinds: [f64; LossKind::COUNT],
    /// Springs of contacts that ended \[J\].
    parted: f64,
}

impl Lost {
    /// Adds it to the book, under the causes of its law.
    pub(crate) fn book(&self, law: &Law, losses: &mut Losses) {
        let other = if law.is_plastic() { Loss::Plastic } else { Loss::Cohesion };
        let causes = [
            Loss::NormalDamping,
            Loss::TangentialDamping,
            Loss::Sliding,
            Loss::TangentialStiffness,
            Loss::Projection,
            Loss::Rolling,
            other,
        ];
        for (cause, energy) in causes.into_iter().zip(self.kinds) {
            losses.add(cause, energy);
        }
        losses.add(Loss::Parting, self.parted);
    }
}
