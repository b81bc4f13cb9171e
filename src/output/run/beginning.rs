//! Where a run begins, what it finds in its folder, and its first files.

use super::jobs::{frame, row};
use super::order::{EarlierResults, RunOrder, Start};
use super::summary;
use crate::engine::simulation::Simulation;
use crate::interface::Interface;
use crate::output::results::files::refuse_to_replace;
use crate::output::results::folder::{Folder, KeptFiles};
use crate::output::results::job::Job;
use crate::output::results::lock::FolderLock;
use crate::output::results::schedule::Schedule;
use crate::output::results::{CHECKPOINT, Failure, OutputError, Refusal, ResumeError, SUMMARY, replacement};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where a run comes from, as far as its files are concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// At time 0: all files are new.
    Anew,
    /// At a later time, in the folder of the run that is continued.
    Here,
    /// At a later time, from a checkpoint of another folder: what was written up to then stays there.
    Elsewhere,
    /// At a later time, from a checkpoint that may be another scene's: a run of its own, with a row where it begins.
    TakenOver {
        /// Whether it goes on bit for bit.
        goes_on: bool,
    },
}

/// What a run writes before its first step.
pub(super) struct First<'a> {
    /// What was asked for.
    pub(super) order: &'a RunOrder<'a>,
    /// The variables.
    pub(super) interface: &'a Interface,
    /// When what is written.
    pub(super) schedule: &'a Schedule,
    /// Columns of the history.
    pub(super) names: &'a [String],
    /// Digest of the table of inputs, if there is one.
    pub(super) inputs: Option<u64>,
}

impl First<'_> {
    /// Writes the first files of a run, in place of what is in the folder: all of them or none.
    pub(super) fn write(&self, simulation: &Simulation, time: f64, origin: Origin) -> Result<(), OutputError> {
        let path = self.order.folder;
        let new = replacement::begin(path)?;
        let frames = self.schedule.frames_until(time);
        let frame_is_due = origin != Origin::Elsewhere && frames.last() == Some(&time);
        let kept = KeptFiles::nothing(frames.len() - usize::from(frame_is_due));
        let named = (Arc::clone(self.order.scene), self.order.scene_name, self.inputs);
        let mut folder = Folder::open(&new, named, self.names, &kept)?;
        if matches!(origin, Origin::Anew | Origin::TakenOver { goes_on: false }) {
            folder.write(Job::Breaks(simulation.state().breaks.clone()))?;
        }
        if origin != Origin::Elsewhere {
            folder.write(row(self.interface, simulation, time))?;
        }
        if frame_is_due {
            folder.write(frame(simulation, time))?;
        }
        folder.checkpoint(simulation.state())?;
        drop(folder);
        replacement::finish(path)
    }
}

/// Locks the folder of the results, which is made if it is not there, and ends what another run may have left half done there.
pub(super) fn lock(path: &Path) -> Result<FolderLock, Failure> {
    if let Some(there) = path.ancestors().find(|part| part.exists()).filter(|there| !there.is_dir()) {
        return Err(Refusal::NotAFolder { folder: there.to_owned() }.into());
    }
    fs::create_dir_all(path).map_err(OutputError::at(path))?;
    let lock = FolderLock::take(path)?;
    replacement::take_up(path)?;
    Ok(lock)
}

/// What is known of the run whose results are in a folder; none if there are no results.
pub(super) fn held(path: &Path) -> Result<Option<String>, OutputError> {
    Ok((!replacement::results(path)?.is_empty()).then(|| summary::told(&path.join(SUMMARY))))
}

/// Locks the folder of the results, and refuses to begin where an earlier run's results are to be kept.
pub(super) fn claim(order: &RunOrder<'_>) -> Result<FolderLock, Failure> {
    let path = order.folder;
    let lock = lock(path)?;
    let own = || *order.start == Start::LastCheckpoint || matches!(checkpoint(order), Ok(Some((_, Origin::Here))));
    if order.earlier_results == EarlierResults::Keep
        && !own()
        && let Some(held) = held(path)?
    {
        return Err(Refusal::Used { folder: path.to_owned(), held }.into());
    }
    if let Some(file) = replacement::foreign_result(path)? {
        return Err(Refusal::Foreign { folder: path.to_owned(), file }.into());
    }
    let from = if let Start::From(path) = order.start { Some(path.as_path()) } else { None };
    let read: Vec<PathBuf> = order.inputs.into_iter().chain(from).map(Path::to_owned).collect();
    refuse_to_replace(path, &read)?;
    Ok(lock)
}

/// The checkpoint that a run begins with, if any, and what that means for its files.
pub(super) fn checkpoint(order: &RunOrder<'_>) -> Result<Option<(PathBuf, Origin)>, ResumeError> {
    let own = order.folder.join(CHECKPOINT);
    match order.start {
        Start::Scene => Ok(None),
        Start::From(path) => Ok(Some((path.clone(), Origin::TakenOver { goes_on: false }))),
        Start::LastCheckpoint if own.exists() => Ok(Some((own, Origin::Here))),
        Start::LastCheckpoint => Err(ResumeError::None { folder: order.folder.to_owned() }),
        Start::Checkpoint(path) => {
            let same = |path: &Path| path.canonicalize().ok();
            let here = same(path).is_some() && same(path) == same(&own);
            Ok(Some((path.clone(), if here { Origin::Here } else { Origin::Elsewhere })))
        }
    }
}
