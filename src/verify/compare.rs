//! How far two trajectories are apart.

use super::case::Case;
use super::samples::{Row, Samples};
use std::fmt;

/// The quantities compared, in order: position, velocity, angular velocity, force, torque.
const QUANTITIES: usize = 5;

/// Below this share of speed over radius an angular velocity is round-off; likewise a torque, of force times radius.
const ROUND_OFF: f64 = 1e-9;

/// How much further than the other engine's own sensitivity a right answer may be away.
const SENSITIVITY_FACTOR: f64 = 100.0;

/// Largest relative errors of a case and what they may be, of position, velocity, angular velocity, force, torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Largest |ours − theirs| over samples and particles, over the largest magnitude of theirs.
    pub found: [f64; QUANTITIES],
    /// What passes.
    pub allowed: [f64; QUANTITIES],
}

/// What came of a case. Displays as one line: name, errors, `ok` or `FAIL`.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The case.
    pub name: String,
    /// How far it is from its samples; `None` for a case without samples.
    pub errors: Option<Errors>,
    /// Why the run stopped before its end.
    pub stopped: Option<String>,
}

impl Errors {
    /// Compares with the samples; what is missing of ours counts as infinitely far.
    pub(super) fn between(case: &Case, theirs: &Samples, ours: &[(u64, Vec<Row>)], tolerance: f64) -> Self {
        let scales = scales(case, theirs);
        let mut found = [0.0_f64; QUANTITIES];
        for (sample, (_, rows)) in theirs.rows.iter().enumerate() {
            for (particle, theirs) in rows.iter().enumerate() {
                let ours = ours.get(sample).map(|(_, rows)| rows[particle]);
                for quantity in 0..QUANTITIES {
                    let error = ours.map_or(f64::INFINITY, |ours| distance(ours[quantity], theirs[quantity]));
                    let error = if scales[quantity] > 0.0 { error / scales[quantity] } else { error };
                    found[quantity] = if error.is_nan() { f64::INFINITY } else { found[quantity].max(error) };
                }
            }
        }
        let sensitivity = case.sensitivity.unwrap_or_default().to_array();
        Self { found, allowed: sensitivity.map(|value| tolerance.max(SENSITIVITY_FACTOR * value)) }
    }

    /// Whether all are allowed.
    pub fn passed(&self) -> bool {
        self.found.iter().zip(&self.allowed).all(|(found, allowed)| found <= allowed)
    }
}

impl Report {
    /// Whether the case ran to its end and holds its samples, if it has any.
    pub fn passed(&self) -> bool {
        self.stopped.is_none() && self.errors.is_none_or(|errors| errors.passed())
    }
}

impl fmt::Display for Report {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:<30}", self.name)?;
        for quantity in 0..QUANTITIES {
            match self.errors {
                Some(errors) => write!(formatter, " {:>9.1e}", errors.found[quantity])?,
                None => write!(formatter, " {:>9}", "-")?,
            }
        }
        write!(formatter, " {}", if self.passed() { "ok" } else { "FAIL" })?;
        match &self.stopped {
            Some(cause) => write!(formatter, ": {cause}"),
            None => Ok(()),
        }
    }
}

/// Distance of two points.
fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    length([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}

/// Euclidean length.
fn length(a: [f64; 3]) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

/// Largest magnitude of each quantity over all samples; of position, the largest displacement.
fn scales(case: &Case, theirs: &Samples) -> [f64; QUANTITIES] {
    let mut scales = [0.0_f64; QUANTITIES];
    let (_, start) = &theirs.rows[0];
    for (_, rows) in &theirs.rows {
        for (row, start) in rows.iter().zip(start) {
            scales[0] = scales[0].max(distance(row[0], start[0]));
            for quantity in 1..QUANTITIES {
                scales[quantity] = scales[quantity].max(length(row[quantity]));
            }
        }
    }
    let radius = case.particles.iter().map(|particle| particle.radius).fold(f64::INFINITY, f64::min);
    if scales[2] < ROUND_OFF * scales[1] / radius {
        scales[2] = scales[1] / radius;
    }
    if scales[4] < ROUND_OFF * scales[3] * radius {
        scales[4] = scales[3] * radius;
    }
    scales
}
