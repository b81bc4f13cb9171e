//! Why a case cannot be replayed.

use std::path::{Path, PathBuf};

/// Why a case cannot be replayed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum VerifyError {
    /// A file or folder that cannot be read or written.
    #[error("{}: {cause}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        cause: String,
    },
    /// A folder without cases.
    #[error("{}: expected a case, or a folder of cases, found no case.json here or in a folder below", folder.display())]
    NoCase {
        /// The folder.
        folder: PathBuf,
    },
    /// A `case.json` that does not say what a case must.
    #[error("{}, {place}: {message}", path.display())]
    Case {
        /// The file.
        path: PathBuf,
        /// Line and column, or the field.
        place: String,
        /// What was found and what was expected.
        message: String,
    },
    /// A `samples.csv` that is not a trajectory of the case.
    #[error("{}, line {line}: {message}", path.display())]
    Samples {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What was found and what was expected.
        message: String,
    },
}

impl VerifyError {
    /// What the system said of a file.
    pub(super) fn file(path: &Path, cause: &std::io::Error) -> Self {
        Self::File { path: path.to_path_buf(), cause: cause.to_string() }
    }
}

/// A mistake in a case, before the file is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Mistake {
    /// The field, as `particles[3].radius`.
    pub(super) field: String,
    /// What was found and what was expected.
    pub(super) message: String,
}

impl Mistake {
    /// In this field, this.
    pub(super) fn new(field: impl Into<String>, message: impl Into<String>) -> Self {
        Self { field: field.into(), message: message.into() }
    }

    /// With its file.
    pub(super) fn at(self, path: &Path) -> VerifyError {
        VerifyError::Case { path: path.to_path_buf(), place: self.field, message: self.message }
    }
}
