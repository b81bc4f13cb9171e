//! Heat is kept to rounding.

use super::{GRAINS, assert_close};
use crate::support::{start, uniform};
use std::fmt::Write as _;

/// A pile of 4 × 4 × 4 spheres of several temperatures and sizes that falls on a floor.
pub(super) fn pile(floor: &str, spread: f64) -> String {
    let (mut list, mut random) = (String::new(), 7);
    for place in 0..64 {
        let [x, y, z] = [place % 4, place / 4 % 4, place / 16].map(|n| f64::from(n) * 2.1e-3);
        let radius = 1e-3 * (0.9 + 0.1 * uniform(&mut random));
        let temperature = 300.0 + spread * uniform(&mut random);
        let _ = writeln!(
            list,
            "{{ position = [{:?}, {y:?}, {:?}], radius = {radius:?}, temperature = {temperature:?}, velocity = [{:?}, 0, -0.5] }},",
            x + 0.3 * z,
            z + 1e-3,
            0.2 * uniform(&mut random) - 0.1
        );
    }
    GRAINS.replace("step = 1.0e-4", "step = 2.0e-6")
        + &format!(
            "[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n[boundary.floor]\n\
             plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stone\"\n{floor}\n"
        )
}

#[test]
fn an_adiabatic_pile_keeps_its_heat() {
    let mut simulation = start(&pile("", 100.0));
    let all = |simulation: &cograin::simulation::Simulation| -> f64 {
        let heat = simulation.state().heat.as_ref().unwrap();
        (0..64).map(|index| heat.capacity[index] * heat.temperature(index)).sum()
    };
    let before = all(&simulation);
    simulation.advance(8e-3).unwrap();
    let exchange = simulation.state().heat.as_ref().unwrap().gained.iter().filter(|heat| **heat != 0.0).count();
    assert!(exchange > 20, "{exchange} spheres exchanged heat");
    assert_close(all(&simulation), before, 1e-14);
}

#[test]
fn what_particles_gain_is_what_boundaries_and_sources_give() {
    let source = "[heat_source.microwave]\nparticles = { set = \"all\" }\npower = 2.0e-3\n\
                  [heat_source.air]\nparticles = { set = \"all\" }\nambient = { temperature = 290.0, conductance = 1.0e-5 }\n";
    let mut simulation = start(&(pile("temperature = 500.0", 100.0) + source));
    simulation.advance(8e-3).unwrap();
    let heat = simulation.state().heat.as_ref().unwrap();
    assert!(heat.boundaries[0].heat() < 0.0 && heat.given > 0.0);
    let residual = heat.energy() + heat.boundaries[0].heat() - heat.given;
    assert!(residual.abs() < 1e-13 * heat.given, "{residual:e} J of {:e}", heat.given);
}

#[test]
fn particles_that_come_and_go_take_their_heat_along() {
    let text = pile("temperature = 500.0", 100.0)
        + "[region.above]\nbox = [[0.0, 0.0, 0.02], [0.01, 0.01, 0.03]]\n[region.side]\nbox = [[0.0, -0.01, -0.01], [0.003, 0.02, 0.03]]\n\
           [insertion.rain]\nregion = \"above\"\nmaterial = \"stone\"\nsizes = { radius = 1.0e-3 }\ncount_rate = 2.0e3\n\
           velocity = [0.0, 0.0, -2.0]\ntemperature = 700.0\n[outlet.out]\nregion = \"side\"\n";
    let mut simulation = start(&text);
    simulation.advance(4e-3).unwrap();
    simulation.advance(6e-3).unwrap();
    let state = simulation.state();
    let (heat, exchange) = (state.heat.as_ref().unwrap(), state.exchange.as_ref().unwrap());
    assert!(exchange.feeds[0].came.count > 5 && heat.departed != 0.0, "{:e} J departed", heat.departed);
    let residual = heat.energy() + heat.boundaries[0].heat();
    assert!(residual.abs() < 1e-13 * heat.boundaries[0].heat().abs(), "{residual:e} J");
    let newest = state.particles.slot_of((state.particles.slot.len() - 1) as u32).unwrap();
    let column = simulation.scene().column("temperature").unwrap();
    assert!(state.particles.declared[column][newest] > 500.0);
}

#[test]
fn small_heats_do_not_drown_in_three_hundred_kelvin() {
    let run = |rise: f64| {
        let mut simulation = start(&pile(&format!("temperature = {{ driven = {:?} }}", 300.0), 0.0));
        simulation.set_heat(cograin::quantity::BoundaryIndex(0), 300.0 + rise);
        simulation.advance(6e-3).unwrap();
        simulation.state().heat.as_ref().unwrap().energy() / rise
    };
    // 2⁻³⁰ K: a temperature near 300 K has 2⁻⁴⁴ K between two numbers, sums of it would have four digits.
    assert_close(run(2.0_f64.powi(-30)), run(8.0), 1e-12);
}
