//! Dashpots of bonds that are integrated by themselves: a sweep before each time step and the reversed one after it.

use super::Simulation;
use crate::books;
use crate::boundaries::felt::{self, Swept};
use crate::boundaries::{RigidBody, course, rigid_body};
use crate::interactions::Sweep;
use crate::motion::Progress;
use crate::scene::Scene;
use crate::state::ledger::Source;
use crate::threads::Context;

/// Whether bonds whose dashpots are integrated by themselves may hold a boundary.
pub(super) fn leads(scene: &Scene) -> bool {
    scene.bonds.iter().any(|bond| bond.law.split.is_some() && scene.held_by(bond).next().is_some())
}

impl Simulation {
    /// The sweep before a time step. Groups and planes that are led have the motion of the step to come.
    pub(super) fn sweep_before(&mut self, progress: Progress, context: &Context) {
        if !self.splits {
            return;
        }
        self.lead_ahead(progress);
        let cross = self.sweep(&progress, false, context);
        self.book_cross(cross, progress.step);
        if self.leads {
            self.state.boundaries.iter_mut().zip(&self.room.led).for_each(|(moved, kept)| {
                (moved.velocity, moved.angular_velocity) = (kept.velocity, kept.angular_velocity);
            });
        }
    }

    /// The sweep after a time step, and the energy book of its second half kick, which has been made.
    pub(super) fn sweep_after(&mut self, progress: &Progress, context: &Context) {
        if !self.splits {
            return;
        }
        let cross = self.sweep(progress, true, context);
        self.book_cross(-cross, progress.step);
        if self.state.ledger.is_some() {
            let between = &mut self.room.between;
            books::work::book_kicked(&mut self.state, between, &self.fields, progress.step, context);
        }
    }

    /// Gives led boundaries and their particles the motion of the time step to come, and keeps what was.
    fn lead_ahead(&mut self, progress: Progress) {
        if !self.leads {
            return;
        }
        self.room.led.clone_from(&self.state.boundaries);
        course::advance(&self.scene, &self.bodies, &mut self.state, progress, &mut self.room.ways);
        let (state, kept) = (&mut self.state, &self.room.led);
        for (place, (moved, kept)) in state.boundaries.iter_mut().zip(kept).enumerate() {
            let (velocity, spin) = (moved.velocity, moved.angular_velocity);
            *moved = *kept;
            let body = self.bodies[place].as_ref();
            if !body.is_some_and(RigidBody::is_free) {
                (moved.velocity, moved.angular_velocity) = (velocity, spin);
                rigid_body::give_led_motion(&self.scene.boundaries[place], body, moved, &mut state.particles);
            }
        }
    }

    /// Sweeps over all bonds. Returns by how much it raised the power of all forces on particles, where a book is kept \[W\].
    fn sweep(&mut self, progress: &Progress, backwards: bool, context: &Context) -> f64 {
        let booked = self.state.ledger.is_some();
        let power =
            |simulation: &Self| if booked { books::work::power(&simulation.state.particles, context) } else { 0.0 };
        let before = power(self);
        let sweep = Sweep { time: 0.5 * progress.step, backwards };
        let mut swept = std::mem::take(&mut self.room.swept);
        swept.clear();
        swept.resize(self.state.boundaries.len(), Swept::default());
        let (state, mut gained) = (&mut self.state, 0.0);
        for turn in 0..self.passes.len() {
            let place = if backwards { self.passes.len() - 1 - turn } else { turn };
            gained += self.passes[place].sweep(state, sweep, &mut swept, context);
        }
        let since_start = if backwards { 0.5 } else { -0.5 } * progress.step;
        felt::book_sweep(&self.scene, &mut self.state, &swept, progress.since_the_middle() + since_start);
        self.room.swept = swept;
        if let Some(ledger) = &mut self.state.ledger {
            ledger.work[Source::Bonds as usize] += gained;
            ledger.turnover += gained.abs();
        }
        power(self) - before
    }

    /// Books that a half kick works with velocities on the other side of a sweep, whereas each kind of force is booked with those between
    /// the sweeps. What comes before a time step and what comes after one cancel to the second order.
    fn book_cross(&mut self, power: f64, step: f64) {
        if let Some(ledger) = &mut self.state.ledger {
            ledger.work[Source::Bonds as usize] += 0.5 * step * power;
            ledger.turnover += 0.5 * step * power.abs();
        }
    }

    /// Lets boundaries feel the present loads of these dashpots.
    pub(super) fn show_swept(&mut self) {
        if !self.leads {
            return;
        }
        let mut loads = std::mem::take(&mut self.room.swept);
        loads.clear();
        loads.resize(self.state.boundaries.len(), Swept::default());
        self.passes.iter().for_each(|pass| pass.add_swept_loads(&self.state, &mut loads));
        felt::show_swept(&mut self.state, &loads);
        self.room.swept = loads;
    }
}
