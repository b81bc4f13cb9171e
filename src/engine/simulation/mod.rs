//! A simulation: the passes, in their order, over the state.

mod advance;
mod assemble;
mod coefficients;
mod construction;
mod depth;
mod derivatives;
mod exchange;
mod inputs;
mod lists;
mod losses;
mod memory_check;
mod observe;
mod pace;
mod placement;
mod plane;
mod probe;
mod rollback;
mod run_checks;
mod stages;
mod start;
mod state_check;
mod taken_over;
mod time_step;

pub use crate::engine::cell::Fabric;
pub use crate::engine::contacts::{BondRecord, ContactRecord, PlacedSpring};
pub use crate::engine::run_error::{Cause, RunError};
pub use crate::engine::stability::{Limit, Limiter, LimiterKind, Mode};
pub use advance::divide;
pub use coefficients::TuneError;
pub use derivatives::{Input, NoDerivative};
pub use observe::ElasticEnergy;
pub use placement::{PlacedBond, PlacedParticle, Placement};
pub use probe::{Displacement, Probe, ProbeBody};
pub(crate) use run_checks::COLLAPSING_COHESION;
pub use run_checks::number;
pub use stages::{Part, Phase, Stage, all_stages};
pub use taken_over::Description;

use crate::base::lanes::Width;
use crate::base::threads::{self, Context, Threads, Workers};
pub use crate::base::threads::{LoopEvent, LoopWatch};
use crate::engine::bodies::{ClumpBodies, RigidBody, Striker};
use crate::engine::boundaries::course::BoundaryTravel;
use crate::engine::boundaries::loads::BoundaryLoads;
use crate::engine::boundaries::nodes;
use crate::engine::boundaries::passing::Passing;
use crate::engine::cell::Cell;
use crate::engine::contacts::Pass;
use crate::engine::contacts::suppression::Suppression;
use crate::engine::energy;
use crate::engine::flow::Flow;
use crate::engine::fluid::Medium;
use crate::engine::integration::Fields;
use crate::engine::neighbours;
use crate::engine::stability::Vibrations;
use crate::engine::state::State;
use crate::engine::transfer::Transfer;
use crate::laws::contact::impact::ErrorCurve;
use crate::scene::Scene;
use rollback::Rollback;
use stages::Stages;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A scene in motion: its state and the passes composed for it.
pub struct Simulation {
    /// The scene.
    scene: Arc<Scene>,
    /// Everything that changes.
    state: State,
    /// What a time step is made of.
    stages: Stages,
    /// Interactions, in the order they are evaluated.
    passes: Vec<Box<dyn Pass>>,
    /// Gravity, applied forces, damping.
    fields: Fields,
    /// Groups that turn or that forces move; `None` for other boundaries.
    bodies: Vec<Option<RigidBody>>,
    /// What a time step makes of impacts, where it follows them.
    errors: ErrorCurve,
    /// The neighbour search.
    search: neighbours::Search,
    /// How particles came to where they are, as boundaries see it.
    passing: Passing,
    /// Which contacts bonds suppress.
    suppression: Suppression,
    /// The periodic cell, where the scene has one.
    cell: Option<Cell>,
    /// Shapes of clumps, where the scene has any.
    shapes: Option<ClumpBodies>,
    /// What lets heat flow, where any does.
    transfer: Option<Transfer>,
    /// The fluid, where the scene has one.
    medium: Option<Medium>,
    /// What lets particles come and go; none where their number stays.
    flow: Option<Flow>,
    /// Whether anything turns the particles.
    turning: bool,
    /// Whether a servo moves a boundary.
    serves: bool,
    /// Lane width.
    width: Width,
    /// Threads.
    workers: Workers,
    /// Working arrays of a time step.
    workspace: Workspace,
    /// What is needed to return to the beginning of a communication step that fails.
    rollback: Rollback,
    /// A flag that another thread sets to end the present interval.
    stop: Option<Arc<AtomicBool>>,
    /// In benchmarks, the function that is called after each stage of a time step.
    watch: Option<Watch>,
    /// In benchmarks, who is told of the loops.
    loop_watch: Option<LoopWatch>,
}

/// Working arrays of a time step. They are kept so that a step requests no memory.
#[derive(Default)]
struct Workspace {
    /// How far the boundaries moved.
    travels: Vec<BoundaryTravel>,
    /// Their loads in the evaluation before.
    loads: Vec<BoundaryLoads>,
    /// Sum of the forces of global damping then \[N\].
    damping_force: [f64; 3],
    /// Sum of the forces of global damping on bodies of several parts now \[N\].
    braking: [f64; 3],
    /// Nodes of meshes before the time step.
    nodes: nodes::NodeWorkspace,
    /// How many contacts each body has.
    contacts: Vec<u8>,
    /// How bonded bodies vibrate.
    vibrations: Vibrations,
    /// Bonds of each law before some were made.
    bonds: Vec<usize>,
    /// Loads between one kind of force and the next, for the energy book.
    between: energy::PendingWork,
}

/// A function that gets the name of each stage of a time step, or `between time steps`, when it is done, and the state then.
pub type Watch = Box<dyn FnMut(&'static str, &State) + Send>;

impl Simulation {
    /// What passes know while time does not advance.
    fn standing(&self) -> Context<'static> {
        Context { step: 0.0, width: self.width, threads: None, watch: self.loop_watch }
    }

    /// Does work to which the helpers come, if there are any.
    fn with_helpers<T>(&mut self, work: impl FnOnce(&mut Self, Option<&Threads>) -> T) -> T {
        let mut workers = std::mem::take(&mut self.workers);
        let done = workers.run(|threads| work(self, threads));
        self.workers = workers;
        done
    }

    /// The same with helpers only if there are enough particles now: where some come and go their number changes.
    fn worth_while<'a>(&self, all: &Context<'a>) -> Context<'a> {
        Context { threads: all.threads.filter(|_| threads::are_many(self.state.particles.len())), ..*all }
    }

    /// Uses this lane width from now on. Every width gives the same bits.
    pub fn set_width(&mut self, width: Width) {
        self.width = if width.offered() { width } else { Width::Least };
    }

    /// Adds Cundall damping of this fraction, gravity included, to every particle that the scene does not damp.
    pub fn damp_rest(&mut self, fraction: f64) {
        self.rollback.forget();
        self.fields.damp_rest(fraction, self.scene.particles.len());
        self.choose_stages();
    }

    /// Lets temperatures stay as they are from now on: for what is brought to rest in a time that means nothing.
    pub fn hold_temperatures(&mut self) {
        self.rollback.forget();
        self.transfer.iter_mut().for_each(Transfer::hold);
    }

    /// From now on an interval ends after its present time step if this flag is set ([`RunError::Stopped`]).
    pub fn stop_when(&mut self, stop: &Arc<AtomicBool>) {
        self.stop = Some(Arc::clone(stop));
    }

    /// Whether the interval under way is to end.
    fn is_stopped(&self) -> bool {
        self.stop.as_ref().is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    /// Calls this function, from now on, after each stage of a time step: to measure what each costs.
    pub fn watch(&mut self, watch: Watch) {
        self.watch = Some(watch);
    }

    /// Tells this function, from now on, of the loops that threads share: each piece when it is done. For benchmarks.
    pub fn watch_loops(&mut self, watch: LoopWatch) {
        self.loop_watch = Some(watch);
    }

    /// What stands for bodies of several spheres where impacts are foreseen.
    fn strikers(&self) -> &[Striker] {
        self.shapes.as_ref().map_or(&[][..], ClumpBodies::strikers)
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
}
