//! Boundaries with a temperature.

use super::{GRAINS, assert_close, capacity, row, steps, temperature};
use crate::support::start;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;

/// A sphere of 1 mm at 300 K that overlaps a floor by 10 µm; nothing moves. The floor has these keys.
fn on_floor(keys: &str) -> Simulation {
    let list = row([(0.0, 300.0)]);
    start(&format!(
        "{GRAINS}[heat]\nfrozen = true\n[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n\
         [boundary.floor]\nplane = {{ point = [0, 0, 1.0e-5], normal = [0, 0, 1] }}\nmaterial = \"stone\"\n{keys}\n"
    ))
}

/// Conductance of a sphere of 1 mm and a floor at an overlap of 10 µm \[W/K\].
fn conductance() -> f64 {
    2.0 * 5.0 * (1e-3_f64 * 1e-5).sqrt()
}

#[test]
fn a_held_temperature_warms_a_sphere_as_the_explicit_method_has_it() {
    let mut simulation = on_floor("temperature = 350.0");
    steps(&mut simulation, 500);
    let left = libm::pow(1.0 - 1e-4 * conductance() / capacity(), 500.0);
    assert_close(temperature(&simulation, 0), 350.0 - 50.0 * left, 1e-12);
    let floor = simulation.state().heat.as_ref().unwrap().boundaries[0];
    assert_close(floor.heat(), -capacity() * 50.0 * (1.0 - left), 1e-11);
}

#[test]
fn without_a_temperature_a_boundary_takes_no_heat() {
    let list = row([(0.0, 300.0), (1.99e-3, 300.0)]);
    let mut simulation = start(&format!(
        "{GRAINS}[heat]\nfrozen = true\n[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n\
         [boundary.floor]\nplane = {{ point = [0, 0, 1.0e-5], normal = [0, 0, 1] }}\nmaterial = \"stone\"\n"
    ));
    steps(&mut simulation, 10);
    assert_eq!(temperature(&simulation, 0), 300.0);
}

#[test]
fn a_boundary_with_a_capacity_and_a_sphere_approach_each_other() {
    let mut simulation = on_floor("temperature = 350.0\nheat_capacity = 0.01");
    steps(&mut simulation, 500);
    let shrinks = 1.0 - 1e-4 * conductance() * (1.0 / capacity() + 1.0 / 0.01);
    let end = (capacity() * 300.0 + 0.01 * 350.0) / (capacity() + 0.01);
    let apart = 50.0 * libm::pow(shrinks, 500.0);
    let floor = simulation.state().heat.as_ref().unwrap().boundaries[0].temperature();
    assert_close(floor - temperature(&simulation, 0), apart, 1e-10);
    assert_close((capacity() * temperature(&simulation, 0) + 0.01 * floor) / (capacity() + 0.01), end, 1e-14);
}

#[test]
fn applied_heat_warms_a_boundary_with_a_capacity() {
    let mut simulation = on_floor("temperature = 300.0\nheat_capacity = 0.01\napplied_heat = 0.5");
    steps(&mut simulation, 200);
    simulation.set_heat(BoundaryIndex(0), 0.0);
    simulation.set_heat_rate(BoundaryIndex(0), 10.0);
    simulation.advance(0.1).unwrap();
    // 0.5 W for 20 ms, then a ramp from 0 to 1 W in 100 ms.
    let given = 0.5 * 0.02 + 0.5 * 0.1;
    let heat = simulation.state().heat.as_ref().unwrap();
    assert_close(heat.energy() + 0.01 * heat.boundaries[0].rise, given, 1e-13);
}

#[test]
fn a_driven_temperature_is_reached_at_the_end_of_the_step_and_the_mean_flow_is_what_was_given() {
    let mut simulation = on_floor("temperature = \"driven\"");
    let mut before = 0.0;
    for (end, interval) in [(310.0, 1e-2), (290.0, 3.3e-3), (290.0, 1e-4)] {
        simulation.set_heat(BoundaryIndex(0), end);
        simulation.advance(interval).unwrap();
        let heat = simulation.state().heat.as_ref().unwrap();
        let gained = heat.energy() - before;
        before = heat.energy();
        assert_close(heat.boundaries[0].temperature(), end, 1e-15);
        assert_close(heat.boundaries[0].mean_flow * interval, -gained, 1e-13);
    }
}

#[test]
fn a_driven_temperature_goes_straight_to_its_new_value() {
    let mut simulation = on_floor("temperature = { driven = 300.0 }");
    simulation.set_heat(BoundaryIndex(0), 310.0);
    simulation.advance(1e-2).unwrap();
    // Explicit Euler against a ramp: T += Δt H/C (300 + 10 n/100 − T).
    let (mut rise, factor) = (0.0, 1e-4 * conductance() / capacity());
    for step in 0..100 {
        rise += factor * (10.0 * f64::from(step) / 100.0 - rise);
    }
    assert_close(temperature(&simulation, 0) - 300.0, rise, 1e-10);
}

#[test]
fn a_flat_mesh_conducts_as_a_plane() {
    let list = row([(0.0, 300.0)]);
    let text = format!(
        "{GRAINS}[heat]\nfrozen = true\n[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n\
         [boundary.floor]\nrectangle = {{ corner = [-0.05, -0.05, 1.0e-5], edges = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0]] }}\n\
         material = \"stone\"\ntemperature = 350.0\n"
    );
    let mut rectangle = start(&text);
    let mut plane = on_floor("temperature = 350.0");
    steps(&mut rectangle, 1);
    steps(&mut plane, 1);
    assert_close(temperature(&rectangle, 0), temperature(&plane, 0), 1e-15);
}
