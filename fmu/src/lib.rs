//! The FMI 2.0 functions for co-simulation. Each is a few lines around [`guard::call`].
//!
//! # Safety
//!
//! For all of them FMI 2.0 demands what C cannot say: arrays hold as many elements as the call says, strings end
//! in a zero, and pointers to results may be written. Components and state handles are looked up, not followed:
//! wrong ones are refused.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
#![allow(clippy::missing_safety_doc, reason = "the demands are those of FMI 2.0, stated above once for all functions")]

mod calls;
mod floating_point;
mod frames;
mod guard;
mod host_memory;
mod instance;
mod location;
mod logger;
mod refusal;
mod saved;
pub mod types;
pub mod values;

use cograin::export::LIBRARY_MARK;
use cograin::scene::Models;
use guard::{Guarded, call};
use host_memory::{Items, Target, readable, text};
use instance::{Instance, Request};
use logger::Logger;
use refusal::Refusal;
use saved::{CHECKED, Saved};
use std::ffi::{CStr, c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::{self, null_mut};
use types::{Boolean, Callbacks, Component, StateHandle, Status, Text};

/// Stands in every library of units from these sources: [`LIBRARY_MARK`].
pub const MARK: [u8; LIBRARY_MARK.len()] = {
    let mut bytes = [0; LIBRARY_MARK.len()];
    bytes.copy_from_slice(LIBRARY_MARK.as_bytes());
    bytes
};

/// `fmi2GetTypesPlatform`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> Text {
    c"default".as_ptr()
}

/// `fmi2GetVersion`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> Text {
    c"2.0".as_ptr()
}

/// What a host hands over to make an instance.
#[derive(Clone, Copy)]
pub struct Arguments {
    /// Name of the instance.
    pub name: Text,
    /// Kind of unit.
    pub kind: c_int,
    /// GUID of the description.
    pub guid: Text,
    /// Where the resources are.
    pub location: Text,
    /// What the host offers.
    pub functions: *const Callbacks,
    /// Whether events are logged.
    pub logging: Boolean,
}

/// `fmi2Instantiate`, for scenes that may name these sub-models: null if there is no instance; the reason goes to the logger. What
/// [`unit!`] exports calls it.
pub unsafe fn instantiate(arguments: &Arguments, models: fn() -> Models) -> Component {
    let Arguments { name, kind, guid, location, functions, logging } = *arguments;
    guard::silence_panics();
    // SAFETY: demands of FMI 2.0. The callbacks are copied: the host may free its own after this call.
    let (callbacks, label) = unsafe {
        let callbacks = if functions.is_null() { None } else { Some(functions.read_unaligned()) };
        (callbacks, if name.is_null() { c"" } else { CStr::from_ptr(name) })
    };
    let Some(callbacks) = callbacks else { return null_mut() };
    let logger = Logger::new(callbacks, label, logging != 0);
    // SAFETY: demands of FMI 2.0.
    let [name, identity, location] = unsafe { [text(name), text(guid), text(location)] }.map(|text| text.map(readable));
    let request = Request { name, kind, identity, location };
    let made = || catch_unwind(AssertUnwindSafe(|| Instance::new(&request, models())));
    match floating_point::standard(made) {
        Ok(Ok(instance)) => {
            logger.event(|| format!("fmi2Instantiate: {}", instance.about()));
            guard::enter(Guarded::new(instance, logger))
        }
        Ok(Err(error)) => {
            logger.failed("fmi2Instantiate", &error.to_string());
            null_mut()
        }
        Err(panic) => {
            logger.failed("fmi2Instantiate", &format!("internal error: {}", guard::message_of(panic.as_ref())));
            null_mut()
        }
    }
}

/// Makes a crate the library of units: `unit!(models)`, with the [`Models`] that their scenes may name, once in a crate of type
/// `cdylib`. The other functions of FMI 2.0 are those of this crate, which the library exports as well.
#[macro_export]
macro_rules! unit {
    ($models:expr) => {
        /// Tells `export` that this is the library of a unit.
        #[used]
        static COGRAIN_UNIT: [u8; $crate::MARK.len()] = $crate::MARK;

        /// `fmi2Instantiate`
        ///
        /// # Safety
        /// As FMI 2.0 demands.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn fmi2Instantiate(
            name: $crate::types::Text,
            kind: ::std::ffi::c_int,
            guid: $crate::types::Text,
            location: $crate::types::Text,
            functions: *const $crate::types::Callbacks,
            _visible: $crate::types::Boolean,
            logging: $crate::types::Boolean,
        ) -> $crate::types::Component {
            let arguments = $crate::Arguments { name, kind, guid, location, functions, logging };
            // SAFETY: demands of FMI 2.0.
            unsafe { $crate::instantiate(&arguments, || $models) }
        }
    };
}

#[cfg(test)]
unit!(Models::standard());

/// `fmi2FreeInstance`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeInstance(component: Component) {
    guard::leave(component);
}

