//! One time step by velocity Verlet, and the evaluation of the forces.

use super::{RunError, Simulation};
use crate::base::number::larger;
use crate::base::threads::Context;
use crate::engine::boundaries::{course, loads, nodes, rigid_body};
use crate::engine::clumps;
use crate::engine::energy;
use crate::engine::integration;
use crate::engine::state::ledger::Source;
use crate::engine::transfer;
use crate::laws::bond::creation::Moment;
use crate::laws::motion::Progress;

impl Simulation {
    /// Makes one time step: half a kick and the drift, the forces where everything stands then, the other half of the kick.
    ///
    /// An error leaves the state after the whole step.
    pub(super) fn step(&mut self, progress: Progress, context: &Context) -> Result<(), RunError> {
        let step = progress.step;
        let moment = self.begin_step(step);
        let progress = Progress { time: moment.to, ..progress };
        if self.scene.heat.frozen {
            self.transfer_heat(&progress, context);
            return Ok(());
        }
        self.book_first_kick(step);
        let way = self.kick_and_drift(step, context);
        self.move_boundaries(progress);
        let deformed = self.deform_cell(&progress, context)?;
        let groups = self.check_groups(step);
        let lists = self.keep_lists(way, deformed, context);
        self.make_bonds(&moment, context);
        self.done("lists and boundaries");

        // Where gravity alone acts beside contacts and bonds, the kick adds it.
        let gravity = self.fields.weight_alone();
        self.clear_boundary_loads();
        let forces = self.evaluate(gravity.is_none(), context);
        if let Some(cell) = &mut self.cell {
            cell.finish(&mut self.state, step);
        }
        self.follow_contacts();
        self.transfer_heat(&progress, context);

        self.book_second_kick(gravity, step, context);
        let speed = self.kick_again(gravity, step, context);
        self.book_impulses(&progress);
        if speed.is_finite() { groups.and(lists).and(forces) } else { Err(self.not_finite()) }
    }

    /// Lets the clock go on by a step of this length \[s\]. Returns the moment that this reaches.
    fn begin_step(&mut self, step: f64) -> Moment {
        let clock = &mut self.state.clock;
        let from = clock.time;
        clock.advance(step);
        clock.steps += 1;
        clock.last_step = step;
        Moment { number: clock.steps, from, to: clock.time }
    }

    /// Makes the first half of the kick and the drift of the particles that forces move, and turns them where they have an orientation. Their
    /// loads are zero then. Returns how far the fastest went \[m\].
    fn kick_and_drift(&mut self, step: f64, context: &Context) -> f64 {
        let particles = &mut self.state.particles;
        let speed = integration::kick_and_drift(particles, step, self.turning, context);
        integration::turn(particles, step, context);
        let clumps = self.clumps.as_ref().map_or(0.0, |clumps| clumps.kick_and_drift(&mut self.state, step, context));
        self.done("kick and drift");
        speed.max(clumps) * step
    }

    /// Deforms the periodic cell, where there is one. Returns the strain.
    fn deform_cell(&mut self, progress: &Progress, context: &Context) -> Result<f64, RunError> {
        let Some(cell) = &mut self.cell else { return Ok(0.0) };
        let strain = cell.advance(&mut self.state, progress, context);
        self.done("cell");
        strain
    }

    /// Lets heat flow between what touches now, where any does.
    fn transfer_heat(&mut self, progress: &Progress, context: &Context) {
        let Self { transfer, scene, passes, state, .. } = self;
        if let Some(transfer) = transfer {
            transfer.advance((scene, passes), state, progress, context);
            self.done("heat");
        }
    }

    /// Finds what conducts now, before anything flows.
    pub(super) fn look_at_heat(&mut self, context: &Context) {
        let Self { transfer, scene, passes, state, .. } = self;
        if let Some(transfer) = transfer {
            transfer.look((scene, passes), state, context);
            transfer::tell(scene, state);
        }
    }

    /// Makes the second half of the kick, of particles and bodies that forces move. Returns the largest speed at the middle of the next
    /// step, or something that is not finite where a force or velocity is not \[m/s\].
    fn kick_again(&mut self, gravity: Option<[f64; 3]>, step: f64, context: &Context) -> f64 {
        let particles = integration::kick_again(&mut self.state.particles, gravity, step, self.turning, context);
        let bodies = rigid_body::kick_again(&self.bodies, &mut self.state, step);
        let clumps = self.clumps.as_ref().map_or(0.0, |clumps| clumps.kick_again(&mut self.state, step, context));
        let speed = [bodies, clumps].into_iter().fold(particles, larger);
        self.state.clock.speed = speed;
        self.done("kick");
        speed
    }

