//! One folder, one run: a second run into the same folder is refused while the first lasts, and results of another run stay unless
//! one asks for their replacement.

use crate::ground::{ALL_OUTPUTS, Place, assert_same, cograin, complaint, results, summary, wait_for_rows};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::thread::sleep;
use std::time::Instant;

/// Many steps: what writes them can be met at work.
const LONG: &str = "end = 0.4\nstep = 1e-6";

/// Moments of a replacement at which it is killed.
const OFFSETS: u32 = 16;

/// Few steps.
const SHORT: &str = "end = 0.05\nstep = 1e-5";

#[test]
fn a_second_run_in_the_folder_of_a_run_at_work_is_refused_with_its_process_and_time() {
    let place = Place::new("two_runs");
    let (scene, out) = (place.scene(LONG, ALL_OUTPUTS), place.at("out"));
    let mut first = cograin(&[&"run", &scene, &"-o", &out]).stdout(Stdio::null()).spawn().unwrap();
    wait_for_rows(&mut first, &out, 3);
    for more in [&["--overwrite"][..], &["--resume"], &[]] {
        let said = complaint(&cograin(&[&"run", &scene, &"-o", &out]).args(more).output().unwrap(), 2);
        assert!(said.contains(&format!("in use by process {}, started 2", first.id())), "{more:?}: {said}");
    }
    assert!(first.wait().unwrap().success());
    let alone = place.at("alone");
    complaint(&cograin(&[&"run", &scene, &"-o", &alone]).output().unwrap(), 0);
    assert_same(&out, &alone);
    assert!(!out.join(".cograin-lock").exists());
}

#[test]
fn the_lock_of_a_killed_run_is_gone() {
    let place = Place::new("lock_of_the_killed");
    let (scene, out) = (place.scene(LONG, ALL_OUTPUTS), place.at("out"));
    let mut first = cograin(&[&"run", &scene, &"-o", &out]).stdout(Stdio::null()).spawn().unwrap();
    wait_for_rows(&mut first, &out, 3);
    first.kill().unwrap();
    first.wait().unwrap();
    assert!(out.join(".cograin-lock").exists(), "it was killed at work");
    complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume"]).output().unwrap(), 0);
    assert!(!out.join(".cograin-lock").exists());
}

#[test]
fn results_of_an_earlier_run_are_kept_unless_overwrite_is_said() {
    let place = Place::new("earlier");
    let (scene, out) = (place.scene(SHORT, ALL_OUTPUTS), place.at("out"));
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    fs::write(out.join("notes.txt"), "mine").unwrap();
    let before = results(&out);
    let shorter = place.scene("end = 0.02\nstep = 1e-5", "history_interval = 1e-3");
    let said = complaint(&cograin(&[&"run", &shorter, &"-o", &out]).output().unwrap(), 2);
    assert!(said.contains("holds results of an earlier run (scene.toml, completed at t = 0.05"), "{said}");
    assert!(said.contains("--overwrite"), "{said}");
    assert!(results(&out) == before, "the refused command changed files");
    complaint(&cograin(&[&"run", &shorter, &"-o", &out, &"--overwrite"]).output().unwrap(), 0);
    assert_eq!(fs::read_to_string(out.join("notes.txt")).unwrap(), "mine");
    fs::remove_file(out.join("notes.txt")).unwrap();
    let alone = place.at("alone");
    complaint(&cograin(&[&"run", &shorter, &"-o", &alone]).output().unwrap(), 0);
    assert_same(&out, &alone);
}

#[test]
fn overwriting_what_is_to_be_resumed_is_refused() {
    let place = Place::new("overwrite_and_resume");
    let scene = place.scene(SHORT, "");
    let said = complaint(
        &cograin(&[&"run", &scene, &"-o", &place.at("out"), &"--resume", &"--overwrite"]).output().unwrap(),
        2,
    );
    assert!(said.contains("--overwrite replaces the results that --resume goes on with"), "{said}");
}

