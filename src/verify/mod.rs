//! Reference cases of other engines, replayed: no physics here, a case becomes a [`Scene`] that is stepped.
//!
//! A case is a folder with `case.json` and perhaps `samples.csv`, the other engine's trajectory.

mod build;
mod case;
mod compare;
mod error;
mod law;
mod samples;

pub use compare::{Errors, Report};
pub use error::VerifyError;

use crate::scene::Scene;
use crate::step::Simulation;
use case::Case;
use samples::{Row, Samples};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How cases are replayed.
#[derive(Clone, Debug)]
pub struct Options {
    /// Largest relative error that passes, unless the case itself is more sensitive.
    pub tolerance: f64,
    /// Folder that gets the trajectories, as `<case>.csv`.
    pub write: Option<PathBuf>,
}

impl Default for Options {
    fn default() -> Self {
        Self { tolerance: 1e-9, write: None }
    }
}

/// The case folders among these, in order: each a case itself or a folder of cases.
pub fn find(folders: &[PathBuf]) -> Result<Vec<PathBuf>, VerifyError> {
    let mut found = Vec::new();
    for folder in folders {
        if folder.join("case.json").is_file() {
            found.push(folder.clone());
            continue;
        }
        let mut inside: Vec<PathBuf> = fs::read_dir(folder)
            .map_err(|cause| VerifyError::file(folder, &cause))?
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.join("case.json").is_file())
            .collect();
        inside.sort();
        if inside.is_empty() {
            return Err(VerifyError::NoCase { folder: folder.clone() });
        }
        found.append(&mut inside);
    }
    Ok(found)
}

/// Replays the case in this folder.
///
/// A case that runs and differs is a [`Report`] that has not passed; a case that cannot be read is an error.
pub fn replay(folder: &Path, options: &Options) -> Result<Report, VerifyError> {
    let name = name_of(folder)?;
    let case = Case::read(&folder.join("case.json"))?;
    let scene = build::scene(&case).map_err(|mistake| mistake.at(&folder.join("case.json")))?;
    let theirs = Samples::read(&folder.join("samples.csv"), &case)?;
    let steps = match &theirs {
        Some(samples) => samples.steps(),
        None => (0..=case.steps).step_by(case.sample_every as usize).collect(),
    };
    let run = trajectory(&case, scene, &steps);
    if let Some(out) = &options.write {
        fs::create_dir_all(out).map_err(|cause| VerifyError::file(out, &cause))?;
        samples::write(&out.join(format!("{name}.csv")), &case, &run.rows)?;
    }
    let errors = theirs.map(|theirs| Errors::between(&case, &theirs, &run.rows, options.tolerance));
    Ok(Report { name, errors, stopped: run.stopped })
}

/// The name of a case: that of its folder.
fn name_of(folder: &Path) -> Result<String, VerifyError> {
    let whole = folder.canonicalize().map_err(|cause| VerifyError::file(folder, &cause))?;
    Ok(whole.file_name().map_or_else(|| "case".into(), |name| name.to_string_lossy().into_owned()))
}

/// What a run left.
struct Run {
    /// The particles at each step, in the case's order.
    rows: Vec<(u64, Vec<Row>)>,
    /// Why it stopped before its end.
    stopped: Option<String>,
}

/// Runs the scene and keeps these steps, in ascending order.
fn trajectory(case: &Case, scene: Scene, steps: &[u64]) -> Run {
    let mut rows = Vec::with_capacity(steps.len());
    let mut simulation = match Simulation::new(Arc::new(scene)) {
        Ok(simulation) => simulation,
        Err(cause) => return Run { rows, stopped: Some(cause.to_string()) },
    };
    let mut now = 0;
    for step in steps {
        if *step > now {
            if let Err(cause) = simulation.advance((step - now) as f64 * case.dt) {
                return Run { rows, stopped: Some(cause.to_string()) };
            }
            now = *step;
        }
        rows.push((now, observe(case, &simulation)));
    }
    Run { rows, stopped: None }
}

/// The particles as they are, in the case's order.
fn observe(case: &Case, simulation: &Simulation) -> Vec<Row> {
    let particles = &simulation.state().particles;
    let three = |row: &[f64; 4]| [row[0], row[1], row[2]];
    case.by_id()
        .into_iter()
        .enumerate()
        .map(|(in_scene, in_case)| (in_case, particles.slot[in_scene] as usize))
        .map(|(in_case, slot)| {
            let row = [
                three(&particles.position[slot]),
                three(&particles.velocity[slot]),
                three(&particles.angular_velocity[slot]),
                three(&particles.force[slot]),
                three(&particles.torque[slot]),
            ];
            (in_case, row)
        })
        .fold(vec![Row::default(); case.particles.len()], |mut rows, (in_case, row)| {
            rows[in_case] = row;
            rows
        })
}
