//! One instance of the unit: what the functions of FMI do, in safe Rust.

mod states;
mod values;

use crate::calls::Phase;
use crate::frames::Frames;
use crate::location::{self, LocationError};
use crate::refusal::Refusal;
use crate::saved::{Course, Saved};
use crate::types::Status;
use cograin::export::{ResourceError, identity, read_resources};
use cograin::interface::{Derivatives, Findings, Interface, Standard, Value};
use cograin::scene::{Models, Scene, SceneErrors, Source};
use cograin::simulation::{Description, RunError, Simulation};
use cograin::state::State;
use cograin::state::snapshot::SnapshotError;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What one communication step may take: time steps times particles, with [`SMALL`] more particles for what a time step
/// costs whatever is in it. Some hours of computing; a host that asks for more is taken to be in error.
const MOST_WORK: f64 = 1e12;

/// As many particles cost as much as everything else in a time step of a small scene.
const SMALL: f64 = 1000.0;

/// Why there is no instance.
#[derive(Debug, thiserror::Error)]
pub(crate) enum StartError {
    /// An argument is missing.
    #[error("{argument}: expected {expected}, found none")]
    Missing {
        /// The argument.
        argument: &'static str,
        /// What was expected.
        expected: &'static str,
    },
    /// Model exchange.
    #[error("fmuType: expected fmi2CoSimulation (1), found {found}")]
    Type {
        /// The type asked for.
        found: i32,
    },
    /// The location is not a path.
    #[error(transparent)]
    Location(#[from] LocationError),
    /// The resources cannot be read.
    #[error(transparent)]
    Resources(#[from] ResourceError),
    /// Description and resources do not belong together.
    #[error(
        "{argument}: expected {expected}, that of the resources with this library, found {given}; take the \
         description, resources and library of one export"
    )]
    Identity {
        /// The argument.
        argument: &'static str,
        /// The GUID given.
        given: String,
        /// That of the resources.
        expected: String,
    },
    /// The scene is refused.
    #[error(transparent)]
    Scene(#[from] SceneErrors),
    /// The state to begin in is refused.
    #[error("resources/state.bin: {0}")]
    State(#[from] SnapshotError),
    /// The scene does not start.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// What the host says when it makes an instance.
pub(crate) struct Request {
    /// The edition of the standard that it speaks.
    pub(crate) standard: Standard,
    /// Name of the instance.
    pub(crate) name: Option<String>,
    /// Kind of unit.
    pub(crate) kind: i32,
    /// GUID of the description that the host has read.
    pub(crate) identity: Option<String>,
    /// Where the resources are: a URI in FMI 2.0, a path in FMI 3.0.
    pub(crate) location: Option<String>,
}

impl Request {
    /// What the standard calls the identity and the location, and what it expects of the location.
    fn arguments(&self) -> [&'static str; 3] {
        match self.standard {
            Standard::Fmi2 => ["fmuGUID", "fmuResourceLocation", "a file: URI of the resources folder"],
            Standard::Fmi3 => ["instantiationToken", "resourcePath", "the path of the resources folder"],
        }
    }

    /// The folder of the resources.
    fn folder(&self) -> Result<PathBuf, StartError> {
        let [_, argument, expected] = self.arguments();
        let location = self.location.as_ref().ok_or(StartError::Missing { argument, expected })?;
        match self.standard {
            Standard::Fmi2 => Ok(location::path_of(location)?),
            Standard::Fmi3 => Ok(PathBuf::from(location)),
        }
    }
}

/// What an instance is made of, which never changes.
struct Unit {
    /// The edition of the standard that the host speaks.
    standard: Standard,
    /// The scene.
    scene: Arc<Scene>,
    /// The sub-models that it may name.
    models: Models,
    /// Its text and files, from which it is read anew with other parameters.
    source: Source,
    /// The state to begin in, if it is not the scene's own.
    start: Option<State>,
    /// The variables.
    interface: Interface,
    /// The GUID.
    identity: String,
}

impl Unit {
    /// Reads the resources.
    fn read(request: &Request, models: Models) -> Result<Self, StartError> {
        let missing = |argument, expected| StartError::Missing { argument, expected };
        if request.name.as_ref().is_none_or(String::is_empty) {
            return Err(missing("instanceName", "a name"));
        }
        if request.kind != crate::types::CO_SIMULATION {
            return Err(StartError::Type { found: request.kind });
        }
        let [argument, ..] = request.arguments();
        let identified = request.identity.as_ref();
        let given = identified.ok_or_else(|| missing(argument, "the identity that modelDescription.xml tells"))?;
        let contents = read_resources(&request.folder()?)?;
        let expected = identity(&contents.source, contents.state.as_deref());
        if *given != expected {
            return Err(StartError::Identity { argument, given: given.clone(), expected });
        }
        let scene = models.scene(&contents.source, &[])?;
        let start = contents.state.map(|bytes| State::from_bytes(&bytes, scene.fingerprint)).transpose()?;
        let (interface, source) = (Interface::of(&scene), contents.source);
        let standard = request.standard;
        Ok(Self { standard, interface, scene: Arc::new(scene), models, source, start, identity: expected })
    }

    /// A simulation at its beginning, with these values of parameters.
    fn begin(&self, given: GivenParameters) -> Result<StartedSimulation, StartError> {
        if given.is_empty() {
            let simulation = match &self.start {
                Some(state) => {
                    let resumed = Simulation::resume(Arc::clone(&self.scene), state.clone());
                    let mut simulation = resumed.map_err(SnapshotError::from)?;
                    simulation.open_books();
                    simulation
                }
                None => Simulation::new(Arc::clone(&self.scene))?,
            };
            return Ok(StartedSimulation { simulation, start: self.start.clone(), given });
        }
        let scene = Arc::new(self.interface.scene_with(&self.models, &self.source, &given)?);
        let Some(state) = &self.start else {
            return Ok(StartedSimulation { simulation: Simulation::new(scene)?, start: None, given });
        };
        let from = Description::of(&self.scene, &self.source.name, state.clock.time);
        let (simulation, _) = Simulation::taken_over(scene, state, &from)?;
        Ok(StartedSimulation { start: Some(simulation.state().clone()), simulation, given })
    }
}

/// Values of parameters that were given before the start, by their places among the variables; those of the scene
/// itself are left out.
pub(crate) type GivenParameters = BTreeMap<usize, f64>;

/// A simulation and what it began with.
struct StartedSimulation {
    /// The scene in motion.
    simulation: Simulation,
    /// The state that it began in, if it was not the scene's own.
    start: Option<State>,
    /// The parameters it was made with.
    given: GivenParameters,
}

/// A saved state, and its bytes once they were asked for.
struct SavedState {
    /// The state.
    saved: Saved,
    /// Its bytes, between asking for their number and for themselves.
    bytes: Option<Vec<u8>>,
}

/// An instance.
pub(crate) struct Instance {
    /// What it is made of.
    unit: Unit,
    /// Where the elements of the variables of FMI 3.0 stand.
    places: values::Places,
    /// The scene in motion.
    simulation: Simulation,
    /// The state that it began in, if it was not the scene's own.
    start: Option<State>,
    /// The parameters it was made with.
    made_with: GivenParameters,
    /// The parameters it is to be made with.
    given: GivenParameters,
    /// What changes beside it.
    course: Course,
    /// Saved states, by the numbers that the host knows them by.
    kept: BTreeMap<usize, SavedState>,
    /// What has been found of the simulation since it last changed.
    findings: Findings,
    /// What has been found of the derivatives of its last communication step.
    derivatives: Derivatives,
    /// The values that are being handed out.
    values: Vec<Value>,
    /// What it writes beside its work.
    frames: Frames,
    /// Set to end the communication step under way.
    stop: Arc<AtomicBool>,
}

impl Instance {
    /// An instance as the host asks for it, whose scene may name these sub-models.
    pub(crate) fn new(request: &Request, models: Models) -> Result<Self, StartError> {
        let unit = Unit::read(request, models)?;
        let StartedSimulation { simulation, start, given } = unit.begin(GivenParameters::new())?;
        let course = Self::at_the_beginning(&simulation);
        let stop = Arc::<AtomicBool>::default();
        let frames = Frames::of(&unit.interface);
        let mut instance = Self {
            places: Self::places(&unit),
            unit,
            simulation,
            start,
            made_with: given.clone(),
            given,
            course,
            kept: BTreeMap::new(),
            findings: Findings::default(),
            derivatives: Derivatives::default(),
            values: Vec::new(),
            frames,
            stop,
        };
        instance.simulation.stop_when(&instance.stop);
        Ok(instance)
    }

    /// What ends the communication step under way when it is set.
    pub(crate) fn stop(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stop)
    }

    /// Forgets what has been found of the simulation.
    fn changed(&mut self) {
        self.findings = Findings::default();
        self.derivatives.forget();
    }

    /// Before anything was set.
    fn at_the_beginning(simulation: &Simulation) -> Course {
        let origin = -simulation.time();
        Course { phase: Phase::Instantiated, placed: true, last_step: Status::Ok, origin, stop: None }
    }

    /// One line about it.
    pub(crate) fn about(&self) -> String {
        format!("{} spheres, {} boundaries", self.unit.scene.particles.len(), self.unit.scene.boundaries.len())
    }

    /// Where it stands.
    pub(crate) fn phase(&self) -> Phase {
        self.course.phase
    }

    /// Nothing but resetting and freeing helps now.
    pub(crate) fn break_down(&mut self) {
        self.course.phase = Phase::Broken;
    }

    /// The host's time \[s\].
    pub(crate) fn time(&self) -> f64 {
        self.simulation.time() + self.course.origin
    }

    /// The host's time at which the experiment starts \[s\].
    fn start_time(&self) -> f64 {
        self.start.as_ref().map_or(0.0, |start| start.clock.time) + self.course.origin
    }

    /// The time step, the stable one and what limits it, in words.
    pub(crate) fn time_step_limit(&self) -> String {
        let (limit, step) = (self.simulation.limit(), self.simulation.state().clock.step);
        let by = limit.by.map_or_else(String::new, |by| format!(", limited by {}", self.simulation.words(&by)));
        format!("time step {step:.4e} s, the stable one {:.4e} s{by}", limit.safe)
    }

    /// That the given time step was divided, in words, if it was.
    pub(crate) fn divided_step(&self) -> Option<String> {
        let clock = self.simulation.state().clock;
        (clock.divided > 0).then(|| {
            format!(
                "the given time step is divided from now on where the stable one, now {:.4e} s, is below it",
                clock.stable
            )
        })
    }

    /// How the last communication step ended.
    pub(crate) fn last_step(&self) -> Status {
        self.course.last_step
    }

    /// `fmi2SetupExperiment`
    pub(crate) fn set_up(&mut self, start: f64, stop: Option<f64>, tolerance: Option<f64>) -> Result<(), Refusal> {
        if !start.is_finite() {
            return Err(Refusal::Time { argument: "startTime", value: start, expected: "a finite number" });
        }
        if let Some(value) = stop.filter(|stop| !stop.is_finite() || *stop < start) {
            let expected = "a finite number, startTime or later";
            return Err(Refusal::Time { argument: "stopTime", value, expected });
        }
        if let Some(value) = tolerance.filter(|tolerance| !tolerance.is_finite() || *tolerance < 0.0) {
            return Err(Refusal::Tolerance { value });
        }
        self.course.origin = start - self.simulation.time();
        self.course.stop = stop;
        Ok(())
    }

    /// `fmi2EnterInitializationMode`
    pub(crate) fn enter_initialization(&mut self) {
        self.course.phase = Phase::Initialization;
    }

    /// `fmi2ExitInitializationMode`
    pub(crate) fn exit_initialization(&mut self) -> Result<(), Refusal> {
        self.place()?;
        self.frames.begin(&self.simulation, self.start_time(), self.time()).map_err(Refusal::Frames)?;
        self.course.phase = Phase::Ready;
        Ok(())
    }

    /// What is legal but risky in how it went.
    pub(crate) fn remarks(&self) -> Vec<String> {
        cograin::run::course(&self.simulation)
    }

    /// `fmi2Terminate`
    pub(crate) fn terminate(&mut self) {
        self.frames.end(&self.simulation);
        self.course.phase = Phase::Terminated;
    }

    /// What the last call left undone, in words, if anything.
    pub(crate) fn take_warning(&mut self) -> Option<String> {
        self.frames.take_warning()
    }

    /// `fmi2Reset`. Saved states stay.
    pub(crate) fn reset(&mut self) -> Result<(), Refusal> {
        let begun =
            self.unit.begin(GivenParameters::new()).map_err(|error| Refusal::Reset { error: error.to_string() })?;
        self.leave_frames();
        self.frames = Frames::of(&self.unit.interface);
        self.given.clear();
        self.take(begun);
        self.course = Self::at_the_beginning(&self.simulation);
        Ok(())
    }

    /// Writes the frame that is due at the present time, from which nothing goes on.
    fn leave_frames(&mut self) {
        if matches!(self.course.phase, Phase::Ready | Phase::Discarded) {
            self.frames.pass(&self.simulation, None);
        }
    }

    /// Goes on with another simulation.
    fn take(&mut self, StartedSimulation { simulation, start, given }: StartedSimulation) {
        (self.simulation, self.start, self.made_with) = (simulation, start, given);
        self.simulation.stop_when(&self.stop);
        self.changed();
    }

    /// Makes the simulation anew where other parameters were given than it was made with.
    fn make(&mut self) -> Result<(), Refusal> {
        if self.given != self.made_with {
            let begun = self.unit.begin(self.given.clone());
            let mut begun = begun.map_err(|error| Refusal::Parameters { error: error.to_string() })?;
            begun.simulation.take_inputs(&self.simulation);
            self.take(begun);
        }
        Ok(())
    }

    /// Takes the boundaries to the start values of the inputs, without motion.
    fn place(&mut self) -> Result<(), Refusal> {
        if !self.course.placed {
            self.make()?;
            self.changed();
            self.simulation.place(self.start.as_ref()).map_err(Refusal::Start)?;
            self.course.placed = true;
        }
        Ok(())
    }

    /// `fmi2DoStep`
    pub(crate) fn step(&mut self, point: f64, length: f64) -> Result<(), Refusal> {
        let present = self.time();
        if !point.is_finite() {
            let expected = "a finite number";
            return Err(Refusal::Time { argument: "currentCommunicationPoint", value: point, expected });
        }
        if !length.is_finite() || length <= 0.0 || present + length <= present {
            let expected = "a finite number above 0, large enough to change the time";
            return Err(Refusal::Time { argument: "communicationStepSize", value: length, expected });
        }
        // Hosts count in nanoseconds or sum up; a step that was left out or done twice differs by all of it.
        let rounding = f64::EPSILON * present.abs();
        let tolerance = (1e-3 * length + 64.0 * rounding).min(0.5 * length);
        let behind = point - present;
        if behind.abs() > tolerance {
            return Err(Refusal::Point { given: point, present });
        }
        if let Some(stop) = self.course.stop.filter(|stop| present + length > stop + tolerance) {
            return Err(Refusal::Stop { end: present + length, stop });
        }
        let step = self.simulation.state().clock.step;
        let most = (MOST_WORK / (SMALL + self.unit.scene.particles.len() as f64)).floor();
        if length / step > most {
            return Err(Refusal::TooMany { length, count: length / step, step, most });
        }
        // Where a host's steps are not quite whole time steps, whole ones are made until the difference shows; then the unit
        // goes to where the host will be.
        let apart = behind.abs() > (1e-6 * step).min(1e-4 * length) + 16.0 * rounding;
        let interval = if apart { length + behind } else { length };
        self.stop.store(false, Ordering::Relaxed);
        self.changed();
        self.frames.pass(&self.simulation, Some(point));
        match self.simulation.advance_or_roll_back(interval) {
            Ok(()) => {
                self.frames.come_to(point + length);
                (self.course.phase, self.course.last_step) = (Phase::Ready, Status::Ok);
                Ok(())
            }
            Err(cause) => {
                (self.course.phase, self.course.last_step) = (Phase::Discarded, Status::Discard);
                Err(Refusal::Discarded { cause, time: self.time() })
            }
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // A host must not see a panic, and there is nobody left to tell.
        let _ = catch_unwind(AssertUnwindSafe(|| self.leave_frames()));
    }
}
