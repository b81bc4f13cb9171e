//! The functions of FMI 2.0 for co-simulation. Each is a few lines around [`guard::call`].
//!
//! # Safety
//!
//! For all of them FMI 2.0 demands what C cannot say: arrays hold as many elements as the call says, strings end
//! in a zero, and pointers to results may be written. Components and state handles are looked up, not followed:
//! wrong ones are refused.

pub mod values;

use crate::guard::{self, call};
use crate::host_memory::{readable, text};
use crate::instance::Request;
use crate::logger::{Host, Logger};
use crate::types::{Boolean, Callbacks, Component, StateHandle, Status, Text};
use crate::{calls, shared};
use cograin::interface::Standard;
use cograin::scene::Models;
use std::ffi::{CStr, c_char, c_int};
use std::ptr::null_mut;

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
/// [`unit!`](crate::unit) exports calls it.
pub unsafe fn instantiate(arguments: &Arguments, models: fn() -> Models) -> Component {
    let Arguments { name, kind, guid, location, functions, logging } = *arguments;
    // SAFETY: demands of FMI 2.0. The callbacks are copied: the host may free its own after this call.
    let (callbacks, label) = unsafe {
        let callbacks = if functions.is_null() { None } else { Some(functions.read_unaligned()) };
        (callbacks, if name.is_null() { c"" } else { CStr::from_ptr(name) })
    };
    let Some(callbacks) = callbacks else { return null_mut() };
    let logger = Logger::new(Host::Fmi2 { callbacks, name: label.to_owned() }, logging != 0);
    // SAFETY: demands of FMI 2.0.
    let [name, identity, location] = unsafe { [text(name), text(guid), text(location)] }.map(|text| text.map(readable));
    let request = Request { standard: Standard::Fmi2, name, kind, identity, location };
    guard::instantiate("fmi2Instantiate", &request, logger, models)
}

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
    // SAFETY: demands of FMI 2.0.
    unsafe { shared::set_debug_logging(component, &calls::SET_DEBUG_LOGGING, on != 0, (categories, count)) }
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
    shared::exit_initialization(component, &calls::EXIT_INITIALIZATION_MODE)
}

/// `fmi2Terminate`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(component: Component) -> Status {
    shared::terminate(component, &calls::TERMINATE)
}

/// `fmi2Reset`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(component: Component) -> Status {
    call(component, &calls::RESET, |instance, _| instance.reset())
}

/// `fmi2GetFMUstate`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(component: Component, state: *mut StateHandle) -> Status {
    // SAFETY: demands of FMI 2.0.
    unsafe { shared::get_state(component, &calls::GET_STATE, state) }
}

/// `fmi2SetFMUstate`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(component: Component, state: StateHandle) -> Status {
    call(component, &calls::SET_STATE, |instance, _| instance.restore(state.addr()))
}

/// `fmi2FreeFMUstate`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Component, state: *mut StateHandle) -> Status {
    // SAFETY: demands of FMI 2.0.
    unsafe { shared::free_state(component, &calls::FREE_STATE, state) }
}

/// `fmi2SerializedFMUstateSize`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    component: Component,
    state: StateHandle,
    size: *mut usize,
) -> Status {
    // SAFETY: demands of FMI 2.0.
    unsafe { shared::serialized_size(component, &calls::SERIALIZED_SIZE, state, size) }
}

/// `fmi2SerializeFMUstate`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    component: Component,
    state: StateHandle,
    bytes: *mut c_char,
    size: usize,
) -> Status {
    // SAFETY: demands of FMI 2.0.
    unsafe { shared::serialize(component, &calls::SERIALIZE, state, (bytes.cast(), size)) }
}

/// `fmi2DeSerializeFMUstate`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: Component,
    bytes: *const c_char,
    size: usize,
    state: *mut StateHandle,
) -> Status {
    // SAFETY: demands of FMI 2.0.
    unsafe { shared::deserialize(component, &calls::DESERIALIZE, (bytes.cast(), size), state) }
}

/// `fmi2DoStep`. That states before the point are not restored is of no use here: nothing is kept for them.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(component: Component, point: f64, length: f64, _no_restore_before: Boolean) -> Status {
    call(component, &calls::DO_STEP, |instance, logger| {
        shared::advance(instance, logger, calls::DO_STEP.name, (point, length))
    })
}
