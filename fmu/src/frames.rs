//! What an instance writes beside its work: frames, in the folder that the parameter `run.frames` names.
//!
//! Frames are results and no part of the state. They go where this instance was told to write them, whatever state it is
//! given; those of a course that a restored state takes back are removed. Where they cannot be written, the call that
//! found out warns and the instance goes on without them: a picture is not worth a coupled computation.

use cograin::interface::{FRAMES, Interface};
use cograin::results::{Failure, OutputError};
use cograin::run::FrameWriter;
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::ffi::{CStr, CString};
use std::path::{Path, PathBuf};

/// The frames of an instance and the texts that it was given.
pub(crate) struct Frames {
    /// The texts, by their places among the variables.
    texts: BTreeMap<usize, CString>,
    /// Place of the one that names the folder.
    place: Option<usize>,
    /// The open folder.
    writer: Option<FrameWriter>,
    /// The host's time that was reached last, as the host says it \[s\]; not a number before the start.
    time: f64,
    /// What the present call left undone.
    warning: Option<String>,
}

impl Frames {
    /// Before anything was set.
    pub(crate) fn of(interface: &Interface) -> Self {
        let texts =
            interface.variables().iter().enumerate().filter_map(|(index, variable)| {
                Some((index, CString::new(variable.start_text()?).unwrap_or_default()))
            });
        Self { texts: texts.collect(), place: interface.find(FRAMES), writer: None, time: f64::NAN, warning: None }
    }

    /// The text with a place among the variables.
    pub(crate) fn text(&self, index: usize) -> &CStr {
        self.texts.get(&index).map_or(c"", |text| text)
    }

    /// Sets a text.
    pub(crate) fn set_text(&mut self, index: usize, text: CString) {
        self.texts.insert(index, text);
    }

    /// The folder, if one is named. A path that the host's present folder completes stays what it is now.
    fn folder(&self) -> Option<PathBuf> {
        let named = self.place.map_or(c"", |place| self.text(place)).to_str().unwrap_or_default();
        let path = Path::new(named);
        (!named.is_empty()).then(|| std::path::absolute(path).unwrap_or_else(|_| path.to_owned()))
    }

    /// Opens the folder that is named, if one is, and writes the first frame. `start` is the host's time at which the
    /// experiment starts, `time` the present one \[s\].
    pub(crate) fn begin(&mut self, simulation: &Simulation, start: f64, time: f64) -> Result<(), Failure> {
        self.time = time;
        if let Some(folder) = self.folder() {
            self.writer = Some(FrameWriter::open(&folder, simulation, start, time)?);
        }
        Ok(())
    }

    /// The simulation goes on from the present time, which the host may say more exactly \[s\]: the frame that is due there
    /// is written.
    pub(crate) fn pass(&mut self, simulation: &Simulation, time: Option<f64>) {
        let time = time.unwrap_or(self.time);
        self.attempt(|writer| writer.pass(simulation, time));
    }

    /// The simulation has come to a time \[s\].
    pub(crate) fn come_to(&mut self, time: f64) {
        self.time = time;
    }

    /// The simulation ends.
    pub(crate) fn end(&mut self, simulation: &Simulation) {
        let time = self.time;
        self.attempt(|writer| writer.end(simulation, time));
    }

    /// The simulation goes on from another state, that of the present time \[s\]. An instance that was never started begins
    /// its frames there.
    pub(crate) fn go_back(&mut self, simulation: &Simulation, start: f64, time: f64) {
        let never_started = self.writer.is_none() && self.time.is_nan();
        self.time = time;
        if !never_started {
            self.attempt(|writer| writer.go_back(time));
        } else if let Err(error) = self.begin(simulation, start, time) {
            self.give_up(&error);
        }
    }

    /// The start was taken back.
    pub(crate) fn undo(&mut self) {
        self.time = f64::NAN;
        if let Some(Err(error)) = self.writer.take().map(FrameWriter::undo) {
            self.give_up(&error.into());
        }
    }

    /// Does something with the open folder. What fails ends the frames.
    fn attempt(&mut self, action: impl FnOnce(&mut FrameWriter) -> Result<(), OutputError>) {
        if let Some(writer) = &mut self.writer
            && let Err(error) = action(writer)
        {
            self.give_up(&error.into());
        }
    }

    /// Writes no more frames, and says why.
    fn give_up(&mut self, error: &Failure) {
        self.writer = None;
        self.warning = Some(format!("{FRAMES}: {error}; no more frames are written, everything else goes on"));
    }

    /// What the present call left undone, in words.
    pub(crate) fn take_warning(&mut self) -> Option<String> {
        self.warning.take()
    }
}