#[test]
fn results_cannot_go_where_a_file_is() {
    let place = Place::new("a_file");
    let scene = place.scene(SHORT, "");
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &scene]).output().unwrap(), 2);
    assert!(said.contains("scene.toml: expected a folder, or a name that is not there yet, found a file"), "{said}");
}

/// Copies the files of a folder.
fn copy(from: &Path, to: &Path) {
    let _ = fs::remove_dir_all(to);
    fs::create_dir_all(to).unwrap();
    for (name, bytes) in results(from) {
        fs::write(to.join(name), bytes).unwrap();
    }
    fs::copy(from.join("summary.json"), to.join("summary.json")).unwrap();
}

/// Two scenes, and a folder with the results of each.
fn two_results(place: &Place) -> [(PathBuf, PathBuf); 2] {
    let frames = "history_interval = 1e-3\nframe_interval = 2e-3\ncontacts = true";
    let make = |name: &str, end: &str| {
        let scene = place.at(&format!("{name}.toml"));
        fs::copy(place.scene(&format!("end = {end}\nstep = 1e-5"), frames), &scene).unwrap();
        let out = place.at(name);
        complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
        (scene, out)
    };
    [make("one", "0.04"), make("other", "0.02")]
}

#[test]
fn a_kill_while_results_are_replaced_leaves_the_old_ones_or_the_new_run() {
    let place = Place::new("killed_replacing");
    let [(_, old), (scene, new)] = two_results(&place);
    let out = place.at("out");
    let begun = Instant::now();
    copy(&old, &out);
    complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--overwrite"]).output().unwrap(), 0);
    let whole = begun.elapsed();
    let (mut kept, mut replaced) = (0, 0);
    for offset in 0..OFFSETS {
        copy(&old, &out);
        let mut child = cograin(&[&"run", &scene, &"-o", &out, &"--overwrite"]).stdout(Stdio::null()).spawn().unwrap();
        sleep(whole * offset / OFFSETS);
        child.kill().unwrap();
        let ended = child.wait().unwrap().success();
        let now = results(&out);
        let hidden = |name: &String| name.starts_with('.');
        let visible: Vec<_> = now.iter().filter(|(name, _)| !hidden(name)).collect();
        if visible == results(&old).iter().collect::<Vec<_>>() {
            kept += 1;
            continue;
        }
        replaced += 1;
        if !ended {
            complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume"]).output().unwrap(), 0);
        }
        assert_same(&out, &new);
    }
    assert!(kept > 0 && replaced > 0, "{kept} kept, {replaced} replaced: the kills met one side only");
}

#[test]
fn a_run_that_begins_with_a_checkpoint_of_another_folder_can_be_resumed_in_turn() {
    let place = Place::new("elsewhere");
    let scene = place.scene(LONG, ALL_OUTPUTS);
    let [whole, first, second] = ["whole", "first", "second"].map(|name| place.at(name));
    let stop_at = |out: &Path, rows: usize, more: &[&str]| {
        let mut child = cograin(&[&"run", &scene, &"-o", &out]).args(more).stdout(Stdio::null()).spawn().unwrap();
        wait_for_rows(&mut child, out, rows);
        child.kill().unwrap();
        child.wait().unwrap();
    };
    stop_at(&first, 30, &[]);
    let checkpoint = first.join("checkpoint.cograin");
    stop_at(&second, 40, &["--resume", checkpoint.to_str().unwrap()]);
    complaint(&cograin(&[&"run", &scene, &"-o", &second, &"--resume"]).output().unwrap(), 0);
    complaint(&cograin(&[&"run", &scene, &"-o", &whole]).output().unwrap(), 0);
    assert!(summary(&second)["start"].as_f64().unwrap() > 0.0);
    // Both folders together hold the rows and frames of the unbroken run.
    let [all, later] = [&whole, &second].map(|folder| results(folder));
    let text = |folder: &Path| fs::read_to_string(folder.join("history.csv")).unwrap();
    let (all_rows, later_rows) = (text(&whole), text(&second));
    let (header, later_rows) = later_rows.split_once('\n').unwrap();
    assert!(all_rows.starts_with(header) && all_rows.ends_with(later_rows) && later_rows.lines().count() > 100);
    let frames: Vec<_> = later.keys().filter(|name| name.ends_with(".vtu")).collect();
    assert!(frames.len() > 10 && frames.len() < all.keys().filter(|name| name.ends_with(".vtu")).count());
    for name in frames.into_iter().map(String::as_str).chain(["checkpoint.cograin"]) {
        assert!(later[name] == all[name], "{name} differs");
    }
    let times = String::from_utf8(later["particles.pvd"].clone()).unwrap();
    assert!(times.contains("timestep=\"0.4\"") && !times.contains("particles_000000.vtu"), "{times}");
}

