//! What leaves the program: a run and its files, the report of a check, the package of a unit.

pub mod export;
pub mod report;
pub mod results;
pub mod run;
#[cfg(test)]
mod scratch;