/// `fmi2SetDebugLogging`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    component: Component,
    on: Boolean,
    count: usize,
    categories: *const Text,
) -> Status {
    call(component, &calls::SET_DEBUG_LOGGING, |_, logger| {
        // SAFETY: demands of FMI 2.0.
        let names = unsafe { Items::new("categories", categories, count)?.iter().map(|name| text(name)) };
        let names = names
            .map(|name| name.map(readable))
            .collect::<Option<Vec<_>>>()
            .ok_or(Refusal::Null { argument: "a category" })?;
        logger.want(on != 0, &names)
    })
}

/// `fmi2SetupExperiment`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    component: Component,
    tolerance_defined: Boolean,
    tolerance: f64,
    start: f64,
    stop_defined: Boolean,
    stop: f64,
) -> Status {
    call(component, &calls::SETUP_EXPERIMENT, |instance, _| {
        let given = |defined: Boolean, value| (defined != 0).then_some(value);
        instance.set_up(start, given(stop_defined, stop), given(tolerance_defined, tolerance))
    })
}

/// `fmi2EnterInitializationMode`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(component: Component) -> Status {
    call(component, &calls::ENTER_INITIALIZATION_MODE, |instance, _| {
        instance.enter_initialization();
        Ok(())
    })
}

/// `fmi2ExitInitializationMode`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(component: Component) -> Status {
    call(component, &calls::EXIT_INITIALIZATION_MODE, |instance, logger| {
        instance.exit_initialization()?;
        logger.event(|| {
            let (time, limit) = (instance.time(), instance.time_step_limit());
            format!("fmi2ExitInitializationMode: starts at {time} s; {limit}")
        });
        Ok(())
    })
}

/// `fmi2Terminate`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(component: Component) -> Status {
    call(component, &calls::TERMINATE, |instance, logger| {
        instance.remarks().iter().for_each(|remark| logger.warned("fmi2Terminate", remark));
        instance.terminate();
        Ok(())
    })
}

/// `fmi2Reset`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(component: Component) -> Status {
    call(component, &calls::RESET, |instance, _| instance.reset())
}

/// `fmi2GetFMUstate`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(component: Component, state: *mut StateHandle) -> Status {
    call(component, &calls::GET_STATE, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let (target, handle) = unsafe {
            let target = Target::one("FMUstate", state)?;
            let handle = target.first();
            (target, handle)
        };
        target.put(0, ptr::without_provenance_mut(instance.save(handle.addr())?));
        Ok(())
    })
}

/// `fmi2SetFMUstate`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(component: Component, state: StateHandle) -> Status {
    call(component, &calls::SET_STATE, |instance, _| instance.restore(state.addr()))
}

/// `fmi2FreeFMUstate`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Component, state: *mut StateHandle) -> Status {
    call(component, &calls::FREE_STATE, |instance, _| {
        if state.is_null() {
            return Ok(());
        }
        // SAFETY: demands of FMI 2.0.
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

/// `fmi2SerializedFMUstateSize`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    component: Component,
    state: StateHandle,
    size: *mut usize,
) -> Status {
    call(component, &calls::SERIALIZED_SIZE, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let target = unsafe { Target::one("size", size)? };
        target.put(0, instance.serialized_size(state.addr())?);
        Ok(())
    })
}

/// `fmi2SerializeFMUstate`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    component: Component,
    state: StateHandle,
    bytes: *mut c_char,
    size: usize,
) -> Status {
    call(component, &calls::SERIALIZE, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let buffer = unsafe { Target::array("serializedState", bytes.cast::<u8>(), size)? };
        instance.serialize(state.addr(), &buffer)
    })
}

/// `fmi2DeSerializeFMUstate`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: Component,
    bytes: *const c_char,
    size: usize,
    state: *mut StateHandle,
) -> Status {
    call(component, &calls::DESERIALIZE, |instance, _| {
        // SAFETY: demands of FMI 2.0.
        let (bytes, target, handle) = unsafe {
            let target = Target::one("FMUstate", state)?;
            let handle = target.first();
            (Items::new("serializedState", bytes.cast::<u8>(), size)?, target, handle)
        };
        Saved::check_length(&bytes.first(CHECKED), bytes.len())?;
        target.put(0, ptr::without_provenance_mut(instance.deserialize(&bytes.to_vec(), handle.addr())?));
        Ok(())
    })
}

/// `fmi2DoStep`. That states before the point are not restored is of no use here: nothing is kept for them.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(component: Component, point: f64, length: f64, _no_restore_before: Boolean) -> Status {
    call(component, &calls::DO_STEP, |instance, logger| {
        let whole = instance.divided_step().is_none();
        instance.step(point, length)?;
        if let Some(told) = instance.divided_step().filter(|_| whole) {
            logger.warned(calls::DO_STEP.name, &told);
        }
        logger.event(|| format!("fmi2DoStep: {length} s to {} s", instance.time()));
        Ok(())
    })
}

#[cfg(test)]
#[path = "../tests/calls.rs"]
mod tests;
