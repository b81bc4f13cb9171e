//! The porosity of the cells of a fluid's grid.

use super::Medium;
use crate::base::threads::Context;
use crate::engine::averages::look::{Fullness, Look, inside};
use crate::engine::state::State;
use crate::scene::Scene;

/// The least porosity that drag laws see: overlaps count twice, and a cell may lie in a grain.
pub(super) const LEAST: f64 = 0.2;

/// Finds the part of each cell that no particle fills, by the exact parts of spheres: at communication points, and before the first step.
pub(crate) fn renew(medium: Option<&Medium>, scene: &Scene, state: &mut State, context: &Context) {
    let Some(grid) = medium.and_then(|medium| medium.grid.as_ref()) else { return };
    let (fullness, volume) = (Fullness::of(scene), grid.cell_volume());
    let Some(mut fluid) = state.fluid.take() else { return };
    fluid.porosity.fill(0.0);
    for part in inside(&Look::at_grid(grid, scene, state), state, context) {
        fluid.porosity[part.part as usize] += fullness.volume(state, &part);
    }
    for (porosity, row) in fluid.porosity.iter_mut().zip(&mut fluid.velocity.now) {
        *porosity = 1.0 - *porosity / volume;
        row[3] = porosity.clamp(LEAST, 1.0);
    }
    state.fluid = Some(fluid);
}
