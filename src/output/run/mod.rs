//! A run of a scene without a master, from one communication point to the next, and what it writes there.

mod beginning;
mod ends;
mod frame_writer;
mod inputs;
pub(crate) mod jobs;
mod meter;
mod momentum;
mod order;
pub(crate) mod remarks;
mod settle;
mod summary;

pub use frame_writer::FrameWriter;
pub use order::{EarlierResults, Progress, RunOrder, Start};
pub use remarks::{course, remarks};
pub use settle::{SettleOrder, SettleProgress, SettleStart, Settled, settle};
pub use summary::Summary;

use crate::engine::simulation::{RunError, Simulation};
use crate::engine::state::{Impact, State};
use crate::interface::{Interface, Variable};
use crate::output::results::files::{Checkpoint, Durability, write_whole};
use crate::output::results::folder::{Folder, KeptFiles, Place};
use crate::output::results::impacts::write_histograms;
use crate::output::results::job::Job;
use crate::output::results::lock::FolderLock;
use crate::output::results::schedule::{Due, Schedule};
use crate::output::results::writer::{Writer, opened};
use crate::output::results::{Failure, OutputError, Refusal, ResumeError};
use crate::output::results::{HISTOGRAMS, SUMMARY};
use beginning::{First, Origin, checkpoint, claim};
use ends::Ends;
use inputs::Inputs;
use jobs::{frame, row};
use meter::Meter;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Wall time between checkpoints of a scene that gives no interval. It determines when they are written, but not
/// their content.
const CHECKPOINT_PAUSE: Duration = Duration::from_secs(30);

/// Where a checkpoint is written from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum WrittenFrom {
    /// From a copy, while the simulation goes on.
    Copied,
    /// From the state itself, if the simulation waits meanwhile: a copy would be the largest use of memory of the process.
    InPlace,
}

/// Runs a scene to its end and returns the summary that also stands in `summary.json`.
pub fn run(order: RunOrder<'_>, watch: &mut dyn FnMut(Progress)) -> Result<Summary, Failure> {
    let mut session = Session::begin(order)?;
    let result = session.go(order.stop, watch);
    session.end(result)
}

/// How many bonds broke, and how many impacts ended, since the present communication step began.
fn happened(state: &State) -> [usize; 2] {
    [state.breaks.len(), impacts(state).len()]
}

/// Impacts that ended since the present communication step began, where each is told.
fn impacts(state: &State) -> &[Impact] {
    state.traces.as_ref().map_or(&[], |traces| &traces.impacts)
}

/// A run under way.
struct Session<'a> {
    /// The order.
    order: RunOrder<'a>,
    /// When each output is written.
    schedule: Schedule,
    /// The end of the run \[s\].
    end: f64,
    /// The scene in motion.
    simulation: Simulation,
    /// Its variables.
    interface: Interface,
    /// Inputs of the driven boundaries.
    inputs: Option<Inputs>,
    /// The folder of the results.
    folder: Arc<Mutex<Folder>>,
    /// The writer.
    writer: Writer,
    /// Communication point that was reached last \[s\].
    time: f64,
    /// Bonds that broke, and impacts that ended, since then and are told.
    told: [usize; 2],
    /// Communication point where this session began \[s\].
    start: f64,
    /// Momentum and impulses at the start of this session.
    momentum: momentum::Start,
    /// The counts.
    meter: Meter,
    /// When the last checkpoint was handed over.
    last_checkpoint: Instant,
    /// What could not be taken over from another scene, in words.
    left_behind: Vec<String>,
    /// The lock that keeps other runs out of the folder.
    lock: FolderLock,
}

