//! The command line: parse, call, print.
//!
//! A program with sub-models of its own calls [`main_with`]; it checks, runs, settles and exports scenes that name them.

mod chart;
mod progress;
mod recipes;
mod shell;

use chart::ChartArguments;
use clap::{Args, Parser, Subcommand};
use cograin::bond::keys::FormulationChoice;
use cograin::export::{Libraries, PackageError, export, find_libraries};
use cograin::interface::Standard;
use cograin::lanes::Width;
use cograin::report;
use cograin::results::{Checkpoint, EarlierFile, Failure, OutputError, claim_file, refuse_to_replace};
use cograin::run::{EarlierResults, RunOrder, SettleOrder, SettleProgress, SettleStart, Start};
use cograin::scene::{Models, PackingProgress, Packings, Scene, Setting, Source};
use cograin::statics::Factorise;
use cograin_verify as verify;
use progress::Progress;
use rayon::prelude::*;
use shell::CompletionArguments;
use std::ffi::c_int;
use std::fmt::Display;
use std::io::{ErrorKind, Write};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

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
    Check(CheckArguments),
    /// List the inputs, outputs and parameters of a scene, with unit and meaning
    Variables(VariablesArguments),
    /// Run a scene to its end and write its results
    Run(RunArguments),
    /// Run a scene with damping until it is at rest and write its state
    Settle(SettleArguments),
    /// Package a scene as a co-simulation unit
    Export(ExportArguments),
    /// Replay reference cases of other engines and compare
    Verify(VerifyArguments),
    /// Chart the outputs of a scene over its time step, and recommend one: a table and a picture
    Chart(ChartArguments),
    /// Print what a shell needs to complete commands and options, or the manual page
    Completion(CompletionArguments),
}

/// A scene.
#[derive(Args)]
struct SceneArguments {
    /// The scene file
    scene: PathBuf,
    /// Another value for a key of the scene, for example pair.glass.glass.friction=0.4; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<Setting>,
}

/// How a scene is computed.
#[derive(Args)]
struct ComputeArguments {
    /// The scene.
    #[command(flatten)]
    scene: SceneArguments,
    /// Number of threads, instead of that in the scene
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Compute at most so many numbers at once, to compare processors: 2, 4 (AVX2) or 8 (AVX-512); the results are the same
    #[arg(long, value_name = "N", value_parser = width)]
    lanes: Option<Width>,
}

/// `cograin check`
#[derive(Args)]
struct CheckArguments {
    /// The scene and how it is computed.
    #[command(flatten)]
    scene: ComputeArguments,
    /// Begin with this checkpoint, which may be that of another scene: takes over particles, contacts and bonds
    #[arg(long, value_name = "CHECKPOINT")]
    from: Option<PathBuf>,
    /// Print the condensed static stiffness of every boundary instead; the packing should be at rest
    #[arg(long)]
    stiffness: bool,
    /// Print the report as JSON
    #[arg(long, conflicts_with = "stiffness")]
    json: bool,
}

/// `cograin variables`
#[derive(Args)]
struct VariablesArguments {
    /// The scene.
    #[command(flatten)]
    scene: SceneArguments,
    /// Print the list as JSON
    #[arg(long)]
    json: bool,
}

/// `cograin run`
#[derive(Args)]
struct RunArguments {
    /// The scene and how it is computed.
    #[command(flatten)]
    scene: ComputeArguments,
    /// Begin with this checkpoint, which may be that of another scene: takes over particles, contacts and bonds
    #[arg(long, value_name = "CHECKPOINT", conflicts_with = "resume")]
    from: Option<PathBuf>,
    /// Folder of the results
    #[arg(short, long, value_name = "DIR", default_value = "output")]
    output: PathBuf,
    /// Continue from a checkpoint: this one, or the last one in the folder of the results
    #[arg(long, value_name = "CHECKPOINT", num_args = 0..=1)]
    resume: Option<Option<PathBuf>>,
    /// End at this time [s] instead of the scene's; with --resume a run goes on beyond its end
    #[arg(long, value_name = "TIME", value_parser = positive)]
    end: Option<f64>,
    /// Replace the results of an earlier run in that folder
    #[arg(long)]
    overwrite: bool,
    /// Table of the driven boundaries' displacements: CSV with `time` and columns named as the unit's inputs
    #[arg(long, value_name = "CSV")]
    inputs: Option<PathBuf>,
}

