//! The folder of a run's results: which files stand in it, and how they are begun, taken up and added to.

use super::collection::Collection;
use super::error::{OutputError, ResumeError};
use super::files::{Durability, UNFINISHED, sync, write_checkpoint, write_whole};
use super::schedule::Schedule;
use super::table::{Found, Table};
use super::{BREAKAGE, CHECKPOINT, HISTORY, SUMMARY, frames, vtk::Cloud};
use crate::bond::breakage::Cause;
use crate::interface::Value;
use crate::scene::Scene;
use crate::state::{Break, Particles, State};
use crate::step::{BondRecord, ContactRecord};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::SyncSender;

/// Kinds of frames: beginning of the names of their files.
const FRAMES: [&str; 3] = ["particles", "contacts", "bonds"];

/// Columns of `breakage.csv`.
const BREAKAGE_COLUMNS: [&str; 5] = ["time", "id1", "id2", "cause", "energy"];

/// One thing to write.
pub(super) enum Job {
    /// A row of the history.
    Row {
        /// Time \[s\].
        time: f64,
        /// The outputs.
        values: Vec<Value>,
    },
    /// Bonds that broke.
    Breaks(Vec<Break>),
    /// A frame.
    Frame {
        /// Time \[s\].
        time: f64,
        /// The particles.
        particles: Box<Particles>,
        /// The contacts, if the scene asks for them.
        contacts: Option<Vec<ContactRecord>>,
        /// The bonds, if the scene has any.
        bonds: Option<Vec<BondRecord>>,
    },
    /// A checkpoint.
    Checkpoint(Box<State>),
    /// Nothing but to tell that it is its turn.
    Tell(SyncSender<()>),
}

/// Where a run comes from, as far as its files are concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// At time 0: what an earlier run left is removed.
    Anew,
    /// At a later time, in the folder of the run that is continued.
    Here,
    /// At a later time, from a checkpoint of another folder.
    Elsewhere,
}

/// A frame's `.pvd` and what has been added.
struct Series {
    /// Beginning of the file names.
    name: &'static str,
    /// The `.pvd`.
    collection: Collection,
    /// Number of the next frame.
    next: usize,
}

/// The open folder.
pub(super) struct Folder {
    /// What is simulated.
    scene: Arc<Scene>,
    /// Where it is.
    path: PathBuf,
    /// `history.csv`.
    history: Table,
    /// `breakage.csv`, if the scene has bonds.
    breakage: Option<Table>,
    /// The kinds of frames that the scene asks for.
    series: Vec<Series>,
    /// Frames that may not be on the disk yet.
    unsynced: Vec<PathBuf>,
}

/// What a continued run keeps of the files in a folder; looking changes nothing.
pub(super) struct Kept {
    /// The rows of the history, or none where a new file is begun.
    history: Option<Found>,
    /// The rows of the breakage, or none where a new file is begun or there are no bonds.
    breakage: Option<Found>,
    /// Times of the frames \[s\].
    frames: Vec<f64>,
}

/// What a continued run begins with, as far as its files are concerned.
#[derive(Clone, Copy)]
pub(super) struct Beginning<'a> {
    /// What is simulated.
    pub scene: &'a Scene,
    /// Columns of the history.
    pub names: &'a [String],
    /// When what is written.
    pub schedule: &'a Schedule,
    /// Communication point where it begins \[s\].
    pub time: f64,
    /// The state there.
    pub state: &'a State,
    /// Where it comes from.
    pub origin: Origin,
}

impl Kept {
    /// Nothing is kept.
    const NOTHING: Self = Self { history: None, breakage: None, frames: Vec::new() };

