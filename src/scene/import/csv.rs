//! Particles from comma-separated columns: a line of names, then a line for each particle.

use super::rows::twice;
use super::{FileFault, REPORTED, Request, Rows};
use crate::base::document::Mistake;
use csv::{ByteRecord, ReaderBuilder, Trim};

/// What a column is read for.
enum Use {
    /// Not at all.
    Nothing,
    /// A number, into the column with this place.
    Number(usize),
    /// The material's name or type.
    Label,
}

/// Reads the text of a CSV file.
pub(crate) fn read(bytes: &[u8], request: &Request) -> Result<Rows, Vec<FileFault>> {
    let mut reader = ReaderBuilder::new().trim(Trim::Headers).comment(Some(b'#')).from_reader(bytes);
    let headers = reader.headers().map_err(|error| vec![unreadable(&error)])?;
    let headers: Vec<String> = headers.iter().map(str::to_owned).collect();
    request.needed(&headers, Some(1))?;
    let mut names = Vec::new();
    let uses = uses(&headers, request, &mut names)?;
    let label_column = headers.iter().find(|header| matches!(header.as_str(), "material" | "type"));
    let left_out =
        headers.iter().zip(&uses).filter(|(header, purpose)| matches!(purpose, Use::Nothing) && request.misses(header));
    let mut rows = Rows {
        label_column: label_column.cloned().unwrap_or_default(),
        left_out: left_out.map(|(header, _)| header.clone()).collect(),
        ..Rows::default()
    };
    let mut columns = vec![Vec::new(); names.len()];
    let mut faults = Vec::new();
    let mut record = ByteRecord::new();
    while faults.len() < REPORTED {
        match reader.read_byte_record(&mut record) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => {
                faults.push(unreadable(&error));
                break;
            }
        }
        let line = record.position().map_or(0, |position| position.line() as u32);
        rows.lines.push(line);
        for ((field, purpose), header) in record.iter().zip(&uses).zip(&headers) {
            // The reader would copy each record to trim it.
            let text = std::str::from_utf8(field.trim_ascii()).unwrap_or("\u{fffd}");
            match purpose {
                Use::Nothing => {}
                Use::Label => rows.push_label(text),
                Use::Number(column) => match text.parse::<f64>() {
                    Ok(number) if number.is_finite() => columns[*column].push(number),
                    _ => faults.push(FileFault::number(line as usize, header, text)),
                },
            }
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    rows.count = rows.lines.len();
    rows.columns = names.into_iter().zip(columns).collect();
    Ok(rows)
}

/// What each column is read for; `names` gets those of the numbers.
fn uses(headers: &[String], request: &Request, names: &mut Vec<String>) -> Result<Vec<Use>, Vec<FileFault>> {
    let mut uses = Vec::new();
    let mut labelled = false;
    for (place, header) in headers.iter().enumerate() {
        if headers[..place].contains(header) {
            let mistake = Mistake::Unexpected {
                found: format!("column {header} twice"),
                expected: "one column of each name".to_owned(),
            };
            return Err(vec![FileFault::at(1, "", mistake)]);
        }
        uses.push(match header.as_str() {
            "material" | "type" if labelled => return Err(twice(["material", "type"], Some(1))),
            "material" | "type" => {
                labelled = true;
                Use::Label
            }
            _ if request.reads(header) => {
                names.push(header.clone());
                Use::Number(names.len() - 1)
            }
            _ => Use::Nothing,
        });
    }
    Ok(uses)
}

/// A line that is not a line of the table.
fn unreadable(error: &csv::Error) -> FileFault {
    let line = error.position().map(|position| position.line() as usize);
    let mistake = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => Mistake::Unexpected {
            found: len.to_string(),
            expected: format!("{expected_len} columns, as in the line of names"),
        },
        csv::ErrorKind::Utf8 { .. } => Mistake::Unexpected {
            found: "bytes that are not UTF-8".to_owned(),
            expected: "a line of column names".to_owned(),
        },
        _ => Mistake::Refused { message: error.to_string() },
    };
    FileFault { line, column: String::new(), mistake }
}
