//! What the program knows of a drag law.

use super::Drag;
use crate::base::lanes::{self, Kernel, Lane, Width};
use crate::laws::kept::{ModelKeys, keep, own, read};
use crate::laws::law_row::{LawModel, LawRow};
use std::fmt;
use std::sync::Arc;

/// A drag law whose type is forgotten.
pub trait Factor: fmt::Debug + Send + Sync {
    /// [`Drag::factor`]
    fn factor(&self, porosity: f64, reynolds: f64) -> f64;
    /// [`Drag::factor`] of each of several spheres, in place of its Reynolds number. It is one loop, which the compiler makes of vector
    /// instructions where the law branches nowhere.
    fn factors(&self, porosities: &[f64], numbers: &mut [f64], width: Width);
}

/// Several spheres.
struct Several<'a, D> {
    /// The law.
    law: &'a D,
    /// Porosity at each.
    porosities: &'a [f64],
    /// Reynolds number of each, which the factor replaces.
    numbers: &'a mut [f64],
}

impl<D: Drag> Kernel for Several<'_, D> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        for (number, porosity) in self.numbers.iter_mut().zip(self.porosities) {
            *number = Drag::factor(self.law, *porosity, *number);
        }
    }
}

impl<D: Drag> Factor for D {
    fn factor(&self, porosity: f64, reynolds: f64) -> f64 {
        Drag::factor(self, porosity, reynolds)
    }

    fn factors(&self, porosities: &[f64], numbers: &mut [f64], width: Width) {
        lanes::run(width, Several { law: self, porosities, numbers });
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
