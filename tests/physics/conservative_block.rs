//! A ringing block of bonded spheres that nothing damps keeps its energy over a million steps near the stable one.

use crate::support::start;
use cograin::simulation::Simulation;

/// Spheres along each edge.
const EDGE: usize = 3;

/// Steps in all, and from one look to the next.
const STEPS: usize = 1_000_000;

/// A free block whose spheres start in motions of their own, small ones.
fn ringing(step: f64) -> Simulation {
    let body = |index: usize| {
        let place = [index % EDGE, index / EDGE % EDGE, index / (EDGE * EDGE)].map(|at| 2e-3 * at as f64);
        let speed = |salt: usize| 1e-3 * (((index * 37 + salt * 101) % 17) as f64 / 17.0 - 0.5);
        let velocity = [speed(1), speed(2), speed(3)];
        format!("{{ position = {place:?}, radius = 1e-3, velocity = {velocity:?} }},\n")
    };
    let bodies: String = (0..EDGE * EDGE * EDGE).map(body).collect();
    start(&format!(
        r#"
[run]
step = {step:?}
threads = 1
[material.ice]
density = 1000.0
[particles.block]
material = "ice"
list = [
{bodies}]
[bond.ice]
between = ["block", "block"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
"#
    ))
}

#[test]
fn the_energy_does_not_drift_over_a_million_steps() {
    let step = 0.9 * ringing(1e-9).stable_step();
    let mut simulation = ringing(step);
    let energies: Vec<f64> = (0..STEPS)
        .map(|_| {
            simulation.advance(step).unwrap();
            let elastic = simulation.bond_elastic_energy();
            simulation.kinetic_energy() + elastic
        })
        .collect();
    let tenth = STEPS / 10;
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let (first, last) = (mean(&energies[..tenth]), mean(&energies[STEPS - tenth..]));
    assert!((last / first - 1.0).abs() < 1e-6, "{first:e} J and {last:e} J");
}
