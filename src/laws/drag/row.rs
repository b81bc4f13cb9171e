//! What the program knows of a drag law.

use super::Drag;
use crate::laws::kept::{ModelKeys, keep, own, read};
use crate::laws::law_row::{LawModel, LawRow};
use std::fmt;
use std::sync::Arc;

/// A drag law whose type is forgotten.
pub trait Factor: fmt::Debug + Send + Sync {
    /// [`Drag::factor`]
    fn factor(&self, porosity: f64, reynolds: f64) -> f64;
}

impl<D: Drag> Factor for D {
    fn factor(&self, porosity: f64, reynolds: f64) -> f64 {
        Drag::factor(self, porosity, reynolds)
    }
}

/// What the program knows of a drag law.
pub type DragRow = LawRow<dyn Factor>;

/// A drag law as a scene chose it.
pub type DragModel = LawModel<dyn Factor>;

impl DragRow {
    /// The row of a law.
    pub const fn of<D: Drag>() -> &'static Self {
        const {
            &Self {
                name: D::NAME,
                read: read::<D::Keys>,
                law: |keys| Arc::new(D::of(own::<D::Keys>(keys))),
                of_one_sphere: D::OF_ONE_SPHERE,
            }
        }
    }
}

impl DragModel {
    /// A law with these keys.
    pub fn of<D: Drag>(keys: D::Keys) -> Self
    where
        D::Keys: ModelKeys,
    {
        Self { row: DragRow::of::<D>(), keys: keep(keys) }
    }
}
