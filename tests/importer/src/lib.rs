//! The crate `fmi`, an importer in Rust that is not ours, loads an exported unit. All is in `tests/`.
//!
//! `COGRAIN_PROGRAM` names the program that exports the unit, seen from the root of the repository; `target/debug/cograin` if it is
//! not set. `tools/test` runs these tests and tells `fmi-sys` where libclang is.
