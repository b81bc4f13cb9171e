//! How far two trajectories are apart.

use super::case::Case;
use super::heat::HeatErrors;
use super::linked::LinkErrors;
use super::samples::Samples;
use super::surfaces::SurfaceErrors;
use super::trajectory::Sample;
use std::fmt;

/// The quantities compared, in order: position, velocity, angular velocity, force, torque.
const QUANTITIES: usize = 5;

/// Below this share of speed over radius an angular velocity is round-off; likewise a torque, of force times radius.
const ROUND_OFF: f64 = 1e-9;

/// How much further than the other engine's own sensitivity a right answer may be away.
const SENSITIVITY_FACTOR: f64 = 100.0;

/// How much further than the deviation of an independent integration a window may be away.
const WINDOW_FACTOR: f64 = 10.0;

/// What a comparison allows, and how far it goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measure {
    /// Largest errors that pass, of the quantities of particles.
    pub(super) allowed: [f64; QUANTITIES],
    /// Largest error that passes, of the quantities of bonds.
    pub(super) allowed_of_links: f64,
    /// The last step compared.
    pub(super) until: u64,
}

impl Measure {
    /// Of a run from the start, or of one from each sample to the next.
    ///
    /// A run with bonds from the start is compared to half the step to which the case can be repeated, or to its end
    /// if all of it can.
    pub(super) fn of(case: &Case, tolerance: f64, windows: bool) -> Self {
        let sensitivity = case.sensitivity.unwrap_or_default().to_array();
        let mut allowed = sensitivity.map(|value| tolerance.max(SENSITIVITY_FACTOR * value));
        let mut allowed_of_links = tolerance;
        let mut until = case.steps;
        if windows {
            let deviation = case.reproducible.window_deviation.unwrap_or(0.0);
            allowed_of_links = tolerance.max(WINDOW_FACTOR * deviation);
            allowed = [allowed_of_links; QUANTITIES];
        } else if let Some(step) = case.reproducible.free_run_1e9_until_step.filter(|step| *step < case.steps) {
            until = step / 2;
        }
        Self { allowed, allowed_of_links, until }
    }
}

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
    /// How far its bonds are from theirs; `None` for a case without a record of bonds.
    pub links: Option<LinkErrors>,
    /// How far the loads on its surfaces are from another program's; `None` for a case without a record of them.
    pub surfaces: Option<SurfaceErrors>,
    /// How far its temperatures are from theirs; `None` for a case without a record of them.
    pub heat: Option<HeatErrors>,
    /// Why the run stopped before its end.
    pub stopped: Option<String>,
}

impl Errors {
    /// Compares with the samples; what is missing of ours counts as infinitely far.
    pub(super) fn between(case: &Case, theirs: &Samples, ours: &[Sample], measure: &Measure) -> Self {
        let scales = scales(case, theirs);
        let mut found = [0.0_f64; QUANTITIES];
        for (sample, (_, rows)) in theirs.rows.iter().enumerate().filter(|(_, (step, _))| *step <= measure.until) {
            for (particle, theirs) in rows.iter().enumerate() {
                let ours = ours.get(sample).map(|sample| sample.rows[particle]);
                for quantity in 0..QUANTITIES {
                    let error = ours.map_or(f64::INFINITY, |ours| distance(ours[quantity], theirs[quantity]));
                    let error = if scales[quantity] > 0.0 { error / scales[quantity] } else { error };
                    found[quantity] = if error.is_nan() { f64::INFINITY } else { found[quantity].max(error) };
                }
            }
        }
        Self { found, allowed: measure.allowed }
    }

    /// Whether all are allowed.
    pub fn passed(&self) -> bool {
        self.found.iter().zip(&self.allowed).all(|(found, allowed)| found <= allowed)
    }
}

impl Report {
    /// Whether the case ran to its end and holds its samples, if it has any.
    pub fn passed(&self) -> bool {
        let links = self.links.is_none_or(|links| links.passed());
        let surfaces = self.surfaces.is_none_or(|surfaces| surfaces.passed());
        let heat = self.heat.is_none_or(|heat| heat.passed());
        self.stopped.is_none() && links && surfaces && heat && self.errors.is_none_or(|errors| errors.passed())
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
        if let Some(links) = &self.links {
            write!(formatter, " {links}")?;
        }
        if let Some(surfaces) = &self.surfaces {
            write!(formatter, " {surfaces}")?;
        }
        if let Some(heat) = &self.heat {
            write!(formatter, " {heat}")?;
        }
        write!(formatter, " {}", if self.passed() { "ok" } else { "FAIL" })?;
        match &self.stopped {
            Some(cause) => write!(formatter, ": {cause}"),
            None => Ok(()),
        }
    }
}

/// Distance of two points.
pub(super) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    length([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}

/// Euclidean length.
pub(super) fn length(a: [f64; 3]) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

/// Largest magnitude of each quantity over all samples; of position, the largest displacement. An angular velocity or
/// a torque that is round-off is measured against speed over radius or force times radius.
pub(super) fn scales(case: &Case, theirs: &Samples) -> [f64; QUANTITIES] {
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
