//! What the program knows of a law of convection.

use super::Convection;
use crate::laws::kept::{ModelKeys, keep, own, read};
use crate::laws::law_row::{LawModel, LawRow};
use std::fmt;
use std::sync::Arc;

/// A law of convection whose type is forgotten.
pub trait Nusselt: fmt::Debug + Send + Sync {
    /// [`Convection::nusselt`]
    fn nusselt(&self, porosity: f64, reynolds: f64, prandtl: f64) -> f64;
}

impl<C: Convection> Nusselt for C {
    fn nusselt(&self, porosity: f64, reynolds: f64, prandtl: f64) -> f64 {
        Convection::nusselt(self, porosity, reynolds, prandtl)
    }
}

/// What the program knows of a law of convection.
pub type ConvectionRow = LawRow<dyn Nusselt>;

/// A law of convection as a scene chose it.
pub type ConvectionModel = LawModel<dyn Nusselt>;

impl ConvectionRow {
    /// The row of a law.
    pub const fn of<C: Convection>() -> &'static Self {
        const {
            &Self {
                name: C::NAME,
                read: read::<C::Keys>,
                law: |keys| Arc::new(C::of(own::<C::Keys>(keys))),
                of_one_sphere: C::OF_ONE_SPHERE,
            }
        }
    }
}

impl ConvectionModel {
    /// A law with these keys.
    pub fn of<C: Convection>(keys: C::Keys) -> Self
    where
        C::Keys: ModelKeys,
    {
        Self { row: ConvectionRow::of::<C>(), keys: keep(keys) }
    }
}
