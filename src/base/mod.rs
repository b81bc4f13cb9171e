//! What every floor stands on: numbers, quantities, orientations, vector registers, threads, and the text of a scene with its places.

pub(crate) mod document;
pub(crate) mod files;
pub mod geometry;
pub mod lanes;
pub mod memory;
pub mod number;
pub mod powers;
pub mod quantity;
pub(crate) mod threads;
pub(crate) mod vtk_reader;
pub mod words;
