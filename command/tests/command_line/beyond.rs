//! Runs that go on beyond their end.

use crate::ground::{ALL_OUTPUTS, Place, assert_same, cograin, complaint, results, summary};
use std::path::Path;

/// Runs a scene into a folder with further arguments, and returns what it says, having ended with this status.
fn run(scene: &Path, folder: &Path, further: &[&str], status: i32) -> String {
    complaint(&cograin(&[&"run", &scene, &"-o", &folder, &"--quiet"]).args(further).output().unwrap(), status)
}

/// Runs a scene to its end and on to others, and to the last of them at once; compares all that is left.
fn goes_on_as_one(place: &Place, scene: &Path, ends: &[&str]) {
    let (parts, whole) = (place.at("parts"), place.at("whole"));
    run(scene, &parts, &[], 0);
    for end in ends {
        run(scene, &parts, &["--resume", "--end", end], 0);
    }
    run(scene, &whole, &["--end", ends.last().unwrap()], 0);
    assert_same(&parts, &whole);
    let [parts, whole] = [summary(&parts), summary(&whole)];
    for key in ["time", "steps", "energy", "largest_overlap", "deepest_contact", "ended"] {
        assert_eq!(parts[key], whole[key], "{key}");
    }
}

#[test]
fn a_run_that_goes_on_beyond_its_end_leaves_the_bytes_of_one_run() {
    let place = Place::new("beyond");
    // At 0.01 there is a row and a checkpoint, and the frame of the first end belongs to no longer run.
    let scene = place.scene("end = 0.01\nstep = 1e-5", ALL_OUTPUTS);
    goes_on_as_one(&place, &scene, &["0.018", "0.04"]);
    assert!(results(&place.at("parts")).contains_key("particles_000002.vtu"));
    assert!(!results(&place.at("parts")).contains_key("particles_000003.vtu"));
}

#[test]
fn the_row_of_an_earlier_end_that_no_interval_meets_goes() {
    let place = Place::new("beyond_rows");
    let scene = place.scene("end = 0.01\nstep = 1e-5", "checkpoint_interval = 2e-3\nenergy = true");
    goes_on_as_one(&place, &scene, &["0.02"]);
    assert_eq!(String::from_utf8_lossy(&results(&place.at("whole"))["history.csv"]).lines().count(), 3);
}

#[test]
fn a_scene_without_intervals_goes_on_in_its_own_communication_steps() {
    let place = Place::new("beyond_plain");
    let scene = place.scene("end = 0.01\nstep = 1e-5", "energy = true");
    goes_on_as_one(&place, &scene, &["0.0153"]);
}

#[test]
fn an_end_that_a_longer_run_does_not_come_by_is_refused() {
    let place = Place::new("beyond_between");
    let (scene, out) = (place.scene("end = 0.0051\nstep = 1e-5", "history_interval = 1e-3"), place.at("out"));
    run(&scene, &out, &[], 0);
    let before = results(&out);
    let said = run(&scene, &out, &["--resume", "--end", "0.01"], 2);
    assert!(said.contains("expected a checkpoint where a run of this scene writes, as at t = 0.005 s"), "{said}");
    // A part of a thousandth of the interval is no rounding either.
    let (near, near_out) = (place.at("near.toml"), place.at("near"));
    let text = std::fs::read_to_string(&scene).unwrap().replace("end = 0.0051", "end = 0.0050005");
    std::fs::write(&near, text).unwrap();
    run(&near, &near_out, &[], 0);
    assert!(run(&near, &near_out, &["--resume", "--end", "0.01"], 2).contains("as at t = 0.005 s"));
    assert_eq!(results(&out), before);
}

#[test]
fn an_end_before_the_checkpoint_and_no_end_are_refused() {
    let place = Place::new("beyond_back");
    let (scene, out) = (place.scene("end = 0.01\nstep = 1e-5", ALL_OUTPUTS), place.at("out"));
    run(&scene, &out, &[], 0);
    for end in ["0.008", "0.01"] {
        let said = run(&scene, &out, &["--resume", "--end", end], 2);
        assert!(said.contains("scene.toml, --end: expected a time after t = 0.01 s"), "{said}");
    }
    for end in ["-1", "soon", "inf"] {
        assert!(run(&scene, &out, &["--resume", &format!("--end={end}")], 2).contains("expected a number above 0"));
    }
    // Another end in the text is another text; the message names the way.
    let text = std::fs::read_to_string(&scene).unwrap();
    std::fs::write(&scene, text.replace("end = 0.01", "end = 0.02")).unwrap();
    let said = run(&scene, &out, &["--resume"], 2);
    assert!(said.contains("give the scene as it was, and --end for another end"), "{said}");
    std::fs::write(&scene, text.replace("friction = 0.4", "friction = 0.5")).unwrap();
    let said = run(&scene, &out, &["--resume", "--end", "0.02"], 2);
    assert!(said.contains("differs from this one in its text or settings; --from takes it along"), "{said}");
}

#[test]
fn without_end_and_interval_nothing_says_how_a_run_goes_on() {
    let place = Place::new("beyond_nothing");
    let (scene, out) = (place.scene("step = 1e-5", "energy = true"), place.at("out"));
    run(&scene, &out, &["--end", "0.005"], 0);
    assert!(
        run(&scene, &out, &["--resume", "--end", "0.01"], 2).contains("expected [run] end or an interval in [output]")
    );
}
