//! Tables of inputs.

use crate::ground::{Place, cograin, column, complaint};
use std::fs;
use std::path::PathBuf;

/// The scene with a floor that is driven, and a table of inputs.
fn driven(place: &Place, table: &str) -> (PathBuf, PathBuf) {
    let scene = place.scene("end = 0.02\nstep = 1e-5", "history_interval = 1e-3\nenergy = true");
    let text = fs::read_to_string(&scene).unwrap();
    let floor = "normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"";
    fs::write(&scene, text.replace(floor, &format!("{floor}\nmotion = {{ driven = [\"z\"] }}"))).unwrap();
    fs::write(place.at("inputs.csv"), table).unwrap();
    (scene, place.at("inputs.csv"))
}

#[test]
fn a_table_of_inputs_moves_driven_boundaries_and_ends_the_run() {
    let place = Place::new("inputs");
    let (scene, inputs) =
        driven(&place, "floor.force.z, time, floor.displacement.z\n-, 0, 0\n-, 4e-3, 8e-3\n-, 1e-2, 5e-3\n");
    let (output, folder) = (place.at("out"), "-o");
    let done = cograin(&[&"run", &scene, &"--inputs", &inputs, &folder, &output]).output().unwrap();
    complaint(&done, 0);
    let (time, work) = (column(&output, "time"), column(&output, "floor.work"));
    assert_eq!(time.len(), 11, "the table ends before the scene");
    let mean_force = column(&output, "floor.mean_force.z");
    let course = |time: f64| if time < 4e-3 { 2.0 * time } else { 8e-3 - 0.5 * (time - 4e-3) };
    for row in 1..time.len() {
        let moved = course(time[row]) - course(time[row - 1]);
        let (found, expected) = (work[row] - work[row - 1], -mean_force[row] * moved);
        assert!((found - expected).abs() < 1e-14, "at {} s: {found} J, {expected} J by the table", time[row]);
    }
    assert!(work[4].abs() > 1e-6, "the floor met nobody: {} J", work[4]);
}

#[test]
fn a_table_of_inputs_that_does_not_fit_is_refused_with_its_line() {
    let place = Place::new("bad_inputs");
    let cases = [
        ("floor.displacement.z\n1e-3\n", "line 1: expected a column time, found floor.displacement.z"),
        ("time,floor.force.z\n1e-3,0\n", "line 1: expected a column floor.displacement.z, found time, floor.force.z"),
        ("0.0,0.0\n1e-3,0\n", "line 1: expected a column time, found a first line without names of columns"),
        (
            "time,floor.displacment.z\n1e-3,0\n",
            "line 1: expected time and variables of the unit, found a column \"floor.displacment.z\"; the nearest is floor.displacement.z",
        ),
        (
            "time,floor.displacement.z,floor.displacement.z\n1e-3,0,0\n",
            "line 1: expected one column floor.displacement.z, found two",
        ),
        (
            "time,floor.displacement.z\n1e-3,nan\n",
            "line 2, floor.displacement.z: expected a finite number, found \"nan\"",
        ),
        ("time,floor.displacement.z\n0,1e-3\n", "line 2: expected displacement 0 at time 0, found 0.001"),
        (
            "time,floor.displacement.z\n2e-3,0\n1e-3,0\n",
            "line 3: expected a time after that of the line before, or 0 in the first, found 0.001",
        ),
    ];
    for (table, expected) in cases {
        let (scene, inputs) = driven(&place, table);
        let output = place.at("out");
        let done = cograin(&[&"run", &scene, &"--inputs", &inputs, &"-o", &output]).output().unwrap();
        let said = complaint(&done, 2);
        assert!(said.trim_end().ends_with(expected), "{said}");
        assert!(!output.exists());
    }
}

/// The cell once ran to the first row's strain within the first row of the history, however long that was.
#[test]
fn a_strain_begins_at_zero() {
    let place = Place::new("strain_inputs");
    let scene = place.at("cell.toml");
    let text = "[run]\nend = 1e-3\nstep = 1e-5\n[material.glass]\ndensity = 2500.0\n[particles.one]\nmaterial = \"glass\"\n\
                list = [{ position = [0.5, 0.5, 0.5], radius = 0.1 }]\n\
                [cell]\nedges = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\nmotion = { driven = [\"zz\"] }\n";
    fs::write(&scene, text).unwrap();
    let inputs = place.at("strain.csv");
    fs::write(&inputs, "time,cell.strain.zz\n0,-0.01\n1e-3,-0.01\n").unwrap();
    let run = || cograin(&[&"run", &scene, &"--inputs", &inputs, &"-o", &place.at("out")]).output().unwrap();
    let said = complaint(&run(), 2);
    assert!(said.trim_end().ends_with("line 2: expected strain 0 at time 0, found -0.01"), "{said}");
    fs::write(&inputs, "time,cell.strain.zz\n0,0\n1e-3,-0.01\n").unwrap();
    complaint(&run(), 0);
}
