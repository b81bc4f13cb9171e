//! Sequences of the unit's calls, in any order and with any values: each answers with a status, none with an internal error, and every
//! output that is given is finite.

#![allow(clippy::print_stderr, reason = "the unit has silenced panics")]

use crate::kept_in;
use crate::state::{forge, source};
use cograin::export::{identity, resources};
use cograin::interface::{Causality, Interface, Type};
use cograin::scene::{Models, Scene};
use cograin_unit::types::{Callbacks, Component, LogFunction, StateHandle, Status, Text};
use cograin_unit::v2::values::*;
use cograin_unit::v2::*;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_void};
use std::fs;
use std::ptr::{self, null_mut};
use std::sync::LazyLock;

/// The unit: its GUID, where its resources are, its variables.
struct Unit {
    /// GUID.
    identity: CString,
    /// URI of the resources.
    location: CString,
    /// Variables.
    interface: Interface,
}

/// The unit, unpacked once: as a whole, since others may be at it.
static UNIT: LazyLock<Unit> = LazyLock::new(|| {
    let source = source();
    let identity = identity(&source, None);
    let folder = kept_in("units").join(identity.trim_matches(['{', '}']));
    if !folder.exists() {
        let making = folder.with_extension(std::process::id().to_string());
        for entry in resources(&source, None) {
            let path = making.join(&entry.path);
            fs::create_dir_all(path.parent().expect("a file stands in a folder")).expect("a folder is made");
            fs::write(path, entry.bytes()).expect("a file is written");
        }
        if fs::rename(&making, &folder).is_err() {
            fs::remove_dir_all(&making).expect("another one was quicker");
        }
    }
    let text = |text: String| CString::new(text).expect("no zeros");
    Unit {
        identity: text(identity),
        location: text(format!("file://{}", folder.display())),
        interface: Interface::of(&Scene::from_source(&source).expect("the scene is right")),
    }
});

/// Values that a host may give: what it means to give, and what is wrong with it.
const REALS: [f64; 24] = [
    0.0,
    1e-6,
    2e-6,
    1e-5,
    1e-4,
    1e-3,
    -1e-6,
    -1e-5,
    -1e-4,
    0.1,
    1.0,
    -1.0,
    1e3,
    1e6,
    1e300,
    -1e300,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    5e-324,
    f64::MAX,
    -0.0,
    3.3e-6,
    1e-7,
];

/// Lengths of communication steps: none that asks for much work.
const LENGTHS: [f64; 16] = [
    1e-6,
    2e-6,
    5e-6,
    1e-5,
    3.3e-6,
    1e-7,
    1e-9,
    1e-300,
    0.0,
    -1e-6,
    f64::NAN,
    f64::INFINITY,
    1e300,
    f64::MAX,
    2e-5,
    1.5e-6,
];

/// The logger of the host.
unsafe extern "C" fn log(environment: *mut c_void, _name: Text, _status: Status, _category: Text, message: Text) {
    // SAFETY: the environment is the one of `run`, which outlives the instance; the message ends in a zero.
    let (said, message) = unsafe { (&*environment.cast::<RefCell<String>>(), CStr::from_ptr(message)) };
    *said.borrow_mut() = message.to_string_lossy().into_owned();
}

/// Bytes that say what is called.
struct Script<'a>(&'a [u8]);

impl Script<'_> {
    /// The next byte; 0 at the end.
    fn byte(&mut self) -> usize {
        let (first, rest) = self.0.split_first().unwrap_or((&0, &[]));
        self.0 = rest;
        usize::from(*first)
    }

    /// A value.
    fn real(&mut self) -> f64 {
        REALS[self.byte() % REALS.len()]
    }

    /// References, mostly of variables that there are.
    fn references(&mut self) -> Vec<u32> {
        let (count, first, stride) = (self.byte() % 6, self.byte() * 2, self.byte() % 5);
        (0..count).map(|index| if first == 510 { u32::MAX } else { (first + index * stride) as u32 }).collect()
    }
}

/// Panics where something does not hold, and says so itself: the unit has silenced panics.
fn demand(holds: bool, found: impl Fn() -> String) {
    if !holds {
        eprintln!("{}", found());
        panic!("{}", found());
    }
}

