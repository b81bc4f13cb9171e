//! Normal sub-models, each in a file of its own.

pub mod dmt;
pub mod eepa;
pub mod hertz;
pub mod hertz_stiffness;
pub mod hertzian;
pub mod hooke;
pub mod hooke_stiffness;
pub mod hooke_viscous;
pub mod jkr;
pub mod sticky;

use super::Normal;
use crate::choices::choices;

choices! {
    /// `[contact.<law>.normal.<model>]`
    NormalChoice of Normal, taken by TakeNormal:
    dmt::Dmt,
    eepa::Eepa,
    hertz::Hertz,
    hertz_stiffness::HertzStiffness,
    hooke::Hooke,
    hooke_stiffness::HookeStiffness,
    hooke_viscous::HookeViscous,
    jkr::Jkr,
}

impl NormalChoice {
    /// What the damping follows, if the model is one of the adhesive elastic spheres.
    pub fn sticky(&self) -> Option<sticky::DampingKind> {
        match self {
            Self::Dmt(keys) | Self::Jkr(keys) => Some(keys.damping),
            _ => None,
        }
    }
}
