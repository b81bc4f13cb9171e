//! The commands: what they leave, what they say, and with which status they end.

use cograin::output::read_checkpoint;
use cograin::scene::Scene;
use cograin::step::Simulation;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::Arc;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A few spheres that fall into a box without a lid. `RUN` and `OUTPUT` stand for the rest of those tables.
const SCENE: &str = r#"
gravity = [0.3, 0.0, -9.81]

[run]
RUN

[material.glass]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25

[pair.glass.glass]
restitution = 0.6
friction = 0.4

[contact.touch.normal.hertz]
[contact.touch.tangential.history]

[particles.few]
material = "glass"
list = [
    { position = [0.000, 0.000, 0.012], radius = 0.005 },
    { position = [0.011, 0.001, 0.012], radius = 0.005, angular_velocity = [0.0, 50.0, 0.0] },
    { position = [0.004, 0.009, 0.013], radius = 0.004 },
    { position = [0.005, 0.003, 0.024], radius = 0.005, velocity = [0.0, 0.1, -0.5] },
    { position = [0.002, 0.004, 0.036], radius = 0.006 },
]

[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "glass"

[boundary.x_low]
plane = { point = [-0.02, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "glass"

[boundary.x_high]
plane = { point = [0.03, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }
material = "glass"

[output]
OUTPUT
"#;

/// Outputs of every kind.
const ALL_OUTPUTS: &str =
    "history_interval = 2e-3\nframe_interval = 2e-2\ncontacts = true\nenergy = true\ncheckpoint_interval = 1e-2";

/// A folder of one test, empty at its start.
struct Place(PathBuf);

impl Place {
    /// The folder of the test with this name.
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("command_line_{name}"));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// A scene with these lines in `[run]` and `[output]`.
    fn scene(&self, run: &str, output: &str) -> PathBuf {
        let path = self.0.join("scene.toml");
        fs::write(&path, SCENE.replace("RUN", run).replace("OUTPUT", output)).unwrap();
        path
    }

    /// A path in it.
    fn at(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

/// The command, with arguments.
fn cograin(arguments: &[&dyn AsRef<std::ffi::OsStr>]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cograin"));
    command.args(arguments.iter().copied().map(AsRef::as_ref)).stdin(Stdio::null());
    command
}

/// What it says on the standard error, having ended with this status.
fn complaint(output: &Output, status: i32) -> String {
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(status), "{said}{}", String::from_utf8_lossy(&output.stdout));
    said
}

/// Every file of a folder but the summary, which tells of one session.
fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let named = entries.map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()));
    named.filter(|(name, _)| name != "summary.json").collect()
}

/// Says which files differ.
fn assert_same(one: &Path, other: &Path) {
    let (one, other) = (results(one), results(other));
    assert_eq!(one.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>());
    let differing: Vec<_> = one.iter().filter(|(name, bytes)| other[*name] != **bytes).map(|(name, _)| name).collect();
    assert!(differing.is_empty(), "these files differ: {differing:?}");
}

/// Waits until the history has some rows, while the run goes on.
fn wait_for_rows(child: &mut Child, folder: &Path, rows: usize) {
    let begun = Instant::now();
    loop {
        let text = fs::read_to_string(folder.join("history.csv")).unwrap_or_default();
        if text.lines().count() > rows {
            break;
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "the run does not come forward");
        assert!(child.try_wait().unwrap().is_none(), "the run ended before it could be stopped");
        sleep(Duration::from_millis(2));
    }
    assert!(child.try_wait().unwrap().is_none(), "the run ended before it could be stopped");
}

/// A value in `summary.json`.
fn summary(folder: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap()
}

#[test]
fn a_mistake_in_the_scene_is_told_with_its_line_and_nothing_is_written() {
    let place = Place::new("mistake");
    let scene = place.scene("end = 0.1\nstepp = 1e-5", "");
    for command in ["check", "run"] {
        let output = match command {
            "check" => cograin(&[&"check", &scene]).output().unwrap(),
            _ => cograin(&[&"run", &scene, &"-o", &place.at("out")]).output().unwrap(),
        };
        let said = complaint(&output, 2);
        assert!(said.contains("scene.toml, line 6, [run]") && said.contains("step"), "{said}");
    }
    assert!(!place.at("out").exists());
}

#[test]
fn a_scene_that_is_not_there_is_refused() {
    let place = Place::new("absent");
    let said = complaint(&cograin(&[&"run", &place.at("scene.toml"), &"-o", &place.at("out")]).output().unwrap(), 2);
    assert!(said.contains("there is no such file"), "{said}");
    assert!(!place.at("out").exists());
}

#[test]
fn a_wrong_command_line_is_refused() {
    for arguments in [vec!["dance"], vec!["run"], vec!["settle", "scene.toml"], vec!["run", "x", "--threads", "0"]] {
        let arguments: Vec<&dyn AsRef<std::ffi::OsStr>> = arguments.iter().map(|a| a as _).collect();
        complaint(&cograin(&arguments).output().unwrap(), 2);
    }
}

#[test]
fn a_run_without_an_end_is_refused_and_nothing_is_written() {
    let place = Place::new("endless");
    let scene = place.scene("step = 1e-5", "");
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &place.at("out")]).output().unwrap(), 2);
    assert!(said.contains("[run] end: not given"), "{said}");
    assert!(!place.at("out").exists());
}

