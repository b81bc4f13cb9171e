//! `cograin check` and `cograin variables`.

use super::scene::{ComputeArguments, SceneArguments, read, read_to_run};
use super::{Ending, FACTORISE, say, say_as_it_is};
use clap::Args;
use cograin::report;
use cograin::scene::Models;
use std::path::PathBuf;

/// `cograin check`
#[derive(Args)]
pub(super) struct CheckArguments {
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
pub(super) struct VariablesArguments {
    /// The scene.
    #[command(flatten)]
    scene: SceneArguments,
    /// Print the list as JSON
    #[arg(long)]
    json: bool,
}

/// `cograin check`
pub(super) fn check(models: &Models, arguments: &CheckArguments, quiet: bool) -> Result<(), Ending> {
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
pub(super) fn variables(models: &Models, arguments: &VariablesArguments, quiet: bool) -> Result<(), Ending> {
    let (scene, source) = read(models, &arguments.scene, None, quiet)?;
    let list = report::variables(&scene, &source.name).map_err(Ending::refused)?;
    if arguments.json { say_as_it_is(list.to_json().as_bytes()) } else { say(list) }
}
