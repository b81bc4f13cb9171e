//! Tables of motions, from the files that boundaries and fluids name.

use crate::base::document::{Faults, Mistake, told_columns};
use crate::laws::motion::{FileKeys, Table, TableKeys};
use crate::scene::{AxisMotion, Source};
use csv::{ReaderBuilder, StringRecord, Trim};

/// The table of an axis, if nothing is wrong with its file.
pub(super) fn read(
    TableKeys(keys): &TableKeys,
    axis: usize,
    source: &Source,
    (table, key): (&str, &str),
    faults: &mut Faults,
) -> Option<Table> {
    // A file that could not be read is reported already.
    let bytes = source.files.get(&keys.file)?;
    let word = AxisMotion::WORDS[axis];
    columns(bytes, keys, word)
        .and_then(|(lines, [times, places])| {
            let rows = Table::of(times, places, keys.interpolation);
            rows.map_err(|(row, found, expected)| (lines.get(row).copied(), found, expected.to_owned()))
        })
        .map_err(|(line, found, expected)| {
            let line = line.map_or_else(String::new, |line| format!(", line {line}"));
            let message = format!("{}{line}: expected {expected}, found {found}", keys.file);
            faults.add(table, key, Mistake::Refused { message });
        })
        .ok()
}

/// What is wrong: line of the file, what was found, what was expected.
type Wrong = (Option<u64>, String, String);

/// Line of each row, times \[s\] and displacements.
fn columns(bytes: &[u8], keys: &FileKeys, word: &str) -> Result<(Vec<u64>, [Vec<f64>; 2]), Wrong> {
    let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(bytes);
    let headers = reader.headers().map_err(|error| unreadable(&error))?.clone();
    let place = |name: &str| {
        let known: Vec<String> = headers.iter().map(str::to_owned).collect();
        let shown = told_columns(&known).unwrap_or_else(|| "a first line without names of columns".to_owned());
        let missing = || (Some(1), shown.clone(), format!("a column {name}"));
        headers.iter().position(|header| header == name).ok_or_else(missing)
    };
    let chosen = [place(keys.time.as_deref().unwrap_or("time"))?, place(keys.column.as_deref().unwrap_or(word))?];
    let (mut lines, mut columns, mut record) = (Vec::new(), [Vec::new(), Vec::new()], StringRecord::new());
    while reader.read_record(&mut record).map_err(|error| unreadable(&error))? {
        let line = record.position().map_or(0, csv::Position::line);
        lines.push(line);
        for (column, place) in columns.iter_mut().zip(chosen) {
            let text = &record[place];
            let number = text.parse().ok().filter(|number: &f64| number.is_finite());
            let wrong =
                || (Some(line), format!("{text:?} in column {}", &headers[place]), "a finite number".to_owned());
            column.push(number.ok_or_else(wrong)?);
        }
    }
    Ok((lines, columns))
}

/// A line that is not a line of the table.
fn unreadable(error: &csv::Error) -> Wrong {
    let line = error.position().map(csv::Position::line);
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            (line, len.to_string(), format!("{expected_len} columns, as in the line of names"))
        }
        _ => (line, "bytes that are not UTF-8".to_owned(), "a table of comma-separated columns".to_owned()),
    }
}
