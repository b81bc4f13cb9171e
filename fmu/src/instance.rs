//! One instance of the unit: the functions of FMI 2.0 in safe Rust.

use crate::calls::Phase;
use crate::frames::Frames;
use crate::guard;
use crate::host_memory::{Items, Target};
use crate::location::{self, LocationError};
use crate::refusal::Refusal;
use crate::saved::{BlobError, Course, Saved};
use crate::types::{Reference, Status};
use cograin::export::{ResourceError, identity, read_resources};
use cograin::interface::{Causality, Derivatives, Findings, Interface, InterfaceError, Type, Value, Variable};
use cograin::scene::{Scene, SceneErrors, Source};
use cograin::state::State;
use cograin::state::snapshot::SnapshotError;
use cograin::step::{Description, RunError, Simulation};
use std::collections::BTreeMap;
use std::ffi::{CStr, CString};
use std::panic::{AssertUnwindSafe, catch_unwind};
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
    #[error("{argument} is missing; {right} is right")]
    Missing {
        /// The argument.
        argument: &'static str,
        /// What would be right.
        right: &'static str,
    },
    /// Model exchange.
    #[error("fmuType {found} is not provided; fmi2CoSimulation (1) is right")]
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
        "fmuGUID {given} is not that of the resources with this library, {expected}; the description, resources \
             and library of one export are right"
    )]
    Identity {
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
    /// Name of the instance.
    pub(crate) name: Option<String>,
    /// Kind of unit.
    pub(crate) kind: i32,
    /// GUID of the description that the host has read.
    pub(crate) identity: Option<String>,
    /// Where the resources are.
    pub(crate) location: Option<String>,
}

/// What an instance is made of, which never changes.
struct Unit {
    /// The scene.
    scene: Arc<Scene>,
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
    fn read(request: &Request) -> Result<Self, StartError> {
        let missing = |argument, right| StartError::Missing { argument, right };
        if request.name.as_ref().is_none_or(String::is_empty) {
            return Err(missing("instanceName", "a name"));
        }
        if request.kind != crate::types::CO_SIMULATION {
            return Err(StartError::Type { found: request.kind });
        }
        let given = request.identity.as_ref().ok_or_else(|| missing("fmuGUID", "the guid of modelDescription.xml"))?;
        let location = request.location.as_ref();
        let location = location.ok_or_else(|| missing("fmuResourceLocation", "a file: URI of the resources folder"))?;
        let contents = read_resources(&location::path_of(location)?)?;
        let expected = identity(&contents.source, contents.state.as_deref());
        if *given != expected {
            return Err(StartError::Identity { given: given.clone(), expected });
        }
        let scene = Scene::from_source(&contents.source)?;
        let start = contents.state.map(|bytes| State::from_bytes(&bytes, scene.fingerprint)).transpose()?;
        let (interface, source) = (Interface::of(&scene), contents.source);
        Ok(Self { interface, scene: Arc::new(scene), source, start, identity: expected })
    }

    /// A simulation at its beginning, with these values of parameters.
    fn begin(&self, given: Given) -> Result<Begun, StartError> {
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
            return Ok(Begun { simulation, start: self.start.clone(), given });
        }
        let scene = Arc::new(self.interface.scene_with(&self.source, &given)?);
        let Some(state) = &self.start else {
            return Ok(Begun { simulation: Simulation::new(scene)?, start: None, given });
        };
        let from = Description::of(&self.scene, &self.source.name, state.clock.time);
        let (simulation, _) = Simulation::taken_over(scene, state, &from)?;
        Ok(Begun { start: Some(simulation.state().clone()), simulation, given })
    }
}

/// Values of parameters that were given before the start, by their places among the variables; those of the scene
/// itself are left out.
pub(crate) type Given = BTreeMap<usize, f64>;

/// A simulation and what it began with.
struct Begun {
    /// The scene in motion.
    simulation: Simulation,
    /// The state that it began in, if it was not the scene's own.
    start: Option<State>,
    /// The parameters it was made with.
    given: Given,
}

/// A saved state, and its bytes once they were asked for.
struct Kept {
    /// The state.
    saved: Saved,
    /// Its bytes, between asking for their number and for themselves.
    bytes: Option<Vec<u8>>,
}

