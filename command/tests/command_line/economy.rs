//! What `check` tells of what makes a run long.

use crate::ground::{Place, cograin, column, complaint};
use std::fs;

/// What `check` tells of a scene, as JSON.
fn report(scene: &std::path::Path) -> serde_json::Value {
    let done = cograin(&[&"check", &scene, &"--json"]).output().unwrap();
    complaint(&done, 0);
    serde_json::from_slice(&done.stdout).unwrap()
}

/// The line of the report that contains a word, of this part of it.
fn line(report: &serde_json::Value, part: &str, word: &str) -> String {
    let lines = report[part].as_array().unwrap();
    let found = lines.iter().filter_map(|line| line.as_str()).find(|line| line.contains(word));
    found.unwrap_or_else(|| panic!("no line with {word}: {report:#}")).to_owned()
}

/// The number before a word of a line.
fn number_before(line: &str, word: &str) -> f64 {
    let before = line.split(word).next().unwrap().trim_end();
    before.rsplit(' ').next().unwrap().parse().unwrap_or_else(|_| panic!("{line}"))
}

#[test]
fn check_tells_how_much_longer_the_step_is_without_one_small_grain() {
    let place = Place::new("small_grain");
    let scene = place.scene("end = 0.2", "");
    let text = fs::read_to_string(&scene).unwrap();
    let with = report(&scene);
    assert!(with["economy"].as_array().unwrap().iter().all(|line| !line.as_str().unwrap().contains("without it")));
    let dust = "[particles.dust]\nmaterial = \"glass\"\nlist = [{ position = [0.02, 0.01, 0.03], radius = 2.5e-4, velocity = [0.0, 0.0, -0.5] }]\n";
    fs::write(&scene, format!("{text}\n{dust}")).unwrap();
    let dusty = report(&scene);
    let told = number_before(&line(&dusty, "economy", "1 grain of radius 2.50e-4 m at most"), " times fewer steps");
    let stable = |report: &serde_json::Value| report["figures"]["stable_step"].as_f64().unwrap();
    let right = stable(&with) / stable(&dusty);
    assert!(right > 5.0 && (told / right - 1.0).abs() < 0.1, "{told} times told, {right} times without the grain");
}

#[test]
fn check_tells_what_stiffness_accuracy_and_books_cost() {
    let place = Place::new("economy");
    let scene = place.scene("end = 0.2\naccuracy = \"high\"", "losses = true");
    let text = fs::read_to_string(&scene).unwrap();
    fs::write(&scene, text.replace("1.0e7", "7.0e10")).unwrap();
    let stiff = report(&scene);
    let times = number_before(&line(&stiff, "economy", "accuracy = \"high\""), " times the steps of the default");
    assert!(times > 1.5, "{stiff:#}");
    line(&stiff, "savings", "[output] losses: the book is kept");
    fs::write(&scene, text.replace("accuracy = \"high\"", "safety = 0.8")).unwrap();
    line(&report(&scene), "economy", "safety = 0.8: an impact of two bodies alone with e = ");
    fs::write(&scene, text.replace("1.0e7", "7.0e10")).unwrap();
    let told = line(&stiff, "economy", "[material.glass] youngs_modulus could be ");
    let modulus: f64 = told.split("could be ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let factor = number_before(&told, " times fewer steps");
    assert!((factor / (7.0e10 / modulus).powf(0.4) - 1.0).abs() < 0.1, "{told}");
    // At that modulus the run does keep its overlaps, and nothing softer is told.
    let soft = format!("material.glass.youngs_modulus={modulus:e}");
    let out = place.at("out");
    complaint(&cograin(&[&"run", &scene, &"--set", &soft, &"-o", &out]).output().unwrap(), 0);
    let largest = *column(&out, "overlap.max").last().unwrap();
    assert!(largest < 0.01, "{largest}");
    let done = cograin(&[&"check", &scene, &"--set", &soft]).output().unwrap();
    assert!(!String::from_utf8_lossy(&done.stdout).contains("could be"), "{done:?}");
}

#[test]
fn check_tells_what_bonds_cost_that_need_not_be() {
    let place = Place::new("bonded_economy");
    let scene = place.at("scene.toml");
    let text = r#"
[run]
end = 1e-3
[material.glass]
density = 2500.0
[particles.block]
material = "glass"
lattice = { kind = "simple_cubic", radius = 1e-3, counts = [10, 10, 10] }
[bond.glue]
between = ["block", "block"]
create_distance = 2.1e-3
normal_stiffness = 1e12
tangential_stiffness = 4e11
"#;
    fs::write(&scene, text).unwrap();
    let told = line(&report(&scene), "economy", "[bond.glue] never breaks");
    assert!(told.contains("as a rigid group") && told.contains("has no bound"), "{told}");
    fs::write(&scene, format!("{text}breakage = {{ max_normal_stress = 3e6, max_shear_stress = 3e6 }}\n")).unwrap();
    let told = report(&scene);
    assert!(told["economy"].as_array().unwrap().is_empty(), "{told:#}");
}

#[test]
fn no_softer_material_is_told_beside_a_stress_that_the_report_does_not_weigh() {
    let place = Place::new("strained_cell");
    let scene = place.at("scene.toml");
    let still = "[material.glass]\ndensity = 2500.0\nyoungs_modulus = 5.0e7\npoissons_ratio = 0.25\n\
                 [pair.glass.glass]\nrestitution = 0.7\n[contact.touch.normal.hertz]\n\
                 [particles.bed]\nmaterial = \"glass\"\n\
                 lattice = { kind = \"simple_cubic\", radius = 1.0e-3, spacing = 1.9999e-3, counts = [3, 3, 3] }\n\
                 [cell]\nedges = [[5.9997e-3, 0, 0], [0, 5.9997e-3, 0], [0, 0, 5.9997e-3]]\n";
    let strained = format!("{still}motion = {{ servo = {{ zz = {{ stress = -1.0e4, max_rate = 1.0 }} }} }}\n");
    let tells = |text: &str| {
        fs::write(&scene, text).unwrap();
        let found = report(&scene);
        found["economy"]
            .as_array()
            .unwrap()
            .iter()
            .any(|line| line.as_str().unwrap().contains("youngs_modulus could be"))
    };
    assert_eq!([still, strained.as_str()].map(tells), [true, false]);
}
