//! What `settle` leaves, and what begins with it.

use crate::ground::{Place, SCENE, cograin, column, complaint};
use cograin::results::read_checkpoint;
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use std::fs;
use std::sync::Arc;

#[test]
fn settling_ends_at_rest_and_a_run_begins_there_at_time_0() {
    let place = Place::new("settle");
    let scene = place.scene("end = 0.004\nstep = 2e-5", "history_interval = 1e-3");
    let (state, out) = (place.at("settled.cograin"), place.at("out"));
    let output = cograin(&[&"settle", &scene, &"-o", &state]).output().unwrap();
    complaint(&output, 0);
    assert!(String::from_utf8_lossy(&output.stdout).contains("settled after"), "{output:?}");
    complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume", &state]).output().unwrap(), 0);
    let mut history = csv::Reader::from_path(out.join("history.csv")).unwrap();
    let force = history.headers().unwrap().iter().position(|name| name == "floor.force.z").unwrap();
    let rows: Vec<_> = history.records().map(|row| row.unwrap()).collect();
    assert_eq!((&rows[0][0], rows.len()), ("0.0", 5));
    let radii = [5.0_f64, 5.0, 4.0, 5.0, 6.0].map(|radius| 1e-3 * radius);
    let mass: f64 = radii.iter().map(|radius| 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * 2500.0).sum();
    for row in rows {
        let (found, expected) = (row[force].parse::<f64>().unwrap(), -9.81 * mass);
        // The tolerance of settling, 1e-4 of the mean contact force, and friction at the side walls' leaning grains.
        assert!(
            (found / expected - 1.0).abs() < 0.05,
            "the floor feels {found} N at {}, the weight is {expected} N",
            &row[0]
        );
    }
}

#[test]
fn a_unit_that_begins_settled_keeps_the_packing_when_its_boundaries_are_placed() {
    let place = Place::new("settled_unit");
    let path = place.scene("end = 0.004\nstep = 2e-5", "");
    let file = place.at("settled.cograin");
    complaint(&cograin(&[&"settle", &path, &"-o", &file]).output().unwrap(), 0);
    let (scene, _) = Scene::read(&path).unwrap();
    let state = read_checkpoint(&file, &scene).unwrap();
    let mut simulation = Simulation::resume(Arc::new(scene), state.clone()).unwrap();
    simulation.place(Some(&state)).unwrap();
    let particles = &simulation.state().particles;
    for (index, slot) in particles.slot.iter().enumerate() {
        let before = state.particles.slot[index] as usize;
        assert_eq!(particles.position[*slot as usize], state.particles.position[before], "particle {index}");
    }
    assert!(simulation.contact_count() >= 5, "{} contacts are left", simulation.contact_count());
}

#[test]
fn what_never_touches_is_told_when_it_does_not_settle() {
    let place = Place::new("never_touching");
    let scene = place.at("scene.toml");
    let text = SCENE.replace("RUN", "step = 2e-5").replace("OUTPUT", "");
    // Without gravity the spheres stay where they are, and none touches another.
    fs::write(&scene, text.replace("gravity", "# gravity").replace("velocity = [0.0, 0.1, -0.5]", "id = 4")).unwrap();
    let state = place.at("settled.cograin");
    let said = complaint(&cograin(&[&"settle", &scene, &"-o", &state, &"--steps", &"300"]).output().unwrap(), 1);
    assert!(said.contains("not settled after 300 steps") && said.contains("nothing touches"), "{said}");
    assert!(!said.contains("inf") && !state.exists(), "{said}");
}

#[test]
fn a_bonded_beam_that_touches_nothing_settles_under_its_weight() {
    let place = Place::new("settled_beam");
    let (scene, state, out) = (place.at("scene.toml"), place.at("settled.cograin"), place.at("out"));
    let beam = r#"
gravity = [0.0, 0.0, -9.81]
[run]
end = 1e-3
[material.glass]
density = 2500.0
[particles.beam]
material = "glass"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.0], counts = [5, 1, 1], spacing = 2e-3, radius = 1e-3 }
[boundary.clamp]
particles = { set = "beam", box = [[-1e-3, -1e-3, -1e-3], [0.5e-3, 1e-3, 1e-3]] }
[bond.glue]
between = ["beam", "beam"]
create_distance = 2.1e-3
normal_stiffness = 1e12
tangential_stiffness = 4e11
[output]
history_interval = 1e-3
"#;
    fs::write(&scene, beam).unwrap();
    let output = cograin(&[&"settle", &scene, &"-o", &state]).output().unwrap();
    complaint(&output, 0);
    assert!(String::from_utf8_lossy(&output.stdout).contains("of the mean bond force"), "{output:?}");
    complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume", &state]).output().unwrap(), 0);
    // The four spheres that are free hang on the clamp.
    let weight = 4.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9 * 2500.0 * 9.81;
    for force in column(&out, "clamp.force.z") {
        assert!((force / -weight - 1.0).abs() < 1e-3, "the clamp feels {force} N, the weight is {weight} N");
    }
}

