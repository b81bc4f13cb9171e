//! One time step: the passes, in their order, over the state.

mod assemble;
mod coefficients;
mod depth;
mod derivatives;
mod exchange;
mod limits;
mod losses;
mod observe;
mod placement;
mod plane;
mod probe;
mod room;
mod run_checks;
mod sight;
mod start;
mod state_check;
mod sweeps;
mod taken_over;
mod way_back;

pub use crate::interactions::{BondRecord, ContactRecord, PlacedSpring};
pub use crate::run_error::{Cause, RunError};
pub use crate::stability::{Limit, Limiter, LimiterKind, Mode};
pub use coefficients::TuneError;
pub use derivatives::{Input, NoDerivative};
pub use limits::LONGEST_AUTOMATIC_STEP;
pub use observe::ElasticEnergy;
pub use placement::{PlacedBond, PlacedParticle, Placement};
pub use probe::{Displacement, Probe, ProbeBody};
pub(crate) use run_checks::COLLAPSING_COHESION;
pub use run_checks::number;
pub use taken_over::Description;

use crate::bond::creation::Moment;
use crate::boundaries::felt::{self, Felt, Swept};
use crate::boundaries::{RigidBody, course, nodes, rigid_body};
use crate::flow::Flow;
use crate::geometry::Quaternion;
use crate::integration::{self, Fields};
use crate::interactions::Pass;
use crate::interactions::suppression::Suppression;
use crate::lanes::Width;
use crate::motion::Progress;
use crate::quantity::BoundaryIndex;
use crate::scene::Scene;
use crate::state::{BoundaryState, Foresight, State, StateFault};
use crate::threads::{Context, Threads, Workers};
use crate::{books, neighbours};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use way_back::WayBack;

/// An interval this close to a whole number of time steps (over the time step) counts as that number.
const WHOLE: f64 = 1e-6;

/// A scene in motion: its state and the passes composed for it.
pub struct Simulation {
    /// The scene.
    scene: Arc<Scene>,
    /// Everything that changes.
    state: State,
    /// Interactions, in the order they are evaluated.
    passes: Vec<Box<dyn Pass>>,
    /// Gravity, applied forces, damping.
    fields: Fields,
    /// Groups that turn or that forces move; `None` for other boundaries.
    bodies: Vec<Option<RigidBody>>,
    /// The neighbour search.
    search: neighbours::Search,
    /// Which contacts bonds suppress.
    suppression: Suppression,
    /// What lets particles come and go; none where their number stays.
    flow: Option<Flow>,
    /// Whether anything turns the particles.
    turning: bool,
    /// Whether a servo moves a boundary.
    serves: bool,
    /// Whether dashpots of bonds are integrated by themselves.
    splits: bool,
    /// Whether such bonds may belong to a boundary.
    leads: bool,
    /// [`plane::permits_plane_rows`]
    permits_plane_rows: bool,
    /// Lane width.
    width: Width,
    /// Threads.
    workers: Workers,
    /// Working space of a time step.
    room: Room,
    /// What is needed to return to the beginning of a communication step that fails.
    way_back: WayBack,
    /// A flag that another thread sets to end the present interval.
    stop: Option<Arc<AtomicBool>>,
    /// In benchmarks, the function that is called after each part of a time step.
    watch: Option<Watch>,
}

/// Working space of a time step. It is kept so that a step requests no memory.
#[derive(Default)]
struct Room {
    /// Ways of the boundaries.
    ways: Vec<course::Way>,
    /// Their loads in the last step.
    loads: Vec<Felt>,
    /// What a sweep did to them.
    swept: Vec<Swept>,
    /// How they stood before a sweep.
    led: Vec<BoundaryState>,
    /// Nodes of meshes before the time step.
    nodes: nodes::Before,
    /// Bonds of each law before some were made.
    bonds: Vec<usize>,
    /// Loads between one kind of force and the next, for the energy book.
    between: books::Between,
}