impl<'a> Session<'a> {
    /// Refuses what cannot be run, before anything is written; then opens the folder.
    fn begin(order: RunOrder<'a>) -> Result<Self, Failure> {
        let scene_name = || order.scene_name.to_owned();
        let interface = Interface::of(order.scene);
        let chosen = interface.check_names(order.scene);
        chosen.map_err(|source| Refusal::Chosen { scene: scene_name(), source: Box::new(source) })?;
        let inputs = order.inputs.map(|path| Inputs::read(path, &interface)).transpose().map_err(Refusal::from)?;
        let digest = inputs.as_ref().map(|inputs| inputs.digest);
        let ends = Ends::of(&order, inputs.as_ref())?;
        let (end, schedule) = (ends.end, ends.schedule(&order)?);
        let early_lock = if order.folder.exists() { Some(claim(&order)?) } else { None };
        let mut left_behind = Vec::new();
        let (simulation, time, origin) = match checkpoint(&order)? {
            Some((path, Origin::TakenOver { .. })) => {
                let not = |error| Refusal::not_taken_over(order.scene_name, error);
                let taken = Checkpoint::read(&path)?.taken_over(order.scene).map_err(not)?;
                left_behind = taken.left_behind;
                let saved = taken.simulation.time();
                order.expect_before(saved, end)?;
                let time = schedule.point_of(saved).unwrap_or(saved);
                let goes_on = taken.goes_on;
                (taken.simulation, time, if time > 0.0 { Origin::TakenOver { goes_on } } else { Origin::Anew })
            }
            Some((path, origin)) => {
                let state = Checkpoint::read(&path)?.state_of_run(order.scene, digest)?;
                let time = ends.going_on(&order, &schedule, &state)?;
                let origin = if time > 0.0 || state.underway.is_some() { origin } else { Origin::Anew };
                let resumed = Simulation::resume(Arc::clone(order.scene), state);
                let source =
                    |fault: crate::engine::state::StateFault| ResumeError::Snapshot { path, source: fault.into() };
                (resumed.map_err(source)?, time, origin)
            }
            None => {
                let start = |source| Refusal::Start { scene: scene_name(), source };
                (Simulation::new(Arc::clone(order.scene)).map_err(start)?, 0.0, Origin::Anew)
            }
        };
        schedule.check_step(order.scene_name, simulation.state().clock.step)?;
        let lock = early_lock.map_or_else(|| claim(&order), Ok)?;
        let outputs = interface.recorded().map(|(_, variable)| variable.name.clone());
        let names: Vec<_> = std::iter::once("time".to_owned()).chain(outputs).collect();
        if origin != Origin::Here {
            let first =
                First { order: &order, interface: &interface, schedule: &schedule, names: &names, inputs: digest };
            first.write(&simulation, time, origin)?;
        }
        let asks_for_impacts = order.scene.output.impacts.is_some_and(|impacts| impacts.events);
        let place = Place { names: &names, schedule: &schedule, time, state: simulation.state(), asks_for_impacts };
        let kept = KeptFiles::look(order.folder, &place)?;
        let named = (Arc::clone(order.scene), order.scene_name, digest);
        let folder = Folder::open(order.folder, named, &names, &kept)?;
        let folder = Arc::new(Mutex::new(folder));
        let writer = Writer::start(Arc::clone(&folder))?;
        let momentum = momentum::Start::of(&simulation);
        let told = simulation.state().underway.map_or([0; 2], |_| happened(simulation.state()));
        let meter = Meter::start(&simulation);
        Ok(Self {
            order,
            schedule,
            end,
            simulation,
            interface,
            inputs,
            folder,
            writer,
            time,
            told,
            start: time,
            momentum,
            meter,
            last_checkpoint: Instant::now(),
            left_behind,
            lock,
        })
    }

    /// Goes from point to point.
    fn go(&mut self, stop: &AtomicBool, watch: &mut dyn FnMut(Progress)) -> Result<(), Failure> {
        let (start, end) = (self.start, self.end);
        let tell = |time| Progress { start, time, end };
        watch(tell(self.time));
        while let Some(point) = self.schedule.after(self.time) {
            if self.simulation.state().underway.is_none() {
                self.told = [0; 2];
                if let Some(inputs) = &self.inputs {
                    inputs.set(&self.interface, &mut self.simulation, point.time);
                }
            }
            while !self.advance_part(point.interval)? {
                watch(tell(self.simulation.time()));
                let stopped = stop.load(Ordering::Relaxed);
                if stopped || self.overdue() {
                    self.write_checkpoint(if stopped { WrittenFrom::InPlace } else { WrittenFrom::Copied })?;
                }
                if stopped {
                    return Err(self.interrupted());
                }
            }
            self.time = point.time;
            let stopped = stop.load(Ordering::Relaxed);
            let last = stopped || point.time >= self.end;
            let due = Due { checkpoint: point.due.checkpoint || stopped || self.overdue(), ..point.due };
            self.write(due, if last { WrittenFrom::InPlace } else { WrittenFrom::Copied })?;
            watch(tell(point.time));
            if stopped && point.time < self.end {
                return Err(self.interrupted());
            }
        }
        Ok(())
    }

