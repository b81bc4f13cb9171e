//! What is wrong in a file of particles.

use crate::base::document::{Mistake, told_columns};

/// A mistake in a file.
#[derive(Debug)]
pub(crate) struct FileFault {
    /// Its line.
    pub(crate) line: Option<usize>,
    /// The column, or empty.
    pub(crate) column: String,
    /// What is wrong.
    pub(crate) mistake: Mistake,
}

impl FileFault {
    /// At a column of a line.
    pub(super) fn at(line: usize, column: &str, mistake: Mistake) -> Self {
        Self { line: Some(line), column: column.to_owned(), mistake }
    }

    /// In the file as a whole.
    pub(super) fn whole(mistake: Mistake) -> Self {
        Self { line: None, column: String::new(), mistake }
    }

    /// A column that is not there.
    pub(super) fn missing(line: Option<usize>, column: &str, found: &[String]) -> Self {
        let mistake = if told_columns(found).is_some() {
            Mistake::Column { column: column.to_owned(), found: found.to_vec() }
        } else {
            let expected = format!("a line of column names with {column}");
            Mistake::Unexpected { found: "a first line without names of columns".to_owned(), expected }
        };
        Self { line, column: String::new(), mistake }
    }

    /// A word where a number should stand, or a number that is not finite.
    pub(super) fn number(line: usize, column: &str, found: &str) -> Self {
        Self::at(
            line,
            column,
            Mistake::Unexpected { found: format!("{found:?}"), expected: "a finite number".to_owned() },
        )
    }
}

/// How many mistakes of one kind and file are reported.
pub(crate) const REPORTED: usize = 10;

/// Refuses a file for its kind.
pub(super) fn unknown(found: &str, expected: &str) -> Vec<FileFault> {
    vec![FileFault::whole(Mistake::Unexpected { found: found.to_owned(), expected: expected.to_owned() })]
}

/// Refuses particles that crossed a face of a box which does not repeat.
pub(super) fn crossed(line: usize) -> Vec<FileFault> {
    let (found, expected) = ("a particle that crossed a face".to_owned(), "a box that repeats there".to_owned());
    vec![FileFault { line: Some(line), column: String::new(), mistake: Mistake::Unexpected { found, expected } }]
}

/// Refuses bodies that are not spheres.
pub(super) fn non_spherical(line: usize) -> Vec<FileFault> {
    let mistake = Mistake::Unsupported { what: "non-spherical bodies but clumps", instead: "spheres" };
    vec![FileFault { line: Some(line), column: String::new(), mistake }]
}