/// `cograin settle`
#[derive(Args)]
struct SettleArguments {
    /// The scene and how it is computed.
    #[command(flatten)]
    scene: ComputeArguments,
    /// Begin with this checkpoint, which may be that of another scene: takes over particles, contacts and bonds
    #[arg(long, value_name = "CHECKPOINT")]
    from: Option<PathBuf>,
    /// Go on with what an earlier attempt left in FILE.unsettled
    #[arg(long, conflicts_with = "from")]
    resume: bool,
    /// File of the settled state
    #[arg(short, long, value_name = "CHECKPOINT")]
    output: PathBuf,
    /// Largest number of time steps
    #[arg(long, value_name = "N", default_value_t = 1_000_000)]
    steps: u64,
    /// Replace the file if it is there
    #[arg(long)]
    overwrite: bool,
}

/// `cograin export`
#[derive(Args)]
struct ExportArguments {
    /// The scene.
    #[command(flatten)]
    scene: SceneArguments,
    /// Begin with this checkpoint, which may be that of another scene: takes over particles, contacts and bonds
    #[arg(long, value_name = "CHECKPOINT")]
    from: Option<PathBuf>,
    /// The unit's file
    #[arg(short, long, value_name = "FMU")]
    output: PathBuf,
    /// The edition of FMI that the unit speaks: 2 (2.0) or 3 (3.0, with arrays)
    #[arg(long, value_name = "EDITION", default_value = "2", value_parser = edition)]
    fmi: Standard,
    /// The unit's library, if it is not in the folder of this program; may be given several times, once for each platform
    #[arg(long = "library", value_name = "FILE")]
    libraries: Vec<PathBuf>,
    /// Carry the library for this platform, such as linux64 or win64; may be given several times; default: all that there are
    #[arg(long = "platform", value_name = "NAME")]
    platforms: Vec<String>,
    /// Replace the file if it is there
    #[arg(long)]
    overwrite: bool,
}

/// The edition of FMI that a user names.
fn edition(text: &str) -> Result<Standard, String> {
    match text {
        "2" | "2.0" => Ok(Standard::Fmi2),
        "3" | "3.0" => Ok(Standard::Fmi3),
        other => Err(format!("expected 2 or 3, found {other}")),
    }
}

/// `cograin verify`
#[derive(Args)]
struct VerifyArguments {
    /// Cases, or folders of cases
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// Largest relative error, unless the case is more sensitive
    #[arg(long, value_name = "ERROR", default_value_t = verify::Options::default().tolerance)]
    tolerance: f64,
    /// Folder that gets the trajectories
    #[arg(long, value_name = "OUT")]
    write: Option<PathBuf>,
    /// Run cases of bonds from their start, instead of from each sample to the next
    #[arg(long)]
    free: bool,
    /// Formulation of bonds; all except engine_exact run from the start of a case
    #[arg(long, value_name = "NAME", default_value = "engine_exact", value_parser = formulation)]
    formulation: FormulationChoice,
}

/// A formulation by its name.
fn formulation(name: &str) -> Result<FormulationChoice, String> {
    let names = || FormulationChoice::ALL.iter().map(|choice| choice.name()).collect::<Vec<_>>().join(", ");
    FormulationChoice::named(name).ok_or_else(|| format!("expected one of {}, found {name}", names()))
}

/// How a command ended that did not do its work.
enum Ending {
    /// The work failed.
    Failed(String),
    /// The input was refused.
    Refused(String),
}

impl Ending {
    /// The work failed for this reason.
    fn failed(reason: impl Display) -> Self {
        Self::Failed(reason.to_string())
    }
    /// The input was refused for this reason.
    fn refused(reason: impl Display) -> Self {
        Self::Refused(reason.to_string())
    }
}

