//! `boundary_rule.csv`: the energy, and force and moment of the particles on each surface, as an independent program has
//! them.

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

/// A step of the record: its number, the energy \[J\] and the surfaces.
type Row = (u64, f64, Vec<OnSurface>);

/// The record of another program.
pub(super) struct Surfaces {
    /// Step by step.
    rows: Vec<Row>,
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
                let message = format!("expected {BEFORE} and {EACH} for each surface, found {} numbers", numbers.len());
                return Err(VerifyError::Samples { path: path.to_path_buf(), line, message });
            }
            let surface = |of: &[f64]| [[of[0], of[1], of[2]], [of[3], of[4], of[5]]];
            Ok((numbers[0] as u64, numbers[BEFORE - 1], numbers[BEFORE..].chunks_exact(EACH).map(surface).collect()))
        });
        Ok(Some(Self { rows: rows.collect::<Result<_, _>>()? }))
    }
}

/// Largest errors of force and moment on the surfaces of a case and of its energy, over the largest of each, and what they
/// may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceErrors {
    /// Of force, of moment, of energy.
    pub found: [f64; 3],
    /// What passes.
    pub allowed: [f64; 3],
}

impl SurfaceErrors {
    /// Compares with the record at the steps that were kept, all of which it must have; `allowed` are the errors that pass of position,
    /// velocity, angular velocity, force and torque.
    pub(super) fn between(case: &Case, theirs: &Surfaces, ours: &[Sample], allowed: [f64; 5]) -> Self {
        let (mut found, mut scales) = ([0.0_f64; 3], [0.0_f64; 3]);
        let mut note = |part: usize, error: f64, size: f64| {
            found[part] = if error.is_nan() { f64::INFINITY } else { found[part].max(error) };
            scales[part] = scales[part].max(size);
        };
        for sample in ours {
            let Some((_, energy, surfaces)) = theirs.rows.iter().find(|(step, ..)| *step == sample.step) else {
                note(0, f64::INFINITY, 0.0);
                continue;
            };
            note(2, (sample.energy - energy).abs(), energy.abs());
            for (number, theirs) in surfaces.iter().enumerate() {
                for part in 0..2 {
                    let ours = sample.surfaces.get(number);
                    let error = ours.map_or(f64::INFINITY, |ours| distance(ours[part], theirs[part]));
                    note(part, error, length(theirs[part]));
                }
            }
        }
        // A moment that is round-off is measured against force times radius.
        let radius = case.particles.iter().map(|particle| particle.radius).fold(f64::INFINITY, f64::min);
        scales[1] = scales[1].max(scales[0] * radius);
        let share = |part: usize| if scales[part] > 0.0 { found[part] / scales[part] } else { found[part] };
        let most = |of: &[f64]| of.iter().copied().fold(0.0, f64::max);
        Self { found: [0, 1, 2].map(share), allowed: [allowed[3], most(&allowed[3..]), most(&allowed)] }
    }

    /// Whether all are allowed.
    pub fn passed(&self) -> bool {
        self.found.iter().zip(&self.allowed).all(|(found, allowed)| found <= allowed)
    }
}

impl fmt::Display for SurfaceErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [force, moment, energy] = self.found;
        write!(formatter, "surfaces {force:.1e} {moment:.1e}, energy {energy:.1e}")
    }
}
