//! Rolling sub-models, one a file.

pub mod cdt;
pub mod none;

use super::Rolling;
use crate::choices::choices;

choices! {
    /// `[contact.<law>.rolling.<model>]`
    RollingChoice of Rolling, taken by TakeRolling:
    none::None,
    cdt::Cdt,
}
