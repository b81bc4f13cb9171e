//! The functions of FMI 3.0 for what a unit does not have: types that no variable is of, clocks, events, other kinds of units. Each
//! refuses with a message that names what is missing.

use super::{Boolean, LogFunction, UpdateFunction};
use crate::calls::{ALWAYS, Call};
use crate::guard::call;
use crate::host_memory::Items;
use crate::logger::{Host, Logger};
use crate::refusal::Refusal;
use crate::types::{Component, Environment, Reference, Status, Text};
use std::ffi::{c_int, c_void};
use std::ptr::null_mut;

/// Refuses a function for what the unit does not have.
fn refuse(instance: Component, name: &'static str, what: &'static str) -> Status {
    call(instance, &Call { name, allowed: ALWAYS }, |_, _| Err(Refusal::Absent { what }))
}

/// Declares functions for what the unit does not have: what it is, and each function with the types of its arguments.
macro_rules! absent {
    ($($what:literal: $($name:ident($($argument:ty),*))+;)+) => {
        $($(
            #[doc = concat!("`", stringify!($name), "`")]
            #[unsafe(no_mangle)]
            pub extern "C" fn $name(instance: Component $(, _: $argument)*) -> Status {
                refuse(instance, stringify!($name), $what)
            }
        )+)+
    };
}

/// Declares the functions for types that no variable is of: the type's name, its functions, and what an element is in C.
macro_rules! of_no_variable {
    ($($kind:literal $element:ty: $get:ident $set:ident;)+) => {
        $(
            of_no_variable!(@function $get $kind *mut $element);
            of_no_variable!(@function $set $kind *const $element);
        )+
    };
    (@function $name:ident $kind:literal $values:ty) => {
        #[doc = concat!("`", stringify!($name), "`")]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(
            instance: Component,
            references: *const Reference,
            count: usize,
            _: $values,
            _: usize,
        ) -> Status {
            call(instance, &Call { name: stringify!($name), allowed: ALWAYS }, |instance, _| {
                // SAFETY: demands of FMI 3.0.
                let references = unsafe { Items::new("valueReferences", references, count)? };
                instance.refuse_type(instance.elements(references)?, $kind)
            })
        }
    };
}

of_no_variable! {
    "Float32" f32: fmi3GetFloat32 fmi3SetFloat32;
    "Int8" i8: fmi3GetInt8 fmi3SetInt8;
    "UInt8" u8: fmi3GetUInt8 fmi3SetUInt8;
    "Int16" i16: fmi3GetInt16 fmi3SetInt16;
    "UInt16" u16: fmi3GetUInt16 fmi3SetUInt16;
    "UInt32" u32: fmi3GetUInt32 fmi3SetUInt32;
    "Int64" i64: fmi3GetInt64 fmi3SetInt64;
    "UInt64" u64: fmi3GetUInt64 fmi3SetUInt64;
    "Boolean" Boolean: fmi3GetBoolean fmi3SetBoolean;
}

/// `fmi3Binary`
type Binary = *const u8;

absent! {
    "binary variables":
        fmi3GetBinary(*const Reference, usize, *mut usize, *mut Binary, usize)
        fmi3SetBinary(*const Reference, usize, *const usize, *const Binary, usize);
    "clocks":
        fmi3GetClock(*const Reference, usize, *mut Boolean)
        fmi3SetClock(*const Reference, usize, *const Boolean)
        fmi3GetIntervalDecimal(*const Reference, usize, *mut f64, *mut c_int)
        fmi3GetIntervalFraction(*const Reference, usize, *mut u64, *mut u64, *mut c_int)
        fmi3GetShiftDecimal(*const Reference, usize, *mut f64)
        fmi3GetShiftFraction(*const Reference, usize, *mut u64, *mut u64)
        fmi3SetIntervalDecimal(*const Reference, usize, *const f64)
        fmi3SetIntervalFraction(*const Reference, usize, *const u64, *const u64)
        fmi3SetShiftDecimal(*const Reference, usize, *const f64)
        fmi3SetShiftFraction(*const Reference, usize, *const u64, *const u64)
        fmi3ActivateModelPartition(Reference, f64);
    "dependencies of single elements":
        fmi3GetNumberOfVariableDependencies(Reference, *mut usize)
        fmi3GetVariableDependencies(Reference, *mut usize, *mut Reference, *mut usize, *mut c_int, usize);
    "adjoint derivatives":
        fmi3GetAdjointDerivative(
            *const Reference, usize, *const Reference, usize, *const f64, usize, *mut f64, usize);
    "structural parameters":
        fmi3EnterConfigurationMode()
        fmi3ExitConfigurationMode();
    "event mode":
        fmi3EnterEventMode()
        fmi3EnterStepMode()
        fmi3EvaluateDiscreteStates()
        fmi3UpdateDiscreteStates(*mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut f64);
    "model exchange":
        fmi3EnterContinuousTimeMode()
        fmi3CompletedIntegratorStep(Boolean, *mut Boolean, *mut Boolean)
        fmi3SetTime(f64)
        fmi3SetContinuousStates(*const f64, usize)
        fmi3GetContinuousStateDerivatives(*mut f64, usize)
        fmi3GetEventIndicators(*mut f64, usize)
        fmi3GetContinuousStates(*mut f64, usize)
        fmi3GetNominalsOfContinuousStates(*mut f64, usize)
        fmi3GetNumberOfEventIndicators(*mut usize)
        fmi3GetNumberOfContinuousStates(*mut usize);
}

/// Says that there is no instance of this kind.
fn no_instance(name: &str, (environment, logger): (Environment, Option<LogFunction>)) -> Component {
    let logger = Logger::new(Host::Fmi3 { logger, environment }, false);
    logger.failed(name, "expected fmi3InstantiateCoSimulation: this unit is for co-simulation");
    null_mut()
}

/// `fmi3InstantiateModelExchange`
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    _name: Text,
    _token: Text,
    _resources: Text,
    _visible: Boolean,
    _logging: Boolean,
    environment: Environment,
    logger: Option<LogFunction>,
) -> Component {
    no_instance("fmi3InstantiateModelExchange", (environment, logger))
}

/// `fmi3InstantiateScheduledExecution`
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _name: Text,
    _token: Text,
    _resources: Text,
    _visible: Boolean,
    _logging: Boolean,
    environment: Environment,
    logger: Option<LogFunction>,
    _clock_update: Option<UpdateFunction>,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> Component {
    no_instance("fmi3InstantiateScheduledExecution", (environment, logger))
}
