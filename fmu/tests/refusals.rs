//! Wrong values are refused by name, nothing changes, and the instance goes on.

use super::host::{Host, Unpacked, source};
use crate::types::Status;
use crate::v2::values::*;
use crate::v2::*;
use cograin::scene::Source;
use std::ptr::{self, null_mut};

#[test]
fn a_value_that_is_no_number_is_refused_by_name() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let status = host.set("floor.displacement.z", value);
        host.refused(status, &["fmi2SetReal", "floor.displacement.z", &value.to_string()]);
        let status = host.set_rate("floor.displacement.z", value);
        host.refused(status, &["fmi2SetRealInputDerivatives", "floor.displacement.z"]);
    }
    assert_eq!(host.get("floor.displacement.z"), 0.0);
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
}

#[test]
fn setters_do_all_or_nothing() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let floor = unit.reference("floor.displacement.z");
    for (other, value) in [(unit.reference("floor.force.z"), 1.0), (9999, 1.0), (floor, f64::NAN)] {
        let (references, values) = ([floor, other], [1.0e-4, value]);
        // SAFETY: two references and two values.
        let status = unsafe { fmi2SetReal(host.component, references.as_ptr(), 2, values.as_ptr()) };
        host.refused(status, &["fmi2SetReal"]);
        assert_eq!(host.get("floor.displacement.z"), 0.0);
    }
}

#[test]
fn getters_write_nothing_when_they_refuse() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let (references, mut values) = ([unit.reference("floor.force.z"), 9999], [7.0, 7.0]);
    // SAFETY: two references and two values.
    let status = unsafe { fmi2GetReal(host.component, references.as_ptr(), 2, values.as_mut_ptr()) };
    host.refused(status, &["9999 is not a variable"]);
    assert_eq!(values, [7.0, 7.0]);
}

#[test]
fn outputs_are_not_set_and_types_are_not_mixed() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let force = unit.reference("floor.force.z");
    let right = "fmi2SetReal: floor.force.z is an output; only inputs and parameters may be set";
    host.refused(host.set("floor.force.z", 1.0), &[right]);

    let count = unit.reference("contacts.count");
    let (mut real, mut integer, integers, mut text) = (0.0, 0, 3, ptr::null());
    // SAFETY: one reference and one value each.
    unsafe {
        let status = fmi2GetReal(host.component, &raw const count, 1, &raw mut real);
        host.refused(status, &["contacts.count", "type Real, found Integer"]);
        let status = fmi2GetInteger(host.component, &raw const force, 1, &raw mut integer);
        host.refused(status, &["floor.force.z", "type Integer, found Real"]);
        let status = fmi2SetInteger(host.component, &raw const count, 1, &raw const integers);
        host.refused(status, &["contacts.count", "only inputs and parameters may be set"]);
        let status = fmi2GetBoolean(host.component, &raw const force, 1, &raw mut integer);
        host.refused(status, &["type Boolean"]);
        let status = fmi2SetBoolean(host.component, &raw const force, 1, &raw const integers);
        host.refused(status, &["type Boolean"]);
        let status = fmi2GetString(host.component, &raw const force, 1, &raw mut text);
        host.refused(status, &["type String"]);
        text = c"here".as_ptr();
        let status = fmi2SetString(host.component, &raw const force, 1, &raw const text);
        host.refused(status, &["type String"]);
        assert_eq!(fmi2GetInteger(host.component, &raw const count, 1, &raw mut integer), Status::Ok);
    }
    assert!(integer > 9, "{integer} contacts in a bed of nine spheres on a floor with four on top");
}

