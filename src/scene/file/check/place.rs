//! Where the rows of a set stand, so that a mistake in one is shown there.

use crate::base::document::{Faults, Mistake};
use crate::scene::import::FileBox;

/// Where the rows of a set stand.
pub(super) enum Place {
    /// In its table's list.
    List,
    /// In the lines of a file, which may say what box is around all.
    File(String, Vec<u32>, Option<FileBox>),
    /// Nowhere: they are generated.
    Nowhere,
}

impl Place {
    /// Reports a mistake at a row, counted from 0.
    pub(super) fn report(&self, table: &str, row: usize, key: &str, mistake: Mistake, faults: &mut Faults) {
        match self {
            Self::List => faults.add(table, &format!("list.{}.{key}", row + 1), mistake),
            Self::File(file, lines, _) => {
                let line = lines.get(row).map(|line| *line as usize);
                faults.in_file(file, line, table, key, mistake);
            }
            Self::Nowhere => faults.add(table, key, mistake),
        }
    }
}
