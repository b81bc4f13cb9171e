//! The command line: parse, call, print.
//!
//! A program with sub-models of its own calls [`main_with`]; it checks, runs, settles and exports scenes that name them.

mod chart;
mod check;
mod ending;
mod interruption;
mod package;
mod progress;
mod recipes;
mod replay;
mod run;
mod say;
mod scene;
mod settle;
mod shell;

use clap::{Parser, Subcommand};
use cograin::scene::Models;
use cograin::statics::Factorise;
use ending::Ending;
use interruption::tell_of_full_files;
use say::{printable, say, say_as_it_is, written};
use std::io::Write;
use std::process::ExitCode;

/// What finds the sparse factors of a network.
const FACTORISE: Option<Factorise> = Some(cograin_sparse::factorise);

/// Particles with bonded and cohesive contacts, run alone or packaged as FMI 2.0 co-simulation units.
///
/// Exit status: 0 done, 1 the work failed, 2 the input was refused.
#[derive(Parser)]
#[command(name = "cograin", version)]
struct Arguments {
    /// What to do.
    #[command(subcommand)]
    command: Command,
    /// Show no progress and no closing line; reports and errors still appear
    #[arg(short, long, global = true)]
    quiet: bool,
}

/// The commands.
#[derive(Subcommand)]
enum Command {
    /// Write a commented scene to start from
    New(recipes::NewArguments),
    /// Read a scene; say what it uses, how long its time step may be, what it costs and what is risky in it
    Check(check::CheckArguments),
    /// List the inputs, outputs and parameters of a scene, with unit and meaning
    Variables(check::VariablesArguments),
    /// Run a scene to its end and write its results
    Run(run::RunArguments),
    /// Run a scene with damping until it is at rest and write its state
    Settle(settle::SettleArguments),
    /// Package a scene as a co-simulation unit
    Export(package::ExportArguments),
    /// Replay reference cases of other engines and compare
    Verify(replay::VerifyArguments),
    /// Chart the outputs of a scene over its time step, and recommend one: a table and a picture
    Chart(chart::ChartArguments),
    /// Print what a shell needs to complete commands and options, or the manual page
    Completion(shell::CompletionArguments),
}

/// The whole program, for scenes that may name these sub-models; units carry the library of this name, which `cograin_unit::unit!` makes
/// with the same sub-models.
pub fn main_with(models: &Models, library: &str) -> ExitCode {
    tell_of_full_files();
    let ended = match Arguments::try_parse() {
        Ok(arguments) => obey(models, library, arguments),
        Err(told) if told.use_stderr() => told.exit(),
        Err(help) => written(help.print()),
    };
    let (status, reason) = match ended {
        Ok(()) => return ExitCode::SUCCESS,
        Err(Ending::Failed(reason)) => (1, reason),
        Err(Ending::Refused(reason)) => (2, reason),
    };
    // Who closed the standard error does not want to know.
    let _ = writeln!(std::io::stderr(), "{}", printable(&reason));
    ExitCode::from(status)
}

/// Does what was asked for.
fn obey(models: &Models, library: &str, Arguments { command, quiet }: Arguments) -> Result<(), Ending> {
    match command {
        Command::New(arguments) => recipes::new(&arguments),
        Command::Check(arguments) => check::check(models, &arguments, quiet),
        Command::Variables(arguments) => check::variables(models, &arguments, quiet),
        Command::Run(arguments) => run::run(models, &arguments, quiet),
        Command::Settle(arguments) => settle::settle(models, &arguments, quiet),
        Command::Export(arguments) => package::package(models, library, &arguments, quiet),
        Command::Verify(arguments) => replay::replay(&arguments),
        Command::Chart(arguments) => chart::chart(models, &arguments),
        Command::Completion(arguments) => shell::completion(&arguments),
    }
}
