//! A scene that runs by itself, from one communication point to the next, and what it writes there.

use super::error::{Failure, OutputError, Refusal, ResumeError};
use super::files::{Durability, read_checkpoint, write_whole};
use super::folder::{Beginning, Folder, Job, Kept, Origin};
use super::inputs::Inputs;
use super::momentum;
use super::schedule::{Due, Schedule};
use super::summary::{Meter, Summary};
use super::writer::{Writer, opened};
use super::{CHECKPOINT, SUMMARY};
use crate::interface::Interface;
use crate::scene::Scene;
use crate::step::Simulation;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Wall time between checkpoints of a scene that gives no interval. It decides when they are written and nothing
/// of what is in them.
const CHECKPOINT_PAUSE: Duration = Duration::from_secs(30);

/// Where a run begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Start {
    /// With the scene as its file has it.
    Scene,
    /// With the checkpoint in the folder of the results.
    LastCheckpoint,
    /// With this checkpoint.
    Checkpoint(PathBuf),
}

/// What is to be run, and where to.
#[derive(Clone, Copy, Debug)]
pub struct RunOrder<'a> {
    /// The scene.
    pub scene: &'a Arc<Scene>,
    /// Its file name, for messages and the summary.
    pub scene_name: &'a str,
    /// Folder of the results.
    pub folder: &'a Path,
    /// Where it begins.
    pub start: &'a Start,
    /// A table of the driven boundaries' displacements over time; without one they stay where they are.
    pub inputs: Option<&'a Path>,
    /// Set from outside to stop at the next communication point.
    pub stop: &'a AtomicBool,
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Where this session began \[s\].
    pub start: f64,
    /// Time \[s\].
    pub time: f64,
    /// Where it ends \[s\].
    pub end: f64,
}

/// Where a checkpoint is written from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Checkpoint {
    /// From a copy, while the simulation goes on.
    Copied,
    /// From the state itself, where nothing goes on meanwhile: a copy would be what the process needs most memory for.
    InPlace,
}

/// Runs a scene to its end and returns the summary that also stands in `summary.json`.
pub fn run(order: RunOrder<'_>, watch: &mut dyn FnMut(Progress)) -> Result<Summary, Failure> {
    let mut session = Session::begin(order)?;
    let result = session.go(order.stop, watch);
    session.end(result)
}

/// A run under way.
struct Session<'a> {
    /// What was asked for.
    order: RunOrder<'a>,
    /// When what is written.
    schedule: Schedule,
    /// The end of the run \[s\].
    end: f64,
    /// The scene in motion.
    simulation: Simulation,
    /// Its variables.
    interface: Interface,
    /// What the driven boundaries do.
    inputs: Option<Inputs>,
    /// Where to.
    folder: Arc<Mutex<Folder>>,
    /// Who writes.
    writer: Writer,
    /// Communication point that was reached last \[s\].
    time: f64,
    /// Communication point where this session began \[s\].
    start: f64,
    /// Momentum and impulses at the start of this session.
    momentum: momentum::Start,
    /// What was counted.
    meter: Meter,
    /// When the last checkpoint was handed over.
    last_checkpoint: Instant,
}

impl<'a> Session<'a> {
    /// Refuses what cannot be run, before anything is written; then opens the folder.
    fn begin(order: RunOrder<'a>) -> Result<Self, Failure> {
        let scene_name = || order.scene_name.to_owned();
        let interface = Interface::of(order.scene);
        let inputs = order.inputs.map(|path| Inputs::read(path, &interface)).transpose().map_err(Refusal::from)?;
        let told = inputs.as_ref().map(Inputs::end).into_iter().chain(order.scene.run.end).reduce(f64::min);
        let end = told.filter(|end| *end > 0.0).ok_or_else(|| Refusal::NoEnd { scene: scene_name() })?;
        let schedule = Schedule::new(&order.scene.output, end);
        let (simulation, time, origin) = match checkpoint(&order)? {
            Some((path, origin)) => {
                let state = read_checkpoint(&path, order.scene.fingerprint)?;
                let saved = state.clock.time;
                let time = schedule.point_of(saved).map_err(|nearest| ResumeError::Between { time: saved, nearest })?;
                let origin = if time > 0.0 { origin } else { Origin::Anew };
                (Simulation::resume(Arc::clone(order.scene), state), time, origin)
            }
            None => {
                let start = |source| Refusal::Start { scene: scene_name(), source };
                (Simulation::new(Arc::clone(order.scene)).map_err(start)?, 0.0, Origin::Anew)
            }
        };
        let outputs = interface.outputs().map(|(_, variable)| variable.name.clone());
        let names: Vec<_> = std::iter::once("time".to_owned()).chain(outputs).collect();
        let state = simulation.state();
        let beginning = Beginning { scene: order.scene, names: &names, schedule: &schedule, time, state, origin };
        let kept = Kept::look(order.folder, &beginning)?;
        let folder = Folder::open(order.folder, Arc::clone(order.scene), &names, &kept)?;
        let folder = Arc::new(Mutex::new(folder));
        let writer = Writer::start(Arc::clone(&folder))?;
        let momentum = momentum::Start::of(&simulation);
        let meter = Meter::start(&simulation);
        let last_checkpoint = Instant::now();
        let mut session = Self {
            order,
            schedule,
            end,
            simulation,
            interface,
            inputs,
            folder,
            writer,
            time,
            start: time,
            momentum,
            meter,
            last_checkpoint,
        };
        match origin {
            Origin::Anew => session.write(session.schedule.at_start(), Checkpoint::InPlace)?,
            Origin::Elsewhere => {
                session.write(Due { history: false, frame: false, checkpoint: true }, Checkpoint::InPlace)?;
            }
            Origin::Here => {}
        }
        Ok(session)
    }

