//! What `check` tells.

use crate::ground::{Place, cograin, column, complaint, results, summary};
use std::fs;

#[test]
fn check_tells_what_a_scene_uses_and_costs() {
    let place = Place::new("check");
    let scene = place.scene("end = 0.1\nstep = 1e-5", "history_interval = 3.5e-5");
    let output = cograin(&[&"check", &scene]).output().unwrap();
    complaint(&output, 0);
    let said = String::from_utf8(output.stdout).unwrap();
    for part in [
        "5 particles",
        "contact touch: normal hertz, tangential history",
        "boundary floor: plane, fixed",
        "time step",
        "memory",
        "for each step",
        "remark     [output] history_interval",
        "writes     2859 rows of history.csv",
        "a checkpoint of",
        // 2857 intervals of 35 µs with 4 steps each, and one of 5 µs.
        "steps      11429 up to t = 0.1 s, 11429 of them shortened to meet an output",
        "time       about ",
    ] {
        assert!(said.contains(part), "{part} is missing in:\n{said}");
    }
}

/// The text that `check` prints.
fn report(scene: &std::path::Path) -> String {
    let output = cograin(&[&"check", &scene]).output().unwrap();
    complaint(&output, 0);
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn rows_frames_and_steps_are_foretold_exactly_where_the_step_is_given() {
    let place = Place::new("foretold");
    let scene = place.scene("end = 0.05\nstep = 3e-5", "history_interval = 1e-3\nframe_interval = 7e-3\nenergy = true");
    let said = report(&scene);
    let out = place.at("out");
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    let steps = &summary(&out)["steps"];
    assert!(said.contains(&format!("steps      {steps} up to t = 0.05 s")), "{steps} steps made, foretold:\n{said}");
    let rows = column(&out, "time").len();
    assert!(said.contains(&format!("{rows} rows of history.csv")), "{rows} rows written, foretold:\n{said}");
    let files: Vec<_> = results(&out).into_iter().filter(|(name, _)| name.ends_with(".vtu")).collect();
    assert!(said.contains(&format!("{} frames of about", files.len())), "{} frames, foretold:\n{said}", files.len());
}

#[test]
fn steps_are_foretold_as_a_range_where_the_step_is_automatic() {
    let place = Place::new("foretold_range");
    let scene = place.scene("end = 0.2", "history_interval = 1e-3");
    let said = report(&scene);
    let out = place.at("out");
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    let steps = summary(&out)["steps"].as_u64().unwrap();
    let line = said.lines().find(|line| line.starts_with("steps ")).unwrap();
    let numbers: Vec<u64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert!(numbers[0] <= steps && steps <= numbers[1], "{steps} steps made; {line}");
}

#[test]
fn a_step_that_outputs_shorten_is_tried_as_it_will_be_run() {
    let place = Place::new("long_step_short_intervals");
    // The step is far above the stable one, but no interval is that long.
    let said = report(&place.scene("end = 1e-3\nstep = 1e-5", "history_interval = 1e-6"));
    assert!(!said.contains("it stops"), "{said}");
}

#[test]
fn lists_that_need_more_memory_than_there_is_are_refused_before_they_are_made() {
    let place = Place::new("memory");
    let scene = place.scene("end = 0.1\nstep = 1e-5\nskin = 1e3", "");
    let many = "[particles.many]\nmaterial = \"glass\"\nlattice = { kind = \"simple_cubic\", origin = [1.0, 1.0, 1.0], \
                counts = [50, 50, 40], radius = 5e-3 }\n";
    let text = fs::read_to_string(&scene).unwrap();
    fs::write(
        &scene,
        format!(
            "{}{many}",
            text.replace("[boundary.x_high]", "[boundary.elsewhere]").replace("0.03, 0.0, 0.0]", "9.0, 0.0, 0.0]")
        ),
    )
    .unwrap();
    for command in ["check", "run"] {
        let mut call = cograin(&[&command, &scene]);
        if command == "run" {
            call.arg("-o").arg(place.at("out"));
        }
        let said = complaint(&call.output().unwrap(), 2);
        assert!(said.contains("near pairs with a [run] skin of 1e3 m need about"), "{said}");
        assert!(said.contains("are free") && said.lines().count() == 1, "{said}");
    }
    assert!(!place.at("out").exists());
}
