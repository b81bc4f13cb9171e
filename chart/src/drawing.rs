//! A chart that was computed, and its files.

use crate::ChartError;
use crate::picture::Picture;
use crate::table::Table;
use std::path::{Path, PathBuf};

/// A chart that was computed.
pub struct Drawing {
    /// Its numbers.
    pub table: Table,
    /// How they are shown.
    pub picture: Picture,
    /// What is to be said about them, a line each.
    pub notes: Vec<String>,
}

impl Drawing {
    /// Writes table and picture into a folder, under this name. Returns the files.
    pub fn write(&self, folder: &Path, name: &str) -> Result<[PathBuf; 2], ChartError> {
        let [table, picture] = ["csv", "svg"].map(|ending| folder.join(format!("{name}.{ending}")));
        let failed = |path: &Path, source| ChartError::File { path: path.display().to_string(), source };
        std::fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
        self.table.write(&table).map_err(|error| failed(&table, error))?;
        self.picture.write(&self.table, &picture).map_err(|error| failed(&picture, error))?;
        Ok([table, picture])
    }
}
