//! Derivatives by inputs and in time, as a host asks for them.

use super::host::{BED, Host, Unpacked, source};
use crate::types::Status;
use crate::v2::values::*;
use crate::v2::*;
use cograin::scene::Source;

impl Host<'_> {
    /// Change of outputs along a direction of inputs; nothing where the call is refused.
    fn change(&self, outputs: &[&str], inputs: &[&str], direction: &[f64]) -> Result<Vec<f64>, Status> {
        let references = |names: &[&str]| names.iter().map(|name| self.unit.reference(name)).collect::<Vec<_>>();
        let (unknowns, knowns) = (references(outputs), references(inputs));
        let mut changes = vec![f64::NAN; outputs.len()];
        // SAFETY: as many references and numbers as the call says.
        let status = unsafe {
            fmi2GetDirectionalDerivative(
                self.component,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                direction.as_ptr(),
                changes.as_mut_ptr(),
            )
        };
        if status == Status::Ok { Ok(changes) } else { Err(status) }
    }

    /// Rate of an output.
    fn rate(&self, name: &str, order: i32) -> Result<f64, Status> {
        let (reference, mut rate) = (self.unit.reference(name), f64::NAN);
        // SAFETY: one reference, order and rate.
        let status = unsafe {
            fmi2GetRealOutputDerivatives(self.component, &raw const reference, 1, &raw const order, &raw mut rate)
        };
        if status == Status::Ok { Ok(rate) } else { Err(status) }
    }
}

/// Outputs that follow the inputs.
const OUTPUTS: [&str; 5] =
    ["floor.force.x", "floor.force.z", "floor.mean_force.z", "floor.moment.y", "floor.mean_moment.x"];

#[test]
fn a_directional_derivative_is_that_of_differences_of_the_unit() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    host.shake(0, 7);
    let (inputs, direction) =
        (["floor.displacement.x", "floor.displacement.z", "grip.displacement.z"], [0.6, 1.0, -0.5]);
    let given = inputs.map(|name| host.get(name));
    let begin = host.save();
    let at = |share: f64| {
        assert_eq!(fmi2SetFMUstate(host.component, begin), Status::Ok);
        for ((name, given), part) in inputs.iter().zip(given).zip(direction) {
            assert_eq!(host.set(name, given + share * part), Status::Ok);
        }
        assert_eq!(host.step(7.0 * 2.0e-4, 2.0e-4), Status::Ok, "{}", host.said());
        OUTPUTS.map(|name| host.get(name))
    };
    let (there, back) = (at(1.0e-10), at(-1.0e-10));
    at(0.0);
    let before = host.outputs();
    let found = host.change(&OUTPUTS, &inputs, &direction).expect("the unit has derivatives");
    assert_eq!(host.outputs(), before, "asking changes nothing");
    for (place, name) in OUTPUTS.iter().enumerate() {
        let expected = (there[place] - back[place]) / 2.0e-10;
        assert!(expected != 0.0, "{name} does not change");
        assert!((found[place] / expected - 1.0).abs() < 1e-5, "{name}: {} and {expected}", found[place]);
    }
    let twice = host.change(&OUTPUTS, &inputs, &direction.map(|part| 2.0 * part)).expect("they are known");
    assert_eq!(twice, found.iter().map(|change| 2.0 * change).collect::<Vec<_>>());
    let state = host.save();
    let expected = host.shake(8, 5);
    assert_eq!(fmi2SetFMUstate(host.component, state), Status::Ok);
    assert!(host.shake(8, 5) == expected, "the unit goes elsewhere");
}

#[test]
fn a_derivative_without_a_step_before_is_refused_and_the_next_one_is_not() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let ask = || host.change(&["floor.force.z"], &["floor.displacement.z"], &[1.0]);
    host.refused(ask().expect_err("there is no step"), &["last communication step"]);
    host.shake(0, 1);
    assert!(ask().is_ok());
    let state = host.save();
    assert_eq!(fmi2SetFMUstate(host.component, state), Status::Ok);
    host.refused(ask().expect_err("there is no step"), &["last communication step"]);
    host.shake(1, 1);
    assert!(ask().is_ok());
}

#[test]
fn what_has_no_derivative_is_refused_by_name() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    host.shake(0, 1);
    let input = host.change(&["floor.displacement.z"], &["floor.displacement.z"], &[1.0]);
    host.refused(input.expect_err("it is no output"), &["floor.displacement.z", "changes continuously"]);
    let output = host.change(&["floor.force.z"], &["floor.force.x"], &[1.0]);
    host.refused(output.expect_err("it is not an input"), &["floor.force.x", "expected an input"]);
    host.refused(host.rate("energy.kinetic", 1).expect_err("it has none"), &["energy.kinetic", "mean_force"]);
    host.refused(host.rate("floor.force.z", 2).expect_err("it is the wrong order"), &["order 2", "expected order 1"]);
}

#[test]
fn a_unit_with_a_drum_has_derivatives_of_everything_that_changes_continuously() {
    let drum = BED.replace(
        "[boundary.grip]",
        "[boundary.drum]\nmaterial = \"glass\"\ncylinder = { from = [0.02, 0.02, -0.1], to = [0.02, 0.02, 0.2], radius = 0.1 }\n\
         motion = { driven = [\"rotation.z\"] }\n[boundary.grip]",
    );
    let unit = Unpacked::of(&Source { text: drum, ..source() }, "drum");
    let host = Host::started(&unit);
    host.shake(0, 3);
    let before = host.outputs();
    let found = host.change(&["floor.force.z", "energy.kinetic"], &["floor.displacement.z"], &[1.0]);
    assert!(found.expect("the unit has derivatives").iter().all(|change| *change != 0.0));
    assert!(host.change(&["drum.moment.z"], &["drum.rotation.z"], &[1.0]).is_ok());
    assert_eq!(host.outputs(), before, "asking changes nothing");
}

#[test]
fn rates_are_handed_out_and_change_nothing() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    assert_eq!(host.rate("floor.force.z", 1), Ok(0.0), "before the first step nothing changes");
    host.shake(0, 3);
    let before = host.outputs();
    for name in ["floor.force.z", "floor.mean_force.z"] {
        let rate = host.rate(name, 1).expect("it is known");
        assert!(rate.is_finite() && rate != 0.0);
    }
    assert_eq!(host.outputs(), before);
}
