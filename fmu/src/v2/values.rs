//! The functions of FMI 2.0 that read and set variables, derivatives and status.

use crate::calls::{self, Call};
use crate::guard::{call, cancel};
use crate::host_memory::{Items, Target};
use crate::refusal::Refusal;
use crate::shared;
use crate::types::{
    Boolean, Component, LAST_SUCCESSFUL_TIME, PENDING_STATUS, Reference, STEP_STATUS, Status, TERMINATED, Text,
};
use cograin::interface::Value;
use std::ffi::c_int;

/// Reads variables of one type, all or nothing.
///
/// # Safety
/// As FMI 2.0 demands of the arrays.
unsafe fn get<T: Copy>(
    component: Component,
    function: &Call,
    kind: &'static str,
    (references, count, values): (*const Reference, usize, *mut T),
    convert: impl Fn(Value) -> T,
) -> Status {
    call(component, function, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let (references, targets) =
            unsafe { (Items::new("vr", references, count)?, Target::array("value", values, count)?) };
        for (place, value) in instance.values(references.indices(), kind)?.iter().enumerate() {
            targets.put(place, convert(*value));
        }
        Ok(())
    })
}

/// `fmi2GetReal`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: Component,
    references: *const Reference,
    count: usize,
    values: *mut f64,
) -> Status {
    // SAFETY: demands of FMI 2.0.
    unsafe { get(component, &calls::GET_REAL, "Real", (references, count, values), Value::number) }
}

/// `fmi2GetInteger`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    component: Component,
    references: *const Reference,
    count: usize,
    values: *mut c_int,
) -> Status {
    let integer = |value| match value {
        Value::Integer(value) => value,
        Value::Real(_) => 0,
    };
    // SAFETY: demands of FMI 2.0.
    unsafe { get(component, &calls::GET_INTEGER, "Integer", (references, count, values), integer) }
}

/// `fmi2GetBoolean`: there are no such variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    component: Component,
    references: *const Reference,
    count: usize,
    values: *mut Boolean,
) -> Status {
    // SAFETY: demands of FMI 2.0.
    unsafe { get(component, &calls::GET_BOOLEAN, "Boolean", (references, count, values), |_| 0) }
}

/// `fmi2GetString`: the texts stay where they are until they are set again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    component: Component,
    references: *const Reference,
    count: usize,
    values: *mut Text,
) -> Status {
    call(component, &calls::GET_STRING, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let (references, targets) =
            unsafe { (Items::new("vr", references, count)?, Target::array("value", values, count)?) };
        shared::put_texts(instance, references.indices(), &targets)
    })
}

/// `fmi2SetReal`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    component: Component,
    references: *const Reference,
    count: usize,
    values: *const f64,
) -> Status {
    call(component, &calls::SET_REAL, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let (references, values) =
            unsafe { (Items::new("vr", references, count)?, Items::new("value", values, count)?) };
        instance.set(references.indices(), values, "Real")
    })
}

/// `fmi2SetInteger`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    component: Component,
    references: *const Reference,
    count: usize,
    values: *const c_int,
) -> Status {
    call(component, &calls::SET_INTEGER, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let (references, values) =
            unsafe { (Items::new("vr", references, count)?, Items::new("value", values, count)?) };
        instance.set(references.indices(), values, "Integer")
    })
}

/// `fmi2SetBoolean`: there are no such inputs, so every reference is a wrong one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    component: Component,
    references: *const Reference,
    count: usize,
    values: *const Boolean,
) -> Status {
    call(component, &calls::SET_BOOLEAN, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let references = unsafe {
            Items::new("value", values, count)?;
            Items::new("vr", references, count)?
        };
        instance.refuse_type(references.indices(), "Boolean")
    })
}

/// `fmi2SetString`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    component: Component,
    references: *const Reference,
    count: usize,
    values: *const Text,
) -> Status {
    call(component, &calls::SET_STRING, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let (references, values) =
            unsafe { (Items::new("vr", references, count)?, Items::new("value", values, count)?) };
        // SAFETY: demands of FMI 2.0.
        unsafe { shared::take_texts(instance, references.indices(), values) }
    })
}