impl From<Failure> for Ending {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Refused(refusal) => Self::refused(refusal),
            Failure::Output(error @ OutputError::NotOwn { .. }) => Self::refused(error),
            failure => Self::failed(failure),
        }
    }
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
        Command::Check(arguments) => check(models, &arguments, quiet),
        Command::Variables(arguments) => variables(models, &arguments, quiet),
        Command::Run(arguments) => run(models, &arguments, quiet),
        Command::Settle(arguments) => settle(models, &arguments, quiet),
        Command::Export(arguments) => package(models, library, &arguments, quiet),
        Command::Verify(arguments) => replay(&arguments),
        Command::Chart(arguments) => chart::chart(models, &arguments),
        Command::Completion(arguments) => shell::completion(&arguments),
    }
}

/// Prints a line.
fn say(line: impl Display) -> Result<(), Ending> {
    say_as_it_is(format!("{}\n", printable(&line.to_string())).as_bytes())
}

/// Prints a text of the program's own.
fn say_as_it_is(text: &[u8]) -> Result<(), Ending> {
    written(std::io::stdout().write_all(text))
}

/// What became of a text for the standard output. A reader that is gone does not want to know more; that a disk is full must be told.
fn written(result: std::io::Result<()>) -> Result<(), Ending> {
    match result.and_then(|()| std::io::stdout().flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Ending::failed(format_args!("the standard output cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// The text with control characters written out: names come from files, and a terminal would obey them.
fn printable(text: &str) -> String {
    let shown = |letter: char| match letter {
        '\n' => "\n".to_owned(),
        letter if letter.is_control() => letter.escape_default().to_string(),
        letter => letter.to_string(),
    };
    text.chars().map(shown).collect()
}

/// Reads a scene, and shows how far its random packings are.
fn read(
    models: &Models,
    arguments: &SceneArguments,
    from: Option<&Path>,
    quiet: bool,
) -> Result<(Scene, Source), Ending> {
    // Packings of a state that is taken over need not be made again.
    let made = from.map_or_else(Packings::default, Checkpoint::packings);
    let mut shown = Progress::new(quiet, "{spinner} {msg}  {elapsed}");
    let result = models.read_with(&arguments.scene, &arguments.settings, &made, &mut |progress| {
        shown.tell(None, || match progress {
            PackingProgress::Placing { set, placed, count } => format!("[{set}] {placed} of {count} spheres placed"),
            PackingProgress::Pushing { set, rounds, overlap } => {
                format!("[{set}] packing: {rounds} rounds, largest overlap {overlap:.1e} of the radius")
            }
        });
    });
    shown.end();
    result.map_err(Ending::refused)
}

/// Files that a command reads: the scene, those that it names, and others.
fn files_read(scene: &Path, source: &Source, others: &[&Option<PathBuf>]) -> Vec<PathBuf> {
    let folder = scene.parent().unwrap_or(Path::new(""));
    let named = source.files.keys().map(|file| folder.join(file));
    let others = others.iter().filter_map(|path| (*path).clone());
    std::iter::once(scene.to_owned()).chain(named).chain(others).collect()
}

/// What happens to a file that is there.
fn earlier_file(overwrite: bool) -> EarlierFile {
    if overwrite { EarlierFile::Replace } else { EarlierFile::Keep }
}

/// Reads a scene to be computed here. Its files are needed no more when the work begins.
fn read_to_run(
    models: &Models,
    arguments: &ComputeArguments,
    from: Option<&Path>,
    quiet: bool,
) -> Result<(Arc<Scene>, Source), Ending> {
    let (scene, source) = read(models, &arguments.scene, from, quiet)?;
    let scene = match arguments.threads {
        Some(threads) => scene.with_threads(NonZeroUsize::new(threads.into())),
        None => scene,
    };
    Ok((Arc::new(scene.with_width(arguments.lanes)), source))
}

/// A lane width that this processor offers.
fn width(text: &str) -> Result<Width, String> {
    let width = match text {
        "2" => Width::Least,
        "4" => Width::Four,
        "8" => Width::Eight,
        _ => return Err("expected 2, 4 or 8".to_owned()),
    };
    width.offered().then_some(width).ok_or_else(|| "this processor does not offer so many".to_owned())
}

/// `cograin check`
fn check(models: &Models, arguments: &CheckArguments, quiet: bool) -> Result<(), Ending> {
    let (scene, source) = read_to_run(models, &arguments.scene, arguments.from.as_deref(), quiet)?;
    if arguments.stiffness {
        return say(
            report::stiffness(&scene, &source.name, arguments.from.as_deref(), FACTORISE).map_err(Ending::refused)?
        );
    }
    let report = report::check(&scene, &source.name, arguments.from.as_deref()).map_err(Ending::refused)?;
    if arguments.json { say_as_it_is(report.to_json().as_bytes()) } else { say(report) }
}

/// `cograin variables`
fn variables(models: &Models, arguments: &VariablesArguments, quiet: bool) -> Result<(), Ending> {
    let (scene, source) = read(models, &arguments.scene, None, quiet)?;
    let list = report::variables(&scene, &source.name).map_err(Ending::refused)?;
    if arguments.json { say_as_it_is(list.to_json().as_bytes()) } else { say(list) }
}

/// A number above 0.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "expected a number above 0".to_owned())
}

/// `cograin run`
fn run(models: &Models, arguments: &RunArguments, quiet: bool) -> Result<(), Ending> {
    let resumed = arguments.resume.as_ref().and_then(Option::as_ref);
    let from = arguments.from.as_ref().or(resumed).map(PathBuf::as_path);
    let (scene, mut source) = read_to_run(models, &arguments.scene, from, quiet)?;
    let read = files_read(&arguments.scene.scene.scene, &source, &[]);
    refuse_to_replace(&arguments.output, &read).map_err(Ending::refused)?;
    source.files.clear();
    let start = match &arguments.resume {
        None => arguments.from.clone().map_or(Start::Scene, Start::From),
        Some(None) => Start::LastCheckpoint,
        Some(Some(path)) => Start::Checkpoint(path.clone()),
    };
    if start == Start::LastCheckpoint && arguments.overwrite {
        return Err(Ending::refused(
            "expected one of --resume and --overwrite, found both: --overwrite replaces the results that --resume \
             goes on with",
        ));
    }
    let stop = stop_at_interruption()?;
    let order = RunOrder {
        scene: &scene,
        scene_name: &source.name,
        folder: &arguments.output,
        start: &start,
        end: arguments.end,
        earlier_results: if arguments.overwrite { EarlierResults::Replace } else { EarlierResults::Keep },
        inputs: arguments.inputs.as_deref(),
        stop: &stop,
    };
    let mut shown = Progress::new(quiet, "{bar:40} {percent:>3} %  {msg}  {eta} left");
    let result = cograin::run::run(order, &mut |progress: cograin::run::Progress| {
        let share = (progress.time - progress.start) / (progress.end - progress.start);
        shown.tell(Some(share), || format!("t = {:.4e} of {:.4e} s", progress.time, progress.end));
    });
    shown.end();
    let summary = result?;
    if quiet { Ok(()) } else { say(summary) }
}

/// `cograin settle`
fn settle(models: &Models, arguments: &SettleArguments, quiet: bool) -> Result<(), Ending> {
    let (scene, mut source) = read_to_run(models, &arguments.scene, arguments.from.as_deref(), quiet)?;
    let read = files_read(&arguments.scene.scene.scene, &source, &[&arguments.from]);
    claim_file(&arguments.output, earlier_file(arguments.overwrite), &read).map_err(Ending::refused)?;
    source.files.clear();
    let stop = stop_at_interruption()?;
    let order = SettleOrder {
        scene: &scene,
        scene_name: &source.name,
        start: match &arguments.from {
            _ if arguments.resume => SettleStart::Unsettled,
            Some(path) => SettleStart::From(path),
            None => SettleStart::Scene,
        },
        checkpoint: &arguments.output,
        earlier: earlier_file(arguments.overwrite),
        most_steps: arguments.steps,
        factorise: FACTORISE,
        stop: &stop,
    };
    let mut shown = Progress::new(quiet, "{spinner} {msg}  {elapsed}");
    let result = cograin::run::settle(order, &mut |progress: SettleProgress| {
        let SettleProgress { steps, ratio, tolerance } = progress;
        shown.tell(None, || format!("{steps} steps, unbalanced force {ratio:.2e}, {tolerance:.0e} asked for"));
    });
    shown.end();
    let settled = result?;
    if quiet { Ok(()) } else { say(settled) }
}

/// `cograin export`
fn package(models: &Models, library: &str, arguments: &ExportArguments, quiet: bool) -> Result<(), Ending> {
    let (scene, source) = read(models, &arguments.scene, arguments.from.as_deref(), quiet)?;
    let scene = Arc::new(scene);
    let mut read = files_read(&arguments.scene.scene, &source, &[&arguments.from]);
    let claim = |read: &[PathBuf]| claim_file(&arguments.output, earlier_file(arguments.overwrite), read);
    claim(&read).map_err(Ending::refused)?;
    let named = !arguments.libraries.is_empty();
    let not = |error| if named { Ending::refused(error) } else { Ending::failed(error) };
    let paths = find_libraries(library, &arguments.libraries).map_err(not)?;
    read.extend_from_slice(&paths);
    let libraries = Libraries { paths, platforms: arguments.platforms.clone() };
    claim(&read).map_err(Ending::refused)?;
    let begun = match &arguments.from {
        Some(path) => {
            let checkpoint = Checkpoint::read(path).map_err(Ending::refused)?;
            Some(checkpoint.taken_over(&scene).map_err(Ending::refused)?)
        }
        None => None,
    };
    let state = begun.as_ref().map(|begun| begun.simulation.state());
    let exported = export(&source, &scene, state, &libraries, arguments.fmi, &arguments.output);
    exported.map_err(|error| match error {
        PackageError::Write { .. } => Ending::failed(error),
        PackageError::Chosen(error) => Ending::refused(format_args!("{}, {error}", source.name)),
        error => Ending::refused(error),
    })?;
    let left_behind = begun.map_or_else(Vec::new, |begun| begun.left_behind);
    left_behind.iter().filter(|_| !quiet).try_for_each(|left| say(format_args!("not taken along: {left}")))
}

/// `cograin verify`
fn replay(arguments: &VerifyArguments) -> Result<(), Ending> {
    let options = verify::Options {
        tolerance: arguments.tolerance,
        write: arguments.write.clone(),
        free: arguments.free,
        formulation: arguments.formulation,
    };
    let cases = verify::find(&arguments.folders).map_err(Ending::refused)?;
    let reports: Vec<_> = cases.par_iter().with_max_len(1).map(|case| verify::replay(case, &options)).collect();
    let mut failed = 0;
    for report in reports {
        let report = report.map_err(Ending::refused)?;
        failed += usize::from(!report.passed());
        say(report)?;
    }
    if failed > 0 { Err(Ending::failed(format_args!("{failed} of {} cases failed", cases.len()))) } else { Ok(()) }
}

/// Lets the first Ctrl-C, or another request to end, end the work in good order, and the second at once: all files are whole at any
/// time. A request that the caller has chosen to ignore, as `nohup` does, stays ignored.
fn stop_at_interruption() -> Result<Arc<AtomicBool>, Ending> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in STOPPING {
        if is_ignored(signal) {
            continue;
        }
        signal_hook::flag::register_conditional_shutdown(signal, 1, Arc::clone(&stop)).map_err(Ending::failed)?;
        signal_hook::flag::register(signal, Arc::clone(&stop)).map_err(Ending::failed)?;
    }
    Ok(stop)
}

/// Lets the system tell by an error that a file may not grow further, instead of ending the program.
fn tell_of_full_files() {
    // Where this cannot be had, the program ends as it did.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

/// Requests to end.
#[cfg(unix)]
const STOPPING: [c_int; 3] = [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP];

/// Requests to end.
#[cfg(not(unix))]
const STOPPING: [c_int; 2] = [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM];

/// Whether the caller has chosen to ignore a signal, where the system tells.
fn is_ignored(signal: c_int) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}
