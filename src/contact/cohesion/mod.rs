//! Cohesion sub-models, each in a file of its own.

pub mod attraction;
pub mod none;
pub mod sjkr;
pub mod sjkr2;

use super::Cohesion;
use crate::choices::choices;

choices! {
    /// `[contact.<law>.cohesion.<model>]`
    CohesionChoice of Cohesion, taken by TakeCohesion:
    none::None,
    sjkr::Sjkr,
    sjkr2::Sjkr2,
}