/// `fmi2SetRealInputDerivatives`: order 1, and 2 of quadratic motion.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    component: Component,
    references: *const Reference,
    count: usize,
    orders: *const c_int,
    values: *const f64,
) -> Status {
    call(component, &calls::SET_INPUT_DERIVATIVES, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let (references, orders, values) = unsafe {
            (
                Items::new("vr", references, count)?,
                Items::new("order", orders, count)?,
                Items::new("value", values, count)?,
            )
        };
        instance.set_rates(references, orders, values)
    })
}

/// `fmi2GetRealOutputDerivatives`: order 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    component: Component,
    references: *const Reference,
    count: usize,
    orders: *const c_int,
    values: *mut f64,
) -> Status {
    call(component, &calls::GET_OUTPUT_DERIVATIVES, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let (references, orders, targets) = unsafe {
            (
                Items::new("vr", references, count)?,
                Items::new("order", orders, count)?,
                Target::array("value", values, count)?,
            )
        };
        targets.put_all(&instance.output_derivatives(references.indices().zip(orders.iter()))?);
        Ok(())
    })
}

/// `fmi2GetDirectionalDerivative`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    component: Component,
    unknowns: *const Reference,
    unknown_count: usize,
    knowns: *const Reference,
    known_count: usize,
    direction: *const f64,
    derivatives: *mut f64,
) -> Status {
    call(component, &calls::GET_DIRECTIONAL_DERIVATIVE, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let (unknowns, knowns, direction, targets) = unsafe {
            (
                Items::new("vUnknown_ref", unknowns, unknown_count)?,
                Items::new("vKnown_ref", knowns, known_count)?,
                Items::new("dvKnown", direction, known_count)?,
                Target::array("dvUnknown", derivatives, unknown_count)?,
            )
        };
        targets.put_all(&instance.directional_derivatives(unknowns.indices(), knowns.indices(), direction)?);
        Ok(())
    })
}

/// `fmi2CancelStep`: from another thread it ends the `fmi2DoStep` under way, which then returns `fmi2Discard`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2CancelStep(component: Component) -> Status {
    cancel(component, &calls::CANCEL_STEP)
}

/// `fmi2GetStatus`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(component: Component, kind: c_int, value: *mut Status) -> Status {
    call(component, &calls::GET_STATUS, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let target = unsafe { Target::one("value", value)? };
        of_kind(kind, STEP_STATUS)?;
        target.put(0, instance.last_step());
        Ok(())
    })
}

/// `fmi2GetRealStatus`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(component: Component, kind: c_int, value: *mut f64) -> Status {
    call(component, &calls::GET_REAL_STATUS, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let target = unsafe { Target::one("value", value)? };
        of_kind(kind, LAST_SUCCESSFUL_TIME)?;
        target.put(0, instance.time());
        Ok(())
    })
}

/// `fmi2GetIntegerStatus`: the standard has no status of this type.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetIntegerStatus(component: Component, kind: c_int, _value: *mut c_int) -> Status {
    call(component, &calls::GET_INTEGER_STATUS, |_, _| Err(Refusal::Kind { kind }))
}

/// `fmi2GetBooleanStatus`: the unit never asks to end the experiment.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(component: Component, kind: c_int, value: *mut Boolean) -> Status {
    call(component, &calls::GET_BOOLEAN_STATUS, |_, _| {
        // SAFETY: demands of FMI 2.0.
        let target = unsafe { Target::one("value", value)? };
        of_kind(kind, TERMINATED)?;
        target.put(0, 0);
        Ok(())
    })
}

/// `fmi2GetStringStatus`: nothing is ever pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(component: Component, kind: c_int, value: *mut Text) -> Status {
    call(component, &calls::GET_STRING_STATUS, |_, _| {
        // SAFETY: demands of FMI 2.0.
        let target = unsafe { Target::one("value", value)? };
        of_kind(kind, PENDING_STATUS)?;
        target.put(0, c"".as_ptr());
        Ok(())
    })
}

/// Whether the kind of status is the one that a function is for.
fn of_kind(kind: c_int, expected: c_int) -> Result<(), Refusal> {
    if kind == expected { Ok(()) } else { Err(Refusal::Kind { kind }) }
}
