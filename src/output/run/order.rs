//! What is to be run, where from and where to.

use crate::output::results::Refusal;
use crate::scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Where a run begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Start {
    /// With the scene as its file has it.
    Scene,
    /// With the checkpoint in the folder of the results.
    LastCheckpoint,
    /// With this checkpoint of the same scene.
    Checkpoint(PathBuf),
    /// With this checkpoint, which may be of another scene.
    From(PathBuf),
}

/// What happens to the results of an earlier run in the folder when a new run begins there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EarlierResults {
    /// They stay, and the run is refused.
    Keep,
    /// They are replaced, all of them at once.
    Replace,
}

/// What is to be run, and where to.
#[derive(Clone, Copy, Debug)]
pub struct RunOrder<'a> {
    /// The scene.
    pub scene: &'a Arc<Scene>,
    /// Its file name, for messages and the summary.
    pub scene_name: &'a str,
    /// Folder of the results.
    pub folder: &'a Path,
    /// Where it begins.
    pub start: &'a Start,
    /// When it ends, instead of the scene's end \[s\].
    pub end: Option<f64>,
    /// What happens to the results of an earlier run.
    pub earlier_results: EarlierResults,
    /// A table of the driven boundaries' displacements over time; without one they stay where they are.
    pub inputs: Option<&'a Path>,
    /// Set from outside to stop after the present time step, or within a tenth of a second.
    pub stop: &'a AtomicBool,
}

impl RunOrder<'_> {
    /// Refuses to go on from a time at or after the end \[s\].
    pub(super) fn expect_before(&self, time: f64, end: f64) -> Result<(), Refusal> {
        if time < end * (1.0 - f64::EPSILON) {
            return Ok(());
        }
        let key = if self.end.is_some() { "--end" } else { "[run] end" };
        Err(Refusal::Ended { scene: self.scene_name.to_owned(), key, end, time })
    }
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Where this session began \[s\].
    pub start: f64,
    /// Time \[s\].
    pub time: f64,
    /// Where it ends \[s\].
    pub end: f64,
}
