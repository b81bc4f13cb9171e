//! How far the bonds of two runs are apart.

use super::case::Case;
use super::compare::{Measure, distance, length, scales as scales_of_particles};
use super::history::{History, PairRow};
use super::samples::Samples;
use super::trajectory::Sample;
use cograin::simulation::BondRecord;
use std::fmt;

/// The quantities compared, in order: axial distance, shear, torsion, bending.
const QUANTITIES: usize = 4;

/// Below this share of the pair's force a shear is round-off; likewise torsion and bending, of the particles' torque.
const ROUND_OFF: f64 = 1e-10;

/// Largest relative errors of bonds: of axial distance, shear, torsion, bending. Displays as columns of a report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkErrors {
    /// Largest |ours − theirs| over samples and bonds, over the largest magnitude of theirs.
    pub found: [f64; QUANTITIES],
    /// What passes.
    pub allowed: f64,
    /// Whether the same bonds live at every sample.
    pub same: bool,
}

/// Axial distance in a vector, shear, torsion, bending.
type Quantities = [[f64; 3]; QUANTITIES];

/// What a stored pair remembers.
fn theirs_of(pair: &PairRow) -> Quantities {
    [[pair.rest, 0.0, 0.0], pair.shear, pair.torsion, pair.bending]
}

/// What a bond of ours carries; torsion along its axis from j to i.
fn ours_of(bond: &BondRecord) -> Quantities {
    let carried = &bond.carried;
    [[carried.rest, 0.0, 0.0], carried.shear, carried.axis.map(|part| carried.torsion * part), carried.bending]
}

impl LinkErrors {
    /// Compares with the stored bonds; a bond that is only in one of the runs counts in `same` alone.
    pub(super) fn between(
        case: &Case,
        samples: &Samples,
        history: &History,
        ours: &[Sample],
        measure: &Measure,
    ) -> Self {
        let scales = scales(case, samples, history);
        let (mut found, mut same) = ([0.0_f64; QUANTITIES], true);
        for (at, (step, _)) in samples.rows.iter().enumerate().filter(|(_, (step, _))| *step <= measure.until) {
            let ours = ours.get(at).map_or(&[][..], |sample| &sample.bonds);
            let living = history.at(*step).iter().filter(|pair| pair.bonded);
            same &= living.clone().count() == ours.len();
            for pair in living {
                let Some(bond) = ours.iter().find(|bond| bond.joins(pair.bodies)) else {
                    same = false;
                    continue;
                };
                let (ours, theirs) = (ours_of(bond), theirs_of(pair));
                for quantity in 0..QUANTITIES {
                    let error = distance(ours[quantity], theirs[quantity]) / scales[quantity];
                    found[quantity] = if error.is_nan() { f64::INFINITY } else { found[quantity].max(error) };
                }
            }
        }
        Self { found, allowed: measure.allowed_of_links, same }
    }

    /// Whether the same bonds live and all errors are allowed.
    pub fn passed(&self) -> bool {
        self.same && self.found.iter().all(|found| *found <= self.allowed)
    }
}

impl fmt::Display for LinkErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for found in self.found {
            write!(formatter, "{found:>9.1e} ")?;
        }
        write!(formatter, "{}", if self.same { "same" } else { "DIFFER" })
    }
}

/// Largest magnitude of each quantity over all samples. A shear that is round-off is measured against the largest force
/// of a pair; torsion and bending that are, against the torque of the particles, which is force times radius where it
/// is round-off itself.
fn scales(case: &Case, samples: &Samples, history: &History) -> [f64; QUANTITIES] {
    let (mut scales, mut force) = ([0.0_f64; QUANTITIES], 0.0_f64);
    for pair in history.all() {
        force = force.max(length(pair.force));
        for (scale, part) in scales.iter_mut().zip(theirs_of(pair)) {
            *scale = scale.max(length(part));
        }
    }
    let [.., torque] = scales_of_particles(case, samples);
    for (scale, other) in scales.iter_mut().zip([force, force, torque, torque]) {
        if *scale < ROUND_OFF * other {
            *scale = other;
        }
        if *scale == 0.0 {
            *scale = 1.0;
        }
    }
    scales
}
