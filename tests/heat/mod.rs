//! Heat between particles, and between particles and boundaries.

mod balance;
mod bodies;
mod bonds;
mod boundaries;
mod held;
mod inputs;
mod losses;
mod network;
mod nodes;
mod refused;
mod relaxation;
mod same_bits;

use cograin::simulation::Simulation;

/// Young's modulus 50 MPa, conductivity 5 W/(m K), specific heat 500 J/(kg K); one law, in which contacts conduct by their circle of
/// contact; no gravity, a step of 0.1 ms.
pub(crate) const GRAINS: &str = r#"
[run]
end = 1.0
step = 1.0e-4
allow_unstable = true
[material.stone]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.25
conductivity = 5.0
specific_heat = 500.0
[pair.stone.stone]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[contact.touch.heat.constriction]
"#;

/// Heat capacity of a sphere of 1 mm of that material \[J/K\].
pub(crate) fn capacity() -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * 1e-9 * 2500.0 * 500.0
}

/// Conductance of two spheres of 1 mm at this overlap \[m\]: 2 k a \[W/K\].
pub(crate) fn conductance(overlap: f64) -> f64 {
    2.0 * 5.0 * (0.5e-3 * overlap).sqrt()
}

/// A list of spheres of 1 mm that no force moves, for they are far too heavy to be moved in a test: places along x \[m\] and temperatures
/// \[K\].
pub(crate) fn row(spheres: impl IntoIterator<Item = (f64, f64)>) -> String {
    let sphere = |(x, temperature): (f64, f64)| {
        format!("{{ position = [{x:?}, 0.0, 1.0e-3], radius = 1.0e-3, temperature = {temperature:?} }},\n")
    };
    spheres.into_iter().map(sphere).collect()
}

/// The temperature of a particle, by its index \[K\].
pub(crate) fn temperature(simulation: &Simulation, index: usize) -> f64 {
    simulation.state().heat.as_ref().expect("heat flows").temperature(index)
}

/// Makes so many time steps of 0.1 ms.
#[track_caller]
pub(crate) fn steps(simulation: &mut Simulation, count: u64) {
    for _ in 0..count {
        simulation.advance(1e-4).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// Fails, with both values, unless they agree to `tolerance` of the expected one.
#[track_caller]
pub(crate) fn assert_close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found:e} found, {expected:e} expected");
}
