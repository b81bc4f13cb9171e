//! `boundary_rule.csv`: force and moment of the particles on each surface, as an independent program has them.

use super::case::Case;
use super::compare::{distance, length};
use super::error::VerifyError;
use super::trajectory::Sample;
use std::fmt;
use std::fs;
use std::path::Path;

/// Force \[N\] and moment about the origin \[N m\] of the particles on a surface.
pub(super) type OnSurface = [[f64; 3]; 2];

/// Columns in front of those of the first surface: step, time, energy.
const BEFORE: usize = 3;

/// Columns of a surface.
const EACH: usize = 6;

/// The record of another program.
pub(super) struct Surfaces {
    /// The surfaces at each step.
    rows: Vec<(u64, Vec<OnSurface>)>,
}

impl Surfaces {
    /// Reads the record of a case, if there is one.
    pub(super) fn read(path: &Path) -> Result<Option<Self>, VerifyError> {
        if !path.exists() {
            return Ok(None);
        }
        let text = fs::read_to_string(path).map_err(|cause| VerifyError::file(path, &cause))?;
        let rows = (1..).zip(text.lines()).skip(1).map(|(line, text)| {
            let numbers: Vec<f64> = text.split(',').filter_map(|field| field.trim().parse().ok()).collect();
            let surfaces = numbers.len().saturating_sub(BEFORE);
            if surfaces == 0 || !surfaces.is_multiple_of(EACH) {
                let message = format!("{} numbers; {BEFORE} and {EACH} for each surface are right", numbers.len());
                return Err(VerifyError::Samples { path: path.to_path_buf(), line, message });
            }
            let surface = |of: &[f64]| [[of[0], of[1], of[2]], [of[3], of[4], of[5]]];
            Ok((numbers[0] as u64, numbers[BEFORE..].chunks_exact(EACH).map(surface).collect()))
        });
        Ok(Some(Self { rows: rows.collect::<Result<_, _>>()? }))
    }
}

/// Largest errors of force and moment on the surfaces of a case, over the largest of each, and what they may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceErrors {
    /// Of force and of moment.
    pub found: [f64; 2],
    /// What passes.
    pub allowed: [f64; 2],
}

impl SurfaceErrors {
    /// Compares with the record at the steps that were kept; `allowed` are the errors of force and torque that pass.
    pub(super) fn between(case: &Case, theirs: &Surfaces, ours: &[Sample], allowed: [f64; 2]) -> Self {
        let (mut found, mut scales) = ([0.0_f64; 2], [0.0_f64; 2]);
        for (step, surfaces) in &theirs.rows {
            let Some(sample) = ours.iter().find(|sample| sample.step == *step) else { continue };
            for (number, theirs) in surfaces.iter().enumerate() {
                for part in 0..2 {
                    let error =
                        sample.surfaces.get(number).map_or(f64::INFINITY, |ours| distance(ours[part], theirs[part]));
                    found[part] = if error.is_nan() { f64::INFINITY } else { found[part].max(error) };
                    scales[part] = scales[part].max(length(theirs[part]));
                }
            }
        }
        // A moment that is round-off is measured against force times radius.
        let radius = case.particles.iter().map(|particle| particle.radius).fold(f64::INFINITY, f64::min);
        scales[1] = scales[1].max(scales[0] * radius);
        let share = |part: usize| if scales[part] > 0.0 { found[part] / scales[part] } else { found[part] };
        Self { found: [share(0), share(1)], allowed: [allowed[0], allowed[0].max(allowed[1])] }
    }

    /// Whether both are allowed.
    pub fn passed(&self) -> bool {
        self.found.iter().zip(&self.allowed).all(|(found, allowed)| found <= allowed)
    }
}

impl fmt::Display for SurfaceErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "surfaces {:.1e} {:.1e}", self.found[0], self.found[1])
    }
}