/// A function that gets the name of each part of a time step when it is done.
pub type Watch = Box<dyn FnMut(&'static str) + Send>;

impl Simulation {
    /// The scene at time 0: bonds made, forces evaluated, springs unmoved.
    pub fn new(scene: Arc<Scene>) -> Result<Self, RunError> {
        let state = assemble::state(&scene);
        let mut simulation = Self::with(scene, state);
        simulation.begin()?;
        Ok(simulation)
    }

    /// The scene in a state saved earlier, which is checked first ([`Simulation::check`]).
    pub fn resume(scene: Arc<Scene>, state: State) -> Result<Self, StateFault> {
        let first = assemble::state(&scene);
        let mut simulation = Self::with(scene, first);
        simulation.check(&state)?;
        simulation.state = state;
        simulation.take_coefficients();
        Ok(simulation)
    }

    /// The scene in a state of its own.
    fn with(scene: Arc<Scene>, state: State) -> Self {
        let passes = assemble::passes(&scene);
        let turning = passes.iter().any(|pass| pass.has_torque());
        let flow = Flow::of(&scene, passes.iter().any(|pass| pass.needs_orientations()));
        let splits = passes.iter().any(|pass| pass.sweeps());
        let mut simulation = Self {
            turning,
            leads: sweeps::leads(&scene),
            splits,
            passes,
            fields: Fields::of(&scene),
            bodies: rigid_body::of(&scene),
            serves: scene.boundaries.iter().any(|boundary| boundary.axes.iter().any(|axis| axis.servo().is_some())),
            permits_plane_rows: plane::permits_plane_rows(&scene, turning, flow.is_some() || splits),
            flow,
            search: neighbours::Search::of(&scene),
            suppression: Suppression::of(&scene),
            width: Width::widest(),
            workers: Workers::new(scene.run.threads, most_particles(&scene)),
            scene,
            state,
            room: Room::default(),
            way_back: WayBack::default(),
            stop: None,
            watch: None,
        };
        simulation.take_coefficients();
        simulation
    }

    /// Builds the scene and evaluates the forces, springs unmoved.
    fn begin(&mut self) -> Result<(), RunError> {
        self.build()?;
        self.start()
    }

    /// Makes the lists and the first bonds.
    fn build(&mut self) -> Result<(), RunError> {
        self.give_orientations();
        rigid_body::place_groups(&self.scene, &self.bodies, &mut self.state);
        self.check_room()?;
        let context = self.standing();
        self.rebuild(&context);
        let time = self.state.clock.time;
        self.bond(&Moment { number: self.state.clock.steps, from: time, to: time }, &context);
        Ok(())
    }

    /// Gives the particles the orientation of time 0, where a bond needs one and they have none.
    fn give_orientations(&mut self) {
        if self.passes.iter().any(|pass| pass.needs_orientations()) {
            self.state.particles.orientation.resize(self.state.particles.len(), Quaternion::identity().to_row());
        }
    }

    /// Makes the bonds that are to be made at this moment.
    fn bond(&mut self, moment: &Moment, context: &Context) {
        let mut made = false;
        self.suppression.count_bonds(&self.state, &mut self.room.bonds);
        for pass in &self.passes {
            made |= pass.create(&mut self.state, moment, context.step);
        }
        if made {
            if moment.number > 0 && self.suppression.any() {
                self.suppression.made(&mut self.state, &self.room.bonds);
            }
            self.rebuild(context);
            if moment.number == 0 {
                self.suppression.begin_offsets(&mut self.state);
            }
        }
    }

    /// Makes new neighbour lists, as happens from time to time by motion: results change by rounding only.
    pub fn renew_lists(&mut self) {
        self.way_back.forget();
        let mut workers = std::mem::take(&mut self.workers);
        workers.run(|threads| self.rebuild(&Context { step: 0.0, width: self.width, threads }));
        self.workers = workers;
    }

    /// What passes know while time does not advance.
    fn standing(&self) -> Context<'static> {
        Context { step: 0.0, width: self.width, threads: None }
    }

    /// Makes the lists anew.
    fn rebuild(&mut self, context: &Context) {
        self.search.rebuild(&mut self.state, context);
        self.suppression.flag(&mut self.state);
        for pass in &self.passes {
            pass.prepare(&mut self.state);
        }
    }

    /// Restores a state of this simulation, which is checked first ([`Simulation::check`]); the simulation continues from
    /// there bit for bit.
    pub fn restore(&mut self, state: &State) -> Result<(), StateFault> {
        self.check(state)?;
        self.return_to(state);
        Ok(())
    }

    /// Goes back to a state that this simulation was in, or one that has been checked: it is not looked at again.
    pub fn return_to(&mut self, state: &State) {
        self.way_back.forget();
        let same = self.state.coefficients == state.coefficients && self.state.tuned == state.tuned;
        self.state.clone_from(state);
        if !same {
            self.take_coefficients();
        }
    }

    /// Uses this lane width from now on. Every width gives the same bits.
    pub fn set_width(&mut self, width: Width) {
        self.width = if width.offered() { width } else { Width::Least };
    }

    /// Adds Cundall damping of this fraction, gravity included, to every particle that the scene does not damp.
    pub fn damp_rest(&mut self, fraction: f64) {
        self.way_back.forget();
        self.fields.damp_rest(fraction, self.scene.particles.len());
    }

    /// From now on an interval ends after its present time step if this flag is set ([`RunError::Stopped`]).
    pub fn stop_when(&mut self, stop: &Arc<AtomicBool>) {
        self.stop = Some(Arc::clone(stop));
    }

    /// Whether the interval under way is to end.
    fn is_stopped(&self) -> bool {
        self.stop.as_ref().is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    /// Calls this function, from now on, after each part of a time step: to measure what each part costs.
    pub fn watch(&mut self, watch: Watch) {
        self.watch = Some(watch);
    }

    /// Tells that a part of a time step is done.
    fn done(&mut self, part: &'static str) {
        if let Some(watch) = &mut self.watch {
            watch(part);
        }
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Everything that changes, at the present time.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The present time \[s\].
    pub fn time(&self) -> f64 {
        self.state.clock.time
    }

    /// Sets the input of an axis for the next interval, along x, y, z (0 to 2) or about them (3 to 5): where a driven axis
    /// is to be at its end \[m, rad\] or how fast it moves \[m/s, rad/s\], the load on one that forces move \[N, N m\], the force
    /// that a servo is to reach \[N\].
    pub fn set_input(&mut self, boundary: BoundaryIndex, axis: usize, value: f64) {
        let boundary = &mut self.state.boundaries[boundary.index()];
        boundary.target[axis] = value;
        boundary.target_rate[axis] = 0.0;
        if let Some(acceleration) = boundary.target_acceleration.get_mut(axis) {
            *acceleration = 0.0;
        }
    }

    /// Sets where a node of a mesh, by its number from 0, is to be at the end of the next interval, along x, y or z \[m\].
    pub fn set_node(&mut self, boundary: BoundaryIndex, (node, axis): (usize, usize), value: f64) {
        if let Some(nodes) = self.state.nodes_of_mut(boundary.index()) {
            nodes.target[node][axis] = value;
            nodes.target_rate[node][axis] = 0.0;
        }
    }

    /// The rate of that value over the next interval \[m/s\].
    pub fn set_node_rate(&mut self, boundary: BoundaryIndex, (node, axis): (usize, usize), rate: f64) {
        if let Some(nodes) = self.state.nodes_of_mut(boundary.index()) {
            nodes.target_rate[node][axis] = rate;
        }
    }

    /// The rate of that value over the next interval: it then ends at the value plus rate × interval.
    pub fn set_input_rate(&mut self, boundary: BoundaryIndex, axis: usize, rate: f64) {
        self.state.boundaries[boundary.index()].target_rate[axis] = rate;
    }

    /// The second derivative of that value over the next interval, along x, y or z: the axis then moves at this acceleration, and ends
    /// at the value plus rate × interval + ½ acceleration × interval² \[m/s²\].
    pub fn set_input_acceleration(&mut self, boundary: BoundaryIndex, axis: usize, acceleration: f64) {
        self.state.boundaries[boundary.index()].target_acceleration[axis] = acceleration;
    }

    /// Runs one communication step of `interval` \[s\]: driven axes arrive at its end.
    ///
    /// An error that is found before a step ([`RunError::Runaway`]) leaves the state of the last good time step, at
    /// [`Simulation::time`]. An error that a step itself causes leaves the state after that step, which serves to find
    /// the cause only: to be able to go on, keep a copy of the state.
    pub fn advance(&mut self, interval: f64) -> Result<(), RunError> {
        if !interval.is_finite() || interval <= 0.0 {
            return Err(RunError::Interval { interval });
        }
        course::begin(&self.scene, &mut self.state, interval)?;
        nodes::begin(&self.scene, &mut self.state, interval);
        self.state.breaks.clear();
        if let Some(flow) = &self.flow {
            flow.begin(&mut self.state, interval);
        }
        let mut workers = std::mem::take(&mut self.workers);
        let (elapsed, result) = workers.run(|threads| self.run(interval, threads));
        self.workers = workers;
        self.show_swept();
        course::end(&mut self.state, elapsed);
        nodes::end(&mut self.state, elapsed);
        if let Some(flow) = &self.flow {
            flow.end(&mut self.state, elapsed);
        }
        result.map_err(|error| self.named(error))
    }

    /// Makes the time steps of a communication step and looks at where they led. Returns how long they took \[s\], and why they
    /// ended early.
    fn run(&mut self, interval: f64, threads: Option<&Threads>) -> (f64, Result<(), RunError>) {
        let (elapsed, result) = self.make_steps(interval, threads);
        self.leave_plane_rows(&Context { threads, ..self.standing() });
        (elapsed, result.and_then(|()| self.check_domain()).and_then(|()| self.check_plane()))
    }

    /// Makes as many time steps as fit when a communication step begins; where the stable one becomes shorter on the way, the
    /// rest is divided again.
    fn make_steps(&mut self, interval: f64, threads: Option<&Threads>) -> (f64, Result<(), RunError>) {
        let standing = Context { threads, ..self.standing() };
        let mut boundaries = self.boundary_speed();
        let (_, step) = divide(interval, self.state.clock.step);
        if self.is_due(boundaries, step) {
            if let Err(error) = self.look(step, &Context { step, ..standing }) {
                return (0.0, Err(error));
            }
            self.shorten_step();
        }
        self.lengthen_step();
        let (count, step) = divide(interval, self.state.clock.step);
        let length = count as f64 * step;
        let mut progress = Progress { done: 0, count, step, time: 0.0, passed: 0.0, length };
        while progress.done < progress.count {
            let (step, elapsed) = (progress.step, |done: u64| progress.passed * length + done as f64 * progress.step);
            self.use_plane_rows(progress.count - progress.done, &standing);
            if let Err(error) = self.check_way(step) {
                return (elapsed(progress.done), Err(error));
            }
            if self.is_stopped() {
                return (elapsed(progress.done), Err(RunError::Stopped { time: self.time() }));
            }
            progress.done += 1;
            let (context, elapsed) = (Context { step, ..standing }, elapsed(progress.done));
            if let Err(error) = self.step(progress, &context) {
                return (elapsed, Err(error));
            }
            if self.boundaries_change_speed() {
                boundaries = self.boundary_speed();
            }
            if !self.is_due(boundaries, step) {
                continue;
            }
            self.leave_plane_rows(&standing);
            if let Err(error) = self.check_plane().and_then(|()| self.look(step, &Context { step, ..standing })) {
                return (elapsed, Err(error));
            }
            if self.shorten_step() && progress.done < progress.count {
                let (count, step) = divide(length - elapsed, self.state.clock.step);
                progress = Progress { done: 0, count, step, passed: elapsed / length, ..progress };
            }
        }
        (progress.passed * length + progress.done as f64 * progress.step, Ok(()))
    }

    /// Makes one time step.
    fn step(&mut self, progress: Progress, context: &Context) -> Result<(), RunError> {
        let step = progress.step;
        let earlier = self.state.clock.time;
        self.state.clock.advance(step);
        self.state.clock.steps += 1;
        self.state.clock.last_step = step;
        self.sweep_before(Progress { time: self.state.clock.time, ..progress }, context);
        books::work::book_first(&mut self.state, &self.fields, &self.bodies, step);
        books::losses::begin_step(&mut self.state, &self.fields, &self.bodies, step);
        let speed = match self.state.particles.plane_rows {
            true => integration::plane::kick_and_drift(&mut self.state.particles, step, context),
            false => integration::kick_and_drift(&mut self.state.particles, step, self.turning, context),
        };
        integration::turn(&mut self.state.particles, step, context);
        self.done("kick and drift");
        let time = self.state.clock.time;
        let Room { ways, nodes, .. } = &mut self.room;
        let progress = Progress { time, ..progress };
        course::advance(&self.scene, &self.bodies, &mut self.state, progress, ways);
        nodes::advance(&self.scene, &mut self.state, &progress, nodes, ways);
        rigid_body::place_groups(&self.scene, &self.bodies, &mut self.state);
        let ways = &self.room.ways;
        let carried = ways.iter().fold(0.0, |most: f64, way| most.max(way.carried));
        let before = self.state.neighbours.travel;
        let travelled = [before, before + (speed * step).max(carried)];
        self.state.neighbours.travel = travelled[1];
        let extents = self.state.neighbours.boundary_extent.iter().copied().chain(std::iter::repeat(0.0));
        let ways = ways.iter().zip(extents).map(|(way, extent)| way.farthest(extent));
        let farthest = ways.fold(speed * step, f64::max);
        self.state.foresight.travel += farthest;
        let outdated = self.search.outdated(&mut self.state, context);
        let mut result = if self.is_depth_due(speed * step, travelled) { self.check_depth() } else { Ok(()) };
        let changed = self.exchange(farthest, step);
        if outdated || !matches!(changed, Ok(false)) {
            result = result.and(changed.map(|_| ())).and_then(|()| self.check_domain());
            self.rebuild(context);
        }
        if !self.scene.bonds.is_empty() {
            let number = self.state.clock.steps;
            self.bond(&Moment { number, from: earlier, to: time }, context);
        }
        self.done("lists and boundaries");
        felt::clear_loads(&mut self.state, &mut self.room.loads);
        nodes::clear_loads(&mut self.state, &mut self.room.nodes);
        let damping_before = self.state.damping_force;
        let gravity = self.fields.weight_alone().filter(|_| !self.books_after_sweeps());
        result = result.and(self.evaluate(gravity.is_none(), context));
        self.follow_contacts(step);
        match self.books_after_sweeps() {
            false => self.book_second(gravity, step, context),
            true => books::work::book_bodies(&mut self.state, &self.fields, &self.bodies, step),
        }
        books::losses::book_bodies(&mut self.state, &self.fields, &self.bodies, step);
        let speed = match self.state.particles.plane_rows {
            true => integration::plane::kick_again(&mut self.state.particles, gravity, step, context),
            false => integration::kick_again(&mut self.state.particles, gravity, step, self.turning, context),
        };
        let free_groups = rigid_body::kick_again(&self.bodies, &mut self.state, step);
        let speed = if free_groups > speed || free_groups.is_nan() { free_groups } else { speed };
        self.state.clock.speed = speed;
        self.sweep_after(&progress, context);
        self.done("kick");
        felt::book(&self.scene, &mut self.state, &self.room.loads, &self.room.ways, &progress);
        nodes::book(&mut self.state, &self.room.nodes, step);
        for axis in 0..3 {
            self.state.damping_impulse[axis] += 0.5 * step * (damping_before[axis] + self.state.damping_force[axis]);
        }
        if !speed.is_finite() {
            result = Err(self.not_finite());
        }
        result
    }

    /// Evaluates all forces and torques at the present positions, the fields among them if asked for. Loads of the
    /// particles must be zero.
    fn evaluate(&mut self, fields: bool, context: &Context) -> Result<(), RunError> {
        let (mut result, told) = (Ok(()), self.state.breaks.len());
        self.room.between.begin();
        for place in 0..self.passes.len() {
            let pass = &self.passes[place];
            result = result.and(pass.apply(&mut self.state, context));
            let (source, next) = (pass.source(), self.passes.get(place + 1).map(|next| next.source()));
            if next != Some(source) {
                self.room.between.note(&mut self.state, &self.bodies, source, next);
                self.done(source.name());
            }
        }
        if fields && self.fields.act() {
            self.room.between.note_before_fields(&self.state);
        }
        let state = &mut self.state;
        self.suppression.broken(state, told);
        self.suppression.settle(state);
        felt::sum_groups(&self.scene, state);
        state.damping_force = if fields { self.fields.apply(state, context) } else { [0.0; 3] };
        let braking = self.fields.load_bodies(&self.bodies, state);
        for (sum, part) in state.damping_force.iter_mut().zip(braking) {
            *sum += part;
        }
        self.done("fields");
        result
    }

    /// Whether the energy book looks at velocities after a sweep that follows the second half kick. Weights are then among the forces.
    fn books_after_sweeps(&self) -> bool {
        self.splits && self.state.ledger.is_some()
    }

    /// Books the half kick that is about to end a step of this length \[s\], with gravity \[m/s²\] where that is not yet among the
    /// forces.
    fn book_second(&mut self, gravity: Option<[f64; 3]>, step: f64, context: &Context) {
        let between = &mut self.room.between;
        books::work::book_second(&mut self.state, between, (&self.fields, gravity), &self.bodies, step, context);
    }

    /// The evaluation before the first step, and what follows from it.
    fn start(&mut self) -> Result<(), RunError> {
        self.state.begin_counting();
        felt::clear_loads(&mut self.state, &mut self.room.loads);
        nodes::clear_loads(&mut self.state, &mut self.room.nodes);
        let context = self.standing();
        integration::clear_loads(&mut self.state.particles);
        let result = self.evaluate(true, &context);
        self.book_second(None, 0.0, &context);
        self.show_swept();
        self.open_energy_book();
        result.map_err(|error| self.named(error))?;
        self.state.foresight = Foresight::default();
        self.first_step(&context)?;
        self.find_impedances();
        let step = self.state.clock.step;
        let groups = rigid_body::coming_speed(&self.bodies, &self.state, step);
        self.state.clock.speed = integration::coming_speed(&self.state.particles, step).max(groups);
        self.check_present()
    }
}

/// So many particles may be there as make threads worth while.
fn most_particles(scene: &Scene) -> usize {
    if scene.insertions.is_empty() { scene.particles.len() } else { usize::MAX }
}

/// Divides an interval into equal time steps: of exactly `step`, where a whole number of them fits, otherwise shorter.
pub fn divide(interval: f64, step: f64) -> (u64, f64) {
    let ratio = interval / step;
    let whole = ratio.round();
    if whole >= 1.0 && (ratio - whole).abs() <= WHOLE {
        return (whole as u64, step);
    }
    let count = ratio.ceil().max(1.0);
    (count as u64, interval / count)
}
