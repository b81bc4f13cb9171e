//! The functions of FMI 3.0: arrays over the same instance, with the same bits.

use super::host::{Host, Unpacked};
use crate::types::{Component, Environment, Reference, Status, Text};
use crate::v3::absent::*;
use crate::v3::values::*;
use crate::v3::*;
use cograin::interface::{Causality, Type};
use cograin::scene::Scene;
use std::cell::RefCell;
use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

/// The host's logger.
unsafe extern "C" fn log(environment: Environment, _status: Status, _category: Text, message: Text) {
    // SAFETY: the environment is that of `Slave`, which outlives the instance; the message ends in a zero.
    let (messages, message) = unsafe { (&*environment.cast::<RefCell<Vec<String>>>(), CStr::from_ptr(message)) };
    messages.borrow_mut().push(message.to_string_lossy().into_owned());
}

/// An instance of the bed in the hands of a host that speaks FMI 3.0.
struct Slave {
    /// The instance.
    instance: Component,
    /// What it said.
    messages: Box<RefCell<Vec<String>>>,
    /// Name and number of elements of each variable, by value reference.
    arrays: Vec<(String, usize)>,
}

impl Slave {
    /// Asks for an instance.
    fn ask(unit: &Unpacked, token: &str, event_mode: u8) -> Self {
        let messages = Box::<RefCell<Vec<String>>>::default();
        let text = |text: &str| CString::new(text).unwrap();
        let (name, token) = (text("bed"), text(token));
        let folder = text(&format!("{}/", unit.folder.join("resources").display()));
        let environment = std::ptr::from_ref(messages.as_ref()).cast_mut().cast();
        // SAFETY: strings live until the call returns, the environment as long as the instance.
        let instance = unsafe {
            crate::fmi3InstantiateCoSimulation(
                name.as_ptr(),
                token.as_ptr(),
                folder.as_ptr(),
                0,
                0,
                event_mode,
                0,
                null(),
                0,
                environment,
                Some(log),
                None,
            )
        };
        let scene = Scene::from_source(&super::host::source()).unwrap();
        let arrays = unit.interface.arrays(&scene).into_iter().map(|array| (array.name.clone(), array.count()));
        Self { instance, messages, arrays: arrays.collect() }
    }

