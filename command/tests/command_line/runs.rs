//! What a run leaves and says.

use crate::ground::{ALL_OUTPUTS, Place, assert_same, cograin, complaint, results, summary};
use std::fs;

#[test]
fn a_run_leaves_its_files_and_says_what_it_cost() {
    let place = Place::new("run");
    let scene = place.scene("end = 0.1\nstep = 2e-5", ALL_OUTPUTS);
    let out = place.at("out");
    let output = cograin(&[&"run", &scene, &"-o", &out]).output().unwrap();
    let said = complaint(&output, 0);
    assert!(said.is_empty(), "progress where there is no terminal: {said}");
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(told.contains("5000 steps") && told.contains(" ns per particle and step, "), "{output:?}");
    let numbers = summary(&out);
    let [cost, contacts, time] = ["/ns_per_contact_and_step", "/counts/mean_contacts", "/stepping_time"]
        .map(|name| numbers.pointer(name).and_then(serde_json::Value::as_f64).unwrap());
    assert!((cost * 1e-9 * contacts * 5000.0 / time - 1.0).abs() < 1e-9, "{numbers:#}");
    let history = fs::read_to_string(out.join("history.csv")).unwrap();
    assert_eq!(history.lines().count(), 52);
    assert!(history.starts_with("time,floor.force.x,"), "{history}");
    assert!(history.lines().last().unwrap().starts_with("0.1,"));
    let names: Vec<_> = results(&out).into_keys().collect();
    let frames = |kind: &str| (0..6).map(|k| format!("{kind}_{k:06}.vtu")).collect::<Vec<_>>();
    let mut expected = [frames("particles"), frames("contacts")].concat();
    expected.extend(["history.csv", "checkpoint.cograin", "particles.pvd", "contacts.pvd"].map(String::from));
    expected.sort();
    assert_eq!(names, expected);
}

#[test]
fn the_summary_closes_its_books() {
    let place = Place::new("books");
    let scene = place.scene("end = 0.1\nstep = 2e-5", ALL_OUTPUTS);
    let out = place.at("out");
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    let summary = summary(&out);
    assert_eq!(summary["ended"], "completed");
    assert_eq!(summary["steps"], 5000);
    // Rounding of 5,000 steps, each of a relative 1e-16, adds up to far less than this.
    for residual in [&summary["energy"]["relative_residual"], &summary["momentum"]["relative_residual"]] {
        assert!(residual.as_f64().unwrap().abs() < 1e-12, "{summary:#}");
    }
    assert!(summary["momentum"]["gravity"][2].as_f64().unwrap() < 0.0, "{summary:#}");
}

#[test]
fn the_balance_of_momentum_has_the_impulse_of_a_fluid() {
    let place = Place::new("momentum_of_a_fluid");
    let (scene, out) = (place.at("scene.toml"), place.at("out"));
    fs::write(&scene, SINKING).unwrap();
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    let momentum = &summary(&out)["momentum"];
    assert!(momentum["relative_residual"].as_f64().unwrap() < 1e-12, "{momentum:#}");
    // The wind takes everything along x; buoyancy and drag bear a part of the weight.
    let along = |term: &str, axis: usize| momentum[term][axis].as_f64().unwrap();
    assert!(along("fluid", 0) > 0.0 && (along("fluid", 0) / along("change", 0) - 1.0).abs() < 1e-12, "{momentum:#}");
    assert!(along("fluid", 2) > 0.0 && along("fluid", 2) < -along("gravity", 2), "{momentum:#}");
}

/// A sphere and a clump that sink in a wind.
const SINKING: &str = r#"
gravity = [0.0, 0.0, -9.81]
[run]
end = 0.01
step = 1e-5
[material.glass]
density = 2500.0
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 5e-4 }, { position = [5e-4, 0.0, 0.0], radius = 5e-4 }]
[particles.ball]
material = "glass"
list = [{ position = [0.0, 0.0, 0.0], radius = 1e-3 }]
[particles.pairs]
material = "glass"
clump = "pair"
list = [{ position = [0.01, 0.0, 0.0], angular_velocity = [30.0, 20.0, 10.0] }]
[fluid.water]
density = 1000.0
viscosity = 1e-3
velocity = [0.1, 0.0, 0.0]
torque = true
[fluid.water.drag.schiller_naumann]
"#;

#[test]
fn any_number_of_threads_and_lanes_leaves_the_same_bytes() {
    let place = Place::new("threads");
    let scene = place.scene("end = 4e-3\nstep = 2e-5", ALL_OUTPUTS);
    // A few spheres are not worth a second thread.
    let many = "[particles.many]\nmaterial = \"glass\"\nvelocity = [0.0, 0.0, -2.0]\nlattice = { kind = \"simple_cubic\", \
                origin = [-0.01, 0.02, 0.006], counts = [4, 20, 28], spacing = 9.9e-3, radius = 5e-3 }\n";
    fs::write(&scene, format!("{}{many}", fs::read_to_string(&scene).unwrap())).unwrap();
    let folders = [1, 2, 3, 4].map(|threads| {
        let (out, count) = (place.at(&threads.to_string()), threads.to_string());
        complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--threads", &count]).output().unwrap(), 0);
        assert_eq!(summary(&out)["threads"], threads, "enough spheres for them");
        assert!(summary(&out)["counts"]["mean_contacts"].as_f64().unwrap() > 1000.0);
        out
    });
    folders[1..].iter().for_each(|folder| assert_same(&folders[0], folder));
    let narrow = place.at("narrow");
    complaint(&cograin(&[&"run", &scene, &"-o", &narrow, &"--lanes", &"2"]).output().unwrap(), 0);
    assert_same(&folders[0], &narrow);
}

#[test]
fn a_run_that_cannot_go_on_stops_with_particle_time_and_cause() {
    let place = Place::new("stopped");
    let scene = place.scene("end = 0.1\nstep = 2e-5", "history_interval = 1e-3");
    let text = fs::read_to_string(&scene).unwrap() + "\n[domain]\nbox = [[-1.0, -1.0, -1.0], [1.0, 1.0, 0.037]]\n";
    fs::write(&scene, text.replace("[0.0, 0.1, -0.5]", "[0.0, 0.1, 2.0]")).unwrap();
    let out = place.at("out");
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 1);
    assert!(said.contains("particle ") && said.contains("t = ") && said.contains("likely"), "{said}");
    assert_eq!(summary(&out)["ended"], "failed");
    assert!(said.contains(summary(&out)["reason"].as_str().unwrap()), "{said}");
    let history = fs::read_to_string(out.join("history.csv")).unwrap();
    assert!(history.ends_with('\n') && history.lines().count() > 2, "{history}");
}

#[test]
fn results_that_cannot_be_written_stop_the_run() {
    let place = Place::new("unwritable");
    let scene = place.scene("end = 0.1\nstep = 2e-5", ALL_OUTPUTS);
    let out = place.at("out");
    fs::create_dir_all(out.join("particles_000002.vtu.part")).unwrap();
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 1);
    assert!(said.contains("particles_000002.vtu") && said.contains("cannot be written"), "{said}");
}