    /// Goes from point to point.
    fn go(&mut self, stop: &AtomicBool, watch: &mut dyn FnMut(Progress)) -> Result<(), Failure> {
        let (start, end) = (self.start, self.end);
        let tell = |time| Progress { start, time, end };
        watch(tell(self.time));
        while let Some(point) = self.schedule.after(self.time) {
            if let Some(inputs) = &self.inputs {
                inputs.set(&self.interface, &mut self.simulation, point.time);
            }
            let advanced = self.meter.step(&mut self.simulation, point.interval);
            self.write_breaks()?;
            advanced?;
            self.time = point.time;
            let stopped = stop.load(Ordering::Relaxed);
            let last = stopped || point.time >= self.end;
            let due = Due { checkpoint: point.due.checkpoint || stopped || self.overdue(), ..point.due };
            self.write(due, if last { Checkpoint::InPlace } else { Checkpoint::Copied })?;
            watch(tell(point.time));
            if stopped && point.time < self.end {
                return Err(self.interrupted());
            }
        }
        Ok(())
    }

    /// Whether a scene that gives no interval has waited long for a checkpoint.
    fn overdue(&self) -> bool {
        let unnamed = self.order.scene.output.checkpoint_interval.is_none();
        unnamed && self.last_checkpoint.elapsed() >= CHECKPOINT_PAUSE
    }

    /// Hands the bonds that broke in the last communication step to the writer.
    fn write_breaks(&mut self) -> Result<(), OutputError> {
        let breaks = &self.simulation.state().breaks;
        if breaks.is_empty() { Ok(()) } else { self.writer.send(Job::Breaks(breaks.clone())) }
    }

    /// Hands what is due of the present state to the writer.
    fn write(&mut self, due: Due, checkpoint: Checkpoint) -> Result<(), OutputError> {
        let time = self.time;
        if due.history {
            let values = self.interface.outputs().map(|(index, _)| self.interface.value(&self.simulation, index));
            let values = values.collect();
            self.writer.send(Job::Row { time, values })?;
        }
        if due.frame {
            let particles = Box::new(self.simulation.state().particles.clone());
            let contacts = self.order.scene.output.contacts.then(|| self.simulation.contacts());
            let bonds = (!self.order.scene.bonds.is_empty()).then(|| self.simulation.bonds());
            self.writer.send(Job::Frame { time, particles, contacts, bonds })?;
        }
        if due.checkpoint {
            self.last_checkpoint = Instant::now();
            let state = self.simulation.state();
            match checkpoint {
                Checkpoint::Copied => self.writer.send(Job::Checkpoint(Box::new(state.clone())))?,
                Checkpoint::InPlace => {
                    self.writer.wait()?;
                    opened(&self.folder).checkpoint(state)?;
                }
            }
        }
        Ok(())
    }

    /// What is told who asked to stop.
    fn interrupted(&self) -> Failure {
        Failure::Interrupted { time: self.time, folder: self.order.folder.to_owned() }
    }

    /// Waits for the writer and leaves the summary. The first thing that went wrong is told.
    fn end(mut self, result: Result<(), Failure>) -> Result<Summary, Failure> {
        let result = result.and(self.writer.finish().map_err(Failure::from));
        let momentum = self.momentum.balance(&self.simulation);
        self.meter.look(&self.simulation);
        let summary =
            Summary::new(&self.order, &self.simulation, &self.meter, self.start, momentum, result.as_ref().err());
        let path = self.order.folder.join(SUMMARY);
        let written = write_whole(&path, summary.to_json().as_bytes(), Durability::Process);
        result.and(written.map_err(Failure::from)).map(|()| summary)
    }
}

/// The checkpoint that a run begins with, if any, and what that means for its files.
fn checkpoint(order: &RunOrder<'_>) -> Result<Option<(PathBuf, Origin)>, ResumeError> {
    let own = order.folder.join(CHECKPOINT);
    match order.start {
        Start::Scene => Ok(None),
        Start::LastCheckpoint if own.exists() => Ok(Some((own, Origin::Here))),
        Start::LastCheckpoint => Err(ResumeError::None { folder: order.folder.to_owned() }),
        Start::Checkpoint(path) => {
            let same = |path: &Path| path.canonicalize().ok();
            let here = same(path).is_some() && same(path) == same(&own);
            Ok(Some((path.clone(), if here { Origin::Here } else { Origin::Elsewhere })))
        }
    }
}
