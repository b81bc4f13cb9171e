//! Frames of a simulation whose communication points come from outside, as those of a unit do.
//!
//! A frame is written when the outside goes on from its point, not when it comes there: a master that repeats a
//! communication step until it agrees with its other side writes one frame of it, that of the step which counts. It is
//! written at once and by no other thread: the reason why there is no frame belongs to the call that should have made it,
//! and a child made by `fork` has no other threads.

use super::beginning::{held, lock};
use super::jobs::frame;
use crate::engine::simulation::Simulation;
use crate::output::results::frame_files::{Frame, FrameFiles};
use crate::output::results::lock::FolderLock;
use crate::output::results::schedule::FrameSchedule;
use crate::output::results::{Failure, OutputError, Refusal};
use std::path::{Path, PathBuf};

/// Two times closer than this part of them are one.
const SAME: f64 = 1e-9;

/// Writes the frames of one simulation into one folder.
pub struct FrameWriter {
    /// The folder.
    folder: PathBuf,
    /// Its files.
    files: FrameFiles,
    /// The frames that are there.
    written: Vec<Frame>,
    /// Whether the last one is there because the simulation ended.
    ended: bool,
    /// When they are due.
    due: FrameSchedule,
    /// The time at which the experiment starts \[s\].
    start: f64,
    /// The lock that keeps others out of the folder.
    lock: FolderLock,
}

impl FrameWriter {
    /// Opens a folder and writes the frame of the present time there: all of it or nothing. `start` is the time at which
    /// the experiment starts, `time` the present one \[s\]. Refused is a folder that another process or instance writes
    /// to, and one that holds results.
    pub fn open(folder: &Path, simulation: &Simulation, start: f64, time: f64) -> Result<Self, Failure> {
        let lock = lock(folder)?;
        if let Some(held) = held(folder)? {
            return Err(Refusal::Taken { folder: folder.to_owned(), held }.into());
        }
        let files = FrameFiles::begin(folder, simulation.scene())?;
        let due = FrameSchedule::of(simulation.scene());
        let (folder, written) = (folder.to_owned(), Vec::new());
        let mut writer = Self { folder, files, written, ended: false, due, start, lock };
        match writer.pass(simulation, time) {
            Ok(()) => Ok(writer),
            Err(error) => {
                // The first error is the one to tell.
                let _ = writer.undo();
                Err(error.into())
            }
        }
    }

    /// Writes the frame of the present time \[s\], from which the simulation is to go on, if one is due.
    pub fn pass(&mut self, simulation: &Simulation, time: f64) -> Result<(), OutputError> {
        match self.due.due(time - self.start, self.last()) {
            Some(frame) => self.write(simulation, frame),
            None => Ok(()),
        }
    }

    /// Writes the frame of the present time \[s\], at which the simulation ends, due or not.
    pub fn end(&mut self, simulation: &Simulation, time: f64) -> Result<(), OutputError> {
        self.pass(simulation, time)?;
        let time = time - self.start;
        let Some(last) = self.last().filter(|last| time > last.time && !is_same(time, last.time)) else {
            return Ok(());
        };
        self.ended = true;
        self.write(simulation, Frame { number: last.number + 1, time })
    }

    /// Removes the frames of this time \[s\] and later ones: the simulation goes back there, and may go another way.
    pub fn go_back(&mut self, time: f64) -> Result<(), OutputError> {
        let stays = |frame: &Frame| frame.time < time - self.start && !is_same(frame.time, time - self.start);
        let mut count = self.written.partition_point(stays);
        if std::mem::take(&mut self.ended) {
            count = count.min(self.written.len() - 1);
        }
        if count == self.written.len() {
            return Ok(());
        }
        self.must_be_own()?;
        let others = self.written.split_off(count);
        self.files.keep(&self.timed(), &others)
    }

    /// Removes everything that was written: the experiment was not begun after all.
    pub fn undo(self) -> Result<(), OutputError> {
        self.must_be_own()?;
        self.files.remove(&self.written)
    }

    /// The last frame; its time is since the start.
    fn last(&self) -> Option<Frame> {
        self.written.last().copied()
    }

    /// The frames with the times of the outside.
    fn timed(&self) -> Vec<Frame> {
        self.written.iter().map(|frame| Frame { time: self.start + frame.time, ..*frame }).collect()
    }

    /// Writes a frame, whose time is since the start.
    fn write(&mut self, simulation: &Simulation, new: Frame) -> Result<(), OutputError> {
        self.must_be_own()?;
        let timed = Frame { time: self.start + new.time, ..new };
        // Also what is there of a frame that is not whole can be undone.
        self.written.push(new);
        self.files.write(simulation.scene(), timed, frame(simulation, timed.time)).map(drop)
    }

    /// Refuses to write in a child of the process that opened the folder: two would write into one file.
    fn must_be_own(&self) -> Result<(), OutputError> {
        if self.lock.is_own() { Ok(()) } else { Err(OutputError::Forked { folder: self.folder.clone() }) }
    }
}

/// Whether two times are one \[s\].
fn is_same(one: f64, other: f64) -> bool {
    (one - other).abs() <= SAME * one.abs().max(other.abs())
}