    /// Looks at the files in a folder.
    pub(super) fn look(path: &Path, beginning: &Beginning<'_>) -> Result<Self, ResumeError> {
        let Beginning { scene, names, schedule, time, state, origin } = *beginning;
        let history = path.join(HISTORY);
        let keeps = match origin {
            Origin::Anew => false,
            Origin::Here => true,
            Origin::Elsewhere => history.exists(),
        };
        if !keeps {
            return Ok(Self::NOTHING);
        }
        let history = Found::rows(&history, names, schedule.rows_until(time), time)?;
        let breakage = if scene.bonds.is_empty() {
            None
        } else {
            let broken = state.bonds.iter().map(|list| list.broken).sum::<u64>();
            let columns = BREAKAGE_COLUMNS.map(String::from);
            Some(Found::rows(&path.join(BREAKAGE), &columns, broken as usize, time)?)
        };
        Ok(Self { history: Some(history), breakage, frames: schedule.frames_until(time) })
    }
}

impl Folder {
    /// Makes the folder ready for the first row.
    pub(super) fn open(path: &Path, scene: Arc<Scene>, names: &[String], kept: &Kept) -> Result<Self, OutputError> {
        fs::create_dir_all(path).map_err(OutputError::at(path))?;
        remove_results(path, kept)?;
        let table = |name: &str, names: &[String], found: &Option<Found>| match found {
            Some(found) => Table::reopen(&path.join(name), found),
            None => Table::create(&path.join(name), names),
        };
        let history = table(HISTORY, names, &kept.history)?;
        let bonded = !scene.bonds.is_empty();
        let breakage =
            bonded.then(|| table(BREAKAGE, &BREAKAGE_COLUMNS.map(String::from), &kept.breakage)).transpose()?;
        let wanted = [true, scene.output.contacts, bonded];
        let series = (FRAMES.into_iter().zip(wanted))
            .filter(|(_, wanted)| *wanted && scene.output.frame_interval.is_some())
            .map(|(name, _)| Series::open(path, name, &kept.frames))
            .collect::<Result<_, _>>()?;
        Ok(Self { scene, path: path.to_owned(), history, breakage, series, unsynced: Vec::new() })
    }

    /// Where it is.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Does one job.
    pub(super) fn write(&mut self, job: Job) -> Result<(), OutputError> {
        match job {
            Job::Row { time, values } => {
                let row: Vec<_> =
                    std::iter::once(format!("{time:?}")).chain(values.iter().map(ToString::to_string)).collect();
                self.history.add(&row)
            }
            Job::Breaks(breaks) => self.breaks(&breaks),
            Job::Frame { time, particles, contacts, bonds } => {
                let clouds = [
                    Some(frames::particles(&self.scene, &particles)),
                    contacts.map(|contacts| frames::contacts(&self.scene, &contacts)),
                    bonds.map(|bonds| frames::bonds(&self.scene, &particles, &bonds)),
                ];
                self.frame(time, clouds.into_iter().flatten())
            }
            Job::Checkpoint(state) => self.checkpoint(&state),
            Job::Tell(done) => {
                // Whoever does not wait any more need not know.
                let _ = done.send(());
                Ok(())
            }
        }
    }

    /// Writes a checkpoint. Everything written before it is on the disk when it has its name.
    pub(super) fn checkpoint(&mut self, state: &State) -> Result<(), OutputError> {
        self.history.sync()?;
        self.breakage.as_ref().map_or(Ok(()), Table::sync)?;
        for path in self.unsynced.drain(..) {
            sync(&path)?;
        }
        write_checkpoint(&self.path.join(CHECKPOINT), state, self.scene.fingerprint)
    }

    /// Writes a row for each bond that broke.
    fn breaks(&mut self, breaks: &[Break]) -> Result<(), OutputError> {
        let Some(table) = &mut self.breakage else { return Ok(()) };
        let scene = &self.scene;
        let id = |index: u32| self.scene.particles.get(index as usize).map_or(index, |particle| particle.id.0);
        for broken in breaks {
            let cause = Cause::from_code(broken.cause).map_or("unknown", Cause::name);
            table.add(&[
                format!("{:?}", broken.time),
                id(broken.first).to_string(),
                broken.second.map_or_else(|| plane(scene, broken.law).to_owned(), |second| id(second).to_string()),
                cause.to_owned(),
                format!("{:?}", broken.energy),
            ])?;
        }
        Ok(())
    }

