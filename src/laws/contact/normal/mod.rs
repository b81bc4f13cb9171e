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

use super::NormalRow;

/// The normal sub-models of the program.
pub(crate) const STANDARD: &[&NormalRow] = &[
    NormalRow::of::<dmt::Dmt>(),
    NormalRow::of::<eepa::Eepa>(),
    NormalRow::of::<hertz::Hertz>(),
    NormalRow::of::<hertz_stiffness::HertzStiffness>(),
    NormalRow::of::<hooke::Hooke>(),
    NormalRow::of::<hooke_stiffness::HookeStiffness>(),
    NormalRow::of::<hooke_viscous::HookeViscous>(),
    NormalRow::of::<jkr::Jkr>(),
];
