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
fn a_given_step_above_it_is_divided() {
    let mut simulation = start(&with_step("1.0e3"));
    simulation.advance(1e3).unwrap();
    let (steps, longest) = (simulation.state().clock.steps, capacity() / conductance(1e-5));
    assert!(steps as f64 >= 1e3 / longest, "{steps} steps of at most {longest:e} s");
    assert!((temperature(&simulation, 0) - 350.0).abs() < 1e-9);
}

#[test]
fn a_strict_step_above_it_is_refused_with_what_limits_it() {
    let scene = crate::support::scene(&with_step("1.0e3\nstrict_step = true"));
    let refused = cograin::simulation::Simulation::new(scene).map(drop).unwrap_err().to_string();
    assert!(refused.contains("limited by the conduction of heat"), "{refused}");
}

#[test]
fn what_loses_more_heat_than_it_has_stops_the_run() {
    let scene = |source: &str, boundary: &str| {
        format!(
            r#"
[run]
step = 1.0e-3
[material.stone]
density = 2500.0
specific_heat = 800.0
[particles.grain]
material = "stone"
temperature = 300.0
list = [{{ id = 7, position = [0.0, 0.0, 0.01], radius = 1.0e-3 }}]
[boundary.plate]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "stone"
temperature = 300.0
heat_capacity = 0.01
{boundary}
{source}
"#
        )
    };
    let source = |power: &str| format!("[heat_source.cooler]\nparticles = {{ set = \"grain\" }}\npower = {power}");
    for (power, boundary, name) in [("-1.0", "", "particle 7"), ("0.0", "applied_heat = -1.0", "[boundary.plate]")] {
        let mut simulation = start(&scene(&source(power), boundary));
        // 2.51 J to 0 K of the grain, 3 J of the plate.
        simulation.advance(2.0).unwrap();
        let stopped = simulation.advance(1.5).unwrap_err().to_string();
        assert!(stopped.starts_with(&format!("{name} has a temperature of -")), "{stopped}");
    }
}
