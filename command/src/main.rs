//! The program with the sub-models that come with it.

use cograin::export::STANDARD_LIBRARY;
use cograin::scene::Models;
use std::process::ExitCode;

/// Large arrays begin at different places of a page.
#[global_allocator]
static ALLOCATOR: cograin::memory::Staggered = cograin::memory::Staggered;

fn main() -> ExitCode {
    cograin_command::main_with(&Models::standard(), STANDARD_LIBRARY)
}
