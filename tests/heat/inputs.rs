//! Thermal variables of the unit: names, values, derivatives.

use super::{GRAINS, assert_close, row};
use crate::support::{start, value};
use cograin::interface::{Derivatives, Interface, Value};
use cograin::simulation::Simulation;

/// A sphere on a floor whose temperature is driven, a cylinder of a probe and a region; nothing moves.
fn begin() -> Simulation {
    let list = row([(0.0, 300.0), (1.99e-3, 320.0)]);
    start(&format!(
        "{GRAINS}[heat]\nfrozen = true\n[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n\
         [boundary.floor]\nplane = {{ point = [0, 0, 1.0e-5], normal = [0, 0, 1] }}\nmaterial = \"stone\"\n\
         temperature = {{ driven = 310.0 }}\n\
         [boundary.lid]\nplane = {{ point = [0, 0, 1.99e-3], normal = [0, 0, -1] }}\nmaterial = \"stone\"\n\
         temperature = 305.0\nheat_capacity = 2.0\n\
         [region.half]\nbox = [[-0.01, -0.01, -0.01], [9.95e-4, 0.01, 0.01]]\n\
         [probe.second]\nparticle = 2\n[probe.both]\nset = \"all\"\n"
    ))
}

#[test]
fn probes_and_regions_show_temperatures_by_heat_capacity() {
    let simulation = begin();
    assert_eq!(value(&simulation, "second.temperature"), 320.0);
    assert_close(value(&simulation, "both.temperature"), 310.0, 1e-15);
    assert!((300.0..300.2).contains(&value(&simulation, "half.temperature")));
    assert_eq!(value(&simulation, "floor.temperature"), 310.0);
    assert_eq!(value(&simulation, "lid.temperature"), 305.0);
    assert_eq!(value(&simulation, "floor.heat_flow"), 0.0);
}

#[test]
fn energies_of_heat_close() {
    let mut simulation = begin();
    simulation.advance(0.05).unwrap();
    let given = value(&simulation, "floor.heat") + value(&simulation, "lid.heat");
    assert_close(value(&simulation, "energy.heat"), -given, 1e-12);
    assert!(value(&simulation, "energy.heat_residual").abs() <= 1e-13 * given.abs());
    assert_close(value(&simulation, "floor.mean_heat_flow") * 0.05, value(&simulation, "floor.heat"), 1e-15);
}

#[test]
fn derivatives_by_thermal_inputs_are_those_of_differences() {
    for (input, change, output) in
        [("floor.temperature", 1.0, "floor.mean_heat_flow"), ("lid.applied_heat", 1.0, "lid.temperature")]
    {
        let mut simulation = begin();
        let interface = Interface::of(simulation.scene());
        let [input, output] = [input, output].map(|name| interface.find(name).unwrap());
        let run = |by: f64| {
            let mut simulation = begin();
            let given = interface.value(&simulation, input).number() + by;
            interface.set(&mut simulation, input, Value::Real(given)).unwrap();
            simulation.advance(0.05).unwrap();
            interface.value(&simulation, output).number()
        };
        let expected = (run(change) - run(-change)) / (2.0 * change);
        simulation.advance_or_roll_back(0.05).unwrap();
        let asked: (&[usize], &[(usize, f64)]) = (&[output], &[(input, 1.0)]);
        let found = interface.derivatives(&mut simulation, &mut Derivatives::default(), asked).unwrap()[0];
        assert!(expected != 0.0);
        assert_close(found, expected, 1e-8);
    }
}