#[test]
fn a_time_step_above_the_bound_is_refused_and_nothing_is_written() {
    let place = Place::new("long_step");
    let scene = place.scene("end = 1.0\nstep = 1e-2", "");
    let text = fs::read_to_string(&scene).unwrap().replace("[0.011, 0.001, 0.012]", "[0.00998, 0.0, 0.012]");
    fs::write(&scene, text).unwrap();
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &place.at("out")]).output().unwrap(), 2);
    assert!(said.contains("scene.toml: the time step") && said.contains("above the stable one"), "{said}");
    assert!(!place.at("out").exists());
}

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
    ] {
        assert!(said.contains(part), "{part} is missing in:\n{said}");
    }
}

#[test]
fn a_run_leaves_its_files_and_says_what_it_cost() {
    let place = Place::new("run");
    let scene = place.scene("end = 0.1\nstep = 2e-5", ALL_OUTPUTS);
    let out = place.at("out");
    let output = cograin(&[&"run", &scene, &"-o", &out]).output().unwrap();
    let said = complaint(&output, 0);
    assert!(said.is_empty(), "progress where there is no terminal: {said}");
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(told.contains("5000 steps") && told.contains(" ns per contact and step, "), "{output:?}");
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
fn any_number_of_threads_leaves_the_same_bytes() {
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
}

/// Starts a run of many steps, stops it as told, and returns the folder; also the folder of a run that was left alone.
fn broken_and_whole(place: &Place, stop: impl FnOnce(Child)) -> (PathBuf, PathBuf, PathBuf) {
    let scene = place.scene("end = 0.4\nstep = 1e-6", ALL_OUTPUTS);
    let (broken, whole) = break_off(place, &scene, stop);
    (scene, broken, whole)
}

/// The same for a scene of its own, which writes more than seventeen rows.
fn break_off(place: &Place, scene: &Path, stop: impl FnOnce(Child)) -> (PathBuf, PathBuf) {
    let (broken, whole) = (place.at("broken"), place.at("whole"));
    let mut child =
        cograin(&[&"run", &scene, &"-o", &broken]).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    wait_for_rows(&mut child, &broken, 17);
    stop(child);
    complaint(&cograin(&[&"run", &scene, &"-o", &whole]).output().unwrap(), 0);
    (broken, whole)
}

#[test]
fn a_run_that_was_killed_goes_on_and_ends_with_the_same_bytes() {
    let place = Place::new("killed");
    let (scene, broken, whole) = broken_and_whole(&place, |mut child| {
        child.kill().unwrap();
        child.wait().unwrap();
    });
    assert!(results(&broken)["history.csv"].len() < results(&whole)["history.csv"].len());
    complaint(&cograin(&[&"run", &scene, &"-o", &broken, &"--resume"]).output().unwrap(), 0);
    assert_same(&broken, &whole);
}

/// A bonded beam, held at one end and thrown sideways: it breaks.
const BEAM: &str = r#"
[run]
end = 4e-3
step = 2e-8

[material.glass]
density = 2500.0

[particles.beam]
material = "glass"
velocity = [0.0, 0.0, -2.0]
lattice = { kind = "simple_cubic", radius = 1e-3, counts = [8, 2, 2] }

[bond.glue]
between = ["beam", "beam"]
create_distance = 2.1e-3
normal_stiffness = 1e12
tangential_stiffness = 4e11
breakage = { max_normal_stress = 3e6, max_shear_stress = 3e6 }

[boundary.clamp]
particles = { set = "beam", box = [[-1.0, -1.0, -1.0], [1.5e-3, 1.0, 1.0]] }
motion = "fixed"

[output]
history_interval = 4e-5
frame_interval = 1e-3
checkpoint_interval = 1e-4
energy = true
"#;

#[test]
fn bonds_that_broke_before_a_kill_are_told_once() {
    let place = Place::new("bonds");
    let scene = place.at("scene.toml");
    fs::write(&scene, BEAM).unwrap();
    let (broken, whole) = break_off(&place, &scene, |mut child| {
        child.kill().unwrap();
        child.wait().unwrap();
    });
    complaint(&cograin(&[&"run", &scene, &"-o", &broken, &"--resume"]).output().unwrap(), 0);
    assert_same(&broken, &whole);
    let breakage = fs::read_to_string(whole.join("breakage.csv")).unwrap();
    assert!(breakage.starts_with("time,id1,id2,cause,energy\n"), "{breakage}");
    let broken = breakage.lines().count() - 1;
    assert!(broken > 0, "nothing broke");
    let summary = summary(&whole);
    assert_eq!(summary["counts"]["bonds_broken"], broken);
    // 8 × 2 × 2 spheres: 7 × 4 bonds along the beam, 8 × 4 across it.
    assert_eq!(summary["counts"]["bonds_intact"], 7 * 4 + 8 * 4 - broken);
    for residual in [&summary["energy"]["relative_residual"], &summary["momentum"]["relative_residual"]] {
        assert!(residual.as_f64().unwrap().abs() < 1e-12, "{summary:#}");
    }
    assert!(whole.join("bonds_000004.vtu").exists() && whole.join("bonds.pvd").exists());
}

#[test]
fn an_interruption_leaves_whole_files_to_go_on_from() {
    let place = Place::new("interrupted");
    let (scene, broken, whole) = broken_and_whole(&place, |child| {
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
        let said = complaint(&child.wait_with_output().unwrap(), 1);
        assert!(said.contains("interrupted at t = ") && said.contains("--resume"), "{said}");
    });
    assert_eq!(summary(&broken)["ended"], "interrupted");
    let history = fs::read_to_string(broken.join("history.csv")).unwrap();
    assert!(history.ends_with('\n') && fs::read_to_string(whole.join("history.csv")).unwrap().starts_with(&history));
    complaint(&cograin(&[&"run", &scene, &"-o", &broken, &"--resume"]).output().unwrap(), 0);
    assert_same(&broken, &whole);
}

#[test]
fn a_checkpoint_of_another_scene_is_refused() {
    let place = Place::new("other_scene");
    let out = place.at("out");
    let scene = place.scene("end = 0.002\nstep = 2e-5", "");
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    let before = results(&out);
    let scene = place.scene("end = 0.004\nstep = 2e-5", "");
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume"]).output().unwrap(), 2);
    assert!(said.contains("state of another scene"), "{said}");
    assert!(results(&out) == before, "the refused command changed files");
}

#[test]
fn resuming_without_a_checkpoint_is_refused() {
    let place = Place::new("no_checkpoint");
    let scene = place.scene("end = 0.002\nstep = 2e-5", "");
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &place.at("out"), &"--resume"]).output().unwrap(), 2);
    assert!(said.contains("holds no checkpoint.cograin"), "{said}");
    assert!(!place.at("out").exists());
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
    let state = read_checkpoint(&file, scene.fingerprint).unwrap();
    let mut simulation = Simulation::resume(Arc::new(scene), state.clone());
    simulation.place(&[]).unwrap();
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
    assert!(!state.exists());
}