    /// Writes the files of a frame, then their entries.
    fn frame(&mut self, time: f64, clouds: impl Iterator<Item = Cloud>) -> Result<(), OutputError> {
        for (series, cloud) in self.series.iter_mut().zip(clouds) {
            self.unsynced.push(series.add(&self.path, time, cloud)?);
        }
        Ok(())
    }
}

impl Series {
    /// Takes up the frames of these times \[s\].
    fn open(path: &Path, name: &'static str, times: &[f64]) -> Result<Self, OutputError> {
        let frames: Vec<_> = (0..).zip(times).map(|(number, time)| (*time, frame_name(name, number))).collect();
        let collection = Collection::create(&path.join(format!("{name}.pvd")), &frames)?;
        Ok(Self { name, collection, next: times.len() })
    }

    /// Writes the next frame.
    fn add(&mut self, folder: &Path, time: f64, cloud: Cloud) -> Result<PathBuf, OutputError> {
        let name = frame_name(self.name, self.next);
        let path = folder.join(&name);
        let bytes = cloud.encode().map_err(|source| OutputError::Encode { path: path.clone(), source })?;
        write_whole(&path, &bytes, Durability::Process)?;
        self.collection.add(time, &name)?;
        self.next += 1;
        Ok(path)
    }
}

/// File name of a frame.
fn frame_name(kind: &str, number: usize) -> String {
    format!("{kind}_{number:06}.vtu")
}

/// Removes what an earlier run left in the folder and this one does not keep, and nothing else. The checkpoint
/// stays until the next one takes its place: this run may have begun from it.
fn remove_results(path: &Path, kept: &Kept) -> Result<(), OutputError> {
    for entry in fs::read_dir(path).map_err(OutputError::at(path))? {
        let entry = entry.map_err(OutputError::at(path))?;
        let name = entry.file_name();
        let Some(name) = name.to_str() else { continue };
        if is_stale(name, kept) {
            fs::remove_file(entry.path()).map_err(OutputError::at(&entry.path()))?;
        }
    }
    Ok(())
}

/// Whether a file is of an earlier run and not kept by this one.
fn is_stale(name: &str, kept: &Kept) -> bool {
    if let Some(name) = name.strip_suffix(&format!(".{UNFINISHED}")) {
        return is_stale(name, &Kept::NOTHING);
    }
    let number = |kind: &str| -> Option<usize> {
        let digits = name.strip_prefix(kind)?.strip_prefix('_')?.strip_suffix(".vtu")?;
        (digits.len() >= 6 && digits.bytes().all(|byte| byte.is_ascii_digit())).then(|| digits.parse().ok())?
    };
    let frame = FRAMES.iter().find_map(|kind| number(kind));
    match name {
        HISTORY => kept.history.is_none(),
        BREAKAGE => kept.breakage.is_none(),
        SUMMARY => true,
        _ => {
            frame.is_some_and(|number| number >= kept.frames.len())
                || FRAMES.iter().any(|kind| name == format!("{kind}.pvd"))
        }
    }
}

/// Name of the plane to which a bond law bonds.
fn plane(scene: &Scene, law: u32) -> &str {
    let plane = scene.bonds.get(law as usize).and_then(|bond| bond.plane);
    plane.and_then(|plane| scene.boundaries.get(plane.index())).map_or("", |plane| &plane.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn removes_what_an_earlier_run_left_and_nothing_else() {
        let nothing = Kept::NOTHING;
        for name in
            ["history.csv", "particles_000003.vtu", "contacts_1234567.vtu", "particles.pvd", "summary.json.part"]
        {
            assert!(is_stale(name, &nothing), "{name}");
        }
        for name in
            ["scene.toml", "particles_3.vtu", "particles_000003.vtk", "my_history.csv", "settled.cograin", "x.part"]
        {
            assert!(!is_stale(name, &nothing), "{name}");
        }
    }

    #[test]
    fn a_continued_run_keeps_its_frames_and_rows() {
        let kept = Kept { history: Some(Found::default()), breakage: None, frames: vec![0.0, 0.1] };
        assert!(!is_stale("history.csv", &kept) && !is_stale("particles_000001.vtu", &kept));
        assert!(is_stale("particles_000002.vtu", &kept));
    }
}
