//! Runs that are broken off and go on.

use crate::ground::{ALL_OUTPUTS, Place, assert_same, cograin, complaint, results, summary, wait_for_rows};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// Starts a run of many steps, stops it as told, and returns the folder; also the folder of a run that was left alone.
fn broken_and_whole(place: &Place, stop: impl FnOnce(Child)) -> (PathBuf, PathBuf, PathBuf) {
    let scene = place.scene("end = 1.0\nstep = 1e-6", ALL_OUTPUTS);
    let (broken, whole) = break_off(place, &scene, stop);
    (scene, broken, whole)
}

/// The same for a scene of its own, which writes more than seventeen rows.
fn break_off(place: &Place, scene: &Path, stop: impl FnOnce(Child)) -> (PathBuf, PathBuf) {
    let (broken, whole) = (place.at("broken"), place.at("whole"));
    let mut child =
        cograin(&[&"run", &scene, &"-o", &broken]).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    wait_for_rows(&mut child, &broken, 17);
    stop(child);
    complaint(&cograin(&[&"run", &scene, &"-o", &whole]).output().unwrap(), 0);
    (broken, whole)
}

#[test]
fn a_run_that_was_killed_goes_on_and_ends_with_the_same_bytes() {
    let place = Place::new("killed");
    let (scene, broken, whole) = broken_and_whole(&place, |mut child| {
        child.kill().unwrap();
        child.wait().unwrap();
    });
    assert!(results(&broken)["history.csv"].len() < results(&whole)["history.csv"].len());
    complaint(&cograin(&[&"run", &scene, &"-o", &broken, &"--resume"]).output().unwrap(), 0);
    assert_same(&broken, &whole);
}

/// A bonded beam, held at one end and thrown sideways: it breaks.
const BEAM: &str = r#"
[run]
end = 4e-3
step = 2e-8

[material.glass]
density = 2500.0

[particles.beam]
material = "glass"
velocity = [0.0, 0.0, -2.0]
lattice = { kind = "simple_cubic", radius = 1e-3, counts = [8, 2, 2] }

[bond.glue]
between = ["beam", "beam"]
create_distance = 2.1e-3
normal_stiffness = 1e12
tangential_stiffness = 4e11
breakage = { max_normal_stress = 3e6, max_shear_stress = 3e6 }

[boundary.clamp]
particles = { set = "beam", box = [[-1.0, -1.0, -1.0], [1.5e-3, 1.0, 1.0]] }
motion = "fixed"

[output]
history_interval = 4e-5
frame_interval = 1e-3
checkpoint_interval = 1e-4
energy = true
"#;

#[test]
fn bonds_that_broke_before_a_kill_are_told_once() {
    let place = Place::new("bonds");
    let scene = place.at("scene.toml");
    fs::write(&scene, BEAM).unwrap();
    let (broken, whole) = break_off(&place, &scene, |mut child| {
        child.kill().unwrap();
        child.wait().unwrap();
    });
    complaint(&cograin(&[&"run", &scene, &"-o", &broken, &"--resume"]).output().unwrap(), 0);
    assert_same(&broken, &whole);
    let breakage = fs::read_to_string(whole.join("breakage.csv")).unwrap();
    assert!(breakage.starts_with("time,id1,id2,cause,energy,position.x,"), "{breakage}");
    let broken = breakage.lines().count() - 1;
    assert!(broken > 0, "nothing broke");
    let summary = summary(&whole);
    assert_eq!(summary["counts"]["bonds_broken"], broken);
    // 8 × 2 × 2 spheres: 7 × 4 bonds along the beam, 8 × 4 across it.
    assert_eq!(summary["counts"]["bonds_intact"], 7 * 4 + 8 * 4 - broken);
    for residual in [&summary["energy"]["relative_residual"], &summary["momentum"]["relative_residual"]] {
        assert!(residual.as_f64().unwrap().abs() < 1e-12, "{summary:#}");
    }
    assert!(whole.join("bonds_000004.vtu").exists() && whole.join("bonds.pvd").exists());
}

#[test]
fn an_interruption_leaves_whole_files_to_go_on_from() {
    let place = Place::new("interrupted");
    let (scene, broken, whole) = broken_and_whole(&place, |child| {
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
        let said = complaint(&child.wait_with_output().unwrap(), 1);
        assert!(said.contains("interrupted at t = ") && said.contains("--resume"), "{said}");
    });
    assert_eq!(summary(&broken)["ended"], "interrupted");
    let history = fs::read_to_string(broken.join("history.csv")).unwrap();
    assert!(history.ends_with('\n') && fs::read_to_string(whole.join("history.csv")).unwrap().starts_with(&history));
    complaint(&cograin(&[&"run", &scene, &"-o", &broken, &"--resume"]).output().unwrap(), 0);
    assert_same(&broken, &whole);
}

#[test]
fn a_checkpoint_of_another_scene_is_refused() {
    let place = Place::new("other_scene");
    let out = place.at("out");
    let scene = place.scene("end = 0.002\nstep = 2e-5", "");
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    let before = results(&out);
    let scene = place.scene("end = 0.004\nstep = 2e-5", "");
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume"]).output().unwrap(), 2);
    assert!(said.contains("is a checkpoint of scene.toml at t = 0.002") && said.contains("--from"), "{said}");
    assert!(results(&out) == before, "the refused command changed files");
}

#[test]
fn resuming_without_a_checkpoint_is_refused() {
    let place = Place::new("no_checkpoint");
    let scene = place.scene("end = 0.002\nstep = 2e-5", "");
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &place.at("out"), &"--resume"]).output().unwrap(), 2);
    assert!(said.contains("holds no checkpoint.cograin"), "{said}");
    assert!(!place.at("out").exists());
}
