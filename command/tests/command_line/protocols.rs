//! Stages of a protocol: a scene begins with the checkpoint of another one, and a run can be given a later end.

use crate::ground::{Place, SCENE, assert_same, cograin, column, complaint, results, summary, wait_for_rows};
use cograin::results::Checkpoint;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// A lid over the spheres.
const LID: &str =
    "\n[boundary.lid]\nplane = { point = [0.0, 0.0, 0.045], normal = [0.0, 0.0, -1.0] }\nmaterial = \"glass\"\n";

/// Writes a stage: what ends it, how lid and floor move, and how rough the spheres are.
fn stage(place: &Place, name: &str, end: &str, [lid, floor]: [&str; 2], friction: &str) -> PathBuf {
    let path = place.at(&format!("{name}.toml"));
    let text = SCENE
        .replace("RUN", &format!("end = {end}\nstep = 2e-7"))
        .replace("OUTPUT", "history_interval = 1e-4\nframe_interval = 1e-2\ncheckpoint_interval = 2e-3")
        .replace("friction = 0.4", &format!("friction = {friction}"));
    // Just below the spheres, so that they touch it in every stage.
    let text = text.replace("point = [0.0, 0.0, 0.0]", "point = [0.0, 0.0, 0.007]");
    let floor_material = "normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"\n";
    let text = text.replace(floor_material, &format!("{floor_material}{floor}\n"));
    fs::write(&path, format!("{text}{LID}{lid}\n")).unwrap();
    path
}

/// The four stages and their ends \[s\].
fn stages(place: &Place) -> Vec<PathBuf> {
    let down = "motion = { prescribed = { z = -0.2 } }";
    let aside = "motion = { prescribed = { x = 0.1 } }";
    let up = "motion = { prescribed = { z = 0.2 } }";
    vec![
        stage(place, "prepare", "0.02", ["", ""], "0.0"),
        stage(place, "consolidate", "0.04", [down, ""], "0.4"),
        stage(place, "shear", "0.06", ["", aside], "0.4"),
        stage(place, "unload", "0.08", [up, ""], "0.4"),
    ]
}

/// The arguments that begin a stage.
fn begin(out: &Path, before: Option<&Path>) -> Vec<String> {
    let mut arguments = vec!["-o".to_owned(), out.display().to_string()];
    if let Some(before) = before {
        arguments.extend(["--from".to_owned(), before.join("checkpoint.cograin").display().to_string()]);
    }
    arguments
}

#[test]
fn a_protocol_that_is_killed_in_each_stage_ends_with_the_bytes_of_the_unbroken_one() {
    let place = Place::new("protocol");
    let (mut whole_before, mut broken_before): (Option<PathBuf>, Option<PathBuf>) = (None, None);
    for (number, scene) in stages(&place).into_iter().enumerate() {
        let [whole, broken] = ["whole", "broken"].map(|kind| place.at(&format!("{kind}{number}")));
        let run = || {
            let mut call = cograin(&[&"run", &scene]);
            call.stdout(Stdio::null());
            call
        };
        complaint(&run().args(begin(&whole, whole_before.as_deref())).output().unwrap(), 0);
        let mut child = run().args(begin(&broken, broken_before.as_deref())).spawn().unwrap();
        wait_for_rows(&mut child, &broken, 40);
        child.kill().unwrap();
        child.wait().unwrap();
        complaint(&run().arg("-o").arg(&broken).arg("--resume").output().unwrap(), 0);
        assert_same(&whole, &broken);
        assert_eq!(summary(&whole)["left_behind"], serde_json::json!([]), "all stages have the same bodies");
        (whole_before, broken_before) = (Some(whole), Some(broken));
    }
    // The lid went down by 4 mm, stayed, and went up again from there: nothing jumped between the stages.
    let last = |number: usize, name: &str| *column(&place.at(&format!("whole{number}")), name).last().unwrap();
    let first = |number: usize, name: &str| column(&place.at(&format!("whole{number}")), name)[0];
    assert!((last(1, "lid.displacement.z") + 4e-3).abs() < 1e-12);
    assert!((first(3, "lid.displacement.z") + 4e-3).abs() < 1e-12 && last(3, "lid.displacement.z").abs() < 1e-12);
    assert!((last(2, "floor.displacement.x") - 2e-3).abs() < 1e-12);
    let (before, after) = (last(1, "energy.kinetic"), first(2, "energy.kinetic"));
    assert!(
        (after / before - 1.0).abs() < 1e-12,
        "{before} J at the end of a stage, {after} J at the next one's begin"
    );
    let (before, after) = (last(1, "energy.elastic"), first(2, "energy.elastic"));
    assert!(
        before > 0.0 && (after / before - 1.0).abs() < 1e-9,
        "{before} J at the end of a stage, {after} J at the next one's begin"
    );
}

