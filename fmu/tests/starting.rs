//! Making an instance: what is read, and what is refused.

use super::host::{Host, Unpacked, instantiate, source, uri};
use crate::v2::fmi2FreeInstance;
use cograin::export::resources;
use std::fs;

/// Asserts that there is no instance, and that the reason says all this.
fn refused(unit: &Unpacked, guid: Option<&str>, location: Option<&str>, words: &[&str]) {
    let (component, messages) = instantiate("bed", 1, guid, location);
    assert!(component.is_null());
    let (_, category, message) = messages.borrow().last().cloned().expect("a reason");
    assert_eq!(category, "logStatusError");
    for word in words {
        assert!(message.contains(word), "{message:?} does not say {word:?}");
    }
    drop(Host::instantiated(unit));
}

#[test]
fn a_folder_with_any_name_is_found() {
    for name in ["a b", "#1", "50%", "Prüfstand", "plain"] {
        let unit = Unpacked::of(&source(), name);
        drop(Host::instantiated(&unit));
        for location in [unit.location().replace("file://", "file:"), format!("{}/", unit.location())] {
            let (component, messages) = instantiate("bed", 1, Some(&unit.identity), Some(&location));
            assert!(!component.is_null(), "{location}: {:?}", messages.borrow());
            fmi2FreeInstance(component);
        }
    }
}

#[test]
fn another_guid_is_refused() {
    let unit = Unpacked::new();
    let location = unit.location();
    refused(&unit, Some("{8c4e810f}"), Some(&location), &["fmuGUID: expected", "found {8c4e810f}", &unit.identity]);
    refused(&unit, None, Some(&location), &["fmuGUID: expected"]);
}

#[test]
fn missing_resources_are_named() {
    let unit = Unpacked::new();
    let nowhere = uri(&unit.folder.join("nowhere"));
    refused(&unit, Some(&unit.identity), Some(&nowhere), &["nowhere/scene.toml"]);
    refused(&unit, Some(&unit.identity), None, &["fmuResourceLocation: expected"]);
    refused(&unit, Some(&unit.identity), Some("http://somewhere/resources"), &["expected a file: URI"]);

    let gone = Unpacked::new();
    let file = resources(&source(), None).into_iter().find(|entry| entry.path.ends_with("bed.csv")).unwrap();
    fs::remove_file(gone.folder.join("resources").join(file.path)).unwrap();
    refused(&unit, Some(&gone.identity), Some(&gone.location()), &["bed.csv"]);
}

#[test]
fn a_changed_scene_is_refused() {
    let (unit, changed) = (Unpacked::new(), Unpacked::new());
    let path = changed.folder.join("resources/scene.toml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(path, text.replace("density = 2500.0", "density = 2600.0")).unwrap();
    refused(&unit, Some(&changed.identity), Some(&changed.location()), &["fmuGUID", "that of the resources"]);
}

#[test]
fn a_nameless_instance_and_model_exchange_are_refused() {
    let unit = Unpacked::new();
    let (identity, location) = (unit.identity.as_str(), unit.location());
    for (name, kind, word) in [("", 1, "instanceName: expected a name, found none"), ("bed", 0, "fmi2CoSimulation")] {
        let (component, messages) = instantiate(name, kind, Some(identity), Some(&location));
        assert!(component.is_null());
        assert!(messages.borrow()[0].2.contains(word), "{:?}", messages.borrow());
    }
}
