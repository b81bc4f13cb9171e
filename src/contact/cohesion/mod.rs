//! Cohesion sub-models, one a file.

pub mod none;

use super::Cohesion;
use crate::choices::choices;

choices! {
    /// `[contact.<law>.cohesion.<model>]`
    CohesionChoice of Cohesion, taken by TakeCohesion:
    none::None,
}
