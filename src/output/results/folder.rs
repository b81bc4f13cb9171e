//! The folder of a run's results: which files stand in it, and how they are begun, taken up and added to.

use super::error::{OutputError, ResumeError};
use super::files::{sync, write_run_checkpoint};
use super::frame_files::{Frame, FrameFiles};
use super::job::{Job, cells};
use super::replacement::own_results;
use super::schedule::Schedule;
use super::table::{Found, Table};
use super::{
    BREAKAGE, CHECKPOINT, FRAMES, HISTOGRAMS, HISTORY, IMPACTS, SUMMARY, UNFINISHED, frame_name, frame_number, impacts,
};
use crate::engine::state::{Break, State};
use crate::scene::Scene;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Columns of `breakage.csv`.
const BREAKAGE_COLUMNS: [&str; 12] = [
    "time",
    "id1",
    "id2",
    "cause",
    "energy",
    "position.x",
    "position.y",
    "position.z",
    "direction.x",
    "direction.y",
    "direction.z",
    "area",
];

/// The open folder.
pub(crate) struct Folder {
    /// What is simulated.
    scene: Arc<Scene>,
    /// Its file name.
    scene_name: String,
    /// Digest of the table of inputs, if the run has one.
    inputs: Option<u64>,
    /// Where it is.
    path: PathBuf,
    /// `history.csv`.
    history: Table,
    /// `breakage.csv`, if the scene has bonds.
    breakage: Option<Table>,
    /// `impacts.csv`, if the scene asks for each impact.
    impacts: Option<Table>,
    /// The frames, if the scene asks for them.
    frames: Option<FrameFiles>,
    /// Number of the next frame.
    next_frame: usize,
    /// Frames that may not be on the disk yet.
    unsynced: Vec<PathBuf>,
}

/// What a run keeps of the files in its folder; looking changes nothing.
#[derive(Default)]
pub(crate) struct KeptFiles {
    /// The rows of the history, or none where a new file is begun.
    history: Option<Found>,
    /// The rows of the breakage, or none where a new file is begun or there are no bonds.
    breakage: Option<Found>,
    /// The rows of the impacts, or none where a new file is begun or nobody asks for them.
    impacts: Option<Found>,
    /// The frames that are there.
    frames: Vec<Frame>,
    /// Number of the next frame.
    next_frame: usize,
}

/// Where a run takes up its files.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    /// Columns of the history.
    pub names: &'a [String],
    /// When what is written.
    pub schedule: &'a Schedule,
    /// The communication point \[s\].
    pub time: f64,
    /// The state there.
    pub state: &'a State,
    /// Whether the scene asks for each impact.
    pub asks_for_impacts: bool,
}

impl KeptFiles {
    /// Nothing is kept, and this is the number of the first frame.
    pub(crate) fn nothing(next_frame: usize) -> Self {
        Self { next_frame, ..Self::default() }
    }

    /// Looks at the files of a run. A run that began at time 0 has all rows; one that began later has those from there on.
    pub(crate) fn look(path: &Path, place: &Place<'_>) -> Result<Self, ResumeError> {
        let Place { names, schedule, time, state, asks_for_impacts } = *place;
        let file = path.join(HISTORY);
        let mut history = Found::until(&file, names, time)?;
        let expected = history.first.map_or(0, |first| 1 + schedule.rows_until(time) - schedule.rows_until(first));
        // The last row of a run to an earlier end is none of a longer one, unless the interval meets it.
        if history.rows == expected + 1 && !schedule.has_row(time) {
            history = Found::until(&file, names, time.next_down())?;
        }
        if history.rows != expected {
            return Err(ResumeError::Rows { path: file, found: history.rows, expected, time });
        }
        let breakage = if state.bonds.is_empty() {
            None
        } else {
            let (file, columns) = (path.join(BREAKAGE), BREAKAGE_COLUMNS.map(String::from));
            let found = Found::until(&file, &columns, state.clock.time)?;
            let expected = state.bonds.iter().map(|list| list.broken).sum::<u64>();
            let whole = history.first == Some(0.0);
            if found.rows > expected || (whole && found.rows < expected) {
                return Err(ResumeError::Rows { path: file, found: found.rows, expected, time });
            }
            Some(found)
        };
        let impacts = match state.traces.as_ref().filter(|_| asks_for_impacts) {
            None => None,
            Some(traces) => {
                let (file, columns) = (path.join(IMPACTS), impacts::COLUMNS.map(String::from));
                let (found, expected) = (Found::until(&file, &columns, state.clock.time)?, traces.ended());
                if found.rows > expected || (history.first == Some(0.0) && found.rows < expected) {
                    return Err(ResumeError::Rows { path: file, found: found.rows, expected, time });
                }
                Some(found)
            }
        };
        let times = schedule.frames_until(time);
        let next_frame = times.len();
        let there = |frame: &Frame| path.join(frame_name(FRAMES[0], frame.number)).exists();
        let frames = (0..).zip(times).map(|(number, time)| Frame { number, time }).filter(there).collect();
        Ok(Self { history: Some(history), breakage, impacts, frames, next_frame })
    }
}