    /// Makes a part of a communication step of this length \[s\]. Returns whether its end is reached.
    fn advance_part(&mut self, interval: f64) -> Result<bool, Failure> {
        let reached = self.meter.part(&mut self.simulation, interval);
        self.write_events()?;
        Ok(reached?)
    }

    /// Whether a scene that gives no interval has waited long for a checkpoint.
    fn overdue(&self) -> bool {
        let unnamed = self.order.scene.output.checkpoint_interval.is_none();
        unnamed && self.last_checkpoint.elapsed() >= CHECKPOINT_PAUSE
    }

    /// Hands the bonds that broke and the impacts that ended in this communication step, and are not told yet, to the writer.
    fn write_events(&mut self) -> Result<(), OutputError> {
        let (state, told) = (self.simulation.state(), self.told);
        self.told = happened(state);
        let breaks = state.breaks.get(told[0]..).unwrap_or_default();
        if !breaks.is_empty() {
            self.writer.send(Job::Breaks(breaks.to_vec()))?;
        }
        let impacts = impacts(state).get(told[1]..).unwrap_or_default();
        if impacts.is_empty() { Ok(()) } else { self.writer.send(Job::Impacts(impacts.to_vec())) }
    }

    /// Hands the outputs that are due to the writer.
    fn write(&mut self, due: Due, checkpoint: WrittenFrom) -> Result<(), Failure> {
        let time = self.time;
        if due.history {
            self.writer.send(row(&self.interface, &self.simulation, time))?;
        }
        if due.frame {
            self.writer.send(frame(&self.simulation, time))?;
        }
        if due.checkpoint { self.write_checkpoint(checkpoint) } else { Ok(()) }
    }

    /// Hands the present state to the writer.
    fn write_checkpoint(&mut self, from: WrittenFrom) -> Result<(), Failure> {
        self.last_checkpoint = Instant::now();
        self.simulation.check_present()?;
        let state = self.simulation.state();
        match from {
            WrittenFrom::Copied => self.writer.send(Job::Checkpoint(Box::new(state.clone())))?,
            WrittenFrom::InPlace => {
                self.writer.wait()?;
                opened(&self.folder).checkpoint(state)?;
            }
        }
        Ok(())
    }

    /// The answer to a request to stop.
    fn interrupted(&self) -> Failure {
        Failure::Interrupted { time: self.simulation.time(), folder: self.order.folder.to_owned() }
    }

    /// Waits for the writer and writes the summary. Returns the first error.
    fn end(mut self, result: Result<(), Failure>) -> Result<Summary, Failure> {
        let result = result.and(self.writer.finish().map_err(Failure::from));
        let momentum = self.momentum.balance(&self.simulation);
        self.meter.count(&self.simulation);
        let mut summary =
            Summary::new(&self.order, &self.simulation, &self.meter, self.start, momentum, result.as_ref().err());
        summary.left_behind = self.left_behind;
        let unit = |variable: &Variable| Some((variable.name.clone(), variable.quantity.unit()?));
        summary.units = self.interface.recorded().filter_map(|(_, variable)| unit(variable)).collect();
        let result = result.and_then(|()| match summary.lacking() {
            Some(part) => {
                Err(RunError::Invalid { part, place: 0, expected: "finite numbers", time: self.simulation.time() }
                    .into())
            }
            None => Ok(()),
        });
        if let Err(failure) = &result {
            summary.end_with(failure);
        }
        // Another folder that has taken this one's name does not get the summary.
        if let Err(moved) = self.lock.expect_in_place() {
            return Err(result.err().unwrap_or(moved.into()));
        }
        let histograms = match &self.simulation.state().traces {
            Some(traces) => write_histograms(&self.order.folder.join(HISTOGRAMS), self.order.scene, traces),
            None => Ok(()),
        };
        let result = result.and(histograms.map_err(Failure::from));
        let path = self.order.folder.join(SUMMARY);
        let written = write_whole(&path, summary.to_json().as_bytes(), Durability::Process);
        result.and(written.map_err(Failure::from)).map(|()| summary)
    }
}
