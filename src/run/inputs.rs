//! Inputs of a run over time, from a table such as a master leaves.

use crate::interface::{Interface, Value};
use crate::results::InputsError;
use crate::step::Simulation;
use std::path::{Path, PathBuf};

/// Two times closer than this part of the later one are one.
const SAME: f64 = 1e-9;

/// What the driven boundaries do: piecewise linear in time, from displacement 0 at time 0 on.
#[derive(Clone, Debug)]
pub(crate) struct Inputs {
    /// Times, ascending, from 0 \[s\].
    times: Vec<f64>,
    /// Index in the interface and values at the times, of each input that the table has.
    columns: Vec<(usize, Vec<f64>)>,
}

impl Inputs {
    /// Reads a table: a column `time`, and columns with the names of inputs; others are skipped.
    pub(crate) fn read(path: &Path, interface: &Interface) -> Result<Self, InputsError> {
        let unreadable = |source| InputsError::Read { path: path.to_owned(), source };
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(unreadable)?;
        let names = reader.headers().map_err(unreadable)?.clone();
        let missing = |right| InputsError::Column { path: path.to_owned(), right };
        let time = names.iter().position(|name| name == "time").ok_or_else(|| missing("time".to_owned()))?;
        let inputs = interface.inputs().filter_map(|(index, variable)| {
            let column = names.iter().position(|name| name == variable.name)?;
            Some((column, index))
        });
        let chosen: Vec<(usize, usize)> = inputs.collect();
        if chosen.is_empty() {
            let known: Vec<String> = interface.inputs().map(|(_, variable)| variable.name.clone()).collect();
            let right = if known.is_empty() { "a scene with a driven boundary".to_owned() } else { known.join(" or ") };
            return Err(missing(right));
        }
        let mut table =
            Self { times: vec![0.0], columns: chosen.iter().map(|(_, index)| (*index, vec![0.0])).collect() };
        for record in reader.records() {
            let record = record.map_err(unreadable)?;
            let line = record.position().map_or(0, csv::Position::line);
            let number = |column: usize| number(path, line, &names[column], &record[column]);
            let now = number(time)?;
            let row = chosen.iter().map(|(column, _)| number(*column)).collect::<Result<Vec<_>, _>>()?;
            table.add(now, &row).map_err(|right| InputsError::Time {
                path: path.to_owned(),
                line,
                time: now,
                right,
            })?;
        }
        Ok(table)
    }

    /// Takes a row; otherwise what would be right.
    fn add(&mut self, time: f64, row: &[f64]) -> Result<(), &'static str> {
        if time == 0.0 && self.times.len() == 1 {
            return if row.iter().all(|value| *value == 0.0) { Ok(()) } else { Err("displacement 0 at time 0") };
        }
        if self.times.last().is_some_and(|last| time <= *last) {
            return Err("a time after that of the line before, or 0 in the first");
        }
        self.times.push(time);
        for ((_, values), value) in self.columns.iter_mut().zip(row) {
            values.push(*value);
        }
        Ok(())
    }

    /// Time of the last row \[s\].
    pub(crate) fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Sets every input to where it is to be at this time.
    pub(crate) fn set(&self, interface: &Interface, simulation: &mut Simulation, time: f64) {
        let next = self.times.partition_point(|row| *row < time * (1.0 - SAME)).min(self.times.len() - 1);
        for (index, values) in &self.columns {
            let value = if next == 0 || (self.times[next] - time).abs() <= SAME * time || time > self.times[next] {
                values[next]
            } else {
                let share = (time - self.times[next - 1]) / (self.times[next] - self.times[next - 1]);
                values[next - 1] + share * (values[next] - values[next - 1])
            };
            // The index is that of an input, and the value is finite: there is nothing to refuse.
            let _ = interface.set(simulation, *index, Value::Real(value));
        }
    }
}

/// A finite number in a field.
fn number(path: &Path, line: u64, column: &str, field: &str) -> Result<f64, InputsError> {
    let found =
        || InputsError::Number { path: PathBuf::from(path), line, column: column.to_owned(), found: field.to_owned() };
    field.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(found)
}
