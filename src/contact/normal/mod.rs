//! Normal sub-models, one a file.

pub mod hertz;
pub mod hertz_stiffness;
pub mod hertzian;
pub mod hooke;
pub mod hooke_stiffness;
pub mod hooke_viscous;

use super::Normal;
use crate::choices::choices;

choices! {
    /// `[contact.<law>.normal.<model>]`
    NormalChoice of Normal, taken by TakeNormal:
    hertz::Hertz,
    hertz_stiffness::HertzStiffness,
    hooke::Hooke,
    hooke_stiffness::HookeStiffness,
    hooke_viscous::HookeViscous,
}