impl Folder {
    /// Makes the folder ready for the next row, keeping what is kept and nothing else.
    pub(crate) fn open(
        path: &Path,
        (scene, scene_name, inputs): (Arc<Scene>, &str, Option<u64>),
        names: &[String],
        kept: &KeptFiles,
    ) -> Result<Self, OutputError> {
        for stale in own_results(path)?.iter().filter(|file| is_stale(file, kept)) {
            fs::remove_file(stale).map_err(OutputError::at(stale))?;
        }
        let table = |name: &str, names: &[String], found: &Option<Found>| match found {
            Some(found) => Table::reopen(&path.join(name), found),
            None => Table::create(&path.join(name), names),
        };
        let history = table(HISTORY, names, &kept.history)?;
        let bonded = !scene.bonds.is_empty();
        let breakage =
            bonded.then(|| table(BREAKAGE, &BREAKAGE_COLUMNS.map(String::from), &kept.breakage)).transpose()?;
        let tells = scene.output.impacts.is_some_and(|impacts| impacts.events);
        let impacts = tells.then(|| table(IMPACTS, &impacts::COLUMNS.map(String::from), &kept.impacts)).transpose()?;
        let asked = scene.output.frame_interval.is_some();
        let frames = asked.then(|| FrameFiles::open(path, &scene, &kept.frames)).transpose()?;
        Ok(Self {
            scene,
            scene_name: scene_name.to_owned(),
            inputs,
            path: path.to_owned(),
            history,
            breakage,
            impacts,
            frames,
            next_frame: kept.next_frame,
            unsynced: Vec::new(),
        })
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Does one job.
    pub(crate) fn write(&mut self, job: Job) -> Result<(), OutputError> {
        match job {
            Job::Row { time, values } => self.history.add(&cells(time, &values)),
            Job::Breaks(breaks) => self.breaks(&breaks),
            Job::Impacts(found) => {
                let Self { impacts: table, scene, .. } = self;
                table.as_mut().map_or(Ok(()), |table| impacts::add(table, scene, &found))
            }
            Job::Frame { time, .. } => self.frame(time, job),
            Job::Checkpoint(state) => self.checkpoint(&state),
            Job::Tell(done) => {
                // Whoever does not wait any more need not know.
                let _ = done.send(());
                Ok(())
            }
        }
    }

    /// Writes a checkpoint. Everything written before it is on the disk when it has its name.
    pub(crate) fn checkpoint(&mut self, state: &State) -> Result<(), OutputError> {
        self.history.sync()?;
        self.breakage.as_ref().map_or(Ok(()), Table::sync)?;
        self.impacts.as_ref().map_or(Ok(()), Table::sync)?;
        for path in self.unsynced.drain(..) {
            sync(&path)?;
        }
        write_run_checkpoint(&self.path.join(CHECKPOINT), state, (&self.scene, &self.scene_name), self.inputs)
    }

    /// Writes a row for each bond that broke.
    fn breaks(&mut self, breaks: &[Break]) -> Result<(), OutputError> {
        let Some(table) = &mut self.breakage else { return Ok(()) };
        let scene = &self.scene;
        let laws: Vec<_> = (0..scene.bonds.len()).map(|bond| scene.bond_law(bond)).collect();
        let id = |index: u32| scene.particles.get(index as usize).map_or(index, |particle| particle.id.0);
        for broken in breaks {
            let law = laws.get(broken.law as usize);
            let cause = law.and_then(|law| law.cause_name(broken.cause)).unwrap_or("unknown");
            let mut row = vec![
                format!("{:?}", broken.time),
                id(broken.first).to_string(),
                broken.second.map_or_else(|| plane(scene, broken.law).to_owned(), |second| id(second).to_string()),
                cause.to_owned(),
                format!("{:?}", broken.energy),
            ];
            let place = broken.position.into_iter().chain(broken.direction).chain([broken.area]);
            row.extend(place.map(|number| format!("{number:?}")));
            table.add(&row)?;
        }
        Ok(())
    }

    /// Writes the next frame.
    fn frame(&mut self, time: f64, job: Job) -> Result<(), OutputError> {
        let Some(frames) = &mut self.frames else { return Ok(()) };
        let frame = Frame { number: self.next_frame, time };
        self.unsynced.extend(frames.write(&self.scene, frame, job)?);
        self.next_frame += 1;
        Ok(())
    }
}

/// Whether a result is not kept. The checkpoint stays until the next one takes its place, a `.pvd` until it is written anew.
fn is_stale(file: &Path, kept: &KeptFiles) -> bool {
    let name = file.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    if name.ends_with(&format!(".{UNFINISHED}")) {
        return true;
    }
    match name {
        HISTORY => kept.history.is_none(),
        BREAKAGE => kept.breakage.is_none(),
        IMPACTS => kept.impacts.is_none(),
        SUMMARY | HISTOGRAMS => true,
        _ => frame_number(name).is_some_and(|number| number >= kept.next_frame),
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
    fn a_continued_run_keeps_its_frames_and_rows() {
        let kept = KeptFiles { history: Some(Found::default()), next_frame: 2, ..KeptFiles::default() };
        let is_stale = |name: &str| is_stale(Path::new(name), &kept);
        assert!(!is_stale("history.csv") && !is_stale("particles_000001.vtu") && !is_stale("particles.pvd"));
        assert!(is_stale("particles_000002.vtu") && is_stale("summary.json") && is_stale("history.csv.part"));
    }
}
