//! A fluid without a partner: drag laws against closed forms, books, fields on grids, heat, and the same bits.

mod beside;
mod bits;
mod books;
mod convection;
mod fields;
mod given;
mod laws;
mod lift;
mod momentum;
mod scenes;
