//! Why a command did not do its work.

use super::vtk::EncodeError;
use crate::base::document::proposal;
use crate::base::words::plain;
use crate::engine::simulation::RunError;
use crate::engine::state::snapshot::SnapshotError;
use crate::interface::InterfaceError;
use std::io;
use std::path::{Path, PathBuf};

/// A file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The system refused.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The bytes could not be made.
    #[error("{}: {source}", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What the encoder said.
        source: EncodeError,
    },
    /// Something that no run has made stands where a run writes.
    #[error("{}: expected {expected}, found {found}; move it away", path.display())]
    NotOwn {
        /// The file or folder.
        path: PathBuf,
        /// What it is.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A file of the run is gone.
    #[error("{}: expected the file that this run writes, found none or another one: it was moved or deleted meanwhile", path.display())]
    Gone {
        /// The file.
        path: PathBuf,
    },
    /// The folder of the run is gone.
    #[error("{}: expected the folder that this run writes to, found none or another one: it was moved or deleted meanwhile", folder.display())]
    Moved {
        /// The folder.
        folder: PathBuf,
    },
    /// A file of the run was changed by somebody else.
    #[error("{}: expected the {expected} bytes that this run wrote, found {found}: another process changed it meanwhile", path.display())]
    Changed {
        /// The file.
        path: PathBuf,
        /// Its length as it was written \[bytes\].
        expected: u64,
        /// The length that was found \[bytes\].
        found: u64,
    },
    /// A child of the process that writes.
    #[error("{}: the process that opened it writes there; a child that it made by fork does not", folder.display())]
    Forked {
        /// The folder.
        folder: PathBuf,
    },
    /// The thread that writes ended without a reason.
    #[error("{}: the writer stopped; its results are not whole", path.display())]
    Writer {
        /// The folder it wrote to.
        path: PathBuf,
    },
}

impl OutputError {
    /// Something that no run has made.
    pub(crate) fn not_own(path: &Path, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self::NotOwn { path: path.to_owned(), found: found.into(), expected: expected.into() }
    }

    /// Ties what the system said to the file.
    pub(crate) fn at(path: &Path) -> impl FnOnce(io::Error) -> Self + '_ {
        move |source| Self::Write { path: path.to_owned(), source }
    }
}

/// Why a checkpoint cannot be continued from.
#[derive(Debug, thiserror::Error)]
pub enum ResumeError {
    /// There is none.
    #[error("{}: holds no {}; run without --resume first", folder.display(), super::CHECKPOINT)]
    None {
        /// Where it was looked for.
        folder: PathBuf,
    },
    /// It cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// It is not a checkpoint of this scene.
    #[error("{}: {source}", path.display())]
    Snapshot {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: SnapshotError,
    },
    /// It is not a checkpoint.
    #[error("{}: expected a checkpoint that run or settle has written, found something else", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// It is one of another program.
    #[error(
        "{}: is a checkpoint in the format of another version of the program: go on with the program that wrote it",
        path.display()
    )]
    Format {
        /// The file.
        path: PathBuf,
    },
    /// It is of another scene.
    #[error(
        "{}: is a checkpoint of {scene} at t = {time} s, written by {program}, and that scene differs from this one in {differs}; \
         {way}", path.display(), time = plain(*time), way = if *goes_on {
            "it goes on in the same way: give the scene as it was, and --end for another end"
        } else {
            "--from takes it along into another scene"
        })]
    OtherScene {
        /// The file.
        path: PathBuf,
        /// File name of its scene.
        scene: String,
        /// The program that wrote it.
        program: String,
        /// Its time \[s\].
        time: f64,
        /// What differs.
        differs: String,
        /// Whether it goes on as this one does: its end and its outputs differ at most.
        goes_on: bool,
    },
    /// It is of a run with other inputs.
    #[error(
        "{}: is a checkpoint of a run with {}, and this one has {} (--inputs); --from takes it along into another run",
        path.display(), with_inputs(*found), with_inputs(*expected))]
    OtherInputs {
        /// The file.
        path: PathBuf,
        /// Digest of the table of its run, if it had one.
        found: Option<u64>,
        /// Digest of the table of this run, if it has one.
        expected: Option<u64>,
    },
    /// A run of this scene never stops at its time.
    #[error(
        "expected a checkpoint where a run of this scene writes, as at t = {nearest} s, found one at t = {time} \
             s", time = plain(*time))]
    Between {
        /// Time of the checkpoint \[s\].
        time: f64,
        /// The nearest time that would do \[s\].
        nearest: f64,
    },
    /// Rows that were there when the checkpoint was written are missing.
    #[error(
        "{}: expected {expected} rows in a run that is continued at t = {time} s, found {found}; take another \
         folder with -o to begin a new file", path.display(), time = plain(*time))]
    Rows {
        /// The file.
        path: PathBuf,
        /// Rows it has.
        found: u64,
        /// Rows it had.
        expected: u64,
        /// Time of the checkpoint \[s\].
        time: f64,
    },
    /// The columns are others.
    #[error("{}: its columns are not those of this scene; take another folder with -o", path.display())]
    Columns {
        /// The file.
        path: PathBuf,
    },
}

/// Why a scene cannot begin with the state of another one.
#[derive(Debug, thiserror::Error)]
pub enum TakeOverError {
    /// The checkpoint cannot be read.
    #[error(transparent)]
    Checkpoint(#[from] ResumeError),
    /// The scene cannot go on from there.
    #[error(transparent)]
    Start(#[from] RunError),
}

/// Why a table of inputs is refused.
#[derive(Debug, thiserror::Error)]
pub enum InputsError {
    /// It cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the reader said.
        source: csv::Error,
    },
    /// A column is missing.
    #[error("{}, line 1: expected a column {expected}, found {found}", path.display())]
    Column {
        /// The file.
        path: PathBuf,
        /// What was expected.
        expected: String,
        /// Its columns, where its first line is one of names.
        found: String,
    },
    /// Nothing takes a table.
    #[error("{}: expected a scene with an input, such as a driven boundary, found none: nothing takes the table", path.display())]
    NoInput {
        /// The file.
        path: PathBuf,
    },
    /// A column that stands for nothing.
    #[error("{}, line 1: expected time and variables of the unit, found a column {column:?}{}", path.display(), nearest_of(column, known))]
    Unknown {
        /// The file.
        path: PathBuf,
        /// The column.
        column: String,
        /// The inputs.
        known: Vec<String>,
    },
    /// A column that stands twice.
    #[error("{}, line 1: expected one column {column}, found two", path.display())]
    Twice {
        /// The file.
        path: PathBuf,
        /// The column.
        column: String,
    },
    /// A field is not a number.
    #[error("{}, line {line}, {column}: expected a finite number, found {found:?}", path.display())]
    Number {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// The column.
        column: String,
        /// The field.
        found: String,
    },
    /// A number that an input does not take.
    #[error("{}, line {line}: {source}", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// Why.
        source: InterfaceError,
    },
    /// A time out of order.
    #[error("{}, line {line}: expected {expected}, found {found}", path.display())]
    Time {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// What was expected.
        expected: &'static str,
        /// What was found.
        found: String,
    },
}

/// With which table of inputs a run is made.
fn with_inputs(digest: Option<u64>) -> String {
    digest.map_or_else(|| "no table of inputs".to_owned(), |digest| format!("the table of inputs {digest:016x}"))
}

/// The known word that a column most likely stands for, in a message.
fn nearest_of(column: &str, known: &[String]) -> String {
    format!("; {}", proposal(column, known, "inputs are"))
}
