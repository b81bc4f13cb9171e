//! What is looked for and made anew on the way: neighbour lists, particles that come and go, bonds.

use super::{RunError, Simulation};
use crate::base::threads::Context;
use crate::engine::cell::Cell;
use crate::laws::bond::creation::Moment;

impl Simulation {
    /// Sees to the lists after a drift in which no particle that forces move went further than this way \[m\], and in
    /// which a periodic cell was strained: they are made anew where they are outdated, or where particles come or go. An error leaves lists that fit the particles.
    pub(super) fn keep_lists(&mut self, way: f64, strain: f64, context: &Context) -> Result<(), RunError> {
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
        let outdated = self.search.outdated(&mut self.state, context);
        let depth = if self.is_depth_due(way, [before, after]) { self.check_depth() } else { Ok(()) };
        let changed = self.exchange(farthest, context.step);
        if !outdated && matches!(changed, Ok(false)) {
            return depth;
        }
        let result = depth.and(changed.map(|_| ())).and_then(|()| self.check_domain());
        self.rebuild(context);
        result
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
        let mut workers = std::mem::take(&mut self.workers);
        workers.run(|threads| self.rebuild(&Context { step: 0.0, width: self.width, threads }));
        self.workers = workers;
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
