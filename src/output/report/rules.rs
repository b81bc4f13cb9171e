//! The usual rules of thumb for the time step, beside the computed bound: Rayleigh time, Hertz time, steps in a collision,
//! and the inertial number. The report shows them for comparison only (`docs/stability.md`).

use crate::base::number::Vector;
use crate::engine::simulation::Simulation;
use crate::scene::Scene;
use std::f64::consts::PI;

/// The rules that can be told of a scene, in one line; none where nothing elastic is in it.
pub(crate) fn rules(scene: &Scene, simulation: &Simulation) -> Option<String> {
    let step = simulation.state().clock.step;
    let rayleigh = scene.particles.iter().filter_map(|particle| rayleigh_time(scene, particle)).reduce(f64::min)?;
    let mut line = format!("Rayleigh time {rayleigh:.3e} s ({:.3} of it)", step / rayleigh);
    if let Some((speed, collision)) = hertz_time(scene, simulation) {
        line += &format!(
            "; Hertz time at {speed:.3e} m/s {collision:.3e} s ({} steps in that collision)",
            rounded(collision / step)
        );
    }
    if let Some(number) = inertial_number(scene, simulation) {
        line += &format!("; inertial number {number:.2e}");
    }
    Some(line)
}

/// A number of steps as a person reads it.
fn rounded(number: f64) -> String {
    if number < 1e6 { format!("{number:.1}") } else { format!("{number:.3e}") }
}

/// Time of a surface wave over a sphere, π R √(ρ/G)/(0.1631 ν + 0.8766) \[s\].
fn rayleigh_time(scene: &Scene, particle: &crate::scene::Particle) -> Option<f64> {
    let material = &scene.materials[particle.material.index()];
    let (modulus, ratio) = (material.youngs_modulus?, material.poissons_ratio?);
    let shear = modulus / (2.0 * (1.0 + ratio));
    Some(PI * particle.radius * (particle.density / shear).sqrt() / (0.1631 * ratio + 0.8766))
}

/// The fastest particle's speed \[m/s\], and how long the two smallest equal spheres of an elastic material would touch that
/// met at it, 2.87 (m*²/(R* E*² v))^(1/5) \[s\].
fn hertz_time(scene: &Scene, simulation: &Simulation) -> Option<(f64, f64)> {
    let speed = simulation.fastest().map(|(_, speed, _)| speed).filter(|speed| *speed > 0.0)?;
    let time = |particle: &crate::scene::Particle| {
        let material = &scene.materials[particle.material.index()];
        let (modulus, ratio) = (material.youngs_modulus?, material.poissons_ratio?);
        let effective = 0.5 * modulus / (1.0 - ratio * ratio);
        let (mass, radius) = (0.5 * particle.mass(), 0.5 * particle.radius);
        Some(2.87 * libm::pow(mass * mass / (radius * effective * effective * speed), 0.2))
    };
    Some((speed, scene.particles.iter().filter_map(time).reduce(f64::min)?))
}

/// γ̇ d √(ρ/p): strain rate of the moving boundaries over the extent of the packing, and its mean pressure.
fn inertial_number(scene: &Scene, simulation: &Simulation) -> Option<f64> {
    let state = simulation.state();
    let fastest = state.boundaries.iter().map(|moved| Vector::from(moved.velocity).length()).fold(0.0, f64::max);
    if fastest == 0.0 {
        return None;
    }
    let along = |axis: usize| {
        let places = state.particles.position.iter().map(|row| row[axis]);
        places.clone().fold(f64::NEG_INFINITY, f64::max) - places.fold(f64::INFINITY, f64::min)
    };
    let count = scene.particles.len() as f64;
    let mean = scene.particles.iter().map(|particle| particle.radius).sum::<f64>() / count;
    let extents = [0, 1, 2].map(|axis| along(axis) + 2.0 * mean);
    let slot = |index: u32| state.particles.position[state.particles.slot[index as usize] as usize];
    let virial: f64 = simulation
        .contacts()
        .iter()
        .filter_map(|contact| {
            let apart = Vector::from(slot(contact.first)) - Vector::from(slot(contact.second?));
            Some(contact.normal_force * apart.length())
        })
        .sum();
    let pressure = virial / (3.0 * extents.iter().product::<f64>());
    let density = scene.particles.iter().map(|particle| particle.density).sum::<f64>() / count;
    let rate = fastest / extents.iter().copied().fold(0.0, f64::max);
    (rate > 0.0 && pressure > 0.0).then(|| rate * 2.0 * mean * (density / pressure).sqrt())
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn numbers_of_steps_stay_short() {
        assert_eq!([12.34, 1.40137e151].map(rounded), ["12.3", "1.401e151"]);
    }
}
