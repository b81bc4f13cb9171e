//! Particles from files: whatever the format, rows of numbers with the names that CSV columns have.

mod csv;

use super::error::Mistake;
use std::collections::BTreeMap;

/// Columns that every file must have.
const NEEDED: [&str; 4] = ["x", "y", "z", "radius"];

/// Columns that a file may have: number, density \[kg/m³\], velocity \[m/s\], angular velocity \[rad/s\].
const POSSIBLE: [&str; 8] = ["id", "density", "vx", "vy", "vz", "wx", "wy", "wz"];

/// The particles of a file.
#[derive(Debug, Default)]
pub(super) struct Rows {
    /// How many there are.
    pub(super) count: usize,
    /// Numbers by column; every number is finite.
    pub(super) columns: BTreeMap<String, Vec<f64>>,
    /// What the file calls the materials: names or types.
    pub(super) labels: Vec<String>,
    /// Index into the labels, of each particle; empty if the file names no materials.
    pub(super) label: Vec<u32>,
    /// Line of each particle in the file; empty if the file has no lines.
    pub(super) lines: Vec<u32>,
}

impl Rows {
    /// The line of a particle.
    pub(super) fn line(&self, row: usize) -> Option<usize> {
        self.lines.get(row).map(|line| *line as usize)
    }

    /// Notes what the file calls the material of the next particle.
    fn push_label(&mut self, name: &str) {
        let last = self.label.last().map(|index| *index as usize);
        let index = match last.filter(|index| self.labels[*index] == name) {
            Some(index) => index,
            None => self.labels.iter().position(|label| label == name).unwrap_or_else(|| {
                self.labels.push(name.to_owned());
                self.labels.len() - 1
            }),
        };
        self.label.push(index as u32);
    }
}

/// A mistake in a file.
#[derive(Debug)]
pub(super) struct FileFault {
    /// Its line.
    pub(super) line: Option<usize>,
    /// The column, or empty.
    pub(super) column: String,
    /// What is wrong.
    pub(super) mistake: Mistake,
}

impl FileFault {
    /// At a column of a line.
    fn at(line: usize, column: &str, mistake: Mistake) -> Self {
        Self { line: Some(line), column: column.to_owned(), mistake }
    }

    /// A column that is not there.
    fn missing(line: Option<usize>, column: &str, found: &[String]) -> Self {
        let mistake = Mistake::Column { column: column.to_owned(), found: found.to_vec() };
        Self { line, column: String::new(), mistake }
    }

    /// A word where a number should stand, or a number that is not finite.
    fn number(line: usize, column: &str, found: &str) -> Self {
        Self::at(line, column, Mistake::Wrong { found: format!("{found:?}"), right: "a finite number".to_owned() })
    }
}

/// How many mistakes of one file are reported.
const REPORTED: usize = 10;

/// Reads a file; `extra` are columns wanted beside the known ones where the file has them.
pub(super) fn read(bytes: &[u8], extra: &[String]) -> Result<Rows, Vec<FileFault>> {
    csv::read(bytes, extra)
}
