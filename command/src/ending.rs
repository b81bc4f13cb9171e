//! How a command ended that did not do its work.

use cograin::results::{Failure, OutputError};
use std::fmt::Display;

/// How a command ended that did not do its work.
pub(super) enum Ending {
    /// The work failed.
    Failed(String),
    /// The input was refused.
    Refused(String),
}

impl Ending {
    /// The work failed for this reason.
    pub(super) fn failed(reason: impl Display) -> Self {
        Self::Failed(reason.to_string())
    }
    /// The input was refused for this reason.
    pub(super) fn refused(reason: impl Display) -> Self {
        Self::Refused(reason.to_string())
    }
}

impl From<Failure> for Ending {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Refused(refusal) => Self::refused(refusal),
            Failure::Output(error @ OutputError::NotOwn { .. }) => Self::refused(error),
            failure => Self::failed(failure),
        }
    }
}