    /// An instance that is ready for its first step, from 0 on.
    fn started(unit: &Unpacked) -> Self {
        let slave = Self::ask(unit, &unit.identity, 0);
        assert!(!slave.instance.is_null(), "{:?}", slave.messages);
        assert_eq!(fmi3EnterInitializationMode(slave.instance, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
        assert_eq!(fmi3ExitInitializationMode(slave.instance), Status::Ok);
        slave
    }

    /// Value reference of a variable, and its number of elements.
    fn reference(&self, name: &str) -> (Reference, usize) {
        let place = self.arrays.iter().position(|(known, _)| known == name);
        let place = place.unwrap_or_else(|| panic!("no variable {name} among {:?}", self.arrays));
        (Reference::try_from(place).unwrap(), self.arrays[place].1)
    }

    /// Values of the elements of a variable.
    fn get(&self, name: &str) -> Vec<f64> {
        let (reference, count) = self.reference(name);
        let mut values = vec![f64::NAN; count];
        // SAFETY: one reference and room for its elements.
        let status = unsafe { fmi3GetFloat64(self.instance, &raw const reference, 1, values.as_mut_ptr(), count) };
        assert_eq!(status, Status::Ok, "{}", self.said());
        values
    }

    /// Sets the elements of a variable.
    fn set(&self, name: &str, values: &[f64]) -> Status {
        let (reference, _) = self.reference(name);
        // SAFETY: one reference and the values.
        unsafe { fmi3SetFloat64(self.instance, &raw const reference, 1, values.as_ptr(), values.len()) }
    }

    /// Makes a step; yields how it ended and the last successful time.
    fn step(&self, point: f64, length: f64) -> (Status, f64) {
        let (mut flags, mut time) = ([7_u8; 3], f64::NAN);
        let [event, terminate, early] = flags.each_mut().map(|flag| &raw mut *flag);
        // SAFETY: four results.
        let status = unsafe { fmi3DoStep(self.instance, point, length, 1, event, terminate, early, &raw mut time) };
        assert!(status != Status::Ok || flags == [0; 3]);
        (status, time)
    }

    /// The last message.
    fn said(&self) -> String {
        self.messages.borrow().last().cloned().unwrap_or_default()
    }

    /// Asserts that a call was refused with a message that says this.
    fn refused(&self, status: Status, words: &str) {
        assert_eq!(status, Status::Error, "{}", self.said());
        assert!(self.said().contains(words), "{:?} does not say {words:?}", self.said());
    }
}

impl Drop for Slave {
    fn drop(&mut self) {
        fmi3FreeInstance(self.instance);
    }
}

/// Real outputs of the unit, by FMI 3.0.
fn outputs(slave: &Slave, unit: &Unpacked) -> Vec<u64> {
    let variables = unit.interface.variables();
    let mut first = 0;
    let mut bits = Vec::new();
    for (name, count) in &slave.arrays {
        let variable = &variables[first];
        first += count;
        if variable.causality == Causality::Output && variable.quantity.of_type() == Type::Real {
            bits.extend(slave.get(name).into_iter().map(f64::to_bits));
        }
    }
    bits
}

#[test]
fn steps_give_the_bits_that_they_give_by_fmi_2() {
    let unit = Unpacked::new();
    let (slave, host) = (Slave::started(&unit), Host::started(&unit));
    for step in 0..10 {
        let (point, lift) = (f64::from(step) * 2.0e-4, 1.0e-5 * f64::from(step % 4));
        for (name, value) in [("floor.displacement.z", lift), ("floor.displacement.x", 0.5 * lift)] {
            assert_eq!((slave.set(name, &[value]), host.set(name, value)), (Status::Ok, Status::Ok));
        }
        assert_eq!(host.step(point, 2.0e-4), Status::Ok);
        assert_eq!(slave.step(point, 2.0e-4), (Status::Ok, point + 2.0e-4));
        assert_eq!(outputs(&slave, &unit), host.outputs());
    }
    assert_eq!(slave.get("floor.force").len(), 3);
    assert!(slave.get("floor.force")[2] != 0.0, "the bed rests on the floor");
}

#[test]
fn states_are_the_same_bytes_in_both_editions() {
    let unit = Unpacked::new();
    let (slave, host) = (Slave::started(&unit), Host::started(&unit));
    host.shake(0, 4);
    let bytes = host.serialize(host.save());
    let expected = host.shake(4, 1);
    let (mut state, mut size) = (null_mut(), 0);
    // SAFETY: the bytes, one handle, one size.
    unsafe {
        let (instance, start) = (slave.instance, bytes.as_ptr());
        assert_eq!(
            fmi3DeserializeFMUState(instance, start, bytes.len(), &raw mut state),
            Status::Ok,
            "{}",
            slave.said()
        );
        assert_eq!(fmi3SetFMUState(instance, state), Status::Ok);
        assert_eq!(fmi3GetFMUState(instance, &raw mut state), Status::Ok);
        assert_eq!(fmi3SerializedFMUStateSize(instance, state, &raw mut size), Status::Ok);
        let mut copy = vec![0_u8; size];
        assert_eq!(fmi3SerializeFMUState(instance, state, copy.as_mut_ptr(), size), Status::Ok);
        assert!(copy == bytes, "the state came back as other bytes");
        assert_eq!(fmi3FreeFMUState(instance, &raw mut state), Status::Ok);
    }
    let phase = f64::from(4) / 20.0;
    slave.set("floor.displacement.z", &[2.0e-4 * phase * (1.0 - phase)]);
    slave.set("floor.displacement.x", &[1.0e-4 * phase]);
    slave.set("grip.displacement.z", &[-3.0e-4 * phase]);
    assert_eq!(slave.step(4.0 * 2.0e-4, 2.0e-4).0, Status::Ok, "{}", slave.said());
    assert_eq!(outputs(&slave, &unit), expected);
}

#[test]
fn derivatives_of_an_array_are_those_of_its_elements() {
    let unit = Unpacked::new();
    let slave = Slave::started(&unit);
    slave.set("floor.displacement.z", &[1.0e-5]);
    assert_eq!(slave.step(0.0, 2.0e-4).0, Status::Ok);
    let (force, known) = (slave.reference("floor.force").0, slave.reference("floor.displacement.z").0);
    let ask = |length: usize| {
        let (mut found, seed) = (vec![0.0; length], 1.0);
        // SAFETY: one reference each, one seed and room for the result.
        let status = unsafe {
            let result = found.as_mut_ptr();
            fmi3GetDirectionalDerivative(
                slave.instance,
                &raw const force,
                1,
                &raw const known,
                1,
                &raw const seed,
                1,
                result,
                length,
            )
        };
        (status, found)
    };
    let (status, found) = ask(3);
    assert_eq!(status, Status::Ok, "{}", slave.said());
    assert!(found[2] < 0.0, "a floor that is lifted is pressed down by {} N/m", found[2]);
    slave.refused(ask(1).0, "sensitivity: expected 3 elements, as many as the variables have, found 1");
    let (order, mut rates) = (1, [f64::NAN; 3]);
    // SAFETY: one reference and order, and room for three rates.
    let status = unsafe {
        fmi3GetOutputDerivatives(slave.instance, &raw const force, 1, &raw const order, rates.as_mut_ptr(), 3)
    };
    assert_eq!(status, Status::Ok, "{}", slave.said());
    assert!(rates.iter().all(|rate| rate.is_finite()));
}

#[test]
fn wrong_lengths_references_and_types_are_refused_by_name() {
    let unit = Unpacked::new();
    let slave = Slave::started(&unit);
    slave.refused(slave.set("floor.displacement.z", &[0.0, 0.0]), "values: expected 1 elements");
    slave.refused(slave.set("floor.force", &[0.0; 3]), "floor.force.x is an output");
    slave.refused(slave.set("floor.displacement.z", &[f64::NAN]), "floor.displacement.z: expected a finite number");
    let (time, unknown) = (Reference::try_from(slave.arrays.len()).unwrap(), 9999);
    let (mut value, mut count) = (f64::NAN, 0);
    slave.step(0.0, 2.0e-4);
    // SAFETY: one reference and one value each.
    unsafe {
        assert_eq!(fmi3GetFloat64(slave.instance, &raw const time, 1, &raw mut value, 1), Status::Ok);
        assert_eq!(value.to_bits(), 2.0e-4_f64.to_bits());
        slave
            .refused(fmi3SetFloat64(slave.instance, &raw const time, 1, &raw const value, 1), "time: expected another");
        let status = fmi3GetFloat64(slave.instance, &raw const unknown, 1, &raw mut value, 1);
        slave.refused(status, "9999 is no value reference; they are 0 to");
        let force = slave.reference("floor.work").0;
        slave
            .refused(fmi3GetInt32(slave.instance, &raw const force, 1, &raw mut count, 1), "type Int32, found Float64");
        let status = fmi3GetFloat32(slave.instance, &raw const force, 1, null_mut(), 1);
        slave.refused(status, "type Float32, found Float64");
    }
}

#[test]
fn what_a_unit_does_not_have_is_said() {
    let unit = Unpacked::new();
    let slave = Slave::started(&unit);
    let instance = slave.instance;
    slave.refused(
        fmi3EnterEventMode(instance),
        "fmi3EnterEventMode: expected a unit with event mode; this one has none",
    );
    slave.refused(fmi3GetClock(instance, null(), 0, null_mut()), "clocks");
    slave.refused(fmi3SetTime(instance, 0.0), "model exchange");
    slave.refused(fmi3GetBinary(instance, null(), 0, null_mut(), null_mut(), 0), "binary variables");
    slave.refused(fmi3EnterConfigurationMode(instance), "structural parameters");
    // SAFETY: no reference and no value.
    assert_eq!(unsafe { fmi3GetUInt64(instance, null(), 0, null_mut(), 0) }, Status::Ok);
    assert_eq!(slave.step(0.0, 2.0e-4).0, Status::Ok, "the instance goes on");

    let asked = Slave::ask(&unit, &unit.identity, 1);
    assert!(asked.instance.is_null() && asked.said().contains("eventModeUsed: expected false"), "{}", asked.said());
    let asked = Slave::ask(&unit, "another", 0);
    assert!(asked.instance.is_null() && asked.said().contains("instantiationToken: expected"), "{}", asked.said());
}

#[test]
fn a_step_that_fails_is_discarded_and_leaves_the_time_of_its_beginning() {
    let unit = Unpacked::new();
    let slave = Slave::started(&unit);
    assert_eq!(slave.step(0.0, 2.0e-4).0, Status::Ok);
    slave.set("floor.displacement.z", &[1.0]);
    let (status, time) = slave.step(2.0e-4, 2.0e-4);
    assert_eq!((status, time), (Status::Discard, 2.0e-4), "{}", slave.said());
    slave.set("floor.displacement.z", &[0.0]);
    assert_eq!(slave.step(2.0e-4, 2.0e-4).0, Status::Ok, "{}", slave.said());
    assert_eq!(fmi3Terminate(slave.instance), Status::Ok);
    assert_eq!(fmi3Reset(slave.instance), Status::Ok);
}
