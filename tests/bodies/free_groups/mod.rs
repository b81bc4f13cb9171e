//! Groups of particles that forces move, or that turn: against theory, against single particles, and their books.

mod books;
mod motion;
mod rotations;
mod scenes;
