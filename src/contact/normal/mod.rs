//! Normal sub-models, one a file.

pub mod hertz;

use super::Normal;
use crate::choices::choices;

choices! {
    /// `[contact.<law>.normal.<model>]`
    NormalChoice of Normal, taken by TakeNormal:
    hertz::Hertz,
}
