//! A host: it unpacks a unit, calls the C functions and keeps their messages.

use crate::types::{Callbacks, Component, Reference, StateHandle, Status, Text};
use crate::v2::values::*;
use crate::v2::*;
use cograin::export::{identity, resources};
use cograin::interface::{Interface, Type};
use cograin::scene::{Scene, Source};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ffi::{CStr, CString, c_void};
use std::fs;
use std::path::{Path, PathBuf};
use std::ptr::{self, null_mut};
use std::sync::atomic::{AtomicU32, Ordering};

/// A heap of spheres in frictional contact on a driven floor, and one sphere held from above.
pub(super) const BED: &str = r#"
gravity = [0.0, 0.0, -9.81]

[run]
end = 0.1
step = 1.0e-5
threads = 1

[material.glass]
youngs_modulus = 5.0e7
poissons_ratio = 0.3
density = 2500.0

[pair.glass.glass]
restitution = 0.5
friction = 0.4

[contact.touch.normal.hertz]
[contact.touch.tangential.history]

[particles.bed]
material = "glass"
file = "bed.csv"

[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "glass"
motion = { driven = ["x", "z"] }

[boundary.grip]
particles = { set = "bed", box = [[-1.0, -1.0, 0.045], [1.0, 1.0, 1.0]] }
motion = { driven = ["z"] }

[output]
energy = true
"#;

/// Its spheres: a layer on the floor, a second one in its gaps, and the held one.
pub(super) fn bed() -> String {
    let mut text = String::from("id,x,y,z,radius\n");
    let mut id = 0;
    let mut sphere = |x: f64, y: f64, z: f64| {
        id += 1;
        text += &format!("{id},{x:?},{y:?},{z:?},0.01\n");
    };
    for row in 0..3 {
        for column in 0..3 {
            sphere(0.0199 * f64::from(column), 0.0199 * f64::from(row), 0.00998);
        }
    }
    for row in 0..2 {
        for column in 0..2 {
            sphere(0.00995 + 0.0199 * f64::from(column), 0.00995 + 0.0199 * f64::from(row), 0.02405);
        }
    }
    sphere(0.0199, 0.0199, 0.0500);
    text
}

/// The bed's source.
pub(super) fn source() -> Source {
    let files = BTreeMap::from([("bed.csv".to_owned(), bed().into_bytes())]);
    Source { name: "scene.toml".to_owned(), text: BED.to_owned(), files }
}

/// What the logger was told: status, category, message.
pub(super) type Messages = RefCell<Vec<(Status, String, String)>>;

/// The host's logger. Rust cannot write a variadic function; our messages come without further arguments.
unsafe extern "C" fn log(environment: *mut c_void, _name: Text, status: Status, category: Text, message: Text) {
    // SAFETY: the environment is the one of `callbacks`, which outlives the instance; strings end in a zero.
    let (messages, category, message) =
        unsafe { (&*environment.cast::<Messages>(), CStr::from_ptr(category), CStr::from_ptr(message)) };
    let text = |text: &CStr| text.to_string_lossy().into_owned();
    messages.borrow_mut().push((status, text(category), text(message)));
}

/// [`log`] as Rust sees it.
type PlainLogFunction = unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text);

/// Callbacks that keep messages.
fn callbacks(messages: &Messages) -> Callbacks {
    // SAFETY: a callee without variadic arguments reads the named ones where a variadic call puts them, on the
    // systems that units run on.
    let log = unsafe { std::mem::transmute::<PlainLogFunction, crate::types::LogFunction>(log) };
    Callbacks {
        logger: Some(log),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment: ptr::from_ref(messages).cast_mut().cast(),
    }
}

/// An unpacked unit, removed when it is dropped.
pub(super) struct Unpacked {
    /// Where it is.
    pub(super) folder: PathBuf,
    /// Its GUID.
    pub(super) identity: String,
    /// Its variables.
    pub(super) interface: Interface,
}

impl Unpacked {
    /// The bed.
    pub(super) fn new() -> Self {
        Self::of(&source(), "unit")
    }

    /// A scene, in a folder whose name ends so.
    pub(super) fn of(source: &Source, name: &str) -> Self {
        Self::begun(source, None, name)
    }

