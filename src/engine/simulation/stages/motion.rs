//! What the stages of the motion do: half a kick and the drift, and what follows from where everything stands then.

use super::super::Simulation;
use super::super::time_step::TimeStep;
use crate::engine::bodies::boundary;
use crate::engine::boundaries::{course, nodes};
use crate::engine::fluid::{self, Kick};
use crate::engine::{energy, integration};

impl Simulation {
    /// Whether a book of energy is kept.
    pub(super) fn keeps_books(&self) -> bool {
        self.state.ledger.is_some() || self.state.losses.is_some()
    }

    /// Whether particles have orientations.
    pub(super) fn has_orientations(&self) -> bool {
        self.passes.iter().any(|pass| pass.needs_orientations())
    }

    /// Whether there are boundaries.
    pub(super) fn has_boundaries(&self) -> bool {
        !self.scene.boundaries.is_empty()
    }

    /// Books the half kick that is about to begin the step.
    pub(super) fn book_first_half(&mut self, step: &mut TimeStep) {
        let length = step.length();
        energy::work::book_first(&mut self.state, &self.fields, &self.bodies, length);
        energy::losses::begin_step(&mut self.state, &self.fields, &self.bodies, length);
    }

    /// Books what the fluid does in the half kick that is about to begin the step.
    pub(super) fn book_fluid_first(&mut self, step: &mut TimeStep) {
        if let Some(medium) = &mut self.medium {
            fluid::book(medium, &mut self.state, Kick::First, step.context);
        }
    }

    /// Whether added mass is carried by a fluid whose velocity changes in time.
    pub(super) fn is_fluid_accelerated(&self) -> bool {
        self.scene.fluid.as_ref().is_some_and(|fluid| fluid.added_mass.is_some() && fluid.velocity.changes())
    }

    /// Gives the half kick that is about to begin the step what it lacks of the acceleration of the fluid.
    pub(super) fn accelerate_by_fluid(&mut self, step: &mut TimeStep) {
        if let Some(medium) = &mut self.medium {
            fluid::accelerate(medium, &self.scene, &mut self.state, &step.progress, step.context);
        }
    }

    /// Brings the velocity of the fluid to the end of the step.
    pub(super) fn advance_fluid(&mut self, step: &mut TimeStep) {
        if let (Some(fluid), Some(state)) = (&self.scene.fluid, &mut self.state.fluid) {
            fluid::advance(fluid, state, &step.progress);
        }
    }

    /// Makes the first half of the kick and the drift of the particles that forces move. Their loads are zero then.
    pub(super) fn kick_and_drift(&mut self, step: &mut TimeStep) {
        let sweep = integration::Sweep { turning: self.turning, in_fluid: self.scene.fluid.is_some() };
        let particles = &mut self.state.particles;
        let speed = integration::kick_and_drift(particles, step.length(), sweep, step.context);
        step.way = speed * step.length();
    }

    /// Turns the particles that have an orientation.
    pub(super) fn turn_particles(&mut self, step: &mut TimeStep) {
        integration::turn(&mut self.state.particles, step.length(), step.context);
    }

    /// Makes the first half of the kick and the drift of clumps.
    pub(super) fn move_clumps(&mut self, step: &mut TimeStep) {
        let Some(clumps) = &self.shapes else { return };
        let speed = clumps.kick_and_drift(&mut self.state, step.length(), step.context);
        step.way = step.way.max(speed * step.length());
    }

    /// Moves boundaries and their nodes to where they stand at the end of the step, groups with their particles.
    pub(super) fn move_boundaries(&mut self, step: &mut TimeStep) {
        let Self { scene, bodies, state, workspace, .. } = self;
        course::advance(scene, bodies, state, step.progress, &mut workspace.travels);
        nodes::advance(scene, state, &step.progress, &mut workspace.travels);
        boundary::place_groups(scene, bodies, state);
    }

    /// Deforms the periodic cell.
    pub(super) fn deform_cell(&mut self, step: &mut TimeStep) {
        let Some(cell) = &mut self.cell else { return };
        match cell.advance(&mut self.state, &step.progress, step.context) {
            Ok(strain) => step.strain = strain,
            Err(error) => step.stop(error),
        }
    }

    /// Looks for particles that a group went over.
    pub(super) fn look_for_passed(&mut self, step: &mut TimeStep) {
        step.note(self.check_groups(step.length()));
    }

    /// Makes the bonds that are due.
    pub(super) fn make_due_bonds(&mut self, step: &mut TimeStep) {
        self.make_bonds(&step.moment, step.context);
    }
}
