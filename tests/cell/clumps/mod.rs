//! Clumps in a periodic cell: stress against closed forms, work, motion through the faces, bits.

mod lattices;
mod motion;
mod scenes;