    /// A scene that begins in a state, if there is one, in a folder whose name ends so.
    pub(super) fn begun(source: &Source, state: Option<Vec<u8>>, name: &str) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("cograin-unit-{}-{number} {name}", std::process::id()));
        let identity = identity(source, state.as_deref());
        for entry in resources(source, state) {
            let path = folder.join("resources").join(&entry.path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, entry.bytes()).unwrap();
        }
        let scene = Scene::from_source(source).unwrap();
        Self { folder, identity, interface: Interface::of(&scene) }
    }

    /// The URI of its resources.
    pub(super) fn location(&self) -> String {
        uri(&self.folder.join("resources"))
    }

    /// Reference of a variable.
    pub(super) fn reference(&self, name: &str) -> Reference {
        Reference::try_from(self.interface.find(name).unwrap_or_else(|| panic!("no variable {name}"))).unwrap()
    }
}

impl Drop for Unpacked {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// A path as a URI, with everything escaped that is not plain.
pub(super) fn uri(path: &Path) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/._-".contains(&byte);
    let escape = |byte: u8| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    format!("file://{}", path.to_str().unwrap().bytes().map(escape).collect::<String>())
}

/// An instance in the hands of a host.
pub(super) struct Host<'a> {
    /// What it is an instance of.
    pub(super) unit: &'a Unpacked,
    /// The instance.
    pub(super) component: Component,
    /// What it said.
    messages: Box<Messages>,
}

impl<'a> Host<'a> {
    /// An instance that was just made.
    pub(super) fn instantiated(unit: &'a Unpacked) -> Self {
        let (component, messages) = instantiate("bed", 1, Some(&unit.identity), Some(&unit.location()));
        assert!(!component.is_null(), "{:?}", messages.borrow());
        Self { unit, component, messages }
    }

    /// An instance that is ready for its first step, from 0 on.
    pub(super) fn started(unit: &'a Unpacked) -> Self {
        let host = Self::instantiated(unit);
        assert_eq!(fmi2SetupExperiment(host.component, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
        assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
        assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);
        host
    }

    /// Sets an input.
    pub(super) fn set(&self, name: &str, value: f64) -> Status {
        let reference = self.unit.reference(name);
        // SAFETY: one reference and one value.
        unsafe { fmi2SetReal(self.component, &raw const reference, 1, &raw const value) }
    }

    /// Sets a text.
    pub(super) fn set_text(&self, name: &str, value: &str) -> Status {
        let (reference, text) = (self.unit.reference(name), CString::new(value).unwrap());
        let text = text.as_ptr();
        // SAFETY: one reference and one text.
        unsafe { fmi2SetString(self.component, &raw const reference, 1, &raw const text) }
    }

    /// A text.
    pub(super) fn text(&self, name: &str) -> String {
        let (reference, mut text) = (self.unit.reference(name), ptr::null());
        // SAFETY: one reference and one text, which the unit keeps.
        unsafe {
            assert_eq!(fmi2GetString(self.component, &raw const reference, 1, &raw mut text), Status::Ok);
            CStr::from_ptr(text).to_str().unwrap().to_owned()
        }
    }

    /// Sets the rate of an input.
    pub(super) fn set_rate(&self, name: &str, rate: f64) -> Status {
        self.set_derivative(name, 1, rate)
    }

    /// Sets a derivative of an input.
    pub(super) fn set_derivative(&self, name: &str, order: i32, rate: f64) -> Status {
        let reference = self.unit.reference(name);
        // SAFETY: one reference, order and rate.
        unsafe {
            fmi2SetRealInputDerivatives(self.component, &raw const reference, 1, &raw const order, &raw const rate)
        }
    }

    /// A real value.
    pub(super) fn get(&self, name: &str) -> f64 {
        let (reference, mut value) = (self.unit.reference(name), f64::NAN);
        // SAFETY: one reference and one value.
        let status = unsafe { fmi2GetReal(self.component, &raw const reference, 1, &raw mut value) };
        assert_eq!(status, Status::Ok, "{}", self.said());
        value
    }

    /// Makes a step.
    pub(super) fn step(&self, point: f64, length: f64) -> Status {
        fmi2DoStep(self.component, point, length, 1)
    }

    /// Makes steps that move the floor up and down and aside, and yields what every output was, bit by bit.
    pub(super) fn shake(&self, from: u32, count: u32) -> Vec<u64> {
        let length = 2.0e-4;
        let mut seen = Vec::new();
        for index in from..from + count {
            let phase = f64::from(index % 20) / 20.0;
            assert_eq!(self.set("floor.displacement.z", 2.0e-4 * phase * (1.0 - phase)), Status::Ok);
            assert_eq!(self.set("floor.displacement.x", 1.0e-4 * phase), Status::Ok);
            assert_eq!(self.set("grip.displacement.z", -3.0e-4 * phase), Status::Ok);
            assert_eq!(self.step(f64::from(index) * length, length), Status::Ok, "{}", self.said());
            seen.extend(self.outputs());
        }
        seen
    }

    /// Every real output, bit by bit.
    pub(super) fn outputs(&self) -> Vec<u64> {
        let real = self.unit.interface.outputs().filter(|(_, variable)| variable.quantity.of_type() == Type::Real);
        real.map(|(_, variable)| self.get(&variable.name).to_bits()).collect()
    }

    /// Saves the state.
    pub(super) fn save(&self) -> StateHandle {
        let mut state = null_mut();
        // SAFETY: one handle.
        assert_eq!(unsafe { fmi2GetFMUstate(self.component, &raw mut state) }, Status::Ok);
        state
    }

    /// Bytes of a saved state.
    pub(super) fn serialize(&self, state: StateHandle) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: one number.
        assert_eq!(unsafe { fmi2SerializedFMUstateSize(self.component, state, &raw mut size) }, Status::Ok);
        let mut bytes = vec![0_u8; size];
        // SAFETY: a buffer of that size.
        let status = unsafe { fmi2SerializeFMUstate(self.component, state, bytes.as_mut_ptr().cast(), size) };
        assert_eq!(status, Status::Ok);
        bytes
    }

