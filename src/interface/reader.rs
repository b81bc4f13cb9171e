//! How variables are read, in little memory: hosts read many thousands of them at a time.

use super::rows::{At, Present, Source as Place};
use super::{Source, Type, Value, Variable};

/// How one variable is read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reader {
    /// Reads it; none where it is a parameter or a text.
    pub(super) read: Option<fn(Present, At) -> Value>,
    /// Which of the variables of its row it is.
    pub(super) at: At,
    /// Its type.
    pub(super) of_type: Type,
}

impl Reader {
    /// The reader of a variable.
    pub(super) fn of(variable: &Variable) -> Self {
        let (read, at) = match &variable.source {
            Source::Row(Place { row, at }) => (Some(row.read), *at),
            Source::Parameter(_) | Source::Text(_) | Source::Derived(_) => (None, At::NOWHERE),
        };
        Self { read, at, of_type: variable.quantity.of_type() }
    }
}
