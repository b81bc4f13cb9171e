//! `cograin new`: every scene to start from is read, runs, and is left alone once it is there.

use crate::ground::{Place, cograin, complaint};
use std::fs;

/// Ends that the recipes are run to here \[s\]: some time steps of each.
const ENDS: [(&str, &str); 19] = [
    ("drop", "1e-3"),
    ("oedometer", "2e-4"),
    ("triaxial", "4e-5"),
    ("element_test", "1e-4"),
    ("silo", "4e-4"),
    ("drum", "4e-4"),
    ("beam", "1e-4"),
    ("rock_core", "2e-6"),
    ("plate", "5e-4"),
    ("loaded_beam", "4e-4"),
    ("fluid", "4e-4"),
    ("fluidised_column", "4e-4"),
    ("heat", "1e-3"),
    ("clumps", "4e-4"),
    ("tablets", "4e-4"),
    ("mill", "4e-4"),
    ("screw", "4e-4"),
    ("shear_cell", "4e-5"),
    ("calibration", "4e-4"),
];

/// Names of the recipes, as the program lists them.
fn names() -> Vec<String> {
    let listed = cograin(&[&"new", &"--list"]).output().unwrap();
    let text = String::from_utf8(listed.stdout).unwrap();
    text.lines().map(|line| line.split_whitespace().next().unwrap().to_owned()).collect()
}

#[test]
fn every_recipe_is_a_scene_that_runs() {
    let place = Place::new("recipes");
    assert_eq!(names(), ENDS.map(|(name, _)| name));
    for (name, end) in ENDS {
        let folder = place.at(name);
        let made = cograin(&[&"new", &name, &"-o", &folder]).output().unwrap();
        assert!(made.status.success(), "{name}: {made:?}");
        let said = String::from_utf8(made.stdout).unwrap();
        let told = said.lines().find_map(|line| line.trim().strip_prefix("cograin ")).unwrap();
        let mut call = cograin(&[]);
        call.args(told.split_whitespace()).args(["--set", &format!("run.end={end}")]);
        let ran = call.output().unwrap();
        let script =
            said.lines().find_map(|line| line.trim().strip_prefix(&format!("cd {} && python ", folder.display())));
        let scripts = fs::read_dir(&folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
        let scripts: Vec<_> = scripts.filter(|file| file.ends_with(".py")).collect();
        assert_eq!(script.into_iter().collect::<Vec<_>>(), scripts, "{name}: {said}");
        assert!(ran.status.success(), "{name}: {}", String::from_utf8_lossy(&ran.stderr));
    }
}

#[test]
fn files_that_are_there_stay_as_they_are() {
    let place = Place::new("recipes_twice");
    let folder = place.at("drop");
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("couple.py"), "mine").unwrap();
    let said = complaint(&cograin(&[&"new", &"drop", &"-o", &folder]).output().unwrap(), 2);
    assert!(said.contains("couple.py: expected no such file, found one"), "{said}");
    assert_eq!(fs::read_to_string(folder.join("couple.py")).unwrap(), "mine");
    assert!(!folder.join("scene.toml").exists(), "nothing is half written");
    let said = complaint(&cograin(&[&"new", &"drop", &"-o", &folder.join("couple.py")]).output().unwrap(), 2);
    assert!(said.contains("couple.py: expected a folder, or a name that is not there yet"), "{said}");
}

#[test]
fn an_unknown_recipe_is_refused_with_what_there_is() {
    let said = complaint(&cograin(&[&"new", &"oedometr"]).output().unwrap(), 2);
    assert!(said.contains("oedometer"), "{said}");
}