#[test]
fn a_packing_that_does_not_settle_in_time_is_a_failure() {
    let place = Place::new("unsettled");
    let scene = place.scene("end = 0.004\nstep = 2e-5", "");
    let state = place.at("settled.cograin");
    let said = complaint(&cograin(&[&"settle", &scene, &"-o", &state, &"--steps", &"5000"]).output().unwrap(), 1);
    assert!(said.contains("not settled after 5000 steps") && said.contains("is asked for"), "{said}");
    assert!(said.contains("it still moves: particle ") && said.contains(", fastest of all, "), "{said}");
    assert!(!state.exists());
    // What was reached is kept, and goes on.
    let reached = place.at("settled.cograin.unsettled");
    assert!(said.contains("settled.cograin.unsettled holds the state so far"), "{said}");
    complaint(&cograin(&[&"settle", &scene, &"-o", &state, &"--from", &reached]).output().unwrap(), 0);
    assert!(state.exists());
    // And neither it nor what the command reads is overwritten unasked.
    let before = fs::read(&state).unwrap();
    let said = complaint(&cograin(&[&"settle", &scene, &"-o", &state]).output().unwrap(), 2);
    assert!(said.contains("found a file; --overwrite replaces it"), "{said}");
    let said = complaint(&cograin(&[&"settle", &scene, &"-o", &scene, &"--overwrite"]).output().unwrap(), 2);
    assert!(said.contains("expected a file that the command does not read itself"), "{said}");
    assert_eq!(fs::read(&state).unwrap(), before);
}

/// Rolling friction of constant size trembles about rest for ever; settling once went on as long, or gave up.
#[test]
fn what_trembles_about_rest_is_at_rest_in_the_mean() {
    let place = Place::new("trembling");
    let scene = place.at("scene.toml");
    let text = "gravity = [0.0, 0.0, -9.81]\n[run]\nthreads = 1\n[material.a]\ndensity = 2500.0\nyoungs_modulus = 1e6\n\
                poissons_ratio = 0.3\n[pair.a.a]\nrestitution = 0.5\nfriction = 0.5\nrolling_friction = 1.0\n\
                [contact.c.normal.hertz]\n[contact.c.tangential.history]\n[contact.c.rolling.cdt]\n\
                [particles.p]\nmaterial = \"a\"\nlist = [\n\
                { position = [0.0, 0.0, 0.01], radius = 0.01 },\n{ position = [0.0105, 0.001, 0.0271], radius = 0.01 },\n\
                { position = [0.021, 0.0, 0.01], radius = 0.01 },\n]\n\
                [boundary.f]\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\nmaterial = \"a\"\n";
    fs::write(&scene, text).unwrap();
    let state = place.at("settled.cograin");
    let output = cograin(&[&"settle", &scene, &"-o", &state]).output().unwrap();
    complaint(&output, 0);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("settled after") && said.contains("in the mean of many steps"), "{said}");
}

/// Damping that leaves gravity out holds a body beside its rest, as dry friction would.
#[test]
fn what_damping_without_gravity_holds_off_its_rest_is_told_with_the_reason() {
    let place = Place::new("gravity_undamped");
    let scene = place.at("scene.toml");
    let text = "gravity = [0.0, 0.0, -9.0]\n[run]\nthreads = 1\n[material.a]\ndensity = 2500.0\nyoungs_modulus = 1e6\n\
                poissons_ratio = 0.3\n[pair.a.a]\nrestitution = 1.0\n[contact.c.normal.hertz]\n[particles.p]\nmaterial = \"a\"\n\
                list = [ { position = [0.0, 0.0, 0.01], radius = 0.01 } ]\n\
                [boundary.f]\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\nmaterial = \"a\"\n\
                [damping.d]\nparticles = { set = \"p\" }\nlinear = 0.1\nangular = 0.1\ngravity_damped = false\n";
    fs::write(&scene, text).unwrap();
    let state = place.at("settled.cograin");
    let said = complaint(&cograin(&[&"settle", &scene, &"-o", &state]).output().unwrap(), 1);
    assert!(said.contains("comes no nearer") && said.contains("gravity_damped"), "{said}");
}

