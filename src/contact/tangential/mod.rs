//! Tangential sub-models, each in a file of its own.

pub mod history;
pub mod no_history;
pub mod none;
pub mod rescaled;
pub mod turned_history;

use super::Tangential;
use crate::choices::choices;

choices! {
    /// `[contact.<law>.tangential.<model>]`
    TangentialChoice of Tangential, taken by TakeTangential:
    none::None,
    history::History,
    no_history::NoHistory,
    rescaled::Rescaled,
    turned_history::TurnedHistory,
}