#[test]
fn a_later_end_goes_on_bit_for_bit() {
    let place = Place::new("later_end");
    let [short, long] =
        [("short", "0.02"), ("long", "0.04")].map(|(name, end)| stage(&place, name, end, ["", ""], "0.4"));
    let [first, second, whole] = ["first", "second", "whole"].map(|name| place.at(name));
    complaint(&cograin(&[&"run", &short, &"-o", &first]).output().unwrap(), 0);
    complaint(&cograin(&[&"run", &long]).args(begin(&second, Some(&first))).output().unwrap(), 0);
    complaint(&cograin(&[&"run", &long, &"-o", &whole]).output().unwrap(), 0);
    let rows = |folder: &Path| fs::read_to_string(folder.join("history.csv")).unwrap();
    let (later, all) = (rows(&second), rows(&whole));
    assert!(all.ends_with(later.split_once('\n').unwrap().1), "the rows of the later part differ");
    let [later, all] = [&second, &whole].map(|folder| results(folder));
    for name in ["particles_000002.vtu", "particles_000004.vtu"] {
        assert!(later[name] == all[name], "{name} differs");
    }
    assert!(state(&later["checkpoint.cograin"]) == state(&all["checkpoint.cograin"]), "the last states differ");
}

/// The state in a checkpoint, without the description, which names the scene.
fn state(bytes: &[u8]) -> Vec<u8> {
    let start = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n').nth(1).unwrap().0;
    bytes[start + 1..].to_vec()
}

#[test]
fn outputs_that_begin_or_end_with_a_later_end_change_no_bit_of_the_motion() {
    let place = Place::new("other_outputs");
    let [short, long] =
        [("short", "0.02"), ("long", "0.04")].map(|(name, end)| stage(&place, name, end, ["", ""], "0.4"));
    let run = |name: &str, scene: &Path, before: Option<&Path>, contacts: bool| {
        let out = place.at(name);
        let contacts = ["--set".to_owned(), format!("output.contacts={contacts}")];
        complaint(&cograin(&[&"run", &scene]).args(begin(&out, before)).args(contacts).output().unwrap(), 0);
        out
    };
    let whole = run("whole", &long, None, false);
    let begun = run("begun", &short, None, false);
    let shown = run("shown", &long, Some(&begun), true);
    let rows = |folder: &Path| fs::read_to_string(folder.join("history.csv")).unwrap();
    assert!(rows(&whole).ends_with(rows(&shown).split_once('\n').unwrap().1), "the rows with contacts differ");
    let ended = run("ended", &long, Some(&run("before", &short, None, true)), false);
    let [ended, whole] = [&ended, &whole].map(|folder| results(folder));
    assert!(state(&ended["checkpoint.cograin"]) == state(&whole["checkpoint.cograin"]), "the last states differ");
}

#[test]
fn settling_begins_with_the_checkpoint_of_another_scene_and_the_clock_goes_on() {
    let place = Place::new("settle_from");
    let smooth = place.scene("end = 0.02\nstep = 2e-5", "history_interval = 1e-3");
    let rough = place.at("rough.toml");
    let text = fs::read_to_string(&smooth).unwrap();
    fs::write(&rough, text.replace("friction = 0.4", "friction = 0.5")).unwrap();
    let [falling, resting] = ["falling", "resting"].map(|name| place.at(name));
    let settled = place.at("settled.cograin");
    complaint(&cograin(&[&"run", &smooth, &"-o", &falling]).output().unwrap(), 0);
    let from = falling.join("checkpoint.cograin");
    // So much damping takes the spin of spheres before they touch; once they do, a spin about the normal has nothing that stops it.
    let damping = "run.settle_damping=0.7";
    let output = cograin(&[&"settle", &rough, &"-o", &settled, &"--from", &from, &"--set", &damping]).output().unwrap();
    complaint(&output, 0);
    assert!(String::from_utf8_lossy(&output.stdout).contains("settled after"), "{output:?}");
    // The clock went on: the next stage ends later than this one was to end.
    let time = Checkpoint::read(&settled).unwrap().scene.time;
    assert!(time > 0.02, "{time}");
    let end = format!("run.end={}", time + 2e-3);
    let call = ["--set", &end, "--from", &settled.display().to_string(), "-o", &resting.display().to_string()];
    complaint(&cograin(&[&"run", &rough]).args(call).output().unwrap(), 0);
    let (before, after) = (*column(&falling, "energy.kinetic").last().unwrap(), column(&resting, "energy.kinetic")[0]);
    assert!(after < 1e-2 * before, "{before} J before it settled, {after} J after");
    assert!(column(&resting, "energy.elastic")[0] > 0.0, "the spheres touch");
}

