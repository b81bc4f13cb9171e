//! The time step: its stages, its length, and where it begins.

mod foreseen;
mod pace;
mod plane;
mod random_scenes;
pub(crate) mod stable;
mod stages;
mod starting;
mod threads;
mod touching_starts;
