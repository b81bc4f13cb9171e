//! Rolling sub-models, each in a file of its own.

pub mod cdt;
pub mod epsd;
pub mod epsd2;
pub mod none;
pub mod rocking;

use super::RollingRow;

/// The rolling sub-models of the program.
pub(crate) const STANDARD: &[&RollingRow] = &[
    RollingRow::of::<none::None>(),
    RollingRow::of::<cdt::Cdt>(),
    RollingRow::of::<epsd::Epsd>(),
    RollingRow::of::<epsd2::Epsd2>(),
];
