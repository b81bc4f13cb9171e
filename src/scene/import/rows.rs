//! The particles of a file: columns by name.

use super::{FileBox, FileFault};
use crate::base::document::Mistake;
use std::collections::BTreeMap;

/// The particles of a file.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    /// How many there are.
    pub(crate) count: usize,
    /// Numbers by column; every number is finite.
    pub(crate) columns: BTreeMap<String, Vec<f64>>,
    /// What the file calls the materials: names or types.
    pub(crate) labels: Vec<String>,
    /// Where each label stands.
    pub(super) label_index: BTreeMap<String, u32>,
    /// Index into the labels, of each particle; empty if the file names no materials.
    pub(crate) label: Vec<u32>,
    /// The column that names materials.
    pub(crate) label_column: String,
    /// Line of each particle in the file; empty if the file has no lines.
    pub(crate) lines: Vec<u32>,
    /// The box around them, if the file says it.
    pub(crate) around: Option<FileBox>,
    /// What the file says and nothing reads: columns and sections by name.
    pub(crate) left_out: Vec<String>,
}

impl Rows {
    /// The line of a particle.
    pub(crate) fn line(&self, row: usize) -> Option<usize> {
        self.lines.get(row).map(|line| *line as usize)
    }

    /// Takes a column; diameters become radii.
    pub(super) fn insert(&mut self, name: &str, mut column: Vec<f64>) {
        let name = match name {
            "diameter" => {
                column.iter_mut().for_each(|diameter| *diameter *= 0.5);
                "radius"
            }
            name => name,
        };
        self.columns.insert(name.to_owned(), column);
    }

    /// Takes what a column of a file says; if another one has said it before, they must agree.
    /// `tolerance`: by how much they may differ, beside the rounding of their own digits.
    pub(super) fn insert_again(
        &mut self,
        name: &str,
        column: &str,
        numbers: Vec<f64>,
        tolerance: f64,
    ) -> Result<(), Vec<FileFault>> {
        let quantity = if name == "diameter" { "radius" } else { name };
        let first = self.columns.remove(quantity);
        self.insert(name, numbers);
        let (Some(first), Some(again)) = (first, self.columns.get(quantity)) else { return Ok(()) };
        agree(&first, again, tolerance + DIGITS * largest(&first), [quantity, column], &self.lines)?;
        self.columns.insert(quantity.to_owned(), first);
        Ok(())
    }

    /// Refuses labels of some particles only.
    pub(super) fn expect_labels(&self) -> Result<(), Vec<FileFault>> {
        if self.label.is_empty() || self.label.len() == self.count {
            return Ok(());
        }
        let found = format!("{} materials for {} particles", self.label.len(), self.count);
        let mistake = Mistake::Unexpected { found, expected: "one for each".to_owned() };
        Err(vec![FileFault { line: None, column: self.label_column.clone(), mistake }])
    }

    /// Adds numbers to a column.
    pub(super) fn extend(&mut self, name: &str, numbers: impl Iterator<Item = f64>) {
        self.columns.entry(name.to_owned()).or_default().extend(numbers);
    }

    /// Notes what the file calls the material of the next particle.
    pub(super) fn push_label(&mut self, name: &str) {
        let last = self.label.last().copied().filter(|index| self.labels[*index as usize] == name);
        let index = last.or_else(|| self.label_index.get(name).copied()).unwrap_or_else(|| {
            let index = self.labels.len() as u32;
            self.labels.push(name.to_owned());
            self.label_index.insert(name.to_owned(), index);
            index
        });
        self.label.push(index);
    }
}

/// How far two columns that say the same may be apart: texts with six digits, as a part of the largest number.
pub(super) const DIGITS: f64 = 1e-5;

/// The largest size of a number of a column.
pub(super) fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |largest: f64, number| largest.max(number.abs()))
}

/// Refuses two columns that say the same and differ by more than a tolerance.
pub(super) fn agree(
    first: &[f64],
    again: &[f64],
    tolerance: f64,
    names: [&str; 2],
    lines: &[u32],
) -> Result<(), Vec<FileFault>> {
    let apart = first.iter().zip(again).position(|(first, again)| (first - again).abs() > tolerance);
    apart.map_or(Ok(()), |row| {
        let found = format!("{:?} of {} and {:?} of {}", first[row], names[0], again[row], names[1]);
        let mistake = Mistake::Unexpected { found, expected: "the same of both columns".to_owned() };
        let line = lines.get(row).map(|line| *line as usize);
        Err(vec![FileFault { line, column: names[1].to_owned(), mistake }])
    })
}

/// Refuses two columns of which each may say the same, in other words.
pub(super) fn twice(names: [&str; 2], line: Option<usize>) -> Vec<FileFault> {
    let found = format!("both columns {} and {}", names[0], names[1]);
    let mistake = Mistake::Unexpected { found, expected: "one of them".to_owned() };
    vec![FileFault { line, column: names[1].to_owned(), mistake }]
}
