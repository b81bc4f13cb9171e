//! Reference cases of other engines, replayed: no physics here, a case becomes a [`Scene`](cograin::scene::Scene) that is stepped.
//!
//! A case is a folder with `case.json` and perhaps `samples.csv`, the other engine's trajectory, and `bonds.csv`, its bonds.
//!
//! Cases of contacts run from their start. So do those of bonds, if asked; otherwise they run from each sample to the
//! next, since the other engine's bonds let rounding grow.

mod bond;
mod build;
mod case;
mod compare;
mod defaults;
mod error;
mod heat;
mod history;
mod law;
mod linked;
mod samples;
mod surfaces;
mod trajectory;

pub use compare::{Errors, Report};
pub use error::VerifyError;
pub use heat::HeatErrors;
pub use linked::LinkErrors;
pub use surfaces::SurfaceErrors;

use case::Case;
use cograin::bond::keys::FormulationChoice;
use compare::Measure;
use heat::Heats;
use history::History;
use samples::Samples;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use surfaces::Surfaces;

/// How cases are replayed.
#[derive(Clone, Debug)]
pub struct Options {
    /// Largest relative error that passes, unless the case itself is more sensitive.
    pub tolerance: f64,
    /// Folder that gets the trajectories of runs from the start, as `<case>.csv`.
    pub write: Option<PathBuf>,
    /// Whether cases of bonds run from their start alone, not from each sample to the next.
    pub free: bool,
    /// The formulation of bonds; every other than `engine_exact` runs from the start, as samples hold no orientations.
    pub formulation: FormulationChoice,
}

impl Default for Options {
    fn default() -> Self {
        Self { tolerance: 1e-9, write: None, free: false, formulation: FormulationChoice::EngineExact }
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
    let scene =
        build::scene(&case, folder, options.formulation).map_err(|mistake| mistake.at(&folder.join("case.json")))?;
    let scene = Arc::new(scene);
    let theirs = Samples::read(&folder.join(samples_of(folder)), &case)?;
    let heats = Heats::read(&folder.join("heat.csv"), &case)?;
    let history = History::read(&folder.join("bonds.csv"), &case)?;
    let in_windows = !options.free && options.formulation == FormulationChoice::EngineExact && case.walls.is_empty();
    let windows = match (&theirs, &history) {
        (Some(samples), Some(history)) if in_windows => Some(trajectory::windows(&case, &scene, samples, history)),
        _ => None,
    };
    let free = (windows.is_none() || options.write.is_some()).then(|| {
        let steps = match (&theirs, &heats) {
            (Some(samples), _) => samples.steps(),
            (None, Some(heats)) => heats.rows.keys().copied().collect(),
            (None, None) => (0..=case.steps).step_by(case.sample_every as usize).collect(),
        };
        trajectory::free(&case, &scene, &steps)
    });
    if let (Some(out), Some(run)) = (&options.write, &free) {
        fs::create_dir_all(out).map_err(|cause| VerifyError::file(out, &cause))?;
        samples::write(&out.join(format!("{name}.csv")), &case, &run.samples)?;
    }
    let measure = Measure::of(&case, options.tolerance, windows.is_some());
    let run = windows.or(free).unwrap_or_default();
    let errors = theirs.as_ref().map(|theirs| Errors::between(&case, theirs, &run.samples, &measure));
    let links = theirs.as_ref().zip(history.as_ref());
    let links = links.map(|(theirs, history)| LinkErrors::between(&case, theirs, history, &run.samples, &measure));
    let surfaces = Surfaces::read(&folder.join("boundary_rule.csv"))?
        .map(|theirs| SurfaceErrors::between(&case, &theirs, &run.samples, measure.allowed));
    let heat = heats.map(|theirs| HeatErrors::between(&theirs, &run.samples));
    Ok(Report { name, errors, links, surfaces, heat, stopped: run.stopped })
}

/// The file that a case is compared with: where the other engine is wrong, an independent program's.
fn samples_of(folder: &Path) -> &'static str {
    if folder.join("samples_rule.csv").is_file() { "samples_rule.csv" } else { "samples.csv" }
}

/// The name of a case: that of its folder.
fn name_of(folder: &Path) -> Result<String, VerifyError> {
    let whole = folder.canonicalize().map_err(|cause| VerifyError::file(folder, &cause))?;
    Ok(whole.file_name().map_or_else(|| "case".into(), |name| name.to_string_lossy().into_owned()))
}
