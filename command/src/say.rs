//! What is printed.

use super::Ending;
use std::fmt::Display;
use std::io::{ErrorKind, Write};

/// Prints a line.
pub(super) fn say(line: impl Display) -> Result<(), Ending> {
    say_as_it_is(format!("{}\n", printable(&line.to_string())).as_bytes())
}

/// Prints a text of the program's own.
pub(super) fn say_as_it_is(text: &[u8]) -> Result<(), Ending> {
    written(std::io::stdout().write_all(text))
}

/// What became of a text for the standard output. A reader that is gone does not want to know more; that a disk is full must be told.
pub(super) fn written(result: std::io::Result<()>) -> Result<(), Ending> {
    match result.and_then(|()| std::io::stdout().flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Ending::failed(format_args!("the standard output cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// The text with control characters written out: names come from files, and a terminal would obey them.
pub(super) fn printable(text: &str) -> String {
    let shown = |letter: char| match letter {
        '\n' => "\n".to_owned(),
        letter if letter.is_control() => letter.escape_default().to_string(),
        letter => letter.to_string(),
    };
    text.chars().map(shown).collect()
}
