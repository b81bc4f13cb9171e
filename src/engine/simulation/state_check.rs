//! States from outside are checked before they are used.

use super::{RunError, Simulation};
use crate::engine::bodies::clumps;
use crate::engine::columns;
use crate::engine::flow;
use crate::engine::state::{State, StateFault, demand};
use crate::scene::Step;

impl Simulation {
    /// Refuses a present state that could not be taken up again.
    pub(crate) fn check_present(&self) -> Result<(), RunError> {
        self.check(&self.state).map_err(|StateFault { part, place, expected }| match self.coincident() {
            Some((id, cause)) => RunError::NotFinite { id, quantity: "force", time: self.time(), cause },
            None => RunError::Invalid { part, place, expected, time: self.time() },
        })
    }

    /// Whether a state can be one of this simulation: everything that the passes trust (slots, lengths and order of the
    /// lists, finite numbers) and what never changes (radii, masses, materials, groups). Takes a time in proportion to
    /// the state.
    pub fn check(&self, state: &State) -> Result<(), StateFault> {
        state.check(&self.state)?;
        self.search.check(state)?;
        clumps::check(&self.scene, state)?;
        columns::check(&self.scene, &state.particles)?;
        let count = state.particles.len();
        if let Some(exchange) = &state.exchange {
            flow::check(&self.scene, &state.particles, exchange)?;
        }
        let orientations =
            state.particles.orientation.len() == count || !self.passes.iter().any(|it| it.needs_orientations());
        demand(orientations, "orientation", state.particles.orientation.len(), "one for each particle")?;
        let step = match self.scene.run.step {
            Step::Given(step) if self.divides() => state.clock.step > 0.0 && state.clock.step <= step,
            Step::Given(step) => state.clock.step == step,
            Step::Automatic { .. } | Step::Following => (0.0..f64::INFINITY).contains(&state.clock.step),
        };
        demand(step, "clock", 2, "the time step of the scene")?;
        for (place, (parameter, &value)) in self.scene.tunables().zip(&state.tuned).enumerate() {
            demand(parameter.range.check(value).is_ok(), "tuned", place, "a value that the parameter takes")?;
        }
        for law in 0..self.scene.bonds.len() {
            demand(
                self.scene.tuned_law(law, &state.tuned).is_ok(),
                "tuned",
                law,
                "strengths of bonds that go together",
            )?;
        }
        if let Some(cell) = &self.cell {
            cell.check(state)?;
        }
        self.passes.iter().try_for_each(|pass| pass.check(state))
    }
}
