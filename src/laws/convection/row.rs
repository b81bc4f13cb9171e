//! What the program knows of a law of convection.

use super::Convection;
use crate::base::lanes::{self, Kernel, Lane, Width};
use crate::laws::kept::{ModelKeys, keep, own, read};
use crate::laws::law_row::{LawModel, LawRow};
use std::fmt;
use std::sync::Arc;

/// A law of convection whose type is forgotten.
pub trait Nusselt: fmt::Debug + Send + Sync {
    /// [`Convection::nusselt`] of each of several spheres, in place of its Reynolds number. It is one loop, which the compiler makes of vector
    /// instructions where the law branches nowhere.
    fn numbers(&self, porosities: &[f64], numbers: &mut [f64], prandtl: f64, width: Width);
}

/// Several spheres.
struct Several<'a, C> {
    /// The law.
    law: &'a C,
    /// Porosity at each.
    porosities: &'a [f64],
    /// Reynolds number of each, which the Nusselt number replaces.
    numbers: &'a mut [f64],
    /// Prandtl number.
    prandtl: f64,
}

impl<C: Convection> Kernel for Several<'_, C> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        for (number, porosity) in self.numbers.iter_mut().zip(self.porosities) {
            *number = Convection::nusselt(self.law, *porosity, *number, self.prandtl);
        }
    }
}

impl<C: Convection> Nusselt for C {
    fn numbers(&self, porosities: &[f64], numbers: &mut [f64], prandtl: f64, width: Width) {
        lanes::run(width, Several { law: self, porosities, numbers, prandtl });
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
