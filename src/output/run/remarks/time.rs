//! On a given time step near the stable one.

use crate::engine::simulation::Simulation;
use crate::engine::state::Clock;
use crate::scene::{Scene, Step};

/// Part of the stable step above which a given step is said to be near it.
const NEAR_THE_BOUND: f64 = 0.8;

/// On a given step near the stable one.
pub(super) fn time_step(scene: &Scene, simulation: &Simulation) -> Option<String> {
    let Step::Given(step) = scene.run.step else { return None };
    let stable = simulation.state().clock.stable;
    if scene.run.allow_unstable {
        let found = if stable.is_finite() { format!(" ({stable:.3e} s as last found)") } else { String::new() };
        return Some(format!(
            "[run] allow_unstable: nothing stops this run when its time step, {step:e} s, is above the stable one{found}; its numbers are worth nothing then"
        ));
    }
    let Clock { divided, steps, .. } = simulation.state().clock;
    if divided > 0 {
        return Some(format!(
            "[run] step: {divided} of {steps} time steps were made shorter than {step:e} s, as the stable one fell below that ({stable:.3e} s as last found)"
        ));
    }
    (step > NEAR_THE_BOUND * stable).then(|| {
        format!("[run] step: {step:e} s is {:.2} of the computed stable step, {stable:.3e} s; accuracy suffers well before stability", step / stable)
    })
}
