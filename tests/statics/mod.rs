//! The condensed stiffness of boundaries: against closed forms, and against what the time steps come to when they have
//! settled.

mod cells;
mod derivatives;
mod rest;
mod scenes;
mod stiffness;
