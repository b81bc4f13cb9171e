//! `cograin completion`: what shells and `man` read.

use super::{Ending, say_as_it_is};
use clap::{Args, CommandFactory, ValueEnum};
use clap_complete::Shell;

/// `cograin completion`
#[derive(Args)]
pub(super) struct CompletionArguments {
    /// What it is for: a shell, or man for the manual page
    #[arg(value_enum)]
    reader: Reader,
}

/// Who reads it.
#[derive(Clone, Copy, ValueEnum)]
enum Reader {
    /// Bash.
    Bash,
    /// Elvish.
    Elvish,
    /// Fish.
    Fish,
    /// The manual.
    Man,
    /// PowerShell.
    Powershell,
    /// Zsh.
    Zsh,
}

/// `cograin completion`
pub(super) fn completion(arguments: &CompletionArguments) -> Result<(), Ending> {
    let mut command = super::Arguments::command();
    let mut text = Vec::new();
    let shell = match arguments.reader {
        Reader::Bash => Shell::Bash,
        Reader::Elvish => Shell::Elvish,
        Reader::Fish => Shell::Fish,
        Reader::Powershell => Shell::PowerShell,
        Reader::Zsh => Shell::Zsh,
        Reader::Man => return manual(command),
    };
    let name = command.get_name().to_owned();
    clap_complete::generate(shell, &mut command, name, &mut text);
    say_as_it_is(&text)
}

/// The manual page: the program, then each command.
fn manual(command: clap::Command) -> Result<(), Ending> {
    let mut text = Vec::new();
    let mut write = |command: clap::Command, first: bool| {
        let page = clap_mangen::Man::new(command);
        let parts = if first {
            page.render(&mut text)
        } else {
            page.render_synopsis_section(&mut text).and_then(|()| page.render_options_section(&mut text))
        };
        parts.map_err(|error| Ending::failed(format_args!("the manual page cannot be made: {error}")))
    };
    let mut all = command;
    all.build();
    let commands: Vec<clap::Command> = all.get_subcommands().filter(|it| it.get_name() != "help").cloned().collect();
    write(all, true)?;
    commands.into_iter().try_for_each(|command| write(command, false))?;
    say_as_it_is(&text)
}
