//! Boundaries: how they move, what they press with, and that nothing passes them unseen.

mod machines;
mod motions;
mod nodes;
mod passing;
mod quadratic_motion;
mod servo;
