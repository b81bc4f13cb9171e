//! The C types of FMI: those of 2.0, and what 3.0 has of the same form under other names.

use std::ffi::{c_char, c_int, c_void};

/// `fmi2Component`: names an instance; never followed as an address.
pub type Component = *mut c_void;
/// `fmi2FMUstate`: names a saved state; never followed as an address.
pub type StateHandle = *mut c_void;
/// `fmi2ValueReference`
pub type Reference = u32;
/// `fmi2Boolean`
pub type Boolean = c_int;
/// `fmi2String`
pub type Text = *const c_char;

/// `fmi2Status`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// `fmi2OK`
    Ok = 0,
    /// `fmi2Warning`
    Warning = 1,
    /// `fmi2Discard`
    Discard = 2,
    /// `fmi2Error`
    Error = 3,
}

/// `fmi2Type` of a unit for co-simulation.
pub(crate) const CO_SIMULATION: c_int = 1;

/// `fmi2DoStepStatus` of `fmi2StatusKind`
pub(crate) const STEP_STATUS: c_int = 0;
/// `fmi2PendingStatus`
pub(crate) const PENDING_STATUS: c_int = 1;
/// `fmi2LastSuccessfulTime`
pub(crate) const LAST_SUCCESSFUL_TIME: c_int = 2;
/// `fmi2Terminated`
pub(crate) const TERMINATED: c_int = 3;

/// `fmi2ComponentEnvironment`, `fmi3InstanceEnvironment`: handed to the logger as it is.
pub type Environment = *mut c_void;
/// `fmi2CallbackLogger`
pub type LogFunction = unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text, ...);

/// `fmi2CallbackFunctions`
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Callbacks {
    /// Takes messages.
    pub logger: Option<LogFunction>,
    /// Not used: memory is our own.
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Not used: memory is our own.
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    /// Not used: steps are done when `fmi2DoStep` returns.
    pub step_finished: Option<unsafe extern "C" fn(*mut c_void, Status)>,
    /// Handed to the logger as it is.
    pub environment: Environment,
}