    /// Moves boundaries and their nodes to where they stand at the end of the step, groups with their particles.
    fn move_boundaries(&mut self, progress: Progress) {
        let Self { scene, bodies, state, workspace, .. } = self;
        course::advance(scene, bodies, state, progress, &mut workspace.travels);
        nodes::advance(scene, state, &progress, &mut workspace.travels);
        rigid_body::place_groups(scene, bodies, state);
    }

    /// Sets the loads of boundaries and nodes to zero, and notes what they were.
    pub(super) fn clear_boundary_loads(&mut self) {
        loads::clear(&mut self.state, &mut self.workspace.loads);
        nodes::clear_loads(&mut self.state, &mut self.workspace.nodes);
        self.workspace.damping_force = self.state.damping_force;
    }

    /// Evaluates all forces and torques at the present positions, the fields among them if asked for. Loads of the
    /// particles must be zero.
    pub(super) fn evaluate(&mut self, fields: bool, context: &Context) -> Result<(), RunError> {
        let (mut result, told) = (Ok(()), self.state.breaks.len());
        if let Some(heat) = self.state.heat.as_mut().filter(|_| self.scene.heat.warms()) {
            heat.collect(self.state.particles.len());
        }
        self.workspace.between.begin();
        if let Some(cell) = self.cell.as_mut().filter(|_| !self.passes.is_empty()) {
            cell.begin_evaluation(&mut self.state);
        }
        for place in 0..self.passes.len() {
            let pass = &self.passes[place];
            result = result.and(pass.apply(&mut self.state, context));
            let (source, next) = (pass.source(), self.passes.get(place + 1).map(|next| next.source()));
            if next != Some(source) {
                let more = next.is_some_and(|next| next != Source::Walls);
                if let Some(cell) = self.cell.as_mut().filter(|_| source != Source::Walls) {
                    cell.end_kind(&mut self.state, !more, context);
                }
                clumps::note_loads(&mut self.state, source);
                self.workspace.between.note(&mut self.state, &self.bodies, source, next);
                self.done(source.name());
                if let Some(cell) = self.cell.as_mut().filter(|_| more) {
                    cell.begin_kind(&mut self.state);
                }
            }
        }
        if fields && self.fields.act() {
            self.workspace.between.note_before_fields(&self.state);
        }
        let state = &mut self.state;
        self.suppression.broken(state, told);
        self.suppression.settle(state);
        loads::sum_groups(&self.scene, state);
        let on_clumps = (!state.clumps.is_empty()).then(|| clumps::load(&self.fields, state, context));
        state.damping_force = if fields { self.fields.apply(state, context) } else { [0.0; 3] };
        let braking = self.fields.load_bodies(&self.bodies, state);
        for braking in on_clumps.into_iter().chain([braking]) {
            state.damping_force.iter_mut().zip(braking).for_each(|(sum, part)| *sum += part);
        }
        self.done("fields");
        result
    }

    /// Books the half kick that is about to begin a step of this length \[s\], where a book of energy is kept.
    fn book_first_kick(&mut self, step: f64) {
        energy::work::book_first(&mut self.state, &self.fields, &self.bodies, step);
        energy::losses::begin_step(&mut self.state, &self.fields, &self.bodies, step);
        self.book_clumps(step);
    }

    /// Books the half kick that is about to end a step of this length \[s\], where a book of energy is kept, with gravity \[m/s²\] where
    /// that is not yet among the forces.
    pub(super) fn book_second_kick(&mut self, gravity: Option<[f64; 3]>, step: f64, context: &Context) {
        let Self { state, fields, bodies, workspace, .. } = self;
        energy::work::book_second(state, &mut workspace.between, (fields, gravity), bodies, step, context);
        energy::losses::book_bodies(state, fields, bodies, step);
        self.book_clumps(step);
    }

    /// Books the half kick of clumps that is about to be made.
    fn book_clumps(&mut self, step: f64) {
        clumps::book_work(&mut self.state, &self.fields, step);
        clumps::book_losses(&mut self.state, &self.fields, step);
    }

    /// Books the impulses of a step on boundaries and nodes, and that of global damping.
    fn book_impulses(&mut self, progress: &Progress) {
        let Self { scene, state, workspace, .. } = self;
        loads::book(scene, state, &workspace.loads, &workspace.travels, progress);
        nodes::book(state, &workspace.nodes, progress.step);
        for axis in 0..3 {
            let both = workspace.damping_force[axis] + state.damping_force[axis];
            state.damping_impulse[axis] += 0.5 * progress.step * both;
        }
    }
}
