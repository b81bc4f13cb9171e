//! What the stages of the second half kick do.

use super::super::Simulation;
use super::super::time_step::TimeStep;
use crate::base::number::larger;
use crate::base::threads::Context;
use crate::engine::bodies::{book, boundary};
use crate::engine::boundaries::{loads, nodes};
use crate::engine::fluid::{self, Kick};
use crate::engine::transfer::Transfer;
use crate::engine::{energy, integration, transfer};

impl Simulation {
    /// Lets heat flow between what touches now.
    pub(super) fn transfer_heat(&mut self, step: &mut TimeStep) {
        let Self { transfer, scene, passes, state, .. } = self;
        if let Some(transfer) = transfer {
            transfer.advance((scene, passes), state, &step.progress, step.context);
        }
    }

    /// Lets heat flow between the fluid and what stands in it.
    pub(super) fn convect(&mut self, step: &mut TimeStep) {
        let holds = self.transfer.as_ref().is_some_and(Transfer::holds);
        if let Some(medium) = self.medium.as_mut().filter(|_| !holds) {
            fluid::convect(medium, &mut self.state, step.context);
        }
    }

    /// Finds what conducts now, before anything flows.
    pub(in crate::engine::simulation) fn look_at_heat(&mut self) {
        let Self { transfer, scene, passes, state, .. } = self;
        if let Some(transfer) = transfer {
            transfer.look((scene, passes), state);
            transfer::tell(scene, state);
        }
        let by_fluid = self.medium.as_ref().map_or(0.0, |medium| fluid::rate(medium, &self.state, &self.standing()));
        self.state.heat.iter_mut().for_each(|heat| heat.rate += by_fluid);
    }

    /// Adds gravity, applied forces and global damping to the loads on particles.
    pub(in crate::engine::simulation) fn apply_fields(&mut self, context: &Context) {
        let Self { fields, state, workspace, .. } = self;
        // In a fluid they were stored before that acted.
        if fields.act() && self.medium.is_none() {
            workspace.between.before_fields(state);
        }
        let on_particles = fields.apply(state, context);
        state.damping_force = [0, 1, 2].map(|axis| on_particles[axis] + workspace.braking[axis]);
    }

    /// Books what the present forces did to the cell in the second half of the step.
    pub(super) fn finish_cell(&mut self, step: &mut TimeStep) {
        if let Some(cell) = &mut self.cell {
            cell.finish(&mut self.state, step.length());
        }
    }

    /// Books the half kick that is about to end the step.
    pub(super) fn book_second_half(&mut self, step: &mut TimeStep) {
        self.book_second_kick(self.fields.weight_alone(), step.context);
    }

    /// Books a second half kick, with gravity \[m/s²\] where that is not yet among the forces.
    pub(in crate::engine::simulation) fn book_second_kick(&mut self, gravity: Option<[f64; 3]>, context: &Context) {
        let Self { state, fields, bodies, workspace, .. } = self;
        energy::work::book_second(state, &mut workspace.between, (fields, gravity), bodies, context);
        book::book_losses(state, fields, bodies, context.step);
    }

    /// Books what the fluid does in the half kick that is about to end the step.
    pub(super) fn book_fluid_second(&mut self, step: &mut TimeStep) {
        if let Some(medium) = &mut self.medium {
            fluid::book(medium, &mut self.state, Kick::Second, step.context);
        }
    }

    /// Makes the second half of the kick of the particles that forces move.
    pub(super) fn kick_particles(&mut self, step: &mut TimeStep) {
        // Where gravity alone acts beside contacts and bonds, the kick adds it.
        let gravity = self.fields.weight_alone();
        let sweep = integration::Sweep { turning: self.turning, in_fluid: self.scene.fluid.is_some() };
        let particles = &mut self.state.particles;
        let speed = integration::kick_again(particles, gravity, step.length(), sweep, step.context);
        self.state.clock.speed = speed;
    }

    /// Makes the second half of the kick of bodies.
    pub(super) fn kick_bodies(&mut self, step: &mut TimeStep) {
        let groups = boundary::kick_again(&self.bodies, &mut self.state, step.length());
        let loose = self.shapes.as_ref().map_or(0.0, |it| it.kick_again(&mut self.state, step.length(), step.context));
        let speed = &mut self.state.clock.speed;
        *speed = larger(larger(*speed, groups), loose);
    }

    /// Books the impulses of the step on boundaries and nodes, and that of global damping.
    pub(super) fn book_impulses(&mut self, step: &mut TimeStep) {
        let Self { scene, state, workspace, .. } = self;
        loads::book(scene, state, &workspace.loads, &workspace.travels, &step.progress);
        nodes::book(state, &workspace.nodes, step.length());
        for axis in 0..3 {
            let both = workspace.damping_force[axis] + state.damping_force[axis];
            state.damping_impulse[axis] += 0.5 * step.length() * both;
        }
    }
}
