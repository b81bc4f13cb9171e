//! Why a command did not do its work: the input was refused, or the work failed.

use super::error::{InputsError, OutputError, ResumeError, TakeOverError};
use super::vtk::EncodeError;
use crate::base::words::{counted, plain};
use crate::engine::simulation::RunError;
use crate::interface::ChosenError;
use std::path::PathBuf;

/// Why the input was refused.
#[derive(Debug, thiserror::Error)]
pub enum Refusal {
    /// The scene does not say when a run ends.
    #[error("{scene}, [run] end: not given; the time at which the run ends [s] is needed")]
    NoEnd {
        /// File name of the scene.
        scene: String,
    },
    /// The scene cannot take its first step.
    #[error("{scene}: {source}")]
    Start {
        /// File name of the scene.
        scene: String,
        /// Why not.
        source: RunError,
    },
    /// The packing has no static stiffness.
    #[error("{scene}: {source}")]
    Stiffness {
        /// File name of the scene.
        scene: String,
        /// Why not.
        source: crate::engine::statics::StaticsError,
    },
    /// A frame cannot be made.
    #[error("{scene}: {source}")]
    Frame {
        /// File name of the scene.
        scene: String,
        /// Why not.
        source: EncodeError,
    },
    /// The results have no place there.
    #[error("{}: expected a folder, or a name that is not there yet, found a file", folder.display())]
    NotAFolder {
        /// Where they were to be.
        folder: PathBuf,
    },
    /// A file that is not to be replaced.
    #[error("{}: expected a name that is not there yet, found a file; --overwrite replaces it", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// Something else than a file where one is to be written.
    #[error("{}: expected a file or a name that is not there yet, found {found}", path.display())]
    NotAFile {
        /// Where.
        path: PathBuf,
        /// What is there.
        found: &'static str,
    },
    /// No folder where a file is to be written.
    #[error("{}: expected a folder that is there, found none", folder.display())]
    NoFolder {
        /// The folder.
        folder: PathBuf,
    },
    /// Something else stands where a state that is not at rest would be kept.
    #[error("{}: expected no file, or what an earlier attempt to settle left, found another file; move it away", path.display())]
    NotUnsettled {
        /// The file.
        path: PathBuf,
    },
    /// What an earlier attempt to settle left.
    #[error("{}: holds what an earlier attempt left; --resume goes on with it, --overwrite replaces it", path.display())]
    Unsettled {
        /// The file.
        path: PathBuf,
    },
    /// A file that the command reads itself.
    #[error("{}: expected a file that the command does not read itself, found {}", path.display(), read.display())]
    Read {
        /// The file that was to be written or replaced.
        path: PathBuf,
        /// The same file as the command reads it.
        read: PathBuf,
    },
    /// Files of the folder have names of results, and no run has written them.
    #[error("{}: expected results that a run has written, found {file} of another kind; move it away", folder.display())]
    Foreign {
        /// The folder.
        folder: PathBuf,
        /// Name of the file.
        file: String,
    },
    /// Another process writes into the folder.
    #[error("{}: in use by {holder}; take another folder, or the same one when that run has ended", folder.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
        /// The process and when it began.
        holder: String,
    },
    /// The folder holds results that were not asked to be replaced.
    #[error(
        "{}: holds results of an earlier run ({held}); --resume goes on with it, --overwrite puts this run in its place, \
         another folder with -o keeps both", folder.display()
    )]
    Used {
        /// The folder.
        folder: PathBuf,
        /// What is known of that run.
        held: String,
    },
    /// The folder holds results, and nothing else may be written there.
    #[error("{}: expected an empty folder, or a name that is not there yet, found results of an earlier run \
             ({held})", folder.display())]
    Taken {
        /// The folder.
        folder: PathBuf,
        /// What is known of that run.
        held: String,
    },
    /// An output that the scene names and does not have.
    #[error("{scene}, {source}")]
    Chosen {
        /// File name of the scene.
        scene: String,
        /// Which; in a place of its own, since it is large.
        source: Box<ChosenError>,
    },
    /// More outputs than anybody can mean.
    #[error(
        "{scene}, [output] {key}: expected at most {most:e} {what} up to t = {end} s, found {count:.3e}, one every \
         {interval:e} s"
    )]
    Counts {
        /// File name of the scene.
        scene: String,
        /// The interval's key.
        key: &'static str,
        /// The interval \[s\].
        interval: f64,
        /// How many outputs.
        count: f64,
        /// Of what.
        what: &'static str,
        /// End of the run \[s\].
        end: f64,
        /// How many there may be.
        most: f64,
    },
    /// More time steps than a clock can count.
    #[error(
        "{scene}, [run] step: expected at most {most:e} time steps up to t = {end} s, found {count:.3e} of {step:e} s"
    )]
    Steps {
        /// File name of the scene.
        scene: String,
        /// The step \[s\].
        step: f64,
        /// How many.
        count: f64,
        /// End of the run \[s\].
        end: f64,
        /// How many there may be.
        most: f64,
    },
    /// The checkpoint does not fit.
    #[error(transparent)]
    Resume(#[from] ResumeError),
    /// The run ends before it begins.
    #[error("{scene}, {key}: expected a time after t = {time} s, where the checkpoint stands, found {end} s", time = plain(*time))]
    Ended {
        /// File name of the scene.
        scene: String,
        /// What says the end.
        key: &'static str,
        /// End of the run \[s\].
        end: f64,
        /// Time of the checkpoint \[s\].
        time: f64,
    },
    /// Nothing says in which communication steps a run went.
    #[error(
        "{scene}: expected [run] end or an interval in [output], which say in which communication steps a run goes on, found neither"
    )]
    NoInterval {
        /// File name of the scene.
        scene: String,
    },
    /// The table of inputs ends before the run.
    #[error("--end: expected a time up to t = {table_end} s, where the table of --inputs ends, found {end} s")]
    BeyondInputs {
        /// End of the run \[s\].
        end: f64,
        /// End of the table \[s\].
        table_end: f64,
    },
    /// The table of inputs does not fit.
    #[error(transparent)]
    Inputs(#[from] InputsError),
}

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The input was refused; nothing was written.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The simulation stopped.
    #[error("the run stopped: {0}")]
    Run(#[from] RunError),
    /// A result could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// Someone asked to stop.
    #[error("interrupted at t = {time} s; run again with -o {} --resume to go on from there", folder.display(), time = plain(*time))]
    Interrupted {
        /// How far it came \[s\].
        time: f64,
        /// The folder of the results, with the checkpoint.
        folder: PathBuf,
    },
    /// Someone asked to stop before the packing had come to rest.
    #[error("interrupted after {} {}; {}", counted(*steps, "step"), reached(*ratio), going_on(kept))]
    SettlingInterrupted {
        /// Where the state is kept.
        kept: PathBuf,
        /// Steps made.
        steps: u64,
        /// Unbalanced force over the mean force of the contacts or bonds; infinite where there is none.
        ratio: f64,
    },
    /// The packing will not come to rest.
    #[error(
        "not settled after {} (t = {time} s), and it comes no nearer: {}: {why}; {}",
        counted(*steps, "step"), restless(*ratio, *tolerance), going_on(kept), time = plain(*time)
    )]
    Restless {
        /// Where the state is kept.
        kept: PathBuf,
        /// Steps made.
        steps: u64,
        /// Time they took \[s\].
        time: f64,
        /// The smallest unbalanced force over the mean force of the contacts or bonds.
        ratio: f64,
        /// What was asked for.
        tolerance: f64,
        /// Why.
        why: String,
    },
    /// The packing did not come to rest.
    #[error("not settled after {} (t = {time} s): {}; {}", counted(*steps, "step"), unsettled(*ratio, *tolerance, why), going_on(kept), time = plain(*time))]
    Unsettled {
        /// Where the state is kept.
        kept: PathBuf,
        /// Steps made.
        steps: u64,
        /// Time they took \[s\].
        time: f64,
        /// Unbalanced force over the mean force of the contacts or bonds; infinite where there is none.
        ratio: f64,
        /// What was asked for.
        tolerance: f64,
        /// Why.
        why: String,
    },
}

