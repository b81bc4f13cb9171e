//! Saved states continue bit for bit; what is not a state is refused.

use super::host::{Host, Unpacked, source};
use crate::types::Status;
use crate::v2::*;
use cograin::scene::Source;
use std::ptr::null_mut;

#[test]
fn a_restored_state_continues_bit_for_bit() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    host.shake(0, 4);
    assert!(host.get("floor.force.x") != 0.0, "springs are loaded");
    let state = host.save();
    let first = host.shake(4, 25);
    assert_eq!(fmi2SetFMUstate(host.component, state), Status::Ok);
    assert!(host.shake(4, 25) == first, "the second run differs");
}

#[test]
fn bytes_of_a_state_continue_in_another_instance() {
    let unit = Unpacked::new();
    let (host, other) = (Host::started(&unit), Host::instantiated(&unit));
    host.shake(0, 4);
    let bytes = host.serialize(host.save());
    let expected = host.shake(4, 10);
    let state = other.deserialize(&bytes);
    assert_eq!(fmi2SetFMUstate(other.component, state), Status::Ok, "{}", other.said());
    assert!(other.shake(4, 10) == expected, "the other instance goes elsewhere");
}

#[test]
fn serialising_twice_gives_the_same_bytes() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    host.shake(0, 3);
    let bytes = host.serialize(host.save());
    let state = host.deserialize(&bytes);
    assert!(host.serialize(state) == bytes);
    assert!(host.serialize(state) == bytes);
}

#[test]
fn inputs_and_their_rates_belong_to_the_state() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    assert_eq!(host.set("floor.displacement.z", 1.0e-5), Status::Ok);
    assert_eq!(host.set_rate("floor.displacement.z", 0.1), Status::Ok);
    let state = host.save();
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
    let expected = host.outputs();
    assert_eq!(fmi2SetFMUstate(host.component, state), Status::Ok);
    assert_eq!(host.get("floor.displacement.z"), 1.0e-5);
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
    assert_eq!(host.outputs(), expected);
}

#[test]
fn a_state_holds_where_the_instance_stands_and_when_it_must_stop() {
    let unit = Unpacked::new();
    let host = Host::instantiated(&unit);
    let made = host.save();
    assert_eq!(fmi2SetupExperiment(host.component, 0, 0.0, 2.0, 1, 2.0 + 1.0e-4), Status::Ok);
    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
    assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);
    let bytes = host.serialize(host.save());
    assert_eq!(host.step(2.0, 1.0e-4), Status::Ok, "{}", host.said());
    assert_eq!(fmi2Terminate(host.component), Status::Ok);

    let ready = host.deserialize(&bytes);
    assert_eq!(fmi2SetFMUstate(host.component, ready), Status::Ok);
    host.refused(host.step(2.0, 2.0e-4), &["up to the stop time"]);
    assert_eq!(host.step(2.0, 1.0e-4), Status::Ok, "{}", host.said());
    assert_eq!(fmi2SetFMUstate(host.component, made), Status::Ok);
    host.refused(host.step(0.0, 1.0e-4), &["before the initialisation mode"]);
}

#[test]
fn a_handle_is_overwritten_freed_and_then_unknown() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let mut state = host.save();
    let before = state;
    host.shake(0, 2);
    // SAFETY: one handle.
    unsafe {
        assert_eq!(fmi2GetFMUstate(host.component, &raw mut state), Status::Ok);
        assert_eq!(state, before);
        assert_eq!(fmi2FreeFMUstate(host.component, &raw mut state), Status::Ok);
        assert!(state.is_null());
        assert_eq!(fmi2FreeFMUstate(host.component, &raw mut state), Status::Ok);
    }
    host.refused(fmi2SetFMUstate(host.component, before), &["fmi2SetFMUstate: expected a state that "]);
    host.refused(fmi2SetFMUstate(host.component, null_mut()), &["fmi2SetFMUstate: expected a state that "]);
}

#[test]
fn a_handle_of_another_instance_is_refused() {
    let unit = Unpacked::new();
    let (host, other) = (Host::started(&unit), Host::started(&unit));
    let state = host.save();
    other.refused(fmi2SetFMUstate(other.component, state), &["expected a state that "]);
    assert_eq!(fmi2SetFMUstate(host.component, state), Status::Ok);
}

#[test]
fn damaged_and_foreign_bytes_are_refused() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let bytes = host.serialize(host.save());
    for place in (0..bytes.len()).step_by(bytes.len() / 40) {
        let mut damaged = bytes.clone();
        damaged[place] ^= 0x10;
        assert!(host.deserialize(&damaged).is_null(), "a changed byte {place} was accepted");
    }
    for length in [0, 7, 8, 11, 12, 20, 40, bytes.len() - 1] {
        assert!(host.deserialize(&bytes[..length]).is_null(), "{length} bytes were accepted");
    }
    assert!(host.deserialize(&[&bytes[..], &[0]].concat()).is_null());

    let text = source().text.replace("end = 0.1", "end = 0.2");
    let stranger = Unpacked::of(&Source { text, ..source() }, "other");
    let stranger = Host::started(&stranger);
    assert!(stranger.deserialize(&bytes).is_null());
    stranger.refused(Status::Error, &["fmi2DeSerializeFMUstate", &unit.identity]);

    let state = host.deserialize(&bytes);
    assert_eq!(fmi2SetFMUstate(host.component, state), Status::Ok);
}

#[test]
fn a_buffer_that_is_too_small_is_refused_and_left_alone() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let state = host.save();
    let size = host.serialize(state).len();
    let mut bytes = vec![7_u8; size - 1];
    // SAFETY: a buffer of that size.
    let status = unsafe { fmi2SerializeFMUstate(host.component, state, bytes.as_mut_ptr().cast(), bytes.len()) };
    host.refused(status, &[&format!("expected {size} bytes, found {}", size - 1)]);
    assert!(bytes.iter().all(|byte| *byte == 7));
}

#[test]
fn a_reset_instance_starts_as_a_new_one() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let first = host.shake(0, 10);
    assert_eq!(fmi2Reset(host.component), Status::Ok);
    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
    assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);
    assert!(host.shake(0, 10) == first, "the second life differs");
}
