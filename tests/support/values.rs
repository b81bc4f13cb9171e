//! What a simulation says, and whether it is what a test expects.

use cograin::interface::{Interface, Value};
use cograin::simulation::Simulation;

/// The value of a variable, by its name.
#[track_caller]
pub(crate) fn value(simulation: &Simulation, name: &str) -> f64 {
    let interface = Interface::of(simulation.scene());
    let index = interface.find(name).unwrap_or_else(|| panic!("there is no {name}"));
    interface.value(simulation, index).number()
}

/// Gives a value to an input, by its name.
#[track_caller]
pub(crate) fn set(simulation: &mut Simulation, name: &str, value: f64) {
    let interface = Interface::of(simulation.scene());
    let index = interface.find(name).unwrap_or_else(|| panic!("there is no {name}"));
    interface.set(simulation, index, Value::Real(value)).unwrap_or_else(|error| panic!("{error}"));
}

/// Velocity of the first particle \[m/s\].
pub(crate) fn velocity_of_first(simulation: &Simulation) -> [f64; 3] {
    let particles = &simulation.state().particles;
    let [x, y, z, _] = particles.velocity[particles.slot[0] as usize];
    [x, y, z]
}

/// Asserts that a number is within a part of another.
#[track_caller]
pub(crate) fn assert_near(found: f64, expected: f64, part: f64) {
    let off = (found - expected).abs();
    assert!(off <= part * expected.abs(), "{found:e}, not {expected:e}: off by {:e} of it", off / expected.abs());
}

/// Asserts that numbers are within a part of the largest of others.
#[track_caller]
pub(crate) fn assert_all_near(found: &[f64], expected: &[f64], part: f64, what: &str) {
    let scale = expected.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= part * scale, "{what}: found {found:?}, expected {expected:?}");
    }
}
