//! The spheres of one body as LIGGGHTS reads them (`fix particletemplate/multisphere .. spheres file`): x y z radius, line by line.

use super::{FileFault, REPORTED, Rows};
use crate::base::document::Mistake;

/// Columns of a line \[m\].
const COLUMNS: [&str; 4] = ["x", "y", "z", "radius"];

/// Reads the text of such a file.
pub(crate) fn read(text: &str) -> Result<Rows, Vec<FileFault>> {
    let (mut rows, mut faults) = (Rows::default(), Vec::new());
    let mut columns = [const { Vec::new() }; 4];
    for (number, line) in (1..).zip(text.lines()) {
        let words: Vec<&str> = line.split('#').next().unwrap_or_default().split_whitespace().collect();
        if words.is_empty() {
            continue;
        }
        if words.len() != COLUMNS.len() {
            let (found, expected) = (format!("{} words", words.len()), "four numbers: x y z radius".to_owned());
            faults.push(FileFault::at(number, "", Mistake::Unexpected { found, expected }));
        }
        for ((word, name), column) in words.iter().zip(COLUMNS).zip(&mut columns) {
            match word.parse::<f64>() {
                Ok(value) if value.is_finite() => column.push(value),
                _ => faults.push(FileFault::number(number, name, word)),
            }
        }
        rows.lines.push(number as u32);
        if faults.len() >= REPORTED {
            break;
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    rows.count = rows.lines.len();
    rows.columns = COLUMNS.into_iter().map(str::to_owned).zip(columns).collect();
    Ok(rows)
}
