//! The functions of FMI 3.0 for co-simulation. Each is a few lines around [`guard::call`], as those of FMI 2.0.
//!
//! # Safety
//!
//! For all of them FMI 3.0 demands what C cannot say: arrays hold as many elements as the call says, strings end
//! in a zero, and pointers to results may be written. Instances and state handles are looked up, not followed:
//! wrong ones are refused.

pub mod absent;
mod calls;
pub mod values;

use crate::guard::{self, call};
use crate::host_memory::{Target, readable, text};
use crate::instance::Request;
use crate::logger::{Host, Logger};
use crate::shared;
use crate::types::{CO_SIMULATION, Component, Environment, StateHandle, Status, Text};
use cograin::interface::Standard;
use cograin::scene::Models;
use std::ptr::null_mut;

/// `fmi3Boolean`, a `bool` of C: read as "not 0", for a host may hand over other bytes.
pub type Boolean = u8;
/// `fmi3LogMessageCallback`
pub type LogFunction = unsafe extern "C" fn(Environment, Status, Text, Text);
/// `fmi3IntermediateUpdateCallback`
pub type UpdateFunction =
    unsafe extern "C" fn(Environment, f64, Boolean, Boolean, Boolean, Boolean, *mut Boolean, *mut f64);

/// `fmi3GetVersion`
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> Text {
    c"3.0".as_ptr()
}

/// What a host hands over to make an instance.
#[derive(Clone, Copy)]
pub struct Arguments {
    /// Name of the instance.
    pub name: Text,
    /// Token of the description.
    pub token: Text,
    /// Path of the resources.
    pub resources: Text,
    /// Whether events are logged.
    pub logging: Boolean,
    /// Whether the host uses event mode.
    pub event_mode: Boolean,
    /// Number of variables that the host wants inside of steps.
    pub intermediates: usize,
    /// Handed to the logger as it is.
    pub environment: Environment,
    /// Takes messages.
    pub logger: Option<LogFunction>,
}

/// `fmi3InstantiateCoSimulation`, for scenes that may name these sub-models: null if there is no instance; the reason goes to the
/// logger. What [`unit!`](crate::unit) exports calls it.
pub unsafe fn instantiate(arguments: &Arguments, models: fn() -> Models) -> Component {
    const NAME: &str = "fmi3InstantiateCoSimulation";
    let Arguments { name, token, resources, logging, event_mode, intermediates, environment, logger } = *arguments;
    let logger = Logger::new(Host::Fmi3 { logger, environment }, logging != 0);
    if event_mode != 0 {
        logger.failed(NAME, "eventModeUsed: expected false, as hasEventMode tells, found true");
        return null_mut();
    }
    if intermediates != 0 {
        logger.failed(
            NAME,
            &format!(
                "nRequiredIntermediateVariables: expected 0, as providesIntermediateUpdate tells, found {intermediates}"
            ),
        );
        return null_mut();
    }
    // SAFETY: demands of FMI 3.0.
    let [name, identity, location] =
        unsafe { [text(name), text(token), text(resources)] }.map(|text| text.map(readable));
    let request = Request { standard: Standard::Fmi3, name, kind: CO_SIMULATION, identity, location };
    guard::instantiate(NAME, &request, logger, models)
}

/// `fmi3FreeInstance`
#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeInstance(instance: Component) {
    guard::leave(instance);
}

/// `fmi3SetDebugLogging`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: Component,
    on: Boolean,
    count: usize,
    categories: *const Text,
) -> Status {
    // SAFETY: demands of FMI 3.0.
    unsafe { shared::set_debug_logging(instance, &calls::SET_DEBUG_LOGGING, on != 0, (categories, count)) }
}

/// `fmi3EnterInitializationMode`
#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    instance: Component,
    tolerance_defined: Boolean,
    tolerance: f64,
    start: f64,
    stop_defined: Boolean,
    stop: f64,
) -> Status {
    call(instance, &calls::ENTER_INITIALIZATION_MODE, |instance, _| {
        let given = |defined: Boolean, value| (defined != 0).then_some(value);
        instance.set_up(start, given(stop_defined, stop), given(tolerance_defined, tolerance))?;
        instance.enter_initialization();
        Ok(())
    })
}

/// `fmi3ExitInitializationMode`: without event mode the instance is ready for its first step.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3ExitInitializationMode(instance: Component) -> Status {
    shared::exit_initialization(instance, &calls::EXIT_INITIALIZATION_MODE)
}

/// `fmi3Terminate`
#[unsafe(no_mangle)]
pub extern "C" fn fmi3Terminate(instance: Component) -> Status {
    shared::terminate(instance, &calls::TERMINATE)
}

/// `fmi3Reset`
#[unsafe(no_mangle)]
pub extern "C" fn fmi3Reset(instance: Component) -> Status {
    call(instance, &calls::RESET, |instance, _| instance.reset())
}

/// `fmi3GetFMUState`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: Component, state: *mut StateHandle) -> Status {
    // SAFETY: demands of FMI 3.0.
    unsafe { shared::get_state(instance, &calls::GET_STATE, state) }
}

/// `fmi3SetFMUState`
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFMUState(instance: Component, state: StateHandle) -> Status {
    call(instance, &calls::SET_STATE, |instance, _| instance.restore(state.addr()))
}

/// `fmi3FreeFMUState`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: Component, state: *mut StateHandle) -> Status {
    // SAFETY: demands of FMI 3.0.
    unsafe { shared::free_state(instance, &calls::FREE_STATE, state) }
}

/// `fmi3SerializedFMUStateSize`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: Component,
    state: StateHandle,
    size: *mut usize,
) -> Status {
    // SAFETY: demands of FMI 3.0.
    unsafe { shared::serialized_size(instance, &calls::SERIALIZED_SIZE, state, size) }
}

/// `fmi3SerializeFMUState`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: Component,
    state: StateHandle,
    bytes: *mut u8,
    size: usize,
) -> Status {
    // SAFETY: demands of FMI 3.0.
    unsafe { shared::serialize(instance, &calls::SERIALIZE, state, (bytes, size)) }
}

/// `fmi3DeserializeFMUState`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: Component,
    bytes: *const u8,
    size: usize,
    state: *mut StateHandle,
) -> Status {
    // SAFETY: demands of FMI 3.0.
    unsafe { shared::deserialize(instance, &calls::DESERIALIZE, (bytes, size), state) }
}

/// `fmi3DoStep`: the unit neither meets events nor returns early, nor asks to end the simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: Component,
    point: f64,
    length: f64,
    _no_restore_before: Boolean,
    event_handling_needed: *mut Boolean,
    terminate: *mut Boolean,
    early_return: *mut Boolean,
    last_time: *mut f64,
) -> Status {
    call(instance, &calls::DO_STEP, |instance, logger| {
        // SAFETY: demands of FMI 3.0.
        let (flags, last_time) = unsafe {
            let flags = [
                Target::one("eventHandlingNeeded", event_handling_needed)?,
                Target::one("terminateSimulation", terminate)?,
                Target::one("earlyReturn", early_return)?,
            ];
            (flags, Target::one("lastSuccessfulTime", last_time)?)
        };
        let done = shared::advance(instance, logger, calls::DO_STEP.name, (point, length));
        flags.iter().for_each(|flag| flag.put(0, 0));
        last_time.put(0, instance.time());
        done
    })
}
