//! Numbers of a chart: columns with units, rows, and CSV.

use std::io;
use std::path::Path;

/// What is in one place of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A word: the name of a law, of a series.
    Word(String),
    /// A number, in the unit of its column.
    Number(f64),
}

impl From<&str> for Cell {
    fn from(word: &str) -> Self {
        Self::Word(word.to_owned())
    }
}

impl From<String> for Cell {
    fn from(word: String) -> Self {
        Self::Word(word)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl std::fmt::Display for Cell {
    /// A number has the shortest text that reads back as the same bits.
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Word(word) => formatter.write_str(word),
            Self::Number(number) => write!(formatter, "{number:?}"),
        }
    }
}

/// A column: what it holds, and in which unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// What it holds.
    pub name: &'static str,
    /// Unit of its numbers; empty for words, "1" for pure numbers.
    pub unit: &'static str,
}

impl Column {
    /// Name and unit, as a line of CSV and an axis of a picture have them.
    pub fn label(&self) -> String {
        if self.unit.is_empty() { self.name.to_owned() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

/// The numbers of a chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// What the columns hold.
    pub columns: Vec<Column>,
    /// The rows, a cell for each column.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// An empty table of columns, each with a name and a unit.
    pub fn new<const N: usize>(columns: [(&'static str, &'static str); N]) -> Self {
        let columns = columns.iter().map(|(name, unit)| Column { name, unit }).collect();
        Self { columns, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn push<const N: usize>(&mut self, row: [Cell; N]) {
        assert_eq!(N, self.columns.len(), "a row has a cell for each column");
        self.rows.push(row.into());
    }

    /// The place of a column.
    pub fn place(&self, name: &str) -> usize {
        self.columns.iter().position(|column| column.name == name).expect("a chart names columns that its table has")
    }

    /// A number in a row, if it is one.
    pub fn number(&self, row: usize, column: &str) -> Option<f64> {
        match self.rows[row][self.place(column)] {
            Cell::Number(number) => Some(number),
            Cell::Word(_) => None,
        }
    }

    /// Writes it as CSV. Units stand in the first line, in brackets.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut writer = csv::Writer::from_path(path)?;
        writer.write_record(self.columns.iter().map(Column::label))?;
        for row in &self.rows {
            writer.write_record(row.iter().map(Cell::to_string))?;
        }
        writer.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::{Cell, Table};

    #[test]
    fn units_stand_in_the_first_line() {
        let mut table = Table::new([("law", ""), ("step", "s")]);
        table.push(["hertz".into(), 1e-6.into()]);
        let path = std::env::temp_dir().join(format!("cograin-table-{}.csv", std::process::id()));
        table.write(&path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::remove_file(path).unwrap();
        assert_eq!(text, "law,step [s]\nhertz,1e-6\n");
    }

    #[test]
    fn a_word_is_no_number() {
        let mut table = Table::new([("law", ""), ("step", "s")]);
        table.push(["hertz".into(), 1e-6.into()]);
        assert_eq!((table.number(0, "law"), table.number(0, "step")), (None, Some(1e-6)));
        assert_eq!(Cell::from("hertz").to_string(), "hertz");
    }
}
