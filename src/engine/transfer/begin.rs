//! Heat of a scene at time 0.

use super::renew;
use crate::engine::state::heat::{BoundaryHeat, NodesHeat};
use crate::engine::state::{GONE, Heat, Particles, State};
use crate::laws::column::TEMPERATURE;
use crate::scene::{Boundary, BoundaryTemperature, Scene};

/// Temperatures and heat capacities of a scene at time 0, if heat flows in it.
pub(crate) fn begun(scene: &Scene) -> Option<Heat> {
    let temperatures = scene.temperatures().filter(|_| scene.has_heat())?;
    let count = scene.particles.len();
    let mut capacity: Vec<f64> = (0..count).map(|particle| scene.heat_capacity(particle).unwrap_or(0.0)).collect();
    let boundaries = scene.boundaries.iter().map(|it| boundary(it, temperatures, &capacity)).collect();
    for clump in &scene.clumps {
        let spheres = scene.spheres_of(clump);
        let (first, material) = (spheres.start, scene.particles[spheres.start].material.index());
        capacity[spheres].fill(0.0);
        capacity[first] = clump.mass * scene.materials[material].thermal.specific_heat.unwrap_or(0.0);
    }
    for boundary in &scene.boundaries {
        boundary.shape.members().iter().for_each(|&member| capacity[member as usize] = 0.0);
    }
    Some(Heat {
        initial: temperatures.to_vec(),
        capacity,
        gained: vec![0.0; count],
        flow: vec![0.0; count],
        boundaries,
        nodes: scene.boundaries.iter().enumerate().filter_map(nodes).collect(),
        ..Heat::default()
    })
}

/// The nodes of a boundary of this index at time 0, where they have temperatures.
fn nodes((index, boundary): (usize, &Boundary)) -> Option<NodesHeat> {
    let BoundaryTemperature::Driven(temperature) = boundary.temperature else { return None };
    let count = boundary.driven_nodes();
    let (initial, target) = (temperature, temperature);
    let node = BoundaryHeat { initial, target, course: [target; 2], ..BoundaryHeat::default() };
    (count > 0).then(|| NodesHeat { boundary: index as u32, each: vec![node; count] })
}

/// A boundary at time 0, beside temperatures \[K\] and heat capacities of the particles \[J/K\].
fn boundary(boundary: &Boundary, temperatures: &[f64], capacities: &[f64]) -> BoundaryHeat {
    let members = boundary.shape.members();
    let (initial, capacity, target) = match boundary.temperature {
        BoundaryTemperature::None => {
            let temperature = members.first().map(|&first| temperatures[first as usize]);
            let capacity = members.iter().map(|&member| capacities[member as usize]).sum();
            (temperature.unwrap_or(0.0), capacity, 0.0)
        }
        BoundaryTemperature::Held(temperature) => (temperature, 0.0, 0.0),
        BoundaryTemperature::Driven(temperature) => (temperature, 0.0, temperature),
        BoundaryTemperature::Body { temperature, capacity, applied } => (temperature, capacity, applied),
    };
    BoundaryHeat { initial, capacity, target, course: [target; 2], ..BoundaryHeat::default() }
}

/// Begins with the temperatures that the particles have: where they were taken over from another state.
pub(crate) fn take(scene: &Scene, state: &mut State) {
    let (Some(heat), Some(column)) = (&mut state.heat, scene.column(TEMPERATURE.name)) else { return };
    let Particles { slot, declared, .. } = &state.particles;
    let temperatures = &declared[column];
    renew::extend(heat, slot.len(), scene.particles.len());
    for (index, &slot) in slot.iter().enumerate().filter(|(_, slot)| **slot != GONE) {
        (heat.initial[index], heat.gained[index]) = (temperatures[slot as usize], 0.0);
    }
    for (boundary, moved) in scene.boundaries.iter().zip(&mut heat.boundaries) {
        if let (BoundaryTemperature::None, Some(&first)) = (boundary.temperature, boundary.shape.members().first()) {
            (moved.initial, moved.rise) = (temperatures[slot[first as usize] as usize], 0.0);
            (moved.before, moved.present) = (0.0, 0.0);
        }
    }
}

/// Writes the temperatures to the column of the particles: all particles of a body have that of the body.
pub(crate) fn tell(scene: &Scene, state: &mut State) {
    let Some(column) = scene.column(TEMPERATURE.name) else { return };
    let mut temperatures = std::mem::take(&mut state.particles.declared[column]);
    for (slot, temperature) in temperatures.iter_mut().enumerate() {
        *temperature = super::temperature(state, slot).unwrap_or(*temperature);
    }
    state.particles.declared[column] = temperatures;
}
