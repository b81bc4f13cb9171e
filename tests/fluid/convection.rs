//! Heat between grains and a fluid.

use super::scenes::{SIX, sum};
use crate::support::{assert_near, start, value};
use cograin::interface::{Interface, Value};
use cograin::simulation::Simulation;
use std::f64::consts::PI;

/// Two warm grains in a fluid on a grid of six cells, at rest; `fluid` keys.
fn warm(fluid: &str) -> Simulation {
    start(&format!(
        r#"
[run]
step = 1.0e-3
[material.a]
density = 2500.0
specific_heat = 800.0
[particles.grains]
material = "a"
temperature = 400.0
list = [{{ position = [0.0123, 0.0171, 0.0088], radius = 1.0e-3 }}, {{ position = [0.0523, 0.0071, 0.0188], radius = 2.0e-3 }}]
[grid.column]
{SIX}
[fluid.water]
density = 1.2
viscosity = 1.8e-5
conductivity = 0.026
specific_heat = 1005.0
{fluid}
[fluid.water.drag.stokes]
"#
    ))
}

/// Temperature of a grain \[K\].
fn temperature(simulation: &Simulation, index: usize) -> f64 {
    simulation.state().heat.as_ref().unwrap().temperature(index)
}

#[test]
fn a_grain_cools_in_air_at_rest_as_an_exponential() {
    // Nu = 2: τ = ρ c d²/(12 k).
    let mut simulation = warm("temperature = 300.0\n[fluid.water.heat.ranz_marshall]");
    simulation.advance(5.0).unwrap();
    for (index, diameter) in [(0, 2e-3_f64), (1, 4e-3)] {
        let relaxation = 2500.0 * 800.0 * diameter * diameter / (12.0 * 0.026);
        let expected = 300.0 + 100.0 * (-5.0 / relaxation).exp();
        assert_near(temperature(&simulation, index) - 300.0, expected - 300.0, 1e-4);
    }
}

#[test]
fn cells_take_the_heat_that_grains_lose_to_rounding() {
    let mut simulation =
        warm("temperature = 300.0\ngrid = \"column\"\nvelocity = [0.1, 0.0, 0.0]\n[fluid.water.heat.gunn]");
    let capacities = [1e-3_f64, 2e-3].map(|radius| 2500.0 * 800.0 * 4.0 / 3.0 * PI * radius.powi(3));
    let heat = |simulation: &Simulation| {
        let of = |index: usize| capacities[index] * temperature(simulation, index);
        of(0) + of(1)
    };
    for _ in 0..3 {
        let before = heat(&simulation);
        simulation.advance(0.05).unwrap();
        let [lost, taken] = [before - heat(&simulation), 0.05 * sum(&simulation, "mean_heat_flow")];
        assert!(lost > 0.0);
        assert_near(taken, lost, 1e-9);
    }
    let name = "energy.heat_residual";
    assert!(value(&simulation, name).abs() < 1e-12 * heat(&simulation), "{name}");
}

#[test]
fn a_driven_temperature_is_that_between_the_centres_of_cells() {
    let keys = "grid = \"column\"\ntemperature = \"driven\"\n[fluid.water.heat.ranz_marshall]";
    let mut simulation = warm(keys);
    let interface = Interface::of(simulation.scene());
    let grid = simulation.scene().grids[0].shape;
    for cell in 0..36 {
        let index = interface.find(&format!("water.cell[{}].temperature", cell + 1)).unwrap();
        interface.set(&mut simulation, index, Value::Real(300.0 + 1e3 * grid.centre(cell)[0])).unwrap();
    }
    simulation.place(None).unwrap();
    simulation.advance(1e-3).unwrap();
    let found = 400.0 - sum(&simulation, "mean_heat_flow") / sum(&simulation, "heat_conductance");
    // Nu = 2, so that conductances go by diameters: 1 to 2.
    assert_near(found, 300.0 + 1e3 * (0.0123 + 2.0 * 0.0523) / 3.0, 1e-12);
}
