//! Rolling sub-models, each in a file of its own.

pub mod cdt;
pub mod epsd;
pub mod epsd2;
pub mod none;
pub mod rocking;

use super::Rolling;
use crate::choices::choices;

choices! {
    /// `[contact.<law>.rolling.<model>]`
    RollingChoice of Rolling, taken by TakeRolling:
    none::None,
    cdt::Cdt,
    epsd::Epsd,
    epsd2::Epsd2,
}