#[test]
fn bonds_that_break_at_time_0_are_listed() {
    let place = Place::new("breaks_at_0");
    let scene = place.at("scene.toml");
    // Spheres that are bonded 10 % further apart than the bond may be long.
    let text = r#"
[run]
end = 1e-4
step = 1e-6
[material.glass]
density = 2500.0
[particles.two]
material = "glass"
list = [{ position = [0.0, 0.0, 0.0], radius = 1e-3 }, { position = [2.2e-3, 0.0, 0.0], radius = 1e-3 }]
[bond.glue]
between = ["two", "two"]
create_distance = 3e-3
normal_stiffness = 1e9
tangential_stiffness = 4e8
breakage = { max_distance = 2.1e-3 }
"#;
    fs::write(&scene, text).unwrap();
    let out = place.at("out");
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    assert_eq!(summary(&out)["counts"]["bonds_broken"], 1);
    let breakage = fs::read_to_string(out.join("breakage.csv")).unwrap();
    assert!(breakage.lines().nth(1).is_some_and(|row| row.starts_with("0.0,1,2,distance,")), "{breakage}");
    complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume"]).output().unwrap(), 0);
    assert_eq!(fs::read_to_string(out.join("breakage.csv")).unwrap(), breakage);
}

#[test]
fn absurd_counts_of_outputs_are_refused_by_run_and_check() {
    let place = Place::new("absurd");
    let cases = [
        (
            "frame_interval = 1e-300",
            "frame_interval: expected at most ",
            "frames up to t = 0.05 s, found 5.000e298, one every 1e-300 s",
        ),
        (
            "history_interval = 5e-14",
            "history_interval: expected at most ",
            "rows of history.csv up to t = 0.05 s, found 1.000e12, one every 5e-14 s",
        ),
        (
            "checkpoint_interval = 1e-9",
            "checkpoint_interval: expected at most ",
            "checkpoints up to t = 0.05 s, found 5.000e7, one every 1e-9 s",
        ),
    ];
    for (output, expected, found) in cases {
        let scene = place.scene(SHORT, output);
        for command in ["check", "run"] {
            let mut call = cograin(&[&command, &scene]);
            if command == "run" {
                call.arg("-o").arg(place.at("out"));
            }
            let said = complaint(&call.output().unwrap(), 2);
            assert!(said.contains(expected) && said.contains(found), "{command}: {said}");
        }
    }
    assert!(!place.at("out").exists());
}

#[test]
fn a_name_cannot_command_the_terminal() {
    let place = Place::new("escapes");
    let scene = place.at("scene.toml");
    fs::write(&scene, "[run]\n\"\\u001b[31mstep\" = 1.0\n").unwrap();
    let said = complaint(&cograin(&[&"check", &scene]).output().unwrap(), 2);
    assert!(!said.contains('\u{1b}') && said.contains("[31mstep"), "{said:?}");
}
