//! Time steps that heat does not allow, and how it limits an automatic one.

use super::{GRAINS, capacity, conductance, row, temperature};
use crate::support::start;

/// Two spheres that overlap by 10 µm, with this time step; nothing moves.
fn with_step(step: &str) -> String {
    let list = row([(0.0, 400.0), (1.99e-3, 300.0)]);
    let grains = GRAINS.replace("step = 1.0e-4\nallow_unstable = true", &format!("step = {step}"));
    format!("{grains}[heat]\nfrozen = true\n[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n")
}

#[test]
fn the_stable_step_is_that_of_the_body_that_exchanges_most() {
    let simulation = start(&with_step("\"auto\""));
    let expected = capacity() / conductance(1e-5);
    let found = simulation.stable_step();
    assert!((found / expected - 1.0).abs() < 1e-12, "{found:e} s found, {expected:e} s expected");
}

#[test]
fn a_bed_at_rest_heats_for_an_hour_in_a_few_time_steps() {
    let text = with_step("\"auto\"")
        + "[heat_source.air]\nparticles = { set = \"all\" }\n\
               ambient = { temperature = 290.0, conductance = 1.0e-5 }\n";
    let mut simulation = start(&text);
    simulation.advance(3600.0).unwrap();
    let steps = simulation.state().clock.steps;
    // Both lose heat with the time constant C/h; what is between them is gone at once. Of this a step takes 1/70, so Euler's method is
    // by t h²/C² Δt/2 = 5 % too low after an hour.
    let left = 60.0 * libm::exp(-3600.0 * 1e-5 / capacity());
    let mean = 0.5 * (temperature(&simulation, 0) + temperature(&simulation, 1)) - 290.0;
    assert!(steps < 1000 && (mean / left - 1.0).abs() < 0.06, "{steps} steps, {mean:e} K, {left:e} K expected");
}

#[test]
fn a_given_step_above_it_is_refused_with_what_limits_it() {
    let scene = crate::support::scene(&with_step("1.0e3"));
    let refused = cograin::simulation::Simulation::new(scene).map(drop).unwrap_err().to_string();
    assert!(refused.contains("limited by the conduction of heat"), "{refused}");
}