#[test]
fn second_derivatives_are_those_of_quadratic_motion() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    host.refused(host.set_derivative("floor.displacement.z", 2, 0.1), &["order 2", "floor.displacement.z", "order 1"]);
    host.refused(host.set_rate("floor.force.z", 0.1), &["only inputs and parameters may be set"]);

    let text = source().text.replace("[boundary.floor]\n", "[boundary.floor]\ninput = \"quadratic\"\n");
    let unit = Unpacked::of(&Source { text, ..source() }, "bent");
    let host = Host::started(&unit);
    let (length, acceleration) = (1.0e-3, 8.0);
    host.refused(
        host.set_derivative("floor.displacement.z", 3, 0.1),
        &["order 3", "expected order 1, or order 2 of quadratic motion, found order 3"],
    );
    host.refused(host.set_derivative("grip.displacement.z", 2, 0.1), &["order 2", "quadratic"]);
    host.refused(host.set_derivative("floor.displacement.z", 2, f64::NAN), &["floor.displacement.z", "NaN"]);
    assert_eq!(host.set("floor.displacement.z", 1.0e-5), Status::Ok);
    assert_eq!(host.set_derivative("floor.displacement.z", 2, acceleration), Status::Ok);
    assert_eq!(host.step(0.0, length), Status::Ok);
    assert_eq!(host.get("floor.displacement.z"), 1.0e-5 + (0.5 * acceleration * length) * length);
    assert!(host.get("floor.force_slope.z") < 0.0, "the floor pushes ever more");
}

#[test]
fn times_that_cannot_be_are_refused() {
    let unit = Unpacked::new();
    let host = Host::instantiated(&unit);
    let set_up = |start, stop| fmi2SetupExperiment(host.component, 0, 0.0, start, 1, stop);
    host.refused(set_up(f64::NAN, 1.0), &["startTime: expected a finite number, found NaN"]);
    host.refused(set_up(0.0, f64::INFINITY), &["stopTime: expected a finite number, startTime or later, found inf s"]);
    host.refused(set_up(1.0, 0.5), &["stopTime: expected a finite number, startTime or later, found 0.5 s"]);
    host.refused(
        fmi2SetupExperiment(host.component, 1, f64::NAN, 0.0, 0, 0.0),
        &["tolerance: expected a finite number of 0 or above, found NaN"],
    );
    assert_eq!(set_up(0.0, 3.0e-4), Status::Ok);
    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
    assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);

    for length in [0.0, -1.0e-4, f64::NAN, f64::INFINITY, 1.0e-300] {
        if length > 0.0 && length < 1.0 {
            assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
            host.refused(host.step(1.0e-4, length), &["communicationStepSize"]);
            continue;
        }
        host.refused(host.step(0.0, length), &["communicationStepSize"]);
    }
    host.refused(host.step(f64::NAN, 1.0e-4), &["currentCommunicationPoint: expected", "found NaN s"]);
    host.refused(
        host.step(2.0e-4, 1.0e-4),
        &["communication point: expected the present time, 0.0001 s, found 0.0002 s"],
    );
    host.refused(host.step(0.0, 1.0e-4), &["communication point: expected the present time, 0.0001 s, found 0 s"]);
    host.refused(host.step(1.0e-4, 3.0e-4), &["up to the stop time", "found one to 0.0003"]);
    assert_eq!(host.step(1.0e-4, 1.0e-4), Status::Ok);
    assert_eq!(host.step(2.0e-4 * (1.0 + 1.0e-12), 1.0e-4), Status::Ok);
    host.refused(host.step(3.0e-4, 1.0e-4), &["up to the stop time"]);
}

#[test]
fn a_step_left_out_or_made_twice_is_seen_at_any_time_of_the_calendar() {
    let length = 1.0e-4;
    for start in [0.0, 3600.0, 86_400.0, 3.0e7, 1.7e9] {
        let unit = Unpacked::new();
        let host = Host::instantiated(&unit);
        assert_eq!(fmi2SetupExperiment(host.component, 0, 0.0, start, 0, 0.0), Status::Ok);
        assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
        assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);
        assert_eq!(host.step(start, length), Status::Ok);
        host.refused(host.step(start, length), &["communication point: expected the present time"]);
        host.refused(host.step(start + 2.0 * length, length), &["communication point: expected the present time"]);
        assert_eq!(host.step(start + length, length), Status::Ok);
    }
}

#[test]
fn a_step_without_end_is_refused() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    host.refused(host.step(0.0, 1.0e12), &["time steps", "1000000000000 s"]);
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
}

