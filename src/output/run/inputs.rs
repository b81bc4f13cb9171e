//! Inputs of a run over time, from a table such as a master leaves.

use crate::base::document::told_columns;
use crate::base::files;
use crate::engine::simulation::Simulation;
use crate::interface::{Interface, Quantity, Value};
use crate::output::results::InputsError;
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_64;

/// Two times closer than this part of the later one are one.
const SAME: f64 = 1e-9;

/// What the outside gives: piecewise linear in time, displacements from 0 at time 0 on, velocities and forces from their start
/// values on or from those in a row for time 0.
#[derive(Clone, Debug)]
pub(crate) struct Inputs {
    /// Digest of the table's bytes: a run that goes on must have the same.
    pub(super) digest: u64,
    /// Times, ascending, from 0 \[s\].
    times: Vec<f64>,
    /// What the table has.
    columns: Vec<Column>,
}

/// An input in a table.
#[derive(Clone, Debug)]
struct Column {
    /// Index in the interface.
    index: usize,
    /// Whether it says where a boundary is to be: at the end of a communication step, and 0 at time 0.
    is_place: bool,
    /// Whether that, or the strain of a cell, counts from time 0.
    begins_at_zero: bool,
    /// Values at the times.
    values: Vec<f64>,
}

impl Inputs {
    /// Reads a table: a column `time`, and columns with the names of inputs. Those of other variables are skipped: a master
    /// notes them, too.
    pub(crate) fn read(path: &Path, interface: &Interface) -> Result<Self, InputsError> {
        let unreadable = |source| InputsError::Read { path: path.to_owned(), source };
        let bytes = files::read(path).map_err(|error| unreadable(error.into()))?;
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(&*bytes);
        let names = reader.headers().map_err(unreadable)?.clone();
        let digest = xxh3_64(&bytes);
        if interface.inputs().next().is_none() {
            return Err(InputsError::NoInput { path: path.to_owned() });
        }
        let found: Vec<String> = names.iter().map(str::to_owned).collect();
        let known = found.len() == 1 && interface.find(&found[0]).is_some();
        let told = told_columns(&found).or_else(|| known.then(|| found[0].clone()));
        let missing = |expected| {
            let found = told.clone().unwrap_or_else(|| "a first line without names of columns".to_owned());
            InputsError::Column { path: path.to_owned(), expected, found }
        };
        let time = names.iter().position(|name| name == "time").ok_or_else(|| missing("time".to_owned()))?;
        if names.len() > 1 && told.is_none() {
            return Err(missing("time".to_owned()));
        }
        for (place, name) in names.iter().enumerate() {
            let column = || name.to_owned();
            if name != "time" && !interface.variables().iter().any(|variable| variable.name == name) {
                let known = interface.inputs().map(|(_, variable)| variable.name.clone()).collect();
                return Err(InputsError::Unknown { path: path.to_owned(), column: column(), known });
            }
            if names.iter().take(place).any(|before| before == name) {
                return Err(InputsError::Twice { path: path.to_owned(), column: column() });
            }
        }
        let inputs = interface.inputs().filter_map(|(index, variable)| {
            let column = names.iter().position(|name| name == variable.name)?;
            Some((column, index))
        });
        let chosen: Vec<(usize, usize)> = inputs.collect();
        if chosen.is_empty() {
            let known: Vec<String> = interface.inputs().map(|(_, variable)| variable.name.clone()).collect();
            return Err(missing(known.join(" or ")));
        }
        let mut table = Self {
            digest,
            times: vec![0.0],
            columns: chosen.iter().map(|(_, index)| Column::of(interface, *index)).collect(),
        };
        for record in reader.records() {
            let record = record.map_err(unreadable)?;
            let line = record.position().map_or(0, csv::Position::line);
            let number = |column: usize| number(path, line, &names[column], &record[column]);
            let now = number(time)?;
            let row = chosen.iter().map(|(column, _)| number(*column)).collect::<Result<Vec<_>, _>>()?;
            for ((_, index), value) in chosen.iter().zip(&row) {
                let refused = |source| InputsError::Refused { path: path.to_owned(), line, source };
                interface.check(*index, *value).map_err(refused)?;
            }
            table.add(now, &row).map_err(|(expected, found)| InputsError::Time {
                path: path.to_owned(),
                line,
                expected,
                found,
            })?;
        }
        Ok(table)
    }

    /// Takes a row; otherwise what was expected and what was found.
    fn add(&mut self, time: f64, row: &[f64]) -> Result<(), (&'static str, String)> {
        if time == 0.0 && self.times.len() == 1 {
            for (column, value) in self.columns.iter_mut().zip(row) {
                if column.begins_at_zero && *value != 0.0 {
                    let what = if column.is_place { "displacement 0 at time 0" } else { "strain 0 at time 0" };
                    return Err((what, format!("{value:?}")));
                }
                column.values[0] = *value;
            }
            return Ok(());
        }
        if self.times.last().is_some_and(|last| time <= *last) {
            return Err(("a time after that of the line before, or 0 in the first", format!("{time:?}")));
        }
        self.times.push(time);
        for (column, value) in self.columns.iter_mut().zip(row) {
            column.values.push(*value);
        }
        Ok(())
    }

    /// Time of the last row \[s\].
    pub(crate) fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Gives every input for the communication step that ends at this time.
    pub(super) fn set(&self, interface: &Interface, simulation: &mut Simulation, time: f64) {
        for column in &self.columns {
            let (now, end) = (simulation.time(), self.at(column, time));
            let value = if column.is_place { end } else { self.at(column, now) };
            // The index is that of an input, and values are finite: there is nothing to refuse.
            let _ = interface.set(simulation, column.index, Value::Real(value));
            if !column.is_place && time > now {
                let _ = interface.set_rate(simulation, column.index, (end - value) / (time - now));
            }
        }
    }

    /// The value of an input at a time.
    fn at(&self, column: &Column, time: f64) -> f64 {
        let (times, values) = (&self.times, &column.values);
        let next = times.partition_point(|row| *row < time * (1.0 - SAME)).min(times.len() - 1);
        if next == 0 || (times[next] - time).abs() <= SAME * time || time > times[next] {
            return values[next];
        }
        let share = (time - times[next - 1]) / (times[next] - times[next - 1]);
        values[next - 1] + share * (values[next] - values[next - 1])
    }
}

impl Column {
    /// The column of an input, before its rows are read.
    fn of(interface: &Interface, index: usize) -> Self {
        let variable = &interface.variables()[index];
        let is_place = matches!(variable.quantity, Quantity::Length | Quantity::Angle);
        let begins_at_zero = is_place || variable.name.starts_with("cell.strain") || variable.name == "cell.shear";
        Self {
            index,
            is_place,
            begins_at_zero,
            values: vec![if begins_at_zero { 0.0 } else { variable.start.unwrap_or(0.0) }],
        }
    }
}

/// A finite number in a field.
fn number(path: &Path, line: u64, column: &str, field: &str) -> Result<f64, InputsError> {
    let found =
        || InputsError::Number { path: PathBuf::from(path), line, column: column.to_owned(), found: field.to_owned() };
    field.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(found)
}
