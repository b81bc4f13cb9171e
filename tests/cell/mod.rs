//! A periodic cell: its images, its motion, its stress and its work, against closed forms.

mod boundaries;
mod clumps;
mod exchange;
mod flights;
mod lattices;
mod runs;
mod scenes;
mod servos;
mod stress;
