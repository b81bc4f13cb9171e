//! Outputs that a scene chooses: columns, probes, sums.

use crate::ground::{Place, SCENE, cograin, column, complaint};
use std::fs;
use std::path::PathBuf;

/// A scene with these tables behind the others, and these lines in `[output]`.
fn scene(place: &Place, output: &str, more: &str) -> PathBuf {
    let path = place.scene("end = 0.1\nstep = 2e-5", &format!("history_interval = 1e-2\n{output}"));
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, format!("{text}\n{more}")).unwrap();
    path
}

/// The columns of the history.
fn names(folder: &std::path::Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("history.csv")).unwrap();
    text.lines().next().unwrap().split(',').map(str::to_owned).collect()
}

#[test]
fn the_history_has_the_columns_that_are_named_in_their_order() {
    let place = Place::new("columns");
    let out = place.at("out");
    let path = scene(&place, r#"columns = ["contacts.count", "*.force.z", "floor.f*.x"]"#, "");
    complaint(&cograin(&[&"run", &path, &"-o", &out]).output().unwrap(), 0);
    let expected = ["time", "contacts.count", "floor.force.z", "x_low.force.z", "x_high.force.z", "floor.force.x"];
    assert_eq!(names(&out), expected);
}

#[test]
fn a_name_that_is_no_output_is_refused_with_the_nearest() {
    let place = Place::new("unknown_columns");
    for (output, more, expected) in [
        (
            r#"columns = ["flor.force.z"]"#,
            "",
            "[output] columns: expected an output of this scene, found \"flor.force.z\"; the nearest is floor.force.z",
        ),
        (
            "",
            "[derived.all]\nsum = [\"floor.force.q\"]",
            "[derived.all] sum: expected an output of this scene, found \"floor.force.q\"; the nearest is floor.force.",
        ),
        (
            "",
            "[derived.all]\nsum = [\"floor.force.z\", \"floor.moment.z\"]",
            "[derived.all] sum: expected outputs of one unit, found floor.force.z [N] and floor.moment.z [N.m]",
        ),
        (
            "",
            "[derived.time]\nsum = [\"floor.force.z\"]",
            "[derived.time]: expected a name of its own, found that of the first column",
        ),
        (
            "",
            "[derived.floor]\nsum = [\"floor.force.z\"]",
            "[derived.floor]: expected a name of its own, found that of [boundary.floor]",
        ),
        ("", "[derived.all]\nsum = []", "[derived.all] sum: expected names of outputs, found none"),
        (
            "",
            "[probe.one]\nparticle = 9",
            "[probe.one] particle: expected the number of a particle of this scene, from 1 to 5, found 9",
        ),
        ("", "[probe.one]\ncontact = [2, 2]", "[probe.one] contact: expected two particles, found 2 twice"),
        (
            "",
            "[probe.one]\nset = \"fwe\"",
            "[probe.one] set: expected a particle set of this scene, found \"fwe\"; the nearest is few",
        ),
        (
            "",
            "[probe.one]\nset = \"few\"\nparticle = 1",
            "[probe.one]: expected one of particle, set and contact, found several",
        ),
        ("", "[probe.one]", "[probe.one]: missing; one of particle = id, set = \"..\" and contact = [id, id]"),
    ] {
        let path = scene(&place, output, more);
        let out = place.at("out");
        for command in [cograin(&[&"check", &path]).output(), cograin(&[&"run", &path, &"-o", &out]).output()] {
            let said = complaint(&command.unwrap(), 2);
            assert!(said.contains(expected), "{said}\n{expected}");
        }
        assert!(!out.exists());
    }
}

/// Five spheres that fall: their mass centre goes by gravity alone until the first touches, and what a probe of the floor's contact
/// and the sum of all walls tell goes with what walls tell one by one.
#[test]
fn probes_and_sums_tell_what_they_stand_for() {
    let place = Place::new("probes");
    let out = place.at("out");
    let more = r#"
[probe.low]
particle = 1
[probe.all]
set = "few"
[probe.pair]
contact = [1, 2]
[derived.support]
sum = ["*.force.z"]
[derived.sides]
sum = ["x_low.force.x", "x_high.force.x"]
"#;
    let more = more.replace("[\"*.force.z\"]", "[\"floor.force.z\", \"x_*.force.z\"]");
    let path = scene(&place, "", &more);
    complaint(&cograin(&[&"run", &path, &"-o", &out]).output().unwrap(), 0);
    let get = |name: &str| column(&out, name);
    let (time, radii) = (get("time"), [5e-3_f64, 5e-3, 4e-3, 5e-3, 6e-3]);
    let masses = radii.map(|radius| 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * 2500.0);
    let mass: f64 = masses.iter().sum();
    // At time 0: as the scene has them; gravity alone acts.
    let heights = [0.012, 0.012, 0.013, 0.024, 0.036];
    let centre = masses.iter().zip(heights).map(|(mass, height)| mass * height).sum::<f64>() / mass;
    assert!((get("all.position.z")[0] - centre).abs() < 1e-15);
    assert!((get("all.velocity.z")[0] + 0.5 * masses[3] / mass).abs() < 1e-15);
    assert!((get("all.force.z")[0] + 9.81 * mass).abs() < 1e-15);
    assert!((get("low.force.x")[0] - 0.3 * masses[0]).abs() < 1e-17);
    assert_eq!((get("low.position.z")[0], get("low.velocity.z")[0], get("low.torque.y")[0]), (0.012, 0.0, 0.0));
    let apart = (0.011_f64.powi(2) + 0.001_f64.powi(2)).sqrt();
    assert!((get("pair.overlap")[0] - (0.01 - apart)).abs() < 1e-17);
    assert_eq!((get("pair.normal_force")[0], get("pair.force.x")[0]), (0.0, 0.0));
    // Newton: the momentum of all changes by the mean of gravity and what the walls do.
    for row in 0..time.len() {
        let forces = ["floor", "x_low", "x_high"].map(|wall| get(&format!("{wall}.force.z"))[row]);
        assert!((get("support")[row] - forces.iter().sum::<f64>()).abs() < 1e-12);
        assert_eq!(get("sides")[row], get("x_low.force.x")[row] + get("x_high.force.x")[row]);
        let all = -9.81 * mass - get("support")[row];
        assert!(
            (get("all.force.z")[row] - all).abs() < 1e-9,
            "{} N, walls and weight give {all} N",
            get("all.force.z")[row]
        );
    }
}

#[test]
fn two_particles_that_press_on_each_other_tell_their_force() {
    let place = Place::new("pressed");
    let out = place.at("out");
    let text = SCENE.replace("RUN", "end = 0.3\nstep = 2e-5").replace("OUTPUT", "history_interval = 0.05");
    let begin = text.find("list = [").unwrap();
    let end = begin + text[begin..].find("\n]").unwrap() + 2;
    // One sphere on another, upright: the lower one carries the upper one.
    let list = "list = [\n{ position = [0.0, 0.0, 0.005], radius = 0.005 },\n{ position = [0.0, 0.0, 0.015], radius = 0.005 }]";
    let text = text.replace(&text[begin..end], list).replace("[0.3, 0.0, -9.81]", "[0.0, 0.0, -9.81]");
    let path = place.at("scene.toml");
    fs::write(&path, format!("{text}\n[probe.up]\ncontact = [2, 1]\n[probe.down]\ncontact = [1, 2]\n")).unwrap();
    complaint(&cograin(&[&"run", &path, &"-o", &out]).output().unwrap(), 0);
    let last = |name: &str| *column(&out, name).last().unwrap();
    let weight = 9.81 * 4.0 / 3.0 * std::f64::consts::PI * 0.005_f64.powi(3) * 2500.0;
    // Restitution 0.6 leaves nothing of the swing after 0.3 s.
    assert!((last("up.force.z") / weight - 1.0).abs() < 1e-3, "{} N, the weight is {weight} N", last("up.force.z"));
    assert_eq!((last("down.force.z"), last("down.normal_force")), (-last("up.force.z"), last("up.normal_force")));
    assert!((last("up.normal_force") / weight - 1.0).abs() < 1e-3 && last("up.overlap") > 0.0);
}

/// Two thousand groups gave 52,072 columns.
#[test]
fn of_very_many_groups_there_are_columns_if_they_are_asked_for() {
    let place = Place::new("many_groups");
    let (path, out) = (place.at("scene.toml"), place.at("out"));
    let mut text = String::from(
        "[run]\nend = 1e-4\nstep = 1e-4\n[material.g]\ndensity = 2500.0\n[particles.p]\nmaterial = \"g\"\n\
         lattice = { kind = \"simple_cubic\", radius = 1e-3, counts = [100, 1, 1] }\n[output]\nCOLUMNS\n",
    );
    for group in 0..100 {
        let x = 2e-3 * f64::from(group);
        text += &format!(
            "[boundary.g{group}]\nparticles = {{ set = \"p\", box = [[{}, -1.0, -1.0], [{}, 1.0, 1.0]] }}\n",
            x - 1e-4,
            x + 1e-4
        );
    }
    fs::write(&path, text.replace("COLUMNS", "")).unwrap();
    let checked = cograin(&[&"check", &path]).output().unwrap();
    complaint(&checked, 0);
    let told = String::from_utf8_lossy(&checked.stdout).into_owned();
    assert!(told.contains("remark     [output] columns: history.csv has "), "{told}");
    complaint(&cograin(&[&"run", &path, &"-o", &out]).output().unwrap(), 0);
    assert!(names(&out).len() < 30, "{:?}", names(&out));
    fs::write(&path, text.replace("COLUMNS", "columns = [\"*\"]")).unwrap();
    complaint(&cograin(&[&"run", &path, &"-o", &out, &"--overwrite"]).output().unwrap(), 0);
    assert!(names(&out).len() > 1000);
}
