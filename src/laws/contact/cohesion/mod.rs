//! Cohesion sub-models, each in a file of its own.

pub mod attraction;
pub mod none;
pub mod sjkr;
pub mod sjkr2;

use super::CohesionRow;

/// The cohesion sub-models of the program.
pub(crate) const STANDARD: &[&CohesionRow] =
    &[CohesionRow::of::<none::None>(), CohesionRow::of::<sjkr::Sjkr>(), CohesionRow::of::<sjkr2::Sjkr2>()];