    /// A saved state from bytes; null where they are refused.
    pub(super) fn deserialize(&self, bytes: &[u8]) -> StateHandle {
        let mut state = null_mut();
        // SAFETY: a buffer of that size and one handle.
        let status =
            unsafe { fmi2DeSerializeFMUstate(self.component, bytes.as_ptr().cast(), bytes.len(), &raw mut state) };
        assert_eq!(status == Status::Ok, !state.is_null());
        state
    }

    /// The last message.
    pub(super) fn said(&self) -> String {
        self.messages.borrow().last().map(|(_, _, message)| message.clone()).unwrap_or_default()
    }

    /// All messages: status, category, message.
    pub(super) fn heard(&self) -> Vec<(Status, String, String)> {
        self.messages.borrow().clone()
    }

    /// Asserts that a call was refused with a message that says all this, and that the instance still works.
    pub(super) fn refused(&self, status: Status, words: &[&str]) {
        assert_eq!(status, Status::Error, "{}", self.said());
        let message = self.said();
        for word in words {
            assert!(message.contains(word), "{message:?} does not say {word:?}");
        }
        assert!(!message.contains('%'), "{message:?}");
    }
}

impl Drop for Host<'_> {
    fn drop(&mut self) {
        fmi2FreeInstance(self.component);
    }
}

/// Asks for an instance.
pub(super) fn instantiate(
    name: &str,
    kind: i32,
    guid: Option<&str>,
    location: Option<&str>,
) -> (Component, Box<Messages>) {
    let messages = Box::<Messages>::default();
    let callbacks = Box::new(callbacks(&messages));
    let text = |text: &str| CString::new(text).unwrap();
    let (name, guid, location) = (text(name), guid.map(text), location.map(text));
    let pointer = |text: &Option<CString>| text.as_ref().map_or(ptr::null(), |text| text.as_ptr());
    // SAFETY: strings and callbacks live until the call returns, as FMI 2.0 demands.
    let component = unsafe {
        crate::fmi2Instantiate(name.as_ptr(), kind, pointer(&guid), pointer(&location), callbacks.as_ref(), 0, 0)
    };
    (component, messages)
}
