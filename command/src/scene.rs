//! The scene of a command, and the files that it reads.

use super::Ending;
use super::progress::Progress;
use clap::Args;
use cograin::lanes::Width;
use cograin::results::{Checkpoint, EarlierFile};
use cograin::scene::{Models, PackingProgress, Packings, Scene, Setting, Source};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene.
#[derive(Args)]
pub(super) struct SceneArguments {
    /// The scene file
    pub(super) scene: PathBuf,
    /// Another value for a key of the scene, for example pair.glass.glass.friction=0.4; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(super) settings: Vec<Setting>,
}

/// How a scene is computed.
#[derive(Args)]
pub(super) struct ComputeArguments {
    /// The scene.
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    /// Number of threads, instead of that in the scene
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) threads: Option<u16>,
    /// Compute at most so many numbers at once, to compare processors: 2, 4 (AVX2) or 8 (AVX-512); the results are the same
    #[arg(long, value_name = "N", value_parser = width)]
    pub(super) lanes: Option<Width>,
}

/// Reads a scene, and shows how far its random packings are.
pub(super) fn read(
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

/// Reads a scene to be computed here. Its files are needed no more when the work begins.
pub(super) fn read_to_run(
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

/// Files that a command reads: the scene, those that it names, and others.
pub(super) fn files_read(scene: &Path, source: &Source, others: &[&Option<PathBuf>]) -> Vec<PathBuf> {
    let folder = scene.parent().unwrap_or(Path::new(""));
    let named = source.files.keys().map(|file| folder.join(file));
    let others = others.iter().filter_map(|path| (*path).clone());
    std::iter::once(scene.to_owned()).chain(named).chain(others).collect()
}

/// What happens to a file that is there.
pub(super) fn earlier_file(overwrite: bool) -> EarlierFile {
    if overwrite { EarlierFile::Replace } else { EarlierFile::Keep }
}
