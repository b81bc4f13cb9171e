//! What bodies do to each other, what a boundary is and how it moves: pure functions. `unsafe` stands in `contact/batch` alone.

pub mod bond;
pub mod column;
pub mod contact;
pub mod drag;
mod kept;
pub mod motion;
pub mod region;
pub mod surface;
pub mod wear;
