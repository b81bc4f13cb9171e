//! What is looked for and made anew on the way: neighbour lists, particles that come and go, bonds.

use super::Simulation;
use super::time_step::TimeStep;
use crate::base::threads::Context;
use crate::engine::cell::Cell;
use crate::laws::bond::creation::Moment;

impl Simulation {
    /// Sums up how far everything went in a step, and tells whether the lists no longer hold every pair that can touch.
    pub(super) fn sum_way(&mut self, step: &mut TimeStep) {
        let (way, strain) = (step.way, step.strain);
        let travels = &self.workspace.travels;
        let carried = travels.iter().fold(0.0_f64, |most, travel| most.max(travel.carried));
        let extents = self.state.neighbours.boundary_extent.iter().copied().chain(std::iter::repeat(0.0));
        let farthest = travels.iter().zip(extents).map(|(travel, extent)| travel.farthest(extent));
        // What is near is carried along by the cell but for the change of the vector between both.
        let reach = self.cell.as_ref().map_or(0.0, Cell::reach);
        let near = 2.0 * reach + self.state.neighbours.skin + self.search.reach();
        let way = if strain > 0.0 { way + 0.5 * strain * near } else { way };
        let farthest = farthest.fold(way, f64::max);
        let before = self.state.neighbours.travel;
        let after = before + way.max(carried);
        self.state.neighbours.travel = after;
        self.state.foresight.travel += farthest;
        self.state.foresight.strained += strain * near;
        (step.farthest, step.outdated) = (farthest, self.search.outdated(&mut self.state, step.context));
        if self.is_depth_due(way, [before, after]) {
            step.note(self.check_depth());
        }
    }

    /// Makes the lists anew where they are outdated, or where particles came or went.
    pub(super) fn renew_outdated(&mut self, step: &mut TimeStep) {
        if step.outdated {
            step.note(self.check_domain());
            self.rebuild(step.context);
        }
    }

    /// Makes the lists anew.
    pub(super) fn rebuild(&mut self, context: &Context) {
        self.search.rebuild(&mut self.state, context);
        self.suppression.flag(&mut self.state);
        for pass in &self.passes {
            pass.prepare(&mut self.state);
        }
    }

    /// Makes new neighbour lists, as happens from time to time by motion: results change by rounding only.
    pub fn renew_lists(&mut self) {
        self.rollback.forget();
        self.with_helpers(|it, threads| it.rebuild(&Context { threads, ..it.standing() }));
    }

    /// Makes the bonds that are to be made at this moment.
    pub(super) fn make_bonds(&mut self, moment: &Moment, context: &Context) {
        if self.scene.bonds.is_empty() {
            return;
        }
        let mut made = false;
        // Images that are not made anew with lists of contacts are where nobody has looked.
        if self.cell.is_some()
            && !self.search.keeps_lists()
            && moment.number > 0
            && self.scene.bonds.iter().any(|bond| bond.keys.create.bonds_near_pairs(moment))
        {
            self.rebuild(context);
        }
        self.suppression.count_bonds(&self.state, &mut self.workspace.bonds);
        for pass in &self.passes {
            made |= pass.create(&mut self.state, moment, context.step);
        }
        if made {
            if moment.number > 0 && self.suppression.any() {
                self.suppression.made(&mut self.state, &self.workspace.bonds);
            }
            self.rebuild(context);
            if moment.number == 0 {
                self.suppression.begin_offsets(&mut self.state);
            }
        }
    }
}