impl Refusal {
    /// Why a scene with this file name cannot begin with a checkpoint.
    pub(crate) fn not_taken_over(scene: &str, error: TakeOverError) -> Self {
        match error {
            TakeOverError::Checkpoint(error) => Self::Resume(error),
            TakeOverError::Start(source) => Self::Start { scene: scene.to_owned(), source },
        }
    }
}

impl From<ResumeError> for Failure {
    fn from(error: ResumeError) -> Self {
        Self::Refused(error.into())
    }
}

/// Where a packing that is not at rest is kept, and how to go on with it.
fn going_on(kept: &std::path::Path) -> String {
    format!("{} holds the state so far; run again with --resume to go on from there", kept.display())
}

/// How far settling had come.
fn reached(ratio: f64) -> String {
    if ratio.is_finite() {
        format!("at an unbalanced force of {ratio:.3e}")
    } else {
        "before anything touched or a bond was loaded".to_owned()
    }
}

/// Where a scene stays that comes no nearer to rest.
fn restless(ratio: f64, tolerance: f64) -> String {
    if ratio.is_finite() {
        format!("the unbalanced force stays at {ratio:.3e} of the mean force, above settle_tolerance, {tolerance:e}")
    } else {
        "nothing stays in touch and no bond is loaded, so there is no force that could come into balance".to_owned()
    }
}

/// What was missing to be settled.
fn unsettled(ratio: f64, tolerance: f64, why: &str) -> String {
    if ratio.is_finite() {
        format!(
            "the unbalanced force is {ratio:.3e} of the mean force of the contacts or bonds, {tolerance:.3e} is asked for; {why}"
        )
    } else {
        "nothing touches and no bond is loaded, so there is no force that could come into balance; more --steps, if bodies \
         are still to meet, or something that holds them may do"
            .to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_that_nothing_holds_is_told_without_a_number() {
        let [told, free] = [0.5, f64::INFINITY].map(|ratio| {
            let (kept, why) = (PathBuf::from("bed.unsettled"), "it still moves".to_owned());
            Failure::Restless { kept, steps: 10, time: 0.1, ratio, tolerance: 1e-4, why }.to_string()
        });
        assert!(told.contains(
            "the unbalanced force stays at 5.000e-1 of the mean force, above settle_tolerance, 1e-4: it still moves; "
        ));
        assert!(
            free.contains("it comes no nearer: nothing stays in touch and no bond is loaded") && !free.contains("inf"),
            "{free}"
        );
    }
}