/// Plays a script to a new instance.
pub(crate) fn run(bytes: &[u8]) {
    let unit = &*UNIT;
    let said = RefCell::new(String::new());
    // SAFETY: a callee without variadic arguments reads the named ones where a variadic call puts them.
    let logger =
        unsafe { std::mem::transmute::<unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text), LogFunction>(log) };
    let callbacks = Callbacks {
        logger: Some(logger),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment: ptr::from_ref(&said).cast_mut().cast(),
    };
    let arguments = Arguments {
        name: c"one".as_ptr(),
        kind: 1,
        guid: unit.identity.as_ptr(),
        location: unit.location.as_ptr(),
        functions: &raw const callbacks,
        logging: 0,
    };
    // SAFETY: strings and callbacks live until the call returns.
    let component = unsafe { instantiate(&arguments, Models::standard) };
    assert!(!component.is_null(), "{}", said.borrow());
    let mut host = Host { component, handles: [null_mut(); 4], serialized: Vec::new(), time: 0.0 };
    let mut script = Script(bytes);
    if script.byte() % 4 != 0 {
        // Most scripts begin as a host that knows the order.
        let _ = fmi2SetupExperiment(component, 0, 0.0, 0.0, 0, 0.0);
        let _ = fmi2EnterInitializationMode(component);
        let _ = fmi2ExitInitializationMode(component);
    }
    for _ in 0..40 {
        if script.0.is_empty() {
            break;
        }
        host.call(&mut script, unit);
        demand(!said.borrow().contains("internal error"), || said.borrow().clone());
    }
    fmi2FreeInstance(component);
}

/// What a host keeps.
struct Host {
    /// The instance.
    component: Component,
    /// Saved states.
    handles: [StateHandle; 4],
    /// Bytes of one of them.
    serialized: Vec<u8>,
    /// Where it believes to stand \[s\].
    time: f64,
}

