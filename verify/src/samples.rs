//! `samples.csv`: particles at chosen steps.

use super::case::Case;
use super::error::VerifyError;
use super::trajectory::Sample;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// A particle: position \[m\], velocity \[m/s\], angular velocity \[rad/s\], force \[N\], torque \[N m\].
pub(super) type Row = [[f64; 3]; 5];

/// The columns.
const COLUMNS: [&str; 18] = [
    "step", "time", "id", "x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz", "fx", "fy", "fz", "tx", "ty",
    "tz",
];

/// Columns of the numbers of a [`Row`].
const NUMBERS: usize = 3;

/// The trajectory that another engine left.
pub(super) struct Samples {
    /// The particles at each step, in the case's order.
    pub(super) rows: Vec<(u64, Vec<Row>)>,
}

impl Samples {
    /// Reads the samples of a case, if there are any.
    pub(super) fn read(path: &Path, case: &Case) -> Result<Option<Self>, VerifyError> {
        if !path.exists() {
            return Ok(None);
        }
        let text = fs::read_to_string(path).map_err(|cause| VerifyError::file(path, &cause))?;
        let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
        let wrong = |line, message| VerifyError::Samples { path: path.to_path_buf(), line, message };
        let header = lines.next().map_or("", |(_, line)| line);
        let places = places(header).map_err(|message| wrong(1, message))?;
        let in_case: BTreeMap<u32, usize> = case.particles.iter().map(|particle| particle.id).zip(0..).collect();
        let mut steps: BTreeMap<u64, Vec<Option<Row>>> = BTreeMap::new();
        for (line, row) in lines {
            let (step, id, row) = parse(row, &places).map_err(|message| wrong(line, message))?;
            let index =
                *in_case.get(&id).ok_or_else(|| wrong(line, format!("id {id} is not a particle of the case")))?;
            if step > case.steps {
                return Err(wrong(
                    line,
                    format!("expected a step up to {}, where the case ends, found {step}", case.steps),
                ));
            }
            let of_step = steps.entry(step).or_insert_with(|| vec![None; in_case.len()]);
            if of_step[index].replace(row).is_some() {
                return Err(wrong(line, format!("a second row of particle {id} at step {step}")));
            }
        }
        let rows = complete(steps, case).map_err(|message| wrong(1, message))?;
        if rows.is_empty() {
            return Err(wrong(1, "expected a row for each particle and sample, found none".into()));
        }
        Ok(Some(Self { rows }))
    }

    /// The sampled steps, ascending.
    pub(super) fn steps(&self) -> Vec<u64> {
        self.rows.iter().map(|(step, _)| *step).collect()
    }
}

/// Every particle of every step, or the name of one that is absent.
fn complete(steps: BTreeMap<u64, Vec<Option<Row>>>, case: &Case) -> Result<Vec<(u64, Vec<Row>)>, String> {
    let row = |step: u64, index: usize, row: Option<Row>| {
        row.ok_or_else(|| format!("no row of particle {} at step {step}", case.particles[index].id))
    };
    steps
        .into_iter()
        .map(|(step, rows)| {
            let rows = rows.into_iter().enumerate().map(|(index, found)| row(step, index, found));
            Ok((step, rows.collect::<Result<_, String>>()?))
        })
        .collect()
}

/// Where each of [`COLUMNS`] stands in the file.
fn places(header: &str) -> Result<Vec<usize>, String> {
    let found: Vec<&str> = header.split(',').map(str::trim).collect();
    let place = |column: &&str| {
        found.iter().position(|name| name == column).ok_or_else(|| format!("no column \"{column}\" in \"{header}\""))
    };
    COLUMNS.iter().map(place).collect()
}

/// Step, id and numbers of one line.
fn parse(line: &str, places: &[usize]) -> Result<(u64, u32, Row), String> {
    let fields: Vec<&str> = line.split(',').map(str::trim).collect();
    let field = |column: usize| {
        let name = COLUMNS[column];
        fields.get(places[column]).copied().ok_or_else(|| format!("no field \"{name}\""))
    };
    let whole = |column: usize| {
        let text = field(column)?;
        text.parse::<u64>().map_err(|_| format!("{}: expected a whole number, found \"{text}\"", COLUMNS[column]))
    };
    let mut row = Row::default();
    for (offset, number) in row.iter_mut().flatten().enumerate() {
        let text = field(NUMBERS + offset)?;
        *number = text
            .parse()
            .ok()
            .filter(|value: &f64| value.is_finite())
            .ok_or_else(|| format!("{}: expected a finite number, found \"{text}\"", COLUMNS[NUMBERS + offset]))?;
    }
    let id = whole(2)?;
    let id = u32::try_from(id).map_err(|_| format!("expected an id below 2³², found {id}"))?;
    Ok((whole(0)?, id, row))
}

/// Writes a trajectory in the same columns, 17 digits.
pub(super) fn write(path: &Path, case: &Case, samples: &[Sample]) -> Result<(), VerifyError> {
    let mut text = COLUMNS.join(",");
    text.push('\n');
    for Sample { step, rows, .. } in samples {
        for (particle, row) in case.particles.iter().zip(rows) {
            let time = *step as f64 * case.dt;
            // writing to a string cannot fail
            let _ = write!(text, "{step},{time},{}", particle.id);
            for number in row.iter().flatten() {
                let _ = write!(text, ",{number:.16e}");
            }
            text.push('\n');
        }
    }
    fs::write(path, text).map_err(|cause| VerifyError::file(path, &cause))
}
