//! How a simulation comes into being: built from a scene, or taken over with a state of it.

use super::rollback::Rollback;
use super::stages::Stages;
use super::{RunError, Simulation, Workspace, assemble};
use crate::base::geometry::Quaternion;
use crate::base::lanes::Width;
use crate::base::threads::{Context, Threads, Workers};
use crate::engine::bodies::{self, ClumpBodies, boundary};
use crate::engine::boundaries::passing::Passing;
use crate::engine::cell::Cell;
use crate::engine::contacts::suppression::Suppression;
use crate::engine::energy::PendingWork;
use crate::engine::flow::Flow;
use crate::engine::fluid::{self, Medium};
use crate::engine::integration::{self, Fields};
use crate::engine::neighbours;
use crate::engine::state::{Foresight, Pace, State, StateFault};
use crate::engine::transfer::{self, Transfer};
use crate::laws::bond::creation::Moment;
use crate::laws::contact::impact::ErrorCurve;
use crate::scene::Scene;
use std::sync::Arc;

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
    pub(super) fn with(scene: Arc<Scene>, state: State) -> Self {
        let passes = assemble::passes(&scene);
        let medium = Medium::of(&scene);
        let turning = passes.iter().any(|pass| pass.has_torque()) || medium.as_ref().is_some_and(Medium::has_torque);
        let flow = Flow::of(&scene, passes.iter().any(|pass| pass.needs_orientations()));
        let workspace = Workspace { between: PendingWork::of(&passes), ..Workspace::default() };
        let mut simulation = Self {
            turning,
            stages: Stages::default(),
            passes,
            fields: Fields::of(&scene),
            bodies: boundary::of(&scene),
            serves: scene.boundaries.iter().any(|boundary| boundary.axes.iter().any(|axis| axis.servo().is_some())),
            cell: Cell::of(&scene),
            shapes: ClumpBodies::of(&scene),
            flow,
            medium,
            transfer: Transfer::of(&scene),
            errors: ErrorCurve::default(),
            search: neighbours::Search::of(&scene),
            passing: Passing::of(&scene),
            suppression: Suppression::of(&scene),
            width: scene.run.width.unwrap_or_else(Width::widest),
            workers: Workers::new(scene.run.threads, most_particles(&scene)),
            scene,
            state,
            workspace,
            rollback: Rollback::default(),
            stop: None,
            watch: None,
            loop_watch: None,
        };
        simulation.take_coefficients();
        simulation.choose_stages();
        simulation
    }

    /// Builds the scene and evaluates the forces, springs unmoved.
    fn begin(&mut self) -> Result<(), RunError> {
        self.build()?;
        self.start()
    }

    /// Makes the lists and the first bonds.
    pub(super) fn build(&mut self) -> Result<(), RunError> {
        self.give_orientations();
        boundary::place_groups(&self.scene, &self.bodies, &mut self.state);
        if let Some(clumps) = &self.shapes {
            clumps.place(&mut self.state);
        }
        self.check_memory()?;
        self.with_helpers(|it, threads| {
            let context = Context { threads, ..it.standing() };
            it.rebuild(&context);
            let time = it.state.clock.time;
            it.make_bonds(&Moment { number: it.state.clock.steps, from: time, to: time }, &context);
        });
        Ok(())
    }

    /// Gives the particles the orientation of time 0, where a bond needs one and they have none.
    pub(super) fn give_orientations(&mut self) {
        if self.passes.iter().any(|pass| pass.needs_orientations()) {
            self.state.particles.orientation.resize(self.state.particles.len(), Quaternion::identity().to_row());
        }
    }

    /// The evaluation before the first step, and what follows from it.
    pub(super) fn start(&mut self) -> Result<(), RunError> {
        self.with_helpers(Self::start_with)
    }

    /// The same, with these helpers.
    fn start_with(&mut self, threads: Option<&Threads>) -> Result<(), RunError> {
        transfer::take(&self.scene, &mut self.state);
        self.state.begin_counting();
        let context = Context { threads, ..self.standing() };
        fluid::renew(self.medium.as_ref(), &self.scene, &mut self.state, &context);
        let result = self.evaluate(&context);
        self.book_second_kick(None, &context);
        self.open_energy_book();
        self.look_at_heat();
        result.map_err(|error| self.named(error))?;
        (self.state.foresight, self.state.pace) = (Foresight::default(), Pace::default());
        self.state.clock.speed = self.coming_speed(0.0);
        self.find_pace(self.state.clock.speed.max(self.boundary_speed()), true, &context);
        self.first_step(&context)?;
        self.look_at_pressed();
        self.look_at_cell();
        let step = self.state.clock.step;
        self.state.clock.speed = self.coming_speed(step);
        self.check_present()
    }

    /// Largest speed of what forces move, at the middle of a step of this length \[s\], from rest or not \[m/s\].
    fn coming_speed(&self, step: f64) -> f64 {
        if self.scene.heat.frozen {
            return 0.0;
        }
        let bodies = bodies::coming_speed(&self.bodies, &self.state, step);
        integration::coming_speed(&self.state.particles, step).max(bodies)
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
        self.rollback.forget();
        self.transfer.iter_mut().for_each(Transfer::forget);
        let same = self.state.coefficients == state.coefficients && self.state.tuned == state.tuned;
        self.state.clone_from(state);
        if !same {
            self.take_coefficients();
        }
    }
}

/// So many particles may be there as make threads worth while.
fn most_particles(scene: &Scene) -> usize {
    if scene.insertions.is_empty() { scene.particles.len() } else { usize::MAX }
}