/// A row of bonded spheres that is held at one end, under gravity.
fn bonded(place: &Place) -> std::path::PathBuf {
    let scene = place.at("scene.toml");
    let text = "gravity = [0.0, 0.0, -9.81]\n[run]\nend = 1e-3\nstep = 1e-6\n[material.ice]\ndensity = 900.0\n\
         [particles.beam]\nmaterial = \"ice\"\nlattice = { kind = \"simple_cubic\", radius = 0.01, counts = [8, 1, 1] }\n\
         [bond.neck]\nbetween = [\"beam\", \"beam\"]\ncreate_distance = 0.0201\nnormal_stiffness = 1e10\ntangential_stiffness = 4e9\n\
         [boundary.clamp]\nparticles = { ids = [1] }\n[output]\nhistory_interval = 1e-3\n";
    fs::write(&scene, text).unwrap();
    scene
}

#[test]
fn bonds_are_settled_by_newtons_method_and_stay_at_rest() {
    let place = Place::new("settle_bonds");
    let (scene, state, out) = (bonded(&place), place.at("settled.cograin"), place.at("out"));
    let output = cograin(&[&"settle", &scene, &"-o", &state]).output().unwrap();
    complaint(&output, 0);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains("of Newton's method") && text.contains("kinetic energy 0.000e0 J"), "{text}");
    complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume", &state]).output().unwrap(), 0);
    let mut history = csv::Reader::from_path(out.join("history.csv")).unwrap();
    let force = history.headers().unwrap().iter().position(|name| name == "clamp.force.z").unwrap();
    let weight = 7.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6 * 900.0 * 9.81;
    for row in history.records() {
        let found: f64 = row.unwrap()[force].parse().unwrap();
        // The tolerance of settling, 1e-4 of the mean bond force.
        assert!((found / -weight - 1.0).abs() < 1e-3, "{found} N, the weight is {weight} N");
    }
}

#[test]
fn what_newtons_method_cannot_settle_is_settled_by_time_steps_and_said() {
    let place = Place::new("settle_bonds_by_steps");
    let scene = bonded(&place);
    let text =
        fs::read_to_string(&scene).unwrap().replace("[bond.neck]", "[bond.neck]\nformulation = \"engine_exact\"");
    fs::write(&scene, text).unwrap();
    let output = cograin(&[&"settle", &scene, &"-o", &place.at("settled.cograin")]).output().unwrap();
    complaint(&output, 0);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        text.contains("by time steps, not by Newton's method: [bond.neck] formulation engine_exact is beyond it"),
        "{text}"
    );
}

#[test]
fn temperatures_stay_while_a_scene_settles_and_go_on_in_another_one() {
    let place = Place::new("warm");
    let (scene, settled) = (place.at("scene.toml"), place.at("settled.cograin"));
    let text = |applied: f64| {
        format!(
            r#"
gravity = [0.0, 0.0, -9.81]
[run]
end = 0.1
step = 1.0e-5
[material.g]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
conductivity = 50.0
specific_heat = 80.0
[pair.g.g]
restitution = 0.6
[contact.c.normal.hertz]
[contact.c.heat.constriction]
[particles.a]
material = "g"
temperature = 300.0
list = [{{ position = [0.0, 0.0, 1.0e-3], radius = 1.0e-3 }}]
[boundary.plate]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "g"
temperature = 400.0
heat_capacity = 0.01
applied_heat = {applied:?}
[heat_source.oven]
particles = {{ set = "a" }}
power = 0.1
[probe.grain]
particle = 1
[output]
history_interval = 0.1
"#
        )
    };
    fs::write(&scene, text(1.0)).unwrap();
    complaint(&cograin(&[&"settle", &scene, &"-o", &settled]).output().unwrap(), 0);
    let values = |folder: &str, name: &str| column(&place.at(folder), name);
    let run = |folder: &str, more: &[&str]| {
        let out = place.at(folder);
        complaint(&cograin(&[&"run", &scene, &"-o", &out]).args(more).output().unwrap(), 0);
    };
    run("first", &["--from", settled.to_str().unwrap()]);
    for (name, expected) in [("grain.temperature", 300.0), ("plate.temperature", 400.0)] {
        assert_eq!(values("first", name)[0], expected);
        assert!(values("first", name)[1] > expected, "{:?}", values("first", name));
    }
    fs::write(&scene, text(2.0)).unwrap();
    let checkpoint = place.at("first").join("checkpoint.cograin");
    run("second", &["--from", checkpoint.to_str().unwrap(), "--set", "run.end=0.2"]);
    for name in ["grain.temperature", "plate.temperature"] {
        assert_eq!(values("second", name)[0], values("first", name)[1], "{name}");
    }
}
