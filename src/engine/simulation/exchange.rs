//! Particles that come and go: when in a time step, and what the books need of it.

use super::time_step::TimeStep;
use super::{RunError, Simulation};
use crate::engine::energy::losses::StoredEnergy;
use crate::engine::flow::{Flow, RemovedParticles};
use crate::engine::transfer;

impl Simulation {
    /// Lets particles come and go in the middle of a time step. Where any did, lists are to be made anew.
    pub(super) fn exchange(&mut self, step: &mut TimeStep) {
        let Some(flow) = self.flow.take() else { return };
        let changed = self.come_and_go(&flow, step.farthest, step.length());
        self.flow = Some(flow);
        step.outdated |= !matches!(changed, Ok(false));
        step.note(changed.map(|_| ()));
    }

    /// The same by what lets them, where nothing moved further than `way` \[m\]. Returns whether any came or went.
    fn come_and_go(&mut self, flow: &Flow, way: f64, step: f64) -> Result<bool, RunError> {
        flow.pass(&self.scene, &mut self.state, way, step);
        let leaving = flow.leaving(&self.scene, &mut self.state, step)?;
        if let Some(leaving) = &leaving {
            self.let_go(flow, leaving, step);
        }
        if !flow.is_due(&self.scene, &self.state) {
            return Ok(leaving.is_some());
        }
        let came = flow.insert(&self.scene, (&self.fields, self.shapes.as_ref()), &mut self.state, step)?;
        if came {
            // What is new may touch others in a way that nothing has foreseen.
            self.state.foresight.travel = f64::MAX;
        }
        Ok(came || leaving.is_some())
    }

    /// Takes particles away, with what their contacts hold.
    fn let_go(&mut self, flow: &Flow, leaving: &RemovedParticles, step: f64) {
        let booked = self.state.ledger.is_some() || self.state.losses.is_some();
        let held = |simulation: &Self| (simulation.elastic_energy(), simulation.held());
        leaving.put_back(&mut self.state);
        if let Some(cell) = &self.cell {
            cell.place_images(&mut self.state);
        }
        let before = booked.then(|| held(self));
        let (passes, state) = (&self.passes, &mut self.state);
        let goes = state.with_all(&leaving.goes);
        let given: f64 = passes.iter().map(|pass| pass.let_go(state, &goes, step)).sum();
        let remembered = transfer::remembered(&self.scene, &self.state, &goes);
        flow.remove(&self.scene, &self.fields, &mut self.state, leaving, step);
        if let Some((elastic, StoredEnergy(before))) = before {
            let (left, StoredEnergy(after)) = held(self);
            let of = |cause: usize| remembered[cause].unwrap_or(before[cause] - after[cause]);
            flow.book_contacts(&mut self.state, elastic + given - left, [0, 1, 2].map(of));
        }
    }

    /// Whether a mass is still to come that finds room.
    pub fn is_filling(&self) -> bool {
        self.flow.as_ref().is_some_and(|flow| flow.is_filling(&self.scene, &self.state))
    }

    /// Gives an insertion a rate, from the next communication step on: a mass or a number in each second.
    pub fn set_insertion_rate(&mut self, insertion: usize, rate: f64) {
        if let Some(feed) = self.state.exchange.as_mut().and_then(|exchange| exchange.feeds.get_mut(insertion)) {
            (feed.rate, feed.rate_of_rate) = (rate, 0.0);
        }
    }

    /// The change of that rate in each second of the next communication step, which then has the mean of its beginning and its end.
    pub fn set_insertion_rate_of_rate(&mut self, insertion: usize, rate: f64) {
        if let Some(feed) = self.state.exchange.as_mut().and_then(|exchange| exchange.feeds.get_mut(insertion)) {
            feed.rate_of_rate = rate;
        }
    }
}