#[test]
fn what_cannot_be_taken_along_is_said() {
    let place = Place::new("left_behind");
    let scene = stage(&place, "prepare", "0.01", ["", ""], "0.4");
    let before = place.at("before");
    complaint(&cograin(&[&"run", &scene, &"-o", &before]).output().unwrap(), 0);
    let text = fs::read_to_string(&scene).unwrap();
    let last = "    { position = [0.002, 0.004, 0.036], radius = 0.006 },\n";
    let text = text.replace(last, "").replace("boundary.lid", "boundary.cover").replace("end = 0.01", "end = 0.02");
    let other = place.at("other.toml");
    fs::write(&other, text.replace("[contact.touch.tangential.history]", "[contact.touch.tangential.no_history]"))
        .unwrap();
    let expected = [
        "1 of 5 particles of prepare.toml are not in this scene and stay behind",
        "[boundary.lid] of prepare.toml has no plane of its name here and stays behind",
        "the tangential spring of [contact.touch] of prepare.toml has no law here that keeps it",
        "[boundary.cover] is new and begins where this scene has it",
    ];
    let out = place.at("out");
    let output = cograin(&[&"run", &other]).args(begin(&out, Some(&before))).output().unwrap();
    complaint(&output, 0);
    let told = String::from_utf8_lossy(&output.stdout);
    let checked = cograin(&[&"check", &other]).args(&begin(&out, Some(&before))[2..]).output().unwrap();
    complaint(&checked, 0);
    for part in expected {
        assert!(told.contains(&format!("not taken along: {part}")), "{part} is missing in:\n{told}");
        assert!(String::from_utf8_lossy(&checked.stdout).contains(part), "{part} is missing in the report");
        assert!(summary(&out)["left_behind"].as_array().unwrap().iter().any(|left| left == part));
    }
}

#[test]
fn a_run_that_ends_where_the_checkpoint_stands_is_refused() {
    let place = Place::new("ended");
    let scene = stage(&place, "prepare", "0.01", ["", ""], "0.4");
    let before = place.at("before");
    complaint(&cograin(&[&"run", &scene, &"-o", &before]).output().unwrap(), 0);
    let said = complaint(&cograin(&[&"run", &scene]).args(begin(&place.at("out"), Some(&before))).output().unwrap(), 2);
    assert!(said.contains("prepare.toml, [run] end: expected a time after t = 0.01"), "{said}");
}

#[test]
fn a_checkpoint_of_an_older_program_is_refused_in_words() {
    let place = Place::new("older");
    let scene = stage(&place, "prepare", "0.01", ["", ""], "0.4");
    let file = place.at("old.cograin");
    for (bytes, expected) in [
        (&b"cograin\0\x04\0\0\0"[..], "is a checkpoint in the format of another version"),
        (b"cograin checkpoint 7\n", "is a checkpoint in the format of another version"),
        (b"[run]\nend = 1", "expected a checkpoint"),
        (b"cograin checkpoint 2\n0000000000000000 {}\n", "damaged"),
    ] {
        fs::write(&file, bytes).unwrap();
        for how in ["--from", "--resume"] {
            let said =
                complaint(&cograin(&[&"run", &scene, &"-o", &place.at("out"), &how, &file]).output().unwrap(), 2);
            assert!(said.contains(expected), "{how}: {said}");
        }
    }
}

#[test]
fn a_value_set_on_the_command_line_is_the_scenes() {
    let place = Place::new("set");
    let scene = stage(&place, "rough", "0.01", ["", ""], "0.4");
    let smooth = stage(&place, "smooth", "0.02", ["", ""], "0.1");
    let [set, written] = ["set", "written"].map(|name| place.at(name));
    let settings = ["--set", "pair.glass.glass.friction=0.1", "--set", "run.end=0.02"];
    complaint(&cograin(&[&"run", &scene, &"-o", &set]).args(settings).output().unwrap(), 0);
    complaint(&cograin(&[&"run", &smooth, &"-o", &written]).output().unwrap(), 0);
    let history = |folder: &Path| fs::read(folder.join("history.csv")).unwrap();
    assert!(history(&set) == history(&written), "the values are not those of the text");
    // A scene with other values is another scene.
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &set, &"--resume"]).output().unwrap(), 2);
    assert!(said.contains("is a checkpoint of rough.toml at t = 0.02"), "{said}");
    complaint(&cograin(&[&"run", &scene, &"-o", &set, &"--resume"]).args(settings).output().unwrap(), 0);
}

#[test]
fn a_setting_that_is_wrong_is_named() {
    let place = Place::new("bad_set");
    let scene = stage(&place, "scene", "0.01", ["", ""], "0.4");
    for (setting, expected) in [
        ("pair.glass.glass.friction=-1", "--set pair.glass.glass.friction=-1, [pair.glass.glass] friction: "),
        ("pair.glass.glass.frction=0.3", "--set pair.glass.glass.frction=0.3, [pair.glass.glass] frction: no such key"),
        ("pair.glass.steel.friction=0.3", "--set pair.glass.steel.friction=0.3, [pair.glass.steel]"),
        ("run.step=soon", "--set run.step=\"soon\", [run] step: "),
        ("friction", "expected KEY=VALUE"),
    ] {
        let said = complaint(&cograin(&[&"check", &scene, &"--set", &setting]).output().unwrap(), 2);
        assert!(said.contains(expected), "{setting}: {said}");
    }
}
