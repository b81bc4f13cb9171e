//! Tangential sub-models, each in a file of its own.

pub mod history;
pub mod no_history;
pub mod none;
pub mod rescaled;
pub mod turned_history;

use super::TangentialRow;

/// The tangential sub-models of the program.
pub(crate) const STANDARD: &[&TangentialRow] = &[
    TangentialRow::of::<none::None>(),
    TangentialRow::of::<history::History>(),
    TangentialRow::of::<no_history::NoHistory>(),
    TangentialRow::of::<rescaled::Rescaled>(),
    TangentialRow::of::<turned_history::TurnedHistory>(),
];
