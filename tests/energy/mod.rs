//! The books of energy.

mod books;
mod losses;
