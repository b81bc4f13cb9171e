//! Heat of a scene at time 0.

use crate::engine::state::Heat;
use crate::engine::state::heat::BoundaryHeat;
use crate::scene::{Boundary, BoundaryTemperature, Scene};

/// Temperatures and heat capacities of a scene at time 0, if heat flows in it.
pub(crate) fn begun(scene: &Scene) -> Option<Heat> {
    if !scene.has_heat() {
        return None;
    }
    let count = scene.particles.len();
    let mut capacity: Vec<f64> = (0..count).map(|particle| scene.heat_capacity(particle).unwrap_or(0.0)).collect();
    let boundaries = scene.boundaries.iter().map(|it| boundary(scene, it, &capacity)).collect();
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
        initial: scene.particles.iter().map(|particle| particle.temperature.unwrap_or(0.0)).collect(),
        capacity,
        gained: vec![0.0; count],
        flow: vec![0.0; count],
        boundaries,
        ..Heat::default()
    })
}

/// A boundary at time 0, beside the heat capacities of the particles \[J/K\].
fn boundary(scene: &Scene, boundary: &Boundary, capacities: &[f64]) -> BoundaryHeat {
    let members = boundary.shape.members();
    let (initial, capacity, target) = match boundary.temperature {
        BoundaryTemperature::None => {
            let temperature = members.first().and_then(|&first| scene.particles[first as usize].temperature);
            let capacity = members.iter().map(|&member| capacities[member as usize]).sum();
            (temperature.unwrap_or(0.0), capacity, 0.0)
        }
        BoundaryTemperature::Held(temperature) => (temperature, 0.0, 0.0),
        BoundaryTemperature::Driven(temperature) => (temperature, 0.0, temperature),
        BoundaryTemperature::Body { temperature, capacity, applied } => (temperature, capacity, applied),
    };
    BoundaryHeat { initial, capacity, target, course: [target; 2], ..BoundaryHeat::default() }
}
