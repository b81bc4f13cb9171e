//! What functions of both editions of the standard do, each under its own name.
//!
//! # Safety
//!
//! As the functions that call these, whose demands both editions state alike.

use crate::calls::Call;
use crate::guard::call;
use crate::host_memory::{Items, Target, readable, text, utf8};
use crate::instance::Instance;
use crate::logger::Logger;
use crate::refusal::Refusal;
use crate::saved::{CHECKED, Saved};
use crate::types::{Component, StateHandle, Status, Text};
use std::ffi::CStr;
use std::ptr::{null_mut, without_provenance_mut};

/// Switches categories of messages on or off.
pub(crate) unsafe fn set_debug_logging(
    component: Component,
    function: &Call,
    on: bool,
    (categories, count): (*const Text, usize),
) -> Status {
    call(component, function, |_, logger| {
        // SAFETY: the caller's promise.
        let names = unsafe { Items::new("categories", categories, count)?.iter().map(|name| text(name)) };
        let names = names
            .map(|name| name.map(readable))
            .collect::<Option<Vec<_>>>()
            .ok_or(Refusal::Null { argument: "a category" })?;
        logger.want(on, &names)
    })
}

/// Leaves the initialisation mode.
pub(crate) fn exit_initialization(component: Component, function: &Call) -> Status {
    call(component, function, |instance, logger| {
        instance.exit_initialization()?;
        logger.event(|| {
            let (time, limit) = (instance.time(), instance.time_step_limit());
            format!("{}: starts at {time} s; {limit}", function.name)
        });
        Ok(())
    })
}

/// Ends the simulation.
pub(crate) fn terminate(component: Component, function: &Call) -> Status {
    call(component, function, |instance, logger| {
        instance.remarks().iter().for_each(|remark| logger.warned(function.name, remark));
        instance.terminate();
        Ok(())
    })
}

/// Makes a communication step from a point \[s\], of a length \[s\].
pub(crate) fn advance(
    instance: &mut Instance,
    logger: &Logger,
    function: &str,
    (point, length): (f64, f64),
) -> Result<(), Refusal> {
    let whole = instance.divided_step().is_none();
    instance.step(point, length)?;
    if let Some(told) = instance.divided_step().filter(|_| whole) {
        logger.warned(function, &told);
    }
    logger.event(|| format!("{function}: {length} s to {} s", instance.time()));
    Ok(())
}

/// Saves the state.
pub(crate) unsafe fn get_state(component: Component, function: &Call, state: *mut StateHandle) -> Status {
    call(component, function, |instance, _| {
        // SAFETY: the caller's promise.
        let (target, handle) = unsafe {
            let target = Target::one("FMUstate", state)?;
            let handle = target.first();
            (target, handle)
        };
        target.put(0, without_provenance_mut(instance.save(handle.addr())?));
        Ok(())
    })
}

/// Frees a saved state.
pub(crate) unsafe fn free_state(component: Component, function: &Call, state: *mut StateHandle) -> Status {
    call(component, function, |instance, _| {
        if state.is_null() {
            return Ok(());
        }
        // SAFETY: the caller's promise.
        let (target, handle) = unsafe {
            let target = Target::one("FMUstate", state)?;
            let handle = target.first();
            (target, handle)
        };
        instance.forget(handle.addr())?;
        target.put(0, null_mut());
        Ok(())
    })
}

/// Number of bytes of a saved state.
pub(crate) unsafe fn serialized_size(
    component: Component,
    function: &Call,
    state: StateHandle,
    size: *mut usize,
) -> Status {
    call(component, function, |instance, _| {
        // SAFETY: the caller's promise.
        let target = unsafe { Target::one("size", size)? };
        target.put(0, instance.serialized_size(state.addr())?);
        Ok(())
    })
}

/// Writes a saved state as bytes.
pub(crate) unsafe fn serialize(
    component: Component,
    function: &Call,
    state: StateHandle,
    (bytes, size): (*mut u8, usize),
) -> Status {
    call(component, function, |instance, _| {
        // SAFETY: the caller's promise.
        let buffer = unsafe { Target::array("serializedState", bytes, size)? };
        instance.serialize(state.addr(), &buffer)
    })
}

/// Makes a saved state of bytes.
pub(crate) unsafe fn deserialize(
    component: Component,
    function: &Call,
    (bytes, size): (*const u8, usize),
    state: *mut StateHandle,
) -> Status {
    call(component, function, |instance, _| {
        // SAFETY: the caller's promise.
        let (bytes, target, handle) = unsafe {
            let target = Target::one("FMUstate", state)?;
            let handle = target.first();
            (Items::new("serializedState", bytes, size)?, target, handle)
        };
        Saved::check_length(&bytes.first(CHECKED), bytes.len())?;
        target.put(0, without_provenance_mut(instance.deserialize(&bytes.to_vec(), handle.addr())?));
        Ok(())
    })
}

/// Hands out the texts of variables. They stay where they are until they are set again.
pub(crate) fn put_texts(
    instance: &Instance,
    indices: impl Iterator<Item = usize>,
    targets: &Target<Text>,
) -> Result<(), Refusal> {
    targets.put_all(&instance.texts(indices)?.into_iter().map(CStr::as_ptr).collect::<Vec<_>>());
    Ok(())
}

/// Takes the texts of variables. No text is read for a wrong variable.
pub(crate) unsafe fn take_texts(
    instance: &mut Instance,
    indices: impl Iterator<Item = usize> + Clone,
    texts: Items<Text>,
) -> Result<(), Refusal> {
    instance.check_texts(indices.clone())?;
    // SAFETY: the caller's promise.
    let texts = texts.iter().map(|value| utf8("a value", unsafe { text(value) }));
    instance.set_texts(indices, texts.collect::<Result<_, _>>()?);
    Ok(())
}
