//! `prescribed = { z = { table = .. } }`: a displacement in time, point by point.

use super::{Motion, ShownVariables};
use crate::base::document::{Forms, several_forms};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess};

/// What a table does between its rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Interpolation {
    /// Straight lines: the velocity jumps at the rows.
    #[default]
    Linear,
    /// Cubic arcs through the rows with a continuous velocity, which never go beyond the rows that they join.
    Smooth,
}

/// Where a table stands: `"motion.csv"`, or with more keys.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FileKeys {
    /// The file, beside the scene.
    pub(crate) file: String,
    /// The column of times \[s\].
    pub(crate) time: Option<String>,
    /// The column of displacements \[m, rad\].
    pub(crate) column: Option<String>,
    /// What it does between its rows.
    #[serde(default)]
    pub(crate) interpolation: Interpolation,
}

/// What the scene writes of a table.
#[derive(Clone, Debug)]
pub(crate) struct TableKeys(pub(crate) FileKeys);

impl Forms for TableKeys {
    const EXPECTED: &'static str = "the name of a file, or { file, time, column, interpolation }";

    fn word<E: Error>(file: &str) -> Result<Self, E> {
        Ok(Self(FileKeys { file: file.to_owned(), ..FileKeys::default() }))
    }

    fn table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        FileKeys::deserialize(MapAccessDeserializer::new(map)).map(Self)
    }
}
several_forms!(TableKeys);

/// A displacement in time, from 0 at time 0 on; after its last row it stays.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Times, ascending from 0 \[s\].
    times: Vec<f64>,
    /// Displacements at the times \[m, rad\].
    places: Vec<f64>,
    /// Velocities at the times; empty where straight lines join the rows \[m/s, rad/s\].
    slopes: Vec<f64>,
}

impl Table {
    /// The table of these rows; otherwise the row that is wrong, counted from 0, what was found and what was expected.
    pub(crate) fn of(
        times: Vec<f64>,
        places: Vec<f64>,
        interpolation: Interpolation,
    ) -> Result<Self, (usize, String, &'static str)> {
        match times[..] {
            [] => return Err((0, "no row".to_owned(), "a row at time 0 and others")),
            [first, ..] if first != 0.0 => return Err((0, format!("time {first:?} s"), "time 0 in the first row")),
            [_] => return Err((0, "one row".to_owned(), "a row at time 0 and others")),
            _ => {}
        }
        if places[0] != 0.0 {
            return Err((0, format!("{:?}", places[0]), "displacement 0 at time 0"));
        }
        if let Some(row) = (1..times.len()).find(|&row| times[row] <= times[row - 1]) {
            let found = format!("time {:?} s after {:?} s", times[row], times[row - 1]);
            return Err((row, found, "a time after that of the row before"));
        }
        let slopes = match interpolation {
            Interpolation::Linear => Vec::new(),
            Interpolation::Smooth => slopes(&times, &places),
        };
        Ok(Self { times, places, slopes })
    }

    /// Displacement and velocity.
    fn at(&self, time: f64) -> [f64; 2] {
        let last = self.times.len() - 1;
        if time >= self.times[last] {
            return [self.places[last], 0.0];
        }
        let next = self.times.partition_point(|row| *row <= time).max(1);
        let (from, to) = (next - 1, next);
        let length = self.times[to] - self.times[from];
        let (share, way) = ((time - self.times[from]) / length, self.places[to] - self.places[from]);
        if self.slopes.is_empty() {
            return [self.places[from] + share * way, way / length];
        }
        let (rest, [a, b]) = (1.0 - share, [self.slopes[from] * length, self.slopes[to] * length]);
        // Hermite's cubic.
        let place =
            self.places[from] + share * share * (3.0 - 2.0 * share) * way + share * rest * (rest * a - share * b);
        let rate = 6.0 * share * rest * way + rest * (1.0 - 3.0 * share) * a + share * (3.0 * share - 2.0) * b;
        [place, rate / length]
    }
}

/// Velocities at the rows: the harmonic mean of those of both sides, 0 at the ends and where the direction changes, so that no
/// arc goes beyond its rows (F. N. Fritsch and R. E. Carlson 1980).
fn slopes(times: &[f64], places: &[f64]) -> Vec<f64> {
    let rate = |row: usize| (places[row] - places[row - 1]) / (times[row] - times[row - 1]);
    let slope = |row: usize| {
        if row == 0 || row + 1 == times.len() {
            return 0.0;
        }
        let (before, after) = (rate(row), rate(row + 1));
        if before * after > 0.0 { 2.0 * before * after / (before + after) } else { 0.0 }
    };
    (0..times.len()).map(slope).collect()
}

impl Motion for Table {
    fn words(&self, _unit: &str) -> Option<String> {
        Some(format!("along a table of {} rows", self.times.len()))
    }

    fn seen(&self) -> ShownVariables {
        ShownVariables::Place
    }

    fn at(&self, time: f64) -> Option<[f64; 2]> {
        Some(Table::at(self, time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// To 2 m, on to 3 m, back to 1 m.
    fn table(interpolation: Interpolation) -> Table {
        Table::of(vec![0.0, 1.0, 2.0, 4.0], vec![0.0, 2.0, 3.0, 1.0], interpolation).unwrap()
    }

    #[test]
    fn a_table_goes_through_its_rows_and_its_velocity_is_the_rate_of_its_displacement() {
        for interpolation in [Interpolation::Linear, Interpolation::Smooth] {
            let table = table(interpolation);
            for (time, place) in [(0.0, 0.0), (1.0, 2.0), (2.0, 3.0), (4.0, 1.0), (9.0, 1.0)] {
                assert!((table.at(time)[0] - place).abs() < 1e-15, "{interpolation:?} at {time} s");
            }
            for number in 0..99 {
                let (time, h) = (0.05 * f64::from(number) + 0.003, 1e-6);
                let rate = (table.at(time + h)[0] - table.at(time - h)[0]) / (2.0 * h);
                assert!((rate - table.at(time)[1]).abs() < 1e-5, "{interpolation:?} at {time} s: {rate}");
                assert!((0.0..=3.0).contains(&table.at(time)[0]), "{interpolation:?} goes beyond its rows at {time} s");
            }
        }
    }

    #[test]
    fn a_smooth_table_has_no_jump_of_its_velocity() {
        let table = table(Interpolation::Smooth);
        for time in [1.0, 2.0, 4.0] {
            let jump = table.at(time + 1e-9)[1] - table.at(time - 1e-9)[1];
            assert!(jump.abs() < 1e-6, "{jump} m/s at {time} s");
        }
        assert!((table.at(1.0)[1] - 2.0 * 2.0 / 3.0).abs() < 1e-12, "the harmonic mean of 2 and 1 m/s");
    }

    #[test]
    fn rows_that_are_no_motion_from_displacement_0_on_are_refused() {
        let wrong =
            |times: &[f64], places: &[f64]| Table::of(times.into(), places.into(), Interpolation::Linear).unwrap_err();
        assert_eq!(wrong(&[], &[]).1, "no row");
        assert_eq!(wrong(&[0.0], &[0.0]).1, "one row");
        assert_eq!(wrong(&[0.5, 1.0], &[0.0, 1.0]).1, "time 0.5 s");
        assert_eq!(wrong(&[0.0, 1.0], &[0.25, 1.0]).1, "0.25");
        assert_eq!(
            wrong(&[0.0, 1.0, 1.0], &[0.0; 3]),
            (2, "time 1.0 s after 1.0 s".to_owned(), "a time after that of the row before")
        );
    }
}
