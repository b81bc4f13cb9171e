//! What bodies do to each other, what a boundary is and how it moves: pure functions, without `unsafe`.

pub mod bond;
pub mod contact;
mod kept;
pub mod motion;
pub mod region;
pub mod surface;