#[test]
fn a_step_that_fails_is_discarded_and_the_state_is_that_of_its_beginning() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
    let (saved, before) = (host.save(), host.outputs());
    // the floor shoots up through the bed within a few time steps
    assert_eq!(host.set("floor.displacement.z", 0.5), Status::Ok);
    assert_eq!(host.step(1.0e-4, 1.0e-4), Status::Discard, "{}", host.said());
    let (status, category, message) = host.heard().pop().unwrap();
    assert_eq!((status, category.as_str()), (Status::Discard, "logStatusDiscard"), "{message}");
    let (mut time, mut terminated) = (f64::NAN, 1);
    // SAFETY: one value each.
    unsafe {
        assert_eq!(fmi2GetRealStatus(host.component, 2, &raw mut time), Status::Ok);
        assert_eq!(fmi2GetBooleanStatus(host.component, 3, &raw mut terminated), Status::Ok);
    }
    assert_eq!(time, 1.0e-4);
    assert_eq!(terminated, 0);
    assert_eq!(host.outputs(), before);
    assert_eq!(host.set("floor.displacement.z", 0.0), Status::Ok);
    assert_eq!(host.step(1.0e-4, 1.0e-5), Status::Ok, "{}", host.said());
    assert_eq!(fmi2SetFMUstate(host.component, saved), Status::Ok);
    assert_eq!(host.set("floor.displacement.z", 1.0e-6), Status::Ok);
    assert_eq!(host.step(1.0e-4, 1.0e-4), Status::Ok);
}

#[test]
fn a_panic_is_an_error_until_reset() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let status = crate::guard::call(host.component, &crate::calls::DO_STEP, |_, _| panic!("broken by hand"));
    host.refused(status, &["fmi2DoStep: internal error: broken by hand"]);
    host.refused(host.step(0.0, 1.0e-4), &["after an internal error"]);
    host.refused(host.set("floor.displacement.z", 0.0), &["after an internal error"]);
    assert_eq!(fmi2Reset(host.component), Status::Ok);
    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
    assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
}

#[test]
fn a_call_within_a_call_is_refused() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let mut inner = Status::Ok;
    let outer = crate::guard::call(host.component, &crate::calls::DO_STEP, |_, _| {
        inner = host.step(0.0, 1.0e-4);
        Ok(())
    });
    assert_eq!(outer, Status::Ok);
    host.refused(inner, &["expected one call of this instance at a time, found another one that runs"]);
}

#[test]
fn a_message_holds_no_percent_sign() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let name = [c"%s%n".as_ptr()];
    // SAFETY: one category.
    let status = unsafe { fmi2SetDebugLogging(host.component, 1, 1, name.as_ptr()) };
    host.refused(status, &["expected a category among"]);
}

/// Room was once made for as many values as the host said, before the first reference was looked at.
#[test]
fn counts_that_no_memory_holds_are_refused_before_anything_is_done() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let force = unit.reference("floor.force.z");
    let (mut real, mut flag, mut text) = (7.0, 7, c"a".as_ptr());
    for count in [1_usize << 33, 1 << 40, 1 << 60, usize::MAX] {
        // SAFETY: the count is refused before anything is read or written.
        unsafe {
            host.refused(
                fmi2GetReal(host.component, &raw const force, count, &raw mut real),
                &["expected an array that memory can hold"],
            );
            host.refused(
                fmi2GetBoolean(host.component, &raw const force, count, &raw mut flag),
                &["expected an array that memory can hold"],
            );
            host.refused(
                fmi2SetString(host.component, &raw const force, count, &raw const text),
                &["expected an array that memory can hold"],
            );
            host.refused(
                fmi2GetString(host.component, &raw const force, count, &raw mut text),
                &["expected an array that memory can hold"],
            );
        }
    }
    assert_eq!((real, flag), (7.0, 7));
    let bytes = host.serialize(host.save());
    let mut state = null_mut();
    for size in [1_usize << 33, 1 << 45, isize::MAX.unsigned_abs()] {
        // SAFETY: the state says how long it is: the size is refused before more is read.
        let status = unsafe { fmi2DeSerializeFMUstate(host.component, bytes.as_ptr().cast(), size, &raw mut state) };
        host.refused(status, &["its length or checksum does not fit"]);
    }
    assert!(state.is_null());
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
}
