//! A mistake of a scene and where it shows.

use crate::base::document::Mistake;

/// A mistake and the table and key where it shows.
#[derive(Debug)]
pub(super) struct Finding {
    /// The table.
    pub(super) table: String,
    /// The key, or empty.
    pub(super) key: String,
    /// The table to name the line of where `table` is not written.
    pub(super) otherwise: String,
    /// What is wrong.
    pub(super) mistake: Mistake,
}

impl Finding {
    /// At a key of a table.
    pub(super) fn at(table: String, key: &str, mistake: Mistake) -> Self {
        Self { otherwise: table.clone(), table, key: key.to_owned(), mistake }
    }
}
