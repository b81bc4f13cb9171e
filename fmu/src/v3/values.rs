//! The functions of FMI 3.0 that read and set variables and tell derivatives.

use super::calls;
use crate::calls::Call;
use crate::guard::call;
use crate::host_memory::{Items, Target};
use crate::refusal::Refusal;
use crate::shared;
use crate::types::{Component, Reference, Status, Text};
use cograin::interface::Value;

/// An array of the host and its length.
type Array<T> = (*const T, usize);

/// Whether an array has as many elements as the variables.
fn fits(argument: &'static str, elements: impl Iterator, given: usize) -> Result<(), Refusal> {
    let needed = elements.count();
    if needed == given { Ok(()) } else { Err(Refusal::Count { argument, needed, given }) }
}

/// Reads variables of one type, all or nothing.
///
/// # Safety
/// As FMI 3.0 demands of the arrays.
unsafe fn get<T: Copy>(
    instance: Component,
    function: &Call,
    kind: &'static str,
    ((references, count), (values, length)): (Array<Reference>, (*mut T, usize)),
    convert: impl Fn(Value) -> T,
) -> Status {
    call(instance, function, |instance, _| {
        // SAFETY: demands of FMI 3.0.
        let (references, targets) =
            unsafe { (Items::new("valueReferences", references, count)?, Target::array("values", values, length)?) };
        let elements = instance.elements(references)?;
        fits("values", elements.clone(), length)?;
        for (place, value) in instance.values(elements, kind)?.iter().enumerate() {
            targets.put(place, convert(*value));
        }
        Ok(())
    })
}

/// Sets variables of one type, all or nothing.
///
/// # Safety
/// As FMI 3.0 demands of the arrays.
unsafe fn set<T: Copy + Into<f64>>(
    instance: Component,
    function: &Call,
    kind: &'static str,
    ((references, count), (values, length)): (Array<Reference>, Array<T>),
) -> Status {
    call(instance, function, |instance, _| {
        // SAFETY: demands of FMI 3.0.
        let (references, values) =
            unsafe { (Items::new("valueReferences", references, count)?, Items::new("values", values, length)?) };
        let elements = instance.elements(references)?;
        fits("values", elements.clone(), length)?;
        instance.set(elements, values, kind)
    })
}

/// `fmi3GetFloat64`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    instance: Component,
    references: *const Reference,
    count: usize,
    values: *mut f64,
    length: usize,
) -> Status {
    let arrays = ((references, count), (values, length));
    // SAFETY: demands of FMI 3.0.
    unsafe { get(instance, &calls::GET_FLOAT64, "Float64", arrays, Value::number) }
}

/// `fmi3GetInt32`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetInt32(
    instance: Component,
    references: *const Reference,
    count: usize,
    values: *mut i32,
    length: usize,
) -> Status {
    let integer = |value| match value {
        Value::Integer(value) => value,
        Value::Real(_) => 0,
    };
    // SAFETY: demands of FMI 3.0.
    unsafe { get(instance, &calls::GET_INT32, "Int32", ((references, count), (values, length)), integer) }
}

/// `fmi3GetString`: the texts stay where they are until they are set again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetString(
    instance: Component,
    references: *const Reference,
    count: usize,
    values: *mut Text,
    length: usize,
) -> Status {
    call(instance, &calls::GET_STRING, |instance, _| {
        // SAFETY: demands of FMI 3.0.
        let (references, targets) =
            unsafe { (Items::new("valueReferences", references, count)?, Target::array("values", values, length)?) };
        let elements = instance.elements(references)?;
        fits("values", elements.clone(), length)?;
        shared::put_texts(instance, elements, &targets)
    })
}

/// `fmi3SetFloat64`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    instance: Component,
    references: *const Reference,
    count: usize,
    values: *const f64,
    length: usize,
) -> Status {
    // SAFETY: demands of FMI 3.0.
    unsafe { set(instance, &calls::SET_FLOAT64, "Float64", ((references, count), (values, length))) }
}

/// `fmi3SetInt32`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetInt32(
    instance: Component,
    references: *const Reference,
    count: usize,
    values: *const i32,
    length: usize,
) -> Status {
    // SAFETY: demands of FMI 3.0.
    unsafe { set(instance, &calls::SET_INT32, "Int32", ((references, count), (values, length))) }
}

/// `fmi3SetString`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetString(
    instance: Component,
    references: *const Reference,
    count: usize,
    values: *const Text,
    length: usize,
) -> Status {
    call(instance, &calls::SET_STRING, |instance, _| {
        // SAFETY: demands of FMI 3.0.
        let (references, values) =
            unsafe { (Items::new("valueReferences", references, count)?, Items::new("values", values, length)?) };
        let elements = instance.elements(references)?;
        fits("values", elements.clone(), length)?;
        // SAFETY: demands of FMI 3.0.
        unsafe { shared::take_texts(instance, elements, values) }
    })
}

/// `fmi3GetDirectionalDerivative`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetDirectionalDerivative(
    instance: Component,
    unknowns: *const Reference,
    unknown_count: usize,
    knowns: *const Reference,
    known_count: usize,
    seed: *const f64,
    seed_length: usize,
    sensitivity: *mut f64,
    sensitivity_length: usize,
) -> Status {
    call(instance, &calls::GET_DIRECTIONAL_DERIVATIVE, |instance, _| {
        // SAFETY: demands of FMI 3.0.
        let (unknowns, knowns, seed, targets) = unsafe {
            (
                Items::new("unknowns", unknowns, unknown_count)?,
                Items::new("knowns", knowns, known_count)?,
                Items::new("seed", seed, seed_length)?,
                Target::array("sensitivity", sensitivity, sensitivity_length)?,
            )
        };
        let (unknowns, knowns) = (instance.elements(unknowns)?, instance.elements(knowns)?);
        fits("seed", knowns.clone(), seed_length)?;
        fits("sensitivity", unknowns.clone(), sensitivity_length)?;
        targets.put_all(&instance.directional_derivatives(unknowns, knowns, seed)?);
        Ok(())
    })
}

/// `fmi3GetOutputDerivatives`: order 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetOutputDerivatives(
    instance: Component,
    references: *const Reference,
    count: usize,
    orders: *const i32,
    values: *mut f64,
    length: usize,
) -> Status {
    call(instance, &calls::GET_OUTPUT_DERIVATIVES, |instance, _| {
        // SAFETY: demands of FMI 3.0.
        let (references, orders, targets) = unsafe {
            (
                Items::new("valueReferences", references, count)?,
                Items::new("orders", orders, count)?,
                Target::array("values", values, length)?,
            )
        };
        // The order of a variable is that of all its elements.
        let mut wanted = Vec::new();
        for (reference, order) in references.iter().zip(orders.iter()) {
            wanted.extend(instance.elements_of(reference)?.map(|index| (index, order)));
        }
        fits("values", wanted.iter(), length)?;
        targets.put_all(&instance.output_derivatives(wanted.into_iter())?);
        Ok(())
    })
}
