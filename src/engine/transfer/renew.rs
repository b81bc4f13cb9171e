//! Particles that come bring their temperature, those that go take their heat along.

use super::flows::{Body, body};
use crate::engine::state::{GONE, Heat, State};
use crate::laws::column::TEMPERATURE;
use crate::scene::Scene;

/// Makes room for so many indices, of which these are the scene's own.
pub(super) fn extend(heat: &mut Heat, count: usize, own: usize) {
    for column in [&mut heat.initial, &mut heat.capacity, &mut heat.gained, &mut heat.flow] {
        column.resize(count, 0.0);
    }
    // Numbers are counted from 1, so this one is nobody's.
    heat.numbers.resize(count - own, 0);
}

/// Books the heat of particles that have gone, and begins with those that came.
pub(super) fn renew(scene: &Scene, state: &mut State) {
    let Some(column) = scene.column(TEMPERATURE.name) else { return };
    let Some(mut heat) = state.heat.take() else { return };
    let particles = &state.particles;
    let (count, own) = (particles.slot.len(), scene.particles.len());
    extend(&mut heat, count, own);
    for index in 0..count {
        let slot = particles.slot[index];
        let is_new = index >= own && slot != GONE && heat.numbers[index - own] != particles.numbers[index - own];
        if slot == GONE || is_new {
            heat.departed += std::mem::take(&mut heat.gained[index]);
            (heat.capacity[index], heat.flow[index]) = (0.0, 0.0);
        }
        if is_new {
            let slot = slot as usize;
            heat.numbers[index - own] = particles.numbers[index - own];
            heat.initial[index] = particles.declared[column][slot];
            let stands = matches!(body(state, slot), Body::Particle(own) if own == index);
            let specific = scene.materials[particles.material[slot] as usize].thermal.specific_heat;
            let mass = state.velocity_of_grain(slot)[3];
            heat.capacity[index] = if stands { mass * specific.unwrap_or(0.0) } else { 0.0 };
        }
    }
    state.heat = Some(heat);
}
