//! `cograin run`

use super::interruption::stop_at_interruption;
use super::progress::Progress;
use super::scene::{ComputeArguments, files_read, read_to_run};
use super::{Ending, say};
use clap::Args;
use cograin::results::refuse_to_replace;
use cograin::run::{EarlierResults, RunOrder, Start};
use cograin::scene::Models;
use std::path::PathBuf;

/// `cograin run`
#[derive(Args)]
pub(super) struct RunArguments {
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

/// A number above 0.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "expected a number above 0".to_owned())
}

/// `cograin run`
pub(super) fn run(models: &Models, arguments: &RunArguments, quiet: bool) -> Result<(), Ending> {
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
