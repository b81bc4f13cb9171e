//! Hosts with other floating-point environments get the same bits and no signal: with
//! directed rounding, and with traps of exceptions.

#![cfg(target_arch = "x86_64")]

use super::host::{Host, Unpacked};
use crate::floating_point::trial::within;
use crate::types::Status;
use crate::v2::*;

/// All exceptions masked.
const MASKED: u32 = 0x1F80;

/// What every output is after some steps of a host whose calls are made in this environment, bit by bit.
fn outputs_within(control: u32, unit: &Unpacked) -> Vec<u64> {
    let host = within(control, || Host::started(unit));
    let length = 2.0e-4;
    let mut seen = Vec::new();
    for number in 0..8 {
        let point = f64::from(number) * length;
        let (x, z) = (1e-5 * f64::from(number), -3e-5 * f64::from(number));
        let names = ["floor.displacement.x", "grip.displacement.z"].map(|name| unit.reference(name));
        within(control, || {
            // SAFETY: two references and two values.
            let status = unsafe { crate::v2::values::fmi2SetReal(host.component, names.as_ptr(), 2, [x, z].as_ptr()) };
            assert_eq!(status, Status::Ok);
            assert_eq!(fmi2DoStep(host.component, point, length, 1), Status::Ok);
        });
        within(control, || seen.extend(host.outputs()));
    }
    seen
}

#[test]
fn the_hosts_rounding_and_flushing_change_no_bit() {
    let unit = Unpacked::new();
    let expected = outputs_within(MASKED, &unit);
    let environments = [
        ("down", 0x2000),
        ("up", 0x4000),
        ("to zero", 0x6000),
        ("flush to zero", 0x8000),
        ("subnormals are zero", 0x40),
    ];
    for (name, control) in environments {
        assert!(outputs_within(MASKED | control, &unit) == expected, "{name}");
    }
}

#[test]
fn a_host_that_traps_exceptions_gets_the_same_bits_and_no_signal() {
    let unit = Unpacked::new();
    let expected = outputs_within(MASKED, &unit);
    // Invalid operation, division by zero, overflow, underflow, rounding: all at once. Flags that are already raised
    // stay the host's.
    assert!(outputs_within(0, &unit) == expected);
    assert!(outputs_within(0x20 | 0x1000, &unit) == expected);
}
