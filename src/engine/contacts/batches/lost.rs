//! What a piece of a list lost, by kind.

use crate::engine::state::{Loss, Losses};
use crate::laws::contact::{Law, LossKind};

/// What a piece of a list lost.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lost {
    /// By kind \[J\].
    kinds: [f64; LossKind::COUNT],
    /// Springs of contacts that ended \[J\].
    parted: f64,
}

impl Lost {
    /// What was lost by kind, and springs of contacts that ended \[J\].
    pub(super) fn of((kinds, parted): ([f64; LossKind::COUNT], f64)) -> Self {
        Self { kinds, parted }
    }

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
