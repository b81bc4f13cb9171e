//! What `chart` leaves.

use crate::ground::{Place, cograin, complaint};
use std::fs;

#[test]
fn chart_holds_the_outputs_of_a_scene_against_those_of_a_fine_step() {
    let place = Place::new("chart");
    let scene = place.scene("end = 0.01\nstep = 2e-5", "history_interval = 1e-3");
    let folder = scene.with_file_name("charts");
    let output = cograin(&[&"chart", &scene, &"-o", &folder]).output().unwrap();
    complaint(&output, 0);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("recommended for an error of 0.01 at any moment: given step times"), "{said}");
    assert!(said.contains("communication steps 1/4 as long change"), "{said}");
    let name = scene.file_stem().unwrap().to_string_lossy().into_owned();
    let table = fs::read_to_string(folder.join(format!("{name}.csv"))).unwrap();
    let parts: Vec<&str> = table.lines().skip(1).filter_map(|line| line.split(',').nth(1)).collect();
    for part in ["4", "2", "1", "0.5", "0.25"].map(|part| format!("given step times {part}")) {
        assert!(parts.contains(&part.as_str()), "no row for {part} in:\n{table}");
    }
    assert!(fs::read_to_string(folder.join(format!("{name}.svg"))).unwrap().starts_with("<svg"));
    let output = cograin(&[&"chart", &"impact"]).output().unwrap();
    assert!(complaint(&output, 2).contains("impact"), "a name that is no scene is refused");
}
