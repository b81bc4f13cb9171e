//! `cograin export`

use super::scene::{SceneArguments, earlier_file, files_read, read};
use super::{Ending, say};
use clap::Args;
use cograin::export::{Libraries, PackageError, export, find_libraries};
use cograin::interface::Standard;
use cograin::results::{Checkpoint, claim_file};
use cograin::scene::Models;
use std::path::PathBuf;
use std::sync::Arc;

/// `cograin export`
#[derive(Args)]
pub(super) struct ExportArguments {
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

/// `cograin export`
pub(super) fn package(models: &Models, library: &str, arguments: &ExportArguments, quiet: bool) -> Result<(), Ending> {
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
