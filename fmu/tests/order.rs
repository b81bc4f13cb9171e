//! Calls in the wrong order are refused, and the instance goes on.

use super::host::{Host, Unpacked};
use crate::types::{LAST_SUCCESSFUL_TIME, PENDING_STATUS, STEP_STATUS, Status, TERMINATED};
use crate::v2::values::*;
use crate::v2::*;
use std::ffi::CStr;
use std::ptr::{self, null, null_mut};

#[test]
fn a_whole_life_is_accepted() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
    assert_eq!(fmi2Terminate(host.component), Status::Ok);
    assert!(host.get("floor.force.z").is_finite());
    assert_eq!(fmi2Reset(host.component), Status::Ok);
    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
}

#[test]
fn calls_out_of_order_are_refused_and_harm_nothing() {
    let unit = Unpacked::new();
    let host = Host::instantiated(&unit);
    host.refused(host.step(0.0, 1.0e-4), &["fmi2DoStep: expected a call ", "found one before the initialisation mode"]);
    host.refused(
        fmi2ExitInitializationMode(host.component),
        &["fmi2ExitInitializationMode: expected", "found one before"],
    );
    host.refused(fmi2Terminate(host.component), &["fmi2Terminate: expected", "found one before"]);
    let (reference, mut value) = (0, 0.0);
    // SAFETY: one reference and one value.
    let status = unsafe { fmi2GetReal(host.component, &raw const reference, 1, &raw mut value) };
    host.refused(status, &["fmi2GetReal: expected a call ", "found one before the initialisation mode"]);

    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
    host.refused(fmi2EnterInitializationMode(host.component), &["found one in the initialisation mode"]);
    host.refused(fmi2SetupExperiment(host.component, 0, 0.0, 0.0, 0, 0.0), &["fmi2SetupExperiment"]);
    host.refused(host.step(0.0, 1.0e-4), &["found one in the initialisation mode"]);
    assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
    assert_eq!(fmi2Terminate(host.component), Status::Ok);
    host.refused(host.step(1.0e-4, 1.0e-4), &["found one after the end of the simulation"]);
    host.refused(host.set("floor.displacement.z", 0.0), &["found one after the end of the simulation"]);
}

#[test]
fn null_freed_and_foreign_components_are_refused() {
    let unit = Unpacked::new();
    let freed = Host::instantiated(&unit).component;
    let mut foreign = 0_u64;
    for component in [null_mut(), freed, ptr::from_mut(&mut foreign).cast()] {
        assert_eq!(fmi2DoStep(component, 0.0, 1.0e-4, 1), Status::Error);
        assert_eq!(fmi2Reset(component), Status::Error);
        fmi2FreeInstance(component);
    }
}

#[test]
fn null_arrays_are_refused_but_where_they_are_empty() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    // SAFETY: null is looked for; no array is read where the count is 0.
    unsafe {
        assert_eq!(fmi2GetReal(host.component, null(), 0, null_mut()), Status::Ok);
        assert_eq!(fmi2SetReal(host.component, null(), 0, null()), Status::Ok);
        host.refused(
            fmi2GetReal(host.component, null(), 1, null_mut()),
            &["fmi2GetReal: vr: expected an address, found null"],
        );
        host.refused(
            fmi2SetReal(host.component, &raw const ZERO, 1, null()),
            &["fmi2SetReal: value: expected an address, found null"],
        );
        host.refused(fmi2GetFMUstate(host.component, null_mut()), &["FMUstate: expected an address, found null"]);
        assert_eq!(fmi2FreeFMUstate(host.component, null_mut()), Status::Ok);
        host.refused(
            fmi2GetStatus(host.component, STEP_STATUS, null_mut()),
            &["value: expected an address, found null"],
        );
    }
}

/// The first value reference.
static ZERO: u32 = 0;

#[test]
fn status_is_of_the_last_step() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
    let (mut status, mut time, mut terminated, mut pending) = (Status::Error, 0.0, 1, null());
    // SAFETY: one value each.
    unsafe {
        assert_eq!(fmi2GetStatus(host.component, STEP_STATUS, &raw mut status), Status::Ok);
        assert_eq!(fmi2GetRealStatus(host.component, LAST_SUCCESSFUL_TIME, &raw mut time), Status::Ok);
        assert_eq!(fmi2GetBooleanStatus(host.component, TERMINATED, &raw mut terminated), Status::Ok);
        assert_eq!(fmi2GetStringStatus(host.component, PENDING_STATUS, &raw mut pending), Status::Ok);
        host.refused(fmi2GetStatus(host.component, TERMINATED, &raw mut status), &["fmi2GetStatus: status kind 3"]);
    }
    assert_eq!((status, time, terminated), (Status::Ok, 1.0e-4, 0));
    assert!(!pending.is_null());
    host.refused(fmi2GetIntegerStatus(host.component, 0, null_mut()), &["fmi2GetIntegerStatus"]);
    host.refused(fmi2CancelStep(host.component), &["fmi2CancelStep: no communication step is under way"]);
}

#[test]
fn the_platform_and_version_are_those_of_the_standard() {
    // SAFETY: both strings are constants that end in a zero.
    let (platform, version) = unsafe { (CStr::from_ptr(fmi2GetTypesPlatform()), CStr::from_ptr(fmi2GetVersion())) };
    assert_eq!((platform, version), (c"default", c"2.0"));
}

#[test]
fn messages_come_in_the_categories_that_are_wanted() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    assert_eq!(host.heard(), []);
    let (events, unknown) = ([c"logEvents".as_ptr()], [c"logEverything".as_ptr()]);
    // SAFETY: one category each.
    unsafe {
        assert_eq!(fmi2SetDebugLogging(host.component, 1, 1, events.as_ptr()), Status::Ok);
        host.refused(fmi2SetDebugLogging(host.component, 1, 1, unknown.as_ptr()), &["logEverything", "logEvents"]);
    }
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
    let (status, category, message) = host.heard().pop().unwrap();
    assert_eq!((status, category.as_str()), (Status::Ok, "logEvents"));
    assert!(message.starts_with("fmi2DoStep: "), "{message}");
    // SAFETY: no categories.
    assert_eq!(unsafe { fmi2SetDebugLogging(host.component, 0, 0, null()) }, Status::Ok);
    let before = host.heard().len();
    assert_eq!(host.step(1.0e-4, 1.0e-4), Status::Ok);
    assert_eq!(host.heard().len(), before);
}
