//! What the program knows of a law of lift.

use super::{Lift, Rotation};
use crate::laws::kept::{ModelKeys, keep, own, read};
use crate::laws::law_row::{LawModel, LawRow};
use std::fmt;
use std::sync::Arc;

/// A law of lift whose type is forgotten.
pub trait Across: fmt::Debug + Send + Sync {
    /// [`Lift::ROTATION`]
    fn rotation(&self) -> Rotation;
    /// [`Lift::factor`]
    fn factor(&self, reynolds: f64, rotation: f64) -> f64;
}

impl<L: Lift> Across for L {
    fn rotation(&self) -> Rotation {
        L::ROTATION
    }

    fn factor(&self, reynolds: f64, rotation: f64) -> f64 {
        Lift::factor(self, reynolds, rotation)
    }
}

/// What the program knows of a law of lift.
pub type LiftRow = LawRow<dyn Across>;

/// A law of lift as a scene chose it.
pub type LiftModel = LawModel<dyn Across>;

impl LiftRow {
    /// The row of a law.
    pub const fn of<L: Lift>() -> &'static Self {
        const {
            &Self {
                name: L::NAME,
                read: read::<L::Keys>,
                law: |keys| Arc::new(L::of(own::<L::Keys>(keys))),
                of_one_sphere: true,
            }
        }
    }
}

impl LiftModel {
    /// A law with these keys.
    pub fn of<L: Lift>(keys: L::Keys) -> Self
    where
        L::Keys: ModelKeys,
    {
        Self { row: LiftRow::of::<L>(), keys: keep(keys) }
    }

    /// About what it acts.
    pub fn rotation(&self) -> Rotation {
        self.law().rotation()
    }
}
