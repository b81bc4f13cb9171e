//! `cograin settle`

use super::interruption::stop_at_interruption;
use super::progress::Progress;
use super::scene::{ComputeArguments, earlier_file, files_read, read_to_run};
use super::{Ending, FACTORISE, say};
use clap::Args;
use cograin::results::claim_file;
use cograin::run::{SettleOrder, SettleProgress, SettleStart};
use cograin::scene::Models;
use std::path::PathBuf;

/// `cograin settle`
#[derive(Args)]
pub(super) struct SettleArguments {
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

/// `cograin settle`
pub(super) fn settle(models: &Models, arguments: &SettleArguments, quiet: bool) -> Result<(), Ending> {
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
