//! What bodies do to each other, what a boundary is and how it moves: pure functions. `unsafe` stands in `contact/batch` alone.

pub mod bond;
pub mod column;
pub mod contact;
pub mod convection;
pub mod drag;
mod kept;
pub(crate) mod law_row;
pub mod lift;
pub mod motion;
pub mod region;
pub mod surface;
pub mod wear;
