//! What the command tells terminals, pipes, shells and other programs.

use crate::ground::{Place, cograin, complaint};

#[test]
fn a_quiet_run_says_nothing_and_a_quiet_check_reports() {
    let place = Place::new("quiet");
    let (scene, out) = (place.scene("end = 1e-3\nstep = 1e-5", ""), place.at("out"));
    let done = cograin(&[&"run", &scene, &"-o", &out, &"--quiet"]).output().unwrap();
    assert_eq!((complaint(&done, 0).as_str(), done.stdout.as_slice()), ("", [].as_slice()));
    let done = cograin(&[&"run", &scene, &"-o", &out, &"-q"]).output().unwrap();
    assert!(complaint(&done, 2).contains("holds results"), "errors are told");
    let done = cograin(&[&"check", &scene, &"-q"]).output().unwrap();
    complaint(&done, 0);
    assert!(String::from_utf8_lossy(&done.stdout).contains("time step  "), "{done:?}");
}

#[test]
fn a_long_run_tells_in_a_pipe_how_far_it_is() {
    let place = Place::new("progress");
    let (scene, out) = (place.scene("end = 1.0\nstep = 1e-6", "history_interval = 0.5"), place.at("out"));
    let done = cograin(&[&"run", &scene, &"-o", &out]).output().unwrap();
    let said = complaint(&done, 0);
    let lines: Vec<&str> = said.lines().collect();
    let told = |line: &&str| line.starts_with("t = ") && line.contains(" of 1.0000e0 s (") && line.ends_with(" left");
    assert!(!lines.is_empty() && lines.len() <= 40 && lines.iter().all(told), "{said}");
}

#[test]
fn check_reports_as_json_what_it_reports_in_lines() {
    let place = Place::new("json");
    let scene = place.scene("end = 1e-3\nstep = 1e-5", "history_interval = 1e-4");
    let done = cograin(&[&"check", &scene, &"--json"]).output().unwrap();
    complaint(&done, 0);
    let report: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!(report["figures"]["particles"], 5);
    assert_eq!(report["figures"]["time_step"], 1e-5);
    assert_eq!(report["figures"]["steps"], serde_json::json!([100, 100, 100]));
    assert!(report["figures"]["stable_step"].as_f64().unwrap() > 1e-5, "{report:#}");
    let times: Vec<f64> = serde_json::from_value(report["figures"]["run_time"].clone()).unwrap();
    assert!(times[0] > 0.0 && times.is_sorted(), "{times:?}");
    assert!(report["uses"][0].as_str().unwrap().starts_with("5 particles, 0 contacts"), "{report:#}");
    assert!(report["remarks"].is_array() && report["cost"].is_string(), "{report:#}");
}

#[test]
fn shells_and_the_manual_know_commands_and_options() {
    for reader in ["bash", "zsh", "fish", "elvish", "powershell", "man"] {
        let done = cograin(&[&"completion", &reader]).output().unwrap();
        complaint(&done, 0);
        let told = String::from_utf8_lossy(&done.stdout).replace("\\-", "-");
        for word in ["settle", "overwrite", "stiffness"] {
            assert!(told.contains(word), "{reader}: {word}");
        }
    }
    let said = complaint(&cograin(&[&"completion", &"csh"]).output().unwrap(), 2);
    assert!(said.contains("bash") && said.contains("man"), "{said}");
    let version = cograin(&[&"-V"]).output().unwrap();
    assert!(String::from_utf8_lossy(&version.stdout).starts_with("cograin "), "{version:?}");
}

#[test]
fn one_of_a_kind_and_times_are_told_as_people_expect() {
    let place = Place::new("plain");
    let scene = place.at("scene.toml");
    let text = "[run]\nend = 3.75e-5\nstep = 1.25e-5\n[material.g]\ndensity = 2500.0\n[particles.p]\nmaterial = \"g\"\n\
                list = [{ position = [0.0, 0.0, 0.0], radius = 1e-3 }]\n[output]\nhistory_interval = 3.75e-5\n";
    std::fs::write(&scene, text).unwrap();
    let done = cograin(&[&"run", &scene, &"-o", &place.at("out")]).output().unwrap();
    complaint(&done, 0);
    let told = String::from_utf8_lossy(&done.stdout).into_owned();
    assert!(told.starts_with("3 steps to t = 0.0000375 s, 1 particle, 0 contacts on average"), "{told}");
}
