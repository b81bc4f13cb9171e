//! The program with what this crate adds: `wet run scene.toml`, `wet export scene.toml -o wet.fmu`.

use std::process::ExitCode;

fn main() -> ExitCode {
    cograin_command::main_with(&own_law::models(), "own_law")
}
