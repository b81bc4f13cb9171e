//! The files that a run writes into its folder, when each is due, and what may be wrong with them.
//!
//! | file in a run's folder      | what it holds                                                     |
//! |-----------------------------|-------------------------------------------------------------------|
//! | `history.csv`               | time and the unit's outputs, a row at each history interval       |
//! | `breakage.csv`              | in a scene with bonds: time, pair, cause and energy of each break |
//! | `impacts.csv`               | time, bodies and losses of each impact, if the scene asks      |
//! | `impact_histograms.csv`     | impacts by bodies and energy lost, if the scene follows them   |
//! | `particles_000000.vtu`, …   | the particles by ascending id, a file at each frame interval      |
//! | `contacts_000000.vtu`, …    | the contacts of each frame, if the scene asks for them            |
//! | `bonds_000000.vtu`, …       | the bonds of each frame, in a scene with bonds                    |
//! | `boundaries_000000.vtu`, …  | the boundaries of each frame, if the scene asks for them          |
//! | `cell_000000.vtu`, …        | the edges of the periodic cell at each frame, if there is one     |
//! | `clumps_000000.vtu`, …      | the clumps at each frame, if there are any                        |
//! | `grid_<name>_000000.vti`, … | the cells of a grid at each frame                             |
//! | `particles.pvd`, …          | the times of the frames                                           |
//! | `checkpoint.cograin`        | the state at the last checkpoint, to continue from bit for bit    |
//! | `summary.json`              | counts, time steps, speed, energy book, momentum, why it ended    |
//!
//! All of them are complete at any time, whatever ends the program. `--resume` continues them from the checkpoint, and
//! they end with the same bytes as those of an uninterrupted run (except `summary.json`, which describes one
//! session). `schedule.rs` says when outputs are due, and how that divides the run.

pub(crate) mod boundaries;
mod collection;
mod error;
mod failure;
pub(crate) mod files;
pub(crate) mod folder;
pub(crate) mod frame_files;
pub(crate) mod frames;
mod image;
pub(crate) mod impacts;
pub(crate) mod job;
pub(crate) mod lock;
pub(crate) mod replacement;
pub(crate) mod schedule;
mod table;
pub(crate) mod vtk;
pub(crate) mod writer;

pub use error::{InputsError, OutputError, ResumeError, TakeOverError};
pub use failure::{Failure, Refusal};
pub use files::{Checkpoint, EarlierFile, TakenOver, claim_file, read_checkpoint, refuse_to_replace, write_checkpoint};
pub use vtk::EncodeError;

/// File of the outputs of the unit over time.
pub(crate) const HISTORY: &str = "history.csv";

/// File of the bonds that broke.
const BREAKAGE: &str = "breakage.csv";

/// File of the impacts, one by one.
const IMPACTS: &str = "impacts.csv";

/// File of the impacts, counted by what they lost.
pub(crate) const HISTOGRAMS: &str = "impact_histograms.csv";

/// File of the state to continue from.
pub const CHECKPOINT: &str = "checkpoint.cograin";

/// File that describes how a run went.
pub(crate) const SUMMARY: &str = "summary.json";

/// Ending of a file that is being written.
pub(crate) const UNFINISHED: &str = "part";

/// Kinds of frames: beginning of the names of their files.
const FRAMES: [&str; 6] = ["particles", "contacts", "bonds", "boundaries", "cell", "clumps"];

/// The kind of frames that a grid of this name has.
fn grid_frames(name: &str) -> String {
    format!("{GRID}{name}")
}

/// What stands before the name of a grid in the names of its frames.
const GRID: &str = "grid_";

/// Ending of the names of frames of a kind, if there is such a kind.
fn ending(kind: &str) -> Option<&'static str> {
    let is_grid = || kind.strip_prefix(GRID).is_some_and(|name| !name.is_empty());
    if FRAMES.contains(&kind) { Some("vtu") } else { is_grid().then_some("vti") }
}

/// File name of a frame.
fn frame_name(kind: &str, number: usize) -> String {
    format!("{kind}_{number:06}.{}", ending(kind).unwrap_or_default())
}

/// The number of a frame, from its file name.
fn frame_number(name: &str) -> Option<usize> {
    let (kind, rest) = name.rsplit_once('_')?;
    let digits = rest.strip_suffix(ending(kind)?)?.strip_suffix('.')?;
    (digits.len() >= 6 && digits.bytes().all(|byte| byte.is_ascii_digit())).then(|| digits.parse().ok())?
}

/// File name of the times of the frames of a kind.
fn collection_name(kind: &str) -> String {
    format!("{kind}.pvd")
}

/// Whether a file holds the times of frames.
fn is_collection(name: &str) -> bool {
    name.strip_suffix(".pvd").is_some_and(|kind| ending(kind).is_some())
}
