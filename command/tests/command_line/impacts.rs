//! Files of impacts: each by itself, and counted by energy.

use crate::broken_off::break_off;
use crate::ground::{Place, assert_same, cograin, column, complaint};
use std::fs;
use std::path::Path;

/// The rows of a file below its names.
fn rows(path: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// The sum of a column.
fn sum(rows: &[Vec<String>], column: usize) -> f64 {
    rows.iter().map(|row| row[column].parse::<f64>().unwrap()).sum()
}

#[test]
fn counts_add_up_to_the_impacts_that_are_told() {
    let place = Place::new("impacts");
    let output = "history_interval = 2e-3\nframe_interval = 2e-2\nboundaries = true\nimpacts = { events = true }";
    let scene = place.scene("end = 0.08\nstep = 1e-5", output);
    let text = fs::read_to_string(&scene).unwrap() + "[boundary.floor.wear.archard]\ncoefficient = 1e-12\n";
    fs::write(&scene, text).unwrap();
    let said = cograin(&[&"check", &scene]).output().unwrap();
    let said = String::from_utf8(said.stdout).unwrap();
    assert!(said.contains("impacts from touch to parting, counted by energy, 5 bins a decade, and each"), "{said}");
    assert!(said.contains("worn by archard"), "{said}");
    let out = place.at("out");
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    let (each, counts) = (rows(&out.join("impacts.csv")), rows(&out.join("impact_histograms.csv")));
    assert!(each.len() > 10, "{} impacts", each.len());
    assert_eq!(sum(&counts, 3), each.len() as f64);
    for (of_each, of_counts) in [(4, 4), (5, 5)] {
        let (one, other) = (sum(&each, of_each), sum(&counts, of_counts));
        assert!((one - other).abs() <= 1e-12 * one.abs(), "{one:e} and {other:e}");
    }
    assert!(
        counts.iter().any(|row| row[0] == "boundary.floor") && counts.iter().any(|row| row[0] == "pair.glass.glass")
    );
    let wear = column(&out, "floor.wear");
    assert!(wear[0] == 0.0 && wear.is_sorted() && wear[wear.len() - 1] > 0.0);
    let frame = fs::read_to_string(out.join("boundaries_000001.vtu")).unwrap();
    for field in ["wear", "wear_depth", "impact_energy_normal", "impact_energy_tangential"] {
        assert!(frame.contains(&format!("Name=\"{field}\"")), "{field}");
    }
}

#[test]
fn a_run_that_was_killed_goes_on_with_the_same_impacts() {
    let place = Place::new("impacts_killed");
    let output = "history_interval = 2e-3\ncheckpoint_interval = 1e-2\nimpacts = { events = true }";
    let scene = place.scene("end = 0.1\nstep = 1e-6", output);
    let (broken, whole) = break_off(&place, &scene, |mut child| {
        child.kill().unwrap();
        child.wait().unwrap();
    });
    complaint(&cograin(&[&"run", &scene, &"-o", &broken, &"--resume"]).output().unwrap(), 0);
    assert_same(&whole, &broken);
    // Results stay unless somebody says that they may go.
    complaint(&cograin(&[&"run", &scene, &"-o", &broken]).output().unwrap(), 2);
    assert!(rows(&whole.join("impacts.csv")).len() > 10);
}