impl Host {
    /// One call.
    fn call(&mut self, script: &mut Script, unit: &Unit) {
        let component = self.component;
        // SAFETY: arrays are as long as the calls say, and strings end in zeros.
        unsafe {
            match script.byte() % 24 {
                0..=4 => {
                    let (length, aside) = (LENGTHS[script.byte() % LENGTHS.len()], script.byte());
                    let point = if aside == 7 { script.real() } else { self.time };
                    let status = fmi2DoStep(component, point, length, 1);
                    if status == Status::Ok {
                        self.expect_finite(unit);
                    }
                    fmi2GetRealStatus(component, 2, &raw mut self.time);
                }
                5..=7 => {
                    let inputs: Vec<u32> = unit.interface.inputs().map(|(index, _)| index as u32).collect();
                    let (reference, value) = (inputs[script.byte() % inputs.len()], script.real());
                    fmi2SetReal(component, &raw const reference, 1, &raw const value);
                }
                8 => {
                    let references = script.references();
                    let values: Vec<f64> = references.iter().map(|_| script.real()).collect();
                    fmi2SetReal(component, references.as_ptr(), references.len(), values.as_ptr());
                }
                9 => {
                    let references = script.references();
                    let mut values = vec![0.0; references.len()];
                    fmi2GetReal(component, references.as_ptr(), references.len(), values.as_mut_ptr());
                    let mut whole = vec![0; references.len()];
                    fmi2GetInteger(component, references.as_ptr(), references.len(), whole.as_mut_ptr());
                    fmi2GetBoolean(component, references.as_ptr(), references.len(), whole.as_mut_ptr());
                    let mut texts = vec![ptr::null(); references.len()];
                    fmi2GetString(component, references.as_ptr(), references.len(), texts.as_mut_ptr());
                }
                10 => {
                    let (references, order, rate) = (script.references(), script.byte() as i32 % 4, script.real());
                    let (orders, rates) = (vec![order; references.len()], vec![rate; references.len()]);
                    fmi2SetRealInputDerivatives(
                        component,
                        references.as_ptr(),
                        references.len(),
                        orders.as_ptr(),
                        rates.as_ptr(),
                    );
                }
                11 => {
                    let references = script.references();
                    let (orders, mut values) = (vec![1; references.len()], vec![0.0; references.len()]);
                    fmi2GetRealOutputDerivatives(
                        component,
                        references.as_ptr(),
                        references.len(),
                        orders.as_ptr(),
                        values.as_mut_ptr(),
                    );
                }
                12 => {
                    let (unknowns, knowns) = (script.references(), script.references());
                    let (seeds, mut changes) = (vec![1.0; knowns.len()], vec![0.0; unknowns.len()]);
                    let known = knowns.as_ptr();
                    fmi2GetDirectionalDerivative(
                        component,
                        unknowns.as_ptr(),
                        unknowns.len(),
                        known,
                        knowns.len(),
                        seeds.as_ptr(),
                        changes.as_mut_ptr(),
                    );
                }
                13 => {
                    fmi2GetFMUstate(component, &raw mut self.handles[script.byte() % 4]);
                }
                14 => {
                    let handle = if script.byte() == 3 { 77 as StateHandle } else { self.handles[script.byte() % 4] };
                    fmi2SetFMUstate(component, handle);
                    fmi2GetRealStatus(component, 2, &raw mut self.time);
                }
                15 => {
                    fmi2FreeFMUstate(component, &raw mut self.handles[script.byte() % 4]);
                }
                16 => {
                    let (handle, mut size) = (self.handles[script.byte() % 4], 0);
                    if fmi2SerializedFMUstateSize(component, handle, &raw mut size) == Status::Ok {
                        self.serialized = vec![0; size];
                        fmi2SerializeFMUstate(component, handle, self.serialized.as_mut_ptr().cast(), size);
                    }
                }
                17 => {
                    let mut bytes = self.serialized.clone();
                    let changes: Vec<u8> = (0..5 * (script.byte() % 3)).map(|_| script.byte() as u8).collect();
                    if bytes.len() > 100 && !changes.is_empty() {
                        forge(&mut bytes, &changes);
                    }
                    fmi2DeSerializeFMUstate(
                        component,
                        bytes.as_ptr().cast(),
                        bytes.len(),
                        &raw mut self.handles[script.byte() % 4],
                    );
                }
                18 => {
                    let (start, stop, defined) = (script.real(), script.real(), script.byte() as i32 % 2);
                    fmi2SetupExperiment(component, defined, script.real(), start, defined, stop);
                }
                19 => {
                    let _ = if script.byte().is_multiple_of(2) {
                        fmi2EnterInitializationMode(component)
                    } else {
                        fmi2ExitInitializationMode(component)
                    };
                }
                20 => {
                    let _ =
                        if script.byte().is_multiple_of(2) { fmi2Reset(component) } else { fmi2Terminate(component) };
                    self.time = 0.0;
                }
                21 => {
                    let parameters: Vec<(usize, _)> = unit.interface.of_causality(Causality::Parameter).collect();
                    let Some((index, parameter)) = parameters.get(script.byte() % parameters.len().max(1)) else {
                        return;
                    };
                    let (reference, value, whole) = (*index as u32, script.real(), script.byte() as i32);
                    match parameter.quantity.of_type() {
                        Type::Real => fmi2SetReal(component, &raw const reference, 1, &raw const value),
                        Type::Integer => fmi2SetInteger(component, &raw const reference, 1, &raw const whole),
                        _ => fmi2SetBoolean(component, &raw const reference, 1, &raw const whole),
                    };
                }
                22 => {
                    let (reference, values) =
                        (script.references(), [c"".as_ptr(), c"/nowhere/frames".as_ptr(), c"\xff".as_ptr()]);
                    let texts: Vec<Text> = reference.iter().map(|_| values[script.byte() % 3]).collect();
                    fmi2SetString(component, reference.as_ptr(), reference.len(), texts.as_ptr());
                }
                _ => {
                    let (mut status, mut real, mut whole, mut text) = (Status::Ok, 0.0, 0, ptr::null());
                    let kind = script.byte() as i32 % 6;
                    fmi2GetStatus(component, kind, &raw mut status);
                    fmi2GetRealStatus(component, kind, &raw mut real);
                    fmi2GetIntegerStatus(component, kind, &raw mut whole);
                    fmi2GetBooleanStatus(component, kind, &raw mut whole);
                    fmi2GetStringStatus(component, kind, &raw mut text);
                    fmi2CancelStep(component);
                }
            }
        }
    }

    /// Demands that outputs are finite, or refused where they are not.
    fn expect_finite(&self, unit: &Unit) {
        for (index, variable) in unit.interface.outputs() {
            if variable.quantity.of_type() == Type::Real {
                let (reference, mut value) = (index as u32, f64::NAN);
                // SAFETY: one reference and one value.
                let status = unsafe { fmi2GetReal(self.component, &raw const reference, 1, &raw mut value) };
                let found = || format!("{} is {value}, {status:?}, after a step that was done", variable.name);
                demand(status != Status::Ok || value.is_finite(), found);
            }
        }
    }
}
