//! Runs that are broken off and go on.

use crate::ground::{ALL_OUTPUTS, Place, assert_same, cograin, complaint, results, summary, wait_for_rows};
use cograin::results::read_checkpoint;
use cograin::scene::Scene;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Starts a run of many steps, stops it as told, and returns the folder; also the folder of a run that was left alone.
fn broken_and_whole(place: &Place, stop: impl FnOnce(Child)) -> (PathBuf, PathBuf, PathBuf) {
    let scene = place.scene("end = 0.4\nstep = 1e-6", ALL_OUTPUTS);
    let (broken, whole) = break_off(place, &scene, stop);
    (scene, broken, whole)
}

/// The same for a scene of its own, which writes more than seventeen rows.
pub(crate) fn break_off(place: &Place, scene: &Path, stop: impl FnOnce(Child)) -> (PathBuf, PathBuf) {
    let (broken, whole) = (place.at("broken"), place.at("whole"));
    // A test that runs in the background may have inherited that interruptions are ignored.
    let mut command = Command::new("env");
    command.args(["--default-signal=INT", env!("CARGO_BIN_EXE_cograin"), "run"]).args([
        scene,
        Path::new("-o"),
        &broken,
    ]);
    let mut child = command.stdin(Stdio::null()).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
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
    assert!(
        said.contains("is a checkpoint of scene.toml at t = 0.002") && said.contains("--end for another end"),
        "{said}"
    );
    let scene = place.scene("end = 0.002\nstep = 1e-5", "");
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

/// Starts a run that goes on for as long as nobody stops it, and interrupts it after a while. Returns what it says.
fn interrupted(scene: &Path, out: &Path, more: &[&str], wait: Duration) -> String {
    let mut command = Command::new("env");
    command.args(["--default-signal=INT", env!("CARGO_BIN_EXE_cograin"), "run"]).arg(scene).arg("-o").arg(out);
    let mut child =
        command.args(more).stdin(Stdio::null()).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    sleep(wait);
    assert!(child.try_wait().unwrap().is_none(), "the run ended before it could be stopped");
    let begun = Instant::now();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let said = complaint(&child.wait_with_output().unwrap(), 1);
    assert!(begun.elapsed() < Duration::from_secs(5), "it took {:?} to stop", begun.elapsed());
    said
}

/// An interruption waited for the end of the communication step: of an hour, in a run without intervals and with short time steps.
#[test]
fn an_interruption_acts_between_time_steps() {
    let place = Place::new("between_steps");
    let (scene, out) = (place.scene("end = 1e6\nstep = 1e-6", ""), place.at("out"));
    let said = interrupted(&scene, &out, &[], Duration::from_millis(1500));
    assert!(said.contains("interrupted at t = ") && said.contains("--resume"), "{said}");
    let checked = Scene::read(&scene).unwrap().0;
    let state = |out: &Path| read_checkpoint(&out.join("checkpoint.cograin"), &checked).unwrap();
    let before = state(&out);
    assert!(before.clock.steps > 1000 && before.underway.is_some(), "{:?}", before.clock);
    assert_eq!(summary(&out)["steps"], before.clock.steps);
    // From another folder, too.
    let other = place.at("other");
    let file = out.join("checkpoint.cograin");
    interrupted(&scene, &other, &["--resume", file.to_str().unwrap()], Duration::from_millis(1500));
    interrupted(&scene, &out, &["--resume"], Duration::from_millis(1500));
    for folder in [&out, &other] {
        let steps = state(folder).clock.steps;
        assert!(steps > before.clock.steps + 1000, "it has gone on");
        // Each time step rounds the sum of impulses once.
        assert!(summary(folder)["momentum"]["relative_residual"].as_f64().unwrap() < steps as f64 * f64::EPSILON);
    }
    assert_eq!(fs::read_to_string(out.join("history.csv")).unwrap().lines().count(), 2);
}

#[test]
fn a_run_that_was_interrupted_on_its_way_ends_with_the_same_bytes() {
    let place = Place::new("on_its_way");
    let scene = place.at("scene.toml");
    let text = BEAM
        .replace("history_interval = 4e-5", "history_interval = 1e-2")
        .replace("frame_interval = 1e-3\ncheckpoint_interval = 1e-4", "")
        .replace("end = 4e-3", "end = 2e-2");
    fs::write(&scene, text).unwrap();
    let (broken, whole) = (place.at("broken"), place.at("whole"));
    interrupted(&scene, &broken, &[], Duration::from_millis(700));
    interrupted(&scene, &broken, &["--resume"], Duration::from_millis(700));
    assert!(!results(&broken)["breakage.csv"].is_empty());
    complaint(&cograin(&[&"run", &scene, &"-o", &broken, &"--resume"]).output().unwrap(), 0);
    complaint(&cograin(&[&"run", &scene, &"-o", &whole]).output().unwrap(), 0);
    assert_same(&broken, &whole);
    assert!(results(&whole)["breakage.csv"].iter().filter(|byte| **byte == b'\n').count() > 1, "nothing broke");
}

#[test]
fn settling_is_interrupted_between_time_steps_and_can_be_gone_on_with() {
    let place = Place::new("settling_interrupted");
    // Nothing comes to rest without damping.
    let run = "step = 1e-7\nsettle_damping = 0.0\nsettle_tolerance = 1e-12";
    let (scene, state) = (place.scene(run, ""), place.at("settled.cograin"));
    // Many enough that it does not give up before it is interrupted.
    let many = "[particles.many]\nmaterial = \"glass\"\nlattice = { kind = \"simple_cubic\", origin = [-0.01, 0.02, 0.006], \
                counts = [4, 20, 28], spacing = 9.9e-3, radius = 4.9e-3 }\n";
    fs::write(&scene, format!("{}{many}", fs::read_to_string(&scene).unwrap())).unwrap();
    let mut command = Command::new("env");
    command.args(["--default-signal=INT", env!("CARGO_BIN_EXE_cograin"), "settle"]).arg(&scene).arg("-o").arg(&state);
    let child = command.args(["--steps", "1000000000"]).stderr(Stdio::piped()).spawn().unwrap();
    sleep(Duration::from_millis(700));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let said = complaint(&child.wait_with_output().unwrap(), 1);
    assert!(said.contains("interrupted after ") && said.contains("run again with --resume"), "{said}");
    let kept = place.at("settled.cograin.unsettled");
    assert!(kept.exists() && !state.exists());
    let again = cograin(&[&"settle", &scene, &"-o", &state, &"--resume", &"--steps", &"200"]).output().unwrap();
    let said = complaint(&again, 1);
    assert!(said.contains("not settled after 200 steps"), "{said}");
}

/// An automatic step of 2e-21 s: 2e18 time steps to the end.
#[test]
fn an_automatic_step_that_never_comes_to_the_end_is_refused() {
    let place = Place::new("endless");
    let scene = place.at("scene.toml");
    let text = BEAM.replace("step = 2e-8", "step = \"auto\"").replace("1e12", "1e40").replace("4e11", "4e39");
    fs::write(&scene, text).unwrap();
    for command in ["check", "run"] {
        let out =
            if command == "run" { vec!["-o".to_owned(), place.at("out").display().to_string()] } else { Vec::new() };
        let done = cograin(&[&command, &scene]).args(&out).output().unwrap();
        let said = complaint(&done, 2);
        assert!(said.contains("expected at most 1e15 time steps"), "{said}");
    }
}
