//! What is refused before anything is written.

use crate::ground::{Place, cograin, complaint};
use std::fs;

#[test]
fn a_mistake_in_the_scene_is_told_with_its_line_and_nothing_is_written() {
    let place = Place::new("mistake");
    let scene = place.scene("end = 0.1\nstepp = 1e-5", "");
    for command in ["check", "run"] {
        let output = match command {
            "check" => cograin(&[&"check", &scene]).output().unwrap(),
            _ => cograin(&[&"run", &scene, &"-o", &place.at("out")]).output().unwrap(),
        };
        let said = complaint(&output, 2);
        assert!(said.contains("scene.toml, line 6, [run]") && said.contains("step"), "{said}");
    }
    assert!(!place.at("out").exists());
}

#[test]
fn a_scene_that_is_not_there_is_refused() {
    let place = Place::new("absent");
    let said = complaint(&cograin(&[&"run", &place.at("scene.toml"), &"-o", &place.at("out")]).output().unwrap(), 2);
    assert!(said.contains("there is no such file"), "{said}");
    assert!(!place.at("out").exists());
}

#[test]
fn a_wrong_command_line_is_refused() {
    for arguments in [
        vec!["dance"],
        vec!["run"],
        vec!["settle", "scene.toml"],
        vec!["run", "x", "--threads", "0"],
        vec!["run", "x", "--lanes", "3"],
    ] {
        let arguments: Vec<&dyn AsRef<std::ffi::OsStr>> = arguments.iter().map(|a| a as _).collect();
        complaint(&cograin(&arguments).output().unwrap(), 2);
    }
}

#[test]
fn a_run_without_an_end_is_refused_and_nothing_is_written() {
    let place = Place::new("endless");
    let scene = place.scene("step = 1e-5", "");
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &place.at("out")]).output().unwrap(), 2);
    assert!(said.contains("[run] end: not given"), "{said}");
    assert!(!place.at("out").exists());
}

#[test]
fn a_time_step_above_the_bound_is_refused_and_nothing_is_written() {
    let place = Place::new("long_step");
    let scene = place.scene("end = 1.0\nstep = 1e-2\nstrict_step = true", "");
    let text = fs::read_to_string(&scene).unwrap().replace("[0.011, 0.001, 0.012]", "[0.00998, 0.0, 0.012]");
    fs::write(&scene, text).unwrap();
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &place.at("out")]).output().unwrap(), 2);
    assert!(said.contains("scene.toml: the time step") && said.contains("above the stable one"), "{said}");
    assert!(!place.at("out").exists());
}

#[test]
fn folders_without_cases_are_refused() {
    let place = Place::new("no_cases");
    let said = complaint(&cograin(&[&"verify", &place.0]).output().unwrap(), 2);
    assert!(said.contains("no case.json here"), "{said}");
}