/// An instance.
pub(crate) struct Instance {
    /// What it is made of.
    unit: Unit,
    /// The scene in motion.
    simulation: Simulation,
    /// The state that it began in, if it was not the scene's own.
    start: Option<State>,
    /// The parameters it was made with.
    made_with: Given,
    /// The parameters it is to be made with.
    given: Given,
    /// What changes beside it.
    course: Course,
    /// Saved states, by the numbers that the host knows them by.
    kept: BTreeMap<usize, Kept>,
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
    /// An instance as the host asks for it.
    pub(crate) fn new(request: &Request) -> Result<Self, StartError> {
        let unit = Unit::read(request)?;
        let Begun { simulation, start, given } = unit.begin(Given::new())?;
        let course = Self::at_the_beginning(&simulation);
        let stop = Arc::<AtomicBool>::default();
        let frames = Frames::of(&unit.interface);
        let mut instance = Self {
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
        (self.findings, self.derivatives) = (Findings::default(), Derivatives::default());
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

    /// How the last communication step ended.
    pub(crate) fn last_step(&self) -> Status {
        self.course.last_step
    }

    /// `fmi2SetupExperiment`
    pub(crate) fn set_up(&mut self, start: f64, stop: Option<f64>, tolerance: Option<f64>) -> Result<(), Refusal> {
        if !start.is_finite() {
            return Err(Refusal::Time { argument: "startTime", value: start, right: "a finite number" });
        }
        if let Some(value) = stop.filter(|stop| !stop.is_finite() || *stop < start) {
            let right = "a finite number, startTime or later,";
            return Err(Refusal::Time { argument: "stopTime", value, right });
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
        let begun = self.unit.begin(Given::new()).map_err(|error| Refusal::Reset { error: error.to_string() })?;
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
    fn take(&mut self, Begun { simulation, start, given }: Begun) {
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

    /// The variable with a reference, if it is of the type that the function is for.
    fn variable(&self, reference: Reference, expected: &'static str) -> Result<(usize, &Variable), Refusal> {
        let index = reference as usize;
        let variable = self.unit.interface.variable(index)?;
        let found = variable.quantity.of_type().name();
        if found == expected {
            Ok((index, variable))
        } else {
            Err(Refusal::Type { reference, name: variable.name.clone(), found, expected })
        }
    }

    /// Values of variables of one type.
    pub(crate) fn values(&mut self, references: Items<Reference>, kind: &'static str) -> Result<&[Value], Refusal> {
        if !self.course.placed {
            for reference in references.iter() {
                self.variable(reference, kind)?;
            }
            self.place()?;
        }
        let wanted = [Type::Real, Type::Integer].into_iter().find(|known| known.name() == kind);
        let mut values = std::mem::take(&mut self.values);
        values.clear();
        values.reserve(references.len());
        for reference in references.iter() {
            let index = reference as usize;
            if wanted.is_none() || self.unit.interface.type_of(index) != wanted {
                self.variable(reference, kind)?;
            }
            let value = self.unit.interface.value_with(&self.simulation, &self.findings, index);
            if !value.number().is_finite() {
                let name = self.unit.interface.variables()[index].name.clone();
                return Err(Refusal::NoNumber { reference, name, value: value.number() });
            }
            values.push(value);
        }
        self.values = values;
        Ok(&self.values)
    }

    /// `fmi2SetReal` and `fmi2SetInteger`: all or nothing.
    pub(crate) fn set<T: Copy + Into<f64>>(
        &mut self,
        references: Items<Reference>,
        values: Items<T>,
        kind: &'static str,
    ) -> Result<(), Refusal> {
        let starting = matches!(self.course.phase, Phase::Instantiated | Phase::Initialization);
        let mut tuned = Vec::new();
        for (reference, value) in references.iter().zip(values.iter()) {
            let (index, variable) = self.variable(reference, kind)?;
            self.unit.interface.check(index, value.into())?;
            if variable.causality == Causality::Parameter && !starting {
                tuned.push((index, value.into()));
            }
        }
        if !tuned.is_empty() {
            self.frames.pass(&self.simulation, None);
            self.unit.interface.tune(&mut self.simulation, &tuned)?;
            self.changed();
        }
        for (reference, value) in references.iter().zip(values.iter()) {
            let (index, value) = (reference as usize, value.into());
            if starting {
                self.course.placed = false;
                self.give(index, value);
            }
            self.unit.interface.set(&mut self.simulation, index, Value::Real(value))?;
        }
        Ok(())
    }

    /// Notes the value of a parameter that the simulation is to be made with.
    fn give(&mut self, index: usize, value: f64) {
        let variable = &self.unit.interface.variables()[index];
        if variable.start == Some(value) {
            self.given.remove(&index);
        } else if variable.causality == Causality::Parameter {
            self.given.insert(index, value);
        }
    }

    /// `fmi2GetString`
    pub(crate) fn texts(&self, references: Items<Reference>) -> Result<Vec<&CStr>, Refusal> {
        let text = |reference| self.variable(reference, "String").map(|(index, _)| self.frames.text(index));
        references.iter().map(text).collect()
    }

    /// `fmi2SetString`: all or nothing.
    pub(crate) fn set_texts(&mut self, references: Items<Reference>, values: Vec<CString>) -> Result<(), Refusal> {
        let starting = matches!(self.course.phase, Phase::Instantiated | Phase::Initialization);
        for reference in references.iter() {
            let (index, variable) = self.variable(reference, "String")?;
            if !starting {
                return Err(InterfaceError::Fixed { index, name: variable.name.clone() }.into());
            }
        }
        for (reference, value) in references.iter().zip(values) {
            self.frames.set_text(reference as usize, value);
        }
        Ok(())
    }

    /// The other setters: there are no inputs of these types, so every reference is a wrong one.
    pub(crate) fn refuse_to_set(&self, references: Items<Reference>, kind: &'static str) -> Result<(), Refusal> {
        for reference in references.iter() {
            let (index, _) = self.variable(reference, kind)?;
            self.unit.interface.check(index, 0.0)?;
        }
        Ok(())
    }

    /// `fmi2SetRealInputDerivatives`, of order 1, or 2 where the motion is quadratic: all or nothing.
    pub(crate) fn set_rates(
        &mut self,
        references: Items<Reference>,
        orders: Items<i32>,
        rates: Items<f64>,
    ) -> Result<(), Refusal> {
        for ((reference, order), rate) in references.iter().zip(orders.iter()).zip(rates.iter()) {
            let (index, variable) = self.variable(reference, "Real")?;
            match order {
                1 => self.unit.interface.check_rate(index, rate)?,
                2 => drop(self.unit.interface.check_acceleration(&self.unit.scene, index, rate)?),
                _ => {
                    let right = "order 1, or order 2 of quadratic motion,";
                    return Err(Refusal::Order { order, right, reference, name: variable.name.clone() });
                }
            }
        }
        for ((reference, order), rate) in references.iter().zip(orders.iter()).zip(rates.iter()) {
            let (interface, index) = (&self.unit.interface, reference as usize);
            if order == 1 {
                interface.set_rate(&mut self.simulation, index, rate)?;
            } else {
                let (boundary, axis) = interface.check_acceleration(&self.unit.scene, index, rate)?;
                self.simulation.set_input_acceleration(boundary, axis, rate);
            }
        }
        Ok(())
    }

    /// `fmi2GetDirectionalDerivative`: change of each unknown, an output, per unit of a direction of inputs.
    pub(crate) fn directional_derivatives(
        &mut self,
        unknowns: Items<Reference>,
        knowns: Items<Reference>,
        direction: Items<f64>,
    ) -> Result<Vec<f64>, Refusal> {
        self.unit.interface.check_derivatives(&self.unit.scene)?;
        let mut changes = Vec::new();
        for unknown in unknowns.iter() {
            let (output, _) = self.variable(unknown, "Real")?;
            let mut change = 0.0;
            for (known, share) in knowns.iter().zip(direction.iter()) {
                let (input, _) = self.variable(known, "Real")?;
                let (interface, known) = (&self.unit.interface, &mut self.derivatives);
                change += share * interface.derivative(&mut self.simulation, known, [output, input])?;
            }
            changes.push(change);
        }
        Ok(changes)
    }

    /// `fmi2GetRealOutputDerivatives`: of order 1.
    pub(crate) fn output_derivatives(
        &mut self,
        references: Items<Reference>,
        orders: Items<i32>,
    ) -> Result<Vec<f64>, Refusal> {
        self.unit.interface.check_rates(&self.unit.scene)?;
        let mut rates = Vec::new();
        for (reference, order) in references.iter().zip(orders.iter()) {
            let (index, variable) = self.variable(reference, "Real")?;
            if order != 1 {
                return Err(Refusal::Order { order, right: "order 1", reference, name: variable.name.clone() });
            }
            rates.push(self.unit.interface.rate(&mut self.simulation, &mut self.derivatives, index)?);
        }
        Ok(rates)
    }

    /// `fmi2DoStep`
    pub(crate) fn step(&mut self, point: f64, length: f64) -> Result<(), Refusal> {
        let present = self.time();
        if !point.is_finite() {
            let right = "a finite number";
            return Err(Refusal::Time { argument: "currentCommunicationPoint", value: point, right });
        }
        if !length.is_finite() || length <= 0.0 || present + length <= present {
            let right = "a finite number above 0, large enough to change the time,";
            return Err(Refusal::Time { argument: "communicationStepSize", value: length, right });
        }
        // hosts count in nanoseconds or sum up; a step that was left out or done twice differs by far more
        let tolerance = 1e-3 * length + 1e-9 * present.abs();
        if (point - present).abs() > tolerance {
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
        self.stop.store(false, Ordering::Relaxed);
        self.changed();
        self.frames.pass(&self.simulation, Some(point));
        match self.simulation.advance_or_return(length) {
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

    /// `fmi2GetFMUstate`: over the state at `address`, or anew if that is 0. Yields the address.
    pub(crate) fn save(&mut self, address: usize) -> Result<usize, Refusal> {
        if address != 0 && !self.kept.contains_key(&address) {
            return Err(Refusal::Handle);
        }
        self.make()?;
        let (state, given) = (self.simulation.state().clone(), self.made_with.clone());
        let saved = Saved { state, course: self.course, given };
        Ok(self.keep(saved, address))
    }

    /// Keeps a state at `address`, or at a new one if this unit has none there. Yields the address.
    fn keep(&mut self, saved: Saved, address: usize) -> usize {
        if let Some(kept) = self.kept.get_mut(&address) {
            *kept = Kept { saved, bytes: None };
            return address;
        }
        let address = guard::fresh_address();
        self.kept.insert(address, Kept { saved, bytes: None });
        address
    }

    /// `fmi2SetFMUstate`
    pub(crate) fn restore(&mut self, address: usize) -> Result<(), Refusal> {
        let Kept { saved, .. } = self.kept.get(&address).ok_or(Refusal::Handle)?;
        let other = if saved.given == self.made_with { None } else { Some(self.made_with_those_of(saved)?) };
        let course = saved.course;
        // Kept states are those of this instance, or were checked as they came in; a simulation made anew has not seen them yet.
        if let Some(begun) = other {
            begun.simulation.check(&saved.state).map_err(|fault| BlobError::State(fault.into()))?;
            self.given.clone_from(&begun.given);
            self.take(begun);
        }
        self.given.clone_from(&self.made_with);
        self.changed();
        self.simulation.return_to(&self.kept[&address].saved.state);
        self.course = course;
        match course.phase {
            Phase::Ready | Phase::Discarded => self.frames.go_back(&self.simulation, self.start_time(), self.time()),
            Phase::Instantiated | Phase::Initialization => self.frames.undo(),
            Phase::Terminated | Phase::Broken => {}
        }
        Ok(())
    }

    /// `fmi2FreeFMUstate`; freeing nothing is fine.
    pub(crate) fn forget(&mut self, address: usize) -> Result<(), Refusal> {
        if address == 0 {
            return Ok(());
        }
        self.kept.remove(&address).map(drop).ok_or(Refusal::Handle)
    }

    /// Bytes of a saved state.
    fn bytes(&mut self, address: usize) -> Result<&mut Option<Vec<u8>>, Refusal> {
        let kept = self.kept.get_mut(&address).ok_or(Refusal::Handle)?;
        if kept.bytes.is_none() {
            kept.bytes = Some(kept.saved.to_bytes(&self.unit.identity, self.unit.scene.fingerprint));
        }
        Ok(&mut kept.bytes)
    }

    /// `fmi2SerializedFMUstateSize`
    pub(crate) fn serialized_size(&mut self, address: usize) -> Result<usize, Refusal> {
        Ok(self.bytes(address)?.as_ref().map_or(0, Vec::len))
    }

    /// `fmi2SerializeFMUstate`: a large buffer is filled to the number of bytes there are.
    pub(crate) fn serialize(&mut self, address: usize, buffer: &Target<u8>) -> Result<(), Refusal> {
        let given = buffer.len();
        let kept = self.bytes(address)?;
        let needed = kept.as_ref().map_or(0, Vec::len);
        if given < needed {
            return Err(Refusal::Size { given, needed });
        }
        // the bytes are as large as the state; they are made again if they are asked for again
        buffer.put_all(&kept.take().unwrap_or_default());
        Ok(())
    }

    /// `fmi2DeSerializeFMUstate`: over the state at `address`, or anew. Yields the address.
    pub(crate) fn deserialize(&mut self, bytes: &[u8], address: usize) -> Result<usize, Refusal> {
        if address != 0 && !self.kept.contains_key(&address) {
            return Err(Refusal::Handle);
        }
        let saved = Saved::from_bytes(bytes, &self.unit.identity, self.unit.scene.fingerprint)?;
        for (&index, &value) in &saved.given {
            self.unit.interface.check(index, value)?;
        }
        let other = if saved.given == self.made_with { None } else { Some(self.made_with_those_of(&saved)?) };
        let simulation = other.as_ref().map_or(&self.simulation, |begun| &begun.simulation);
        simulation.check(&saved.state).map_err(|fault| BlobError::State(fault.into()))?;
        Ok(self.keep(saved, address))
    }

    /// A simulation with the parameters of a saved state.
    fn made_with_those_of(&self, saved: &Saved) -> Result<Begun, Refusal> {
        self.unit.begin(saved.given.clone()).map_err(|error| Refusal::Parameters { error: error.to_string() })
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // A host must not see a panic, and there is nobody left to tell.
        let _ = catch_unwind(AssertUnwindSafe(|| self.leave_frames()));
    }
}
