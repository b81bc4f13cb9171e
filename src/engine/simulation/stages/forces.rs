//! What the stages of the forces do.

use super::super::Simulation;
use super::super::time_step::TimeStep;
use crate::base::threads::Context;
use crate::engine::bodies::{self, RigidBody};
use crate::engine::boundaries::{loads, nodes};
use crate::engine::fluid;
use crate::engine::state::ledger::Source;

impl Simulation {
    /// Whether there are forces of this kind.
    pub(super) fn acts(&self, source: Source) -> bool {
        self.passes.iter().any(|pass| pass.source() == source)
    }

    /// Whether passes act in a periodic cell.
    pub(super) fn is_cell_loaded(&self) -> bool {
        self.cell.is_some() && !self.passes.is_empty()
    }

    /// Whether anything but particles moves by forces, or gathers those on its particles.
    pub(super) fn has_bodies(&self) -> bool {
        let is_body = |body: &RigidBody| body.is_free();
        self.shapes.is_some()
            || self.bodies.iter().flatten().any(is_body)
            || self.scene.boundaries.iter().any(|boundary| !boundary.shape.members().is_empty())
    }

    /// Sets the loads of boundaries and nodes to zero, and notes what they and the force of global damping were.
    pub(super) fn begin_loads(&mut self) {
        let Self { state, workspace, .. } = self;
        loads::clear(state, &mut workspace.loads);
        nodes::clear_loads(state, &mut workspace.nodes);
        workspace.damping_force = state.damping_force;
        workspace.between.begin();
    }

    /// Gives contacts the temperatures between which heat flows, and room for what they are about to lose.
    pub(super) fn begin_heat(&mut self, context: &Context) {
        let Self { transfer, scene, passes, state, .. } = self;
        if let Some(transfer) = transfer {
            transfer.prepare((scene, passes), state, context);
        }
    }

    /// Gives passes the velocities that include the streaming motion of the cell.
    pub(super) fn stream(&mut self, context: &Context) {
        if let Some(cell) = &mut self.cell {
            cell.stream(&mut self.state, context);
        }
    }

    /// Adds the forces of one kind, law by law.
    pub(super) fn act(&mut self, source: Source, step: &mut TimeStep) {
        for pass in self.passes.iter().filter(|pass| pass.source() == source) {
            step.note(pass.apply(&mut self.state, step.context));
        }
    }

    /// Adds the forces of bonds.
    pub(super) fn act_by_bonds(&mut self, step: &mut TimeStep) {
        step.broken = self.state.breaks.len();
        self.act(Source::Bonds, step);
    }

    /// Images hand on their loads.
    pub(super) fn gather_images(&mut self) {
        if let Some(cell) = &self.cell {
            cell.gather_images(&mut self.state);
        }
    }

    /// Notes the loads on bodies so far, of which the last are of this kind.
    pub(super) fn book_on_bodies(&mut self, source: Source) {
        bodies::book::note(&mut self.state, &self.bodies, source);
    }

    /// Finds the virial, and takes the streaming motion out of the velocities.
    pub(super) fn find_virial(&mut self, step: &mut TimeStep) {
        if let Some(cell) = &mut self.cell {
            cell.find_virial(&mut self.state, step.context);
        }
    }

    /// Lets the contacts of bonds that broke act again, and those of bonds that were made in this step no longer.
    pub(super) fn release_contacts(&mut self, step: &mut TimeStep) {
        self.suppression.broken(&mut self.state, step.broken);
        self.suppression.settle(&mut self.state);
    }

    /// Adds the forces of the fluid to those on particles.
    pub(super) fn act_by_fluid(&mut self, step: &mut TimeStep) {
        let Self { medium, fields, state, workspace, .. } = self;
        if let Some(medium) = medium {
            workspace.between.before_fields(state);
            fluid::load(medium, state, fields, step.context);
        }
    }

    /// Puts the whole load on bodies.
    pub(super) fn load_bodies(&mut self, context: &Context) {
        let Self { scene, fields, medium, bodies, state, workspace, .. } = self;
        loads::sum_groups(scene, state);
        workspace.braking = bodies::loads::load((fields, medium.as_ref()), bodies, state, context);
    }
}
