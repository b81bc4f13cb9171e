//! Input and surroundings that mean harm: all end in words, and nothing of others is touched.

use crate::ground::{Place, cograin, complaint, wait_for_rows};
use std::fs::{self, OpenOptions};
use std::path::Path;
use std::process::{Command, Stdio};

/// `check` panicked on such scenes, and `run` left a checkpoint that it then refused itself.
#[test]
fn a_start_that_no_state_may_have_is_refused_by_check_and_run() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/scenes/overflowing");
    // A spin beyond all energies, and a course faster than any number.
    for name in ["spin", "course"] {
        let (place, scene) = (Place::new(&format!("overflowing_{name}")), scenes.join(format!("{name}.toml")));
        let (out, end) = (place.at("out"), "run.end=1e-3");
        let checked = complaint(&cograin(&[&"check", &scene, &"--set", &end]).output().unwrap(), 2);
        let run = complaint(&cograin(&[&"run", &scene, &"--set", &end, &"-o", &out]).output().unwrap(), 2);
        assert_eq!(checked, run);
        assert!(run.starts_with(&format!("{name}.toml")) && !run.contains("panicked"), "{run}");
        assert!(!out.join("checkpoint.cograin").exists());
    }
}

#[test]
fn a_run_does_not_replace_what_no_run_has_written_nor_what_it_reads() {
    let place = Place::new("foreign_results");
    let (scene, out) = (place.scene("end = 1e-3\nstep = 1e-5", "history_interval = 1e-3"), place.at("out"));
    fs::create_dir_all(&out).unwrap();
    fs::write(out.join("particles_000003.vtu"), "mine").unwrap();
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--overwrite"]).output().unwrap(), 2);
    assert!(
        said.contains("expected results that a run has written, found particles_000003.vtu of another kind"),
        "{said}"
    );
    assert_eq!(fs::read_to_string(out.join("particles_000003.vtu")).unwrap(), "mine");
    fs::remove_file(out.join("particles_000003.vtu")).unwrap();
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    let checkpoint = out.join("checkpoint.cograin");
    let again = cograin(&[&"run", &scene, &"-o", &out, &"--from", &checkpoint, &"--overwrite"]).output().unwrap();
    let said = complaint(&again, 2);
    assert!(said.contains("expected a file that the command does not read itself"), "{said}");
    assert!(checkpoint.exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_the_standard_output_is_a_failure() {
    let place = Place::new("full_output");
    let scene = place.scene("end = 1e-3\nstep = 1e-5", "");
    let said = |arguments: &[&dyn AsRef<std::ffi::OsStr>]| {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let done = cograin(arguments).stdout(full).stderr(Stdio::piped()).spawn().unwrap();
        complaint(&done.wait_with_output().unwrap(), 1)
    };
    for said in [said(&[&"check", &scene]), said(&[&"--help"]), said(&[&"run", &"--help"]), said(&[&"--version"])] {
        assert!(said.contains("the standard output cannot be written"), "{said}");
    }
}

#[cfg(unix)]
#[test]
fn a_history_that_is_deleted_during_a_run_is_told() {
    let place = Place::new("deleted_history");
    let (scene, out) = (place.scene("end = 0.4\nstep = 1e-6", "history_interval = 2e-3"), place.at("out"));
    let mut child =
        cograin(&[&"run", &scene, &"-o", &out]).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    wait_for_rows(&mut child, &out, 3);
    fs::remove_file(out.join("history.csv")).unwrap();
    let said = complaint(&child.wait_with_output().unwrap(), 1);
    assert!(said.contains("expected the file that this run writes"), "{said}");
}

/// The program goes on ignoring the signal that `nohup` told it to ignore.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_the_caller_ignores_stays_ignored() {
    let place = Place::new("nohup");
    let (scene, out) = (place.scene("end = 0.4\nstep = 1e-6", "history_interval = 2e-3"), place.at("out"));
    let program = env!("CARGO_BIN_EXE_cograin");
    let line = format!("trap '' HUP; exec {program} run {} -o {}", scene.display(), out.display());
    let mut child =
        Command::new("sh").args(["-c", &line]).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    wait_for_rows(&mut child, &out, 3);
    assert!(Command::new("kill").args(["-HUP", &child.id().to_string()]).status().unwrap().success());
    complaint(&child.wait_with_output().unwrap(), 0);
}

#[cfg(unix)]
#[test]
fn a_limit_on_the_size_of_files_is_told_in_words() {
    let place = Place::new("file_size");
    let (scene, out) = (place.scene("end = 0.05\nstep = 1e-5", "history_interval = 1e-4"), place.at("out"));
    let program = env!("CARGO_BIN_EXE_cograin");
    let line = format!("ulimit -f 8; exec {program} run {} -o {}", scene.display(), out.display());
    let said = complaint(&Command::new("sh").args(["-c", &line]).output().unwrap(), 1);
    assert!(said.contains("cannot be written"), "{said}");
}

/// Frames and the state behind a checkpoint were not foreseen: the program ended by a signal.
#[cfg(target_os = "linux")]
#[test]
fn without_memory_a_run_ends_in_words() {
    let place = Place::new("without_memory");
    let scene = place.at("scene.toml");
    let text = r#"
gravity = [0.0, 0.0, -9.81]
[run]
end = 4e-6
step = 1e-6
threads = 2
[material.g]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.g.g]
restitution = 0.5
[contact.c.normal.hertz]
[particles.p]
material = "g"
lattice = { kind = "face_centred_cubic", radius = 0.001, spacing = 0.00199, counts = [14, 14, 14] }
[bond.b]
between = ["p", "p"]
create_distance = 0.0021
normal_stiffness = 1e10
tangential_stiffness = 4e9
[output]
history_interval = 2e-6
frame_interval = 2e-6
contacts = true
checkpoint_interval = 2e-6
"#;
    fs::write(&scene, text).unwrap();
    let mut words = Vec::new();
    for megabytes in [40, 60, 80, 100, 120, 140, 160, 180, 200, 230, 260, 300] {
        let line = format!("ulimit -v {}; exec \"$0\" \"$@\"", 1000 * megabytes);
        let out = place.at(&megabytes.to_string());
        let mut run = Command::new("sh");
        run.args(["-c", &line, env!("CARGO_BIN_EXE_cograin"), "run"]).arg(&scene).arg("-o").arg(&out);
        let done = run.stdin(Stdio::null()).output().unwrap();
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        let status = done.status.code();
        assert!(matches!(status, Some(0..=2)), "{megabytes} MB: {:?}\n{said}", done.status);
        assert!(!said.contains("panicked") && !said.contains("backtrace"), "{megabytes} MB: {said}");
        assert!(status == Some(0) || said.contains("memory"), "{megabytes} MB: {said}");
        words.extend((status == Some(1)).then_some(said));
    }
    assert!(words.iter().any(|said| said.contains("more of memory, found none free")), "{words:?}");
}
