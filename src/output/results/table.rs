//! Tables that grow by rows: `history.csv` (time and the unit's outputs at each output time) and `breakage.csv`.
//!
//! Numbers have the shortest form that reads back as the same bits. Each row is written at once, so a file
//! ends with a whole row at any time.

use super::error::{OutputError, ResumeError};
use super::files::is_at;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The open file.
pub(crate) struct Table {
    /// Where it is.
    path: PathBuf,
    /// Its end.
    rows: csv::Writer<Counted>,
}

/// A file that knows how long it is to be.
struct Counted {
    /// The file, to whose end is written.
    file: File,
    /// What was written so far \[bytes\].
    length: u64,
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.length += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Table {
    /// Begins a file with a row of column names.
    pub(crate) fn create(path: &Path, names: &[String]) -> Result<Self, OutputError> {
        let file = File::create(path).and_then(|_| OpenOptions::new().append(true).open(path));
        let file = file.map_err(OutputError::at(path))?;
        let rows = csv::Writer::from_writer(Counted { file, length: 0 });
        let mut table = Self { path: path.to_owned(), rows };
        table.add(names)?;
        Ok(table)
    }

    /// Takes up a file after the rows that are kept; those behind them are cut off.
    pub(crate) fn reopen(path: &Path, found: &Found) -> Result<Self, OutputError> {
        let at = OutputError::at;
        let file = OpenOptions::new().append(true).open(path).map_err(at(path))?;
        if !is_at(&file, path).map_err(at(path))? {
            return Err(OutputError::not_own(path, "a link", "a file of a run"));
        }
        file.set_len(found.bytes).map_err(at(path))?;
        Ok(Self { path: path.to_owned(), rows: csv::Writer::from_writer(Counted { file, length: found.bytes }) })
    }

    /// Adds a row and hands it to the system.
    pub(crate) fn add(&mut self, row: &[String]) -> Result<(), OutputError> {
        self.expect_whole()?;
        let written = self.rows.write_record(row).map_err(io::Error::from).and_then(|()| self.rows.flush());
        written.map_err(OutputError::at(&self.path))
    }

    /// Refuses a file that somebody else has cut short, or has written to.
    fn expect_whole(&self) -> Result<(), OutputError> {
        let Counted { file, length: expected } = self.rows.get_ref();
        let (path, expected) = (self.path.clone(), *expected);
        let found = file.metadata().map_err(OutputError::at(&self.path))?.len();
        if found == expected { Ok(()) } else { Err(OutputError::Changed { path, expected, found }) }
    }

    /// Makes sure that all rows are on the disk.
    pub(crate) fn sync(&self) -> Result<(), OutputError> {
        let file = &self.rows.get_ref().file;
        file.sync_all().map_err(OutputError::at(&self.path))?;
        self.expect_whole()?;
        if is_at(file, &self.path).map_err(OutputError::at(&self.path))? {
            Ok(())
        } else {
            Err(OutputError::Gone { path: self.path.clone() })
        }
    }
}

/// The part of an existing file that a continued run keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Found {
    /// Its length.
    bytes: u64,
    /// Its rows.
    pub rows: u64,
    /// Time of the first of them \[s\].
    pub first: Option<f64>,
}

impl Found {
    /// Looks for the rows up to a time \[s\] in a file that begins with these column names, `time` before all.
    pub(crate) fn until(path: &Path, names: &[String], time: f64) -> Result<Self, ResumeError> {
        let bytes = std::fs::read(path).map_err(|source| ResumeError::Read { path: path.to_owned(), source })?;
        let mut lines = bytes.split_inclusive(|byte| *byte == b'\n').filter(|line| line.ends_with(b"\n"));
        let header = lines.next().unwrap_or_default();
        let mut columns = csv::ReaderBuilder::new().has_headers(false).from_reader(header);
        let same = columns.records().next().is_some_and(|record| record.is_ok_and(|record| record.iter().eq(names)));
        if !same {
            return Err(ResumeError::Columns { path: path.to_owned() });
        }
        let mut found = Self { bytes: header.len() as u64, ..Self::default() };
        for line in lines {
            let first = line.split(|byte| *byte == b',').next().unwrap_or_default();
            let row = std::str::from_utf8(first).ok().and_then(|text| text.trim().parse::<f64>().ok());
            let Some(row) = row.filter(|row| *row <= time) else { break };
            found.bytes += line.len() as u64;
            found.rows += 1;
            found.first = found.first.or(Some(row));
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::scratch::Scratch;

    /// Column names.
    fn names() -> Vec<String> {
        ["time", "floor.force.z", "contacts.count"].map(String::from).to_vec()
    }

    /// A row of these numbers.
    fn row(time: f64, force: f64) -> [String; 3] {
        [format!("{time:?}"), format!("{force:?}"), "3".to_owned()]
    }

    /// A file of three rows, and the folder that goes with it.
    fn three_rows() -> (PathBuf, Scratch) {
        let folder = Scratch::new();
        let path = folder.join("table.csv");
        let mut table = Table::create(&path, &names()).unwrap();
        for (time, force) in [(0.0, -1.0 / 3.0), (1e-7, 1e300), (0.1, f64::MIN_POSITIVE)] {
            table.add(&row(time, force)).unwrap();
        }
        (path, folder)
    }

    #[test]
    fn numbers_read_back_as_the_same_bits() {
        let (path, _folder) = three_rows();
        let text = std::fs::read_to_string(&path).unwrap();
        let forces: Vec<f64> =
            text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect();
        assert_eq!(forces, [-1.0 / 3.0, 1e300, f64::MIN_POSITIVE]);
        assert!(text.contains("1e-7,1e300,3\n"), "{text}");
    }

    #[test]
    fn a_reopened_file_goes_on_as_if_it_had_never_been_closed() {
        let (path, _folder) = three_rows();
        let whole = std::fs::read(&path).unwrap();
        let found = Found::until(&path, &names(), 0.0).unwrap();
        assert_eq!((found.rows, found.first), (1, Some(0.0)));
        let mut table = Table::reopen(&path, &found).unwrap();
        table.add(&row(1e-7, 1e300)).unwrap();
        table.add(&row(0.1, f64::MIN_POSITIVE)).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), whole);
    }

    #[test]
    fn a_row_that_was_cut_off_is_not_kept() {
        let (path, _folder) = three_rows();
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, &whole[..whole.len() - 2]).unwrap();
        assert_eq!(Found::until(&path, &names(), 1.0).unwrap().rows, 2);
    }

    #[test]
    fn a_file_of_other_columns_is_refused() {
        let (path, _folder) = three_rows();
        let error = Found::until(&path, &names()[..2], 0.0).unwrap_err();
        assert!(matches!(error, ResumeError::Columns { .. }), "{error}");
    }
}
