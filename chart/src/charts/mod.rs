//! The charts, a row each.

mod bed;
mod block;
mod border;
mod cantilever;
mod cohesion;
mod dashpots;
mod drops;
mod features;
mod impact;
mod kharaz;
mod oblique;
mod peers;
mod rolling;
mod runs;
mod schemes;
mod size_ratio;
mod work;

use crate::ChartError;
use crate::picture::Picture;
use crate::table::Table;
use std::path::{Path, PathBuf};

/// One chart.
pub struct Chart {
    /// Its name on the command line and of its files.
    pub name: &'static str,
    /// What it shows, in a line.
    pub shows: &'static str,
    /// What it takes, about: processor time of one core with the development build \[s\].
    pub seconds: f64,
    /// Computes it.
    pub draw: fn() -> Result<Drawing, ChartError>,
}

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
        self.table.write(&table).map_err(|error| failed(&table, error))?;
        self.picture.write(&self.table, &picture).map_err(|error| failed(&picture, error))?;
        Ok([table, picture])
    }
}

/// All charts.
pub const CHARTS: &[Chart] = &[
    impact::CHART,
    oblique::CHART,
    kharaz::CHART,
    rolling::CHART,
    cantilever::CHART,
    dashpots::CHART,
    cohesion::CHART,
    bed::CHART,
    size_ratio::CHART,
    features::CHART,
    work::CHART,
];

/// The chart of this name.
pub fn named(name: &str) -> Option<&'static Chart> {
    CHARTS.iter().find(|chart| chart.name == name)
}
