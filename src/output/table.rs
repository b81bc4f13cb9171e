//! Tables that grow by rows: `history.csv` (time and the unit's outputs at each output time) and `breakage.csv`.
//!
//! Numbers have the shortest form that reads back as the same bits. Each row is written at once, so a file
//! ends with a whole row at any time.

use super::error::{OutputError, ResumeError};
use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// The open file.
pub(super) struct Table {
    /// Where it is.
    path: PathBuf,
    /// Its end.
    rows: csv::Writer<File>,
}

impl Table {
    /// Begins a file with a row of column names.
    pub(super) fn create(path: &Path, names: &[String]) -> Result<Self, OutputError> {
        let file = File::create(path).map_err(OutputError::at(path))?;
        let mut table = Self { path: path.to_owned(), rows: csv::Writer::from_writer(file) };
        table.add(names)?;
        Ok(table)
    }

    /// Takes up a file after the rows that are kept; those behind them are cut off.
    pub(super) fn reopen(path: &Path, found: &Found) -> Result<Self, OutputError> {
        let at = OutputError::at;
        let file = OpenOptions::new().append(true).open(path).map_err(at(path))?;
        file.set_len(found.bytes).map_err(at(path))?;
        Ok(Self { path: path.to_owned(), rows: csv::Writer::from_writer(file) })
    }

    /// Adds a row and hands it to the system.
    pub(super) fn add(&mut self, row: &[String]) -> Result<(), OutputError> {
        let written = self.rows.write_record(row).map_err(io::Error::from).and_then(|()| self.rows.flush());
        written.map_err(OutputError::at(&self.path))
    }

    /// Makes sure that all rows are on the disk.
    pub(super) fn sync(&self) -> Result<(), OutputError> {
        self.rows.get_ref().sync_all().map_err(OutputError::at(&self.path))
    }
}

/// The part of an existing file that a continued run keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Found {
    /// Its length.
    bytes: u64,
}

impl Found {
    /// Looks for the first `count` rows of a file that begins with these column names; `time` \[s\] is for the message.
    pub(super) fn rows(path: &Path, names: &[String], count: usize, time: f64) -> Result<Self, ResumeError> {
        let bytes = match std::fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            Err(source) => return Err(ResumeError::Read { path: path.to_owned(), source }),
        };
        let ends: Vec<usize> = (1..).zip(&bytes).filter(|(_, byte)| **byte == b'\n').map(|(end, _)| end).collect();
        let missing = |found| ResumeError::Rows { path: path.to_owned(), found, expected: count, time };
        let Some(&header) = ends.first() else { return Err(missing(0)) };
        let mut columns = csv::ReaderBuilder::new().has_headers(false).from_reader(&bytes[..header]);
        let same = columns.records().next().is_some_and(|record| record.is_ok_and(|record| record.iter().eq(names)));
        if !same {
            return Err(ResumeError::Columns { path: path.to_owned() });
        }
        match ends.get(count) {
            Some(&end) => Ok(Self { bytes: end as u64 }),
            None => Err(missing(ends.len() - 1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Column names.
    fn names() -> Vec<String> {
        ["time", "floor.force.z", "contacts.count"].map(String::from).to_vec()
    }

    /// A row of these numbers.
    fn row(time: f64, force: f64) -> [String; 3] {
        [format!("{time:?}"), format!("{force:?}"), "3".to_owned()]
    }

    /// A file of three rows in a folder of its own.
    fn three_rows(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("cograin-table-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("table.csv");
        let mut table = Table::create(&path, &names()).unwrap();
        for (time, force) in [(0.0, -1.0 / 3.0), (1e-7, 1e300), (0.1, f64::MIN_POSITIVE)] {
            table.add(&row(time, force)).unwrap();
        }
        path
    }

    #[test]
    fn numbers_read_back_as_the_same_bits() {
        let path = three_rows("bits");
        let text = std::fs::read_to_string(&path).unwrap();
        let forces: Vec<f64> =
            text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect();
        assert_eq!(forces, [-1.0 / 3.0, 1e300, f64::MIN_POSITIVE]);
        assert!(text.contains("1e-7,1e300,3\n"), "{text}");
    }

    #[test]
    fn a_reopened_file_goes_on_as_if_it_had_never_been_closed() {
        let path = three_rows("reopened");
        let whole = std::fs::read(&path).unwrap();
        let found = Found::rows(&path, &names(), 1, 0.0).unwrap();
        let mut table = Table::reopen(&path, &found).unwrap();
        table.add(&row(1e-7, 1e300)).unwrap();
        table.add(&row(0.1, f64::MIN_POSITIVE)).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), whole);
    }

    #[test]
    fn a_file_that_lacks_rows_is_refused() {
        let path = three_rows("short");
        let error = Found::rows(&path, &names(), 5, 0.4).unwrap_err().to_string();
        assert!(error.contains("3 rows found; a run that is continued at t = 0.4 s has 5"), "{error}");
    }

    #[test]
    fn a_file_of_other_columns_is_refused() {
        let path = three_rows("columns");
        let error = Found::rows(&path, &names()[..2], 1, 0.0).unwrap_err();
        assert!(matches!(error, ResumeError::Columns { .. }), "{error}");
    }
}