/// The scene with a floor that is driven, and a table of inputs.
fn driven(place: &Place, table: &str) -> (PathBuf, PathBuf) {
    let scene = place.scene("end = 0.02\nstep = 1e-5", "history_interval = 1e-3\nenergy = true");
    let text = fs::read_to_string(&scene).unwrap();
    let floor = "normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"";
    fs::write(&scene, text.replace(floor, &format!("{floor}\nmotion = {{ driven = [\"z\"] }}"))).unwrap();
    fs::write(place.at("inputs.csv"), table).unwrap();
    (scene, place.at("inputs.csv"))
}

/// A column of `history.csv`.
fn column(folder: &Path, name: &str) -> Vec<f64> {
    let text = fs::read_to_string(folder.join("history.csv")).unwrap();
    let mut lines = text.lines();
    let place = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(place).unwrap().parse().unwrap()).collect()
}

#[test]
fn a_table_of_inputs_moves_driven_boundaries_and_ends_the_run() {
    let place = Place::new("inputs");
    let (scene, inputs) = driven(&place, "other, time, floor.displacement.z\n-, 0, 0\n-, 4e-3, 8e-3\n-, 1e-2, 5e-3\n");
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
        ("floor.displacement.z\n1e-3\n", "has no column time"),
        ("time,floor.displacement.x\n1e-3,0\n", "has no column floor.displacement.z"),
        (
            "time,floor.displacement.z\n1e-3,nan\n",
            "line 2, floor.displacement.z: \"nan\" found; a finite number is right",
        ),
        ("time,floor.displacement.z\n0,1e-3\n", "line 2: time 0.0 found; displacement 0 at time 0 is right"),
        (
            "time,floor.displacement.z\n2e-3,0\n1e-3,0\n",
            "line 3: time 0.001 found; a time after that of the line before, or 0 in the first is right",
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

#[test]
fn folders_without_cases_are_refused() {
    let place = Place::new("no_cases");
    let said = complaint(&cograin(&[&"verify", &place.0]).output().unwrap(), 2);
    assert!(said.contains("no case.json here"), "{said}");
}
