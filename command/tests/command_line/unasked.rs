//! What belongs to others: nothing of it is replaced, printed or taken for the program's own.

use crate::ground::{Place, SCENE, cograin, column, complaint, wait_for_rows};
use std::fs;
use std::path::Path;
use std::process::Command;

/// A pipe of this name.
#[cfg(unix)]
fn pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn pipes_and_folders_are_never_replaced_by_files() {
    use std::os::unix::fs::FileTypeExt;
    let place = Place::new("pipes");
    let scene = place.scene("end = 0.004\nstep = 2e-5", "");
    let (there, link) = (place.at("pipe"), place.at("link"));
    pipe(&there);
    std::os::unix::fs::symlink("pipe", &link).unwrap();
    for path in [&there, &link] {
        for command in ["settle", "export"] {
            let done = cograin(&[&command, &scene, &"-o", path, &"--overwrite"]).output().unwrap();
            let said = complaint(&done, 2);
            assert!(said.contains("found a device or a pipe"), "{command}: {said}");
        }
        assert!(fs::metadata(path).unwrap().file_type().is_fifo());
    }
    let said = complaint(&cograin(&[&"settle", &scene, &"-o", &place.at("no/such")]).output().unwrap(), 2);
    assert!(said.contains("expected a folder that is there, found none"), "{said}");
}

#[test]
fn what_stands_where_an_unsettled_state_would_go_stays() {
    let place = Place::new("foreign_unsettled");
    let scene = place.scene("end = 0.004\nstep = 2e-5", "");
    let (state, other) = (place.at("bed"), place.at("bed.unsettled"));
    fs::write(&other, "mine").unwrap();
    for more in [&[][..], &["--overwrite"], &["--resume"]] {
        let done = cograin(&[&"settle", &scene, &"-o", &state, &"--steps", &"10"]).args(more).output().unwrap();
        let said = complaint(&done, 2);
        assert!(said.contains("found another file; move it away"), "{said}");
        assert_eq!(fs::read_to_string(&other).unwrap(), "mine");
    }
    fs::remove_file(&other).unwrap();
    let settle = |more: &[&str]| cograin(&[&"settle", &scene, &"-o", &state, &"--steps", &"10"]).args(more).output();
    complaint(&settle(&[]).unwrap(), 1);
    let said = complaint(&settle(&[]).unwrap(), 2);
    assert!(said.contains("--resume goes on with it, --overwrite replaces it"), "{said}");
    complaint(&settle(&["--overwrite"]).unwrap(), 1);
    complaint(&settle(&["--resume"]).unwrap(), 1);
    // It goes on as the scene of which it is, and no other.
    let said = complaint(&settle(&["--resume", "--set", "pair.glass.glass.friction=0.1"]).unwrap(), 2);
    assert!(said.contains("differs from this one in its text or settings; --from"), "{said}");
}

/// The first line of a file that is no table is nobody's business.
#[test]
fn first_lines_of_other_files_are_not_printed() {
    let place = Place::new("first_lines");
    let scene = place.scene("end = 0.004\nstep = 2e-5", "");
    let text = fs::read_to_string(&scene).unwrap();
    let floor = "normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"";
    let driven =
        |motion: &str| fs::write(&scene, text.replace(floor, &format!("{floor}\nmotion = {{ {motion} }}"))).unwrap();
    for secret in ["root:hunter2:0:0\nx:y\n", "hunter2\n1\n", "time,hunter2:0\n1,2\n"] {
        fs::write(place.at("secret"), secret).unwrap();
        driven("driven = [\"z\"]");
        let done =
            cograin(&[&"run", &scene, &"-o", &place.at("out"), &"--inputs", &place.at("secret")]).output().unwrap();
        let said = complaint(&done, 2);
        assert!(!said.contains("hunter2") && said.contains("secret, line 1: expected a column time"), "{said}");
        driven("prescribed = { z = { table = \"secret\" } }");
        let said = complaint(&cograin(&[&"check", &scene]).output().unwrap(), 2);
        assert!(!said.contains("hunter2") && said.contains("secret, line 1: expected a column"), "{said}");
    }
}

#[test]
fn a_history_that_another_process_cuts_short_fails_the_run() {
    let place = Place::new("cut_history");
    let scene = place.scene("end = 100.0\nstep = 1e-5", "history_interval = 1e-4");
    let out = place.at("out");
    let mut run =
        cograin(&[&"run", &scene, &"-o", &out, &"--quiet"]).stderr(std::process::Stdio::piped()).spawn().unwrap();
    wait_for_rows(&mut run, &out, 20);
    fs::File::options().write(true).open(out.join("history.csv")).unwrap().set_len(100).unwrap();
    let said = complaint(&run.wait_with_output().unwrap(), 1);
    assert!(said.contains("history.csv: expected the ") && said.contains("another process changed it"), "{said}");
}

#[cfg(unix)]
#[test]
fn a_folder_that_takes_the_name_of_the_results_gets_no_summary() {
    let place = Place::new("moved_results");
    let scene = place.scene("end = 100.0\nstep = 1e-5", "history_interval = 1e-4\nframe_interval = 1e-3");
    let out = place.at("out");
    let mut run =
        cograin(&[&"run", &scene, &"-o", &out, &"--quiet"]).stderr(std::process::Stdio::piped()).spawn().unwrap();
    wait_for_rows(&mut run, &out, 20);
    fs::rename(&out, place.at("moved")).unwrap();
    fs::create_dir(&out).unwrap();
    assert!(Command::new("kill").arg(run.id().to_string()).status().unwrap().success());
    let done = run.wait_with_output().unwrap();
    assert_eq!(done.status.code(), Some(1), "{done:?}");
    assert!(!out.join("summary.json").exists());
}

#[test]
fn a_run_goes_on_with_its_own_scene_files_settings_and_inputs_only() {
    let place = Place::new("other_inputs");
    let scene = place.at("scene.toml");
    let floor = "normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"";
    let list = SCENE.split("list = [").nth(1).unwrap().split("\n]").next().unwrap();
    let text = SCENE
        .replace("RUN", "end = 0.02\nstep = 1e-5")
        .replace("OUTPUT", "checkpoint_interval = 5e-3")
        .replace(floor, &format!("{floor}\nmotion = {{ driven = [\"z\"] }}"))
        .replace(&format!("list = [{list}\n]"), "file = \"p.csv\"");
    fs::write(&scene, &text).unwrap();
    fs::write(place.at("p.csv"), "x,y,z,radius\n0,0,0.012,0.005\n0.011,0.001,0.012,0.005\n").unwrap();
    let table = |name: &str, last: &str| {
        fs::write(place.at(name), format!("time,floor.displacement.z\n0,0\n{last}\n")).unwrap();
    };
    table("a.csv", "0.01,1e-3");
    table("b.csv", "0.02,1e-3");
    let out = place.at("out");
    let go = |more: &[&str]| cograin(&[&"run", &scene, &"-o", &out]).args(more).current_dir(&place.0).output().unwrap();
    complaint(&go(&["--inputs", "a.csv"]), 0);
    for (more, part) in [
        (&["--resume", "--inputs", "b.csv"][..], "and this one has the table of inputs"),
        (&["--resume"], "and this one has no table of inputs"),
        (
            &["--resume", "--inputs", "a.csv", "--set", "pair.glass.glass.friction=0.1"],
            "in its text or settings; --from",
        ),
    ] {
        let said = complaint(&go(more), 2);
        assert!(said.contains(part), "{said}");
    }
    fs::write(place.at("p.csv"), "x,y,z,radius\n0,0,0.012,0.004\n").unwrap();
    let said = complaint(&go(&["--resume", "--inputs", "a.csv"]), 2);
    assert!(said.contains("in the file p.csv; --from"), "{said}");
}

#[test]
fn statuses_tell_refusals_from_failures() {
    let place = Place::new("statuses");
    let scene = place.scene("end = 0.004\nstep = 2e-5", "");
    let missing = place.at("missing.so");
    let done = cograin(&[&"export", &scene, &"-o", &place.at("a.fmu"), &"--library", &missing]).output().unwrap();
    complaint(&done, 2);
    #[cfg(unix)]
    {
        let out = place.at("out");
        fs::create_dir(&out).unwrap();
        std::os::unix::fs::symlink("elsewhere", out.join(".cograin-new")).unwrap();
        let said = complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 2);
        assert!(said.contains("found a link or a file"), "{said}");
    }
    fs::write(place.at("file"), "mine").unwrap();
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &place.at("file/out")]).output().unwrap(), 2);
    assert!(said.contains("file: expected a folder, or a name that is not there yet, found a file"), "{said}");
}

#[test]
fn variables_lists_what_a_scene_has_with_unit_and_meaning() {
    let place = Place::new("variables");
    let scene = place.scene("end = 0.004\nstep = 2e-5", "");
    let text = fs::read_to_string(&scene).unwrap();
    let floor = "normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"";
    fs::write(&scene, text.replace(floor, &format!("{floor}\nmotion = {{ driven = [\"z\"] }}"))).unwrap();
    let done = cograin(&[&"variables", &scene]).output().unwrap();
    complaint(&done, 0);
    let told = String::from_utf8(done.stdout).unwrap();
    let line = |name: &str| {
        let found = told.lines().find(|line| line.split_whitespace().nth(1) == Some(name));
        found.unwrap_or_else(|| panic!("no {name}: {told}")).to_owned()
    };
    assert!(
        told.starts_with("inputs: 1\n") && told.contains("\noutputs: ") && told.contains("\nparameters: "),
        "{told}"
    );
    assert!(line("floor.displacement.z").contains("  m  ") && line("floor.force.z").contains("  N  "), "{told}");
    assert!(line("pair.glass.glass.friction").contains("starts with 0.4"), "{told}");
    let done = cograin(&[&"variables", &scene, &"--json"]).output().unwrap();
    let list: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    let input = list.as_array().unwrap().iter().find(|it| it["name"] == "floor.displacement.z").unwrap();
    assert_eq!((input["causality"].as_str(), input["unit"].as_str()), (Some("input"), Some("m")));
    let place_of = |row: &serde_json::Value| row["reference"].as_u64();
    assert!(list.as_array().unwrap().iter().enumerate().all(|(place, row)| place_of(row) == Some(place as u64)));
}

#[test]
fn a_driven_displacement_stands_beside_its_force() {
    let place = Place::new("driven_column");
    let scene = place.scene(
        "end = 0.02\nstep = 1e-5",
        "history_interval = 1e-2\ncolumns = [\"floor.displacement.z\", \"floor.force.z\"]",
    );
    let text = fs::read_to_string(&scene).unwrap();
    let floor = "normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"";
    fs::write(&scene, text.replace(floor, &format!("{floor}\nmotion = {{ driven = [\"z\"] }}"))).unwrap();
    fs::write(place.at("inputs.csv"), "time,floor.displacement.z\n0,0\n0.02,4e-3\n").unwrap();
    let out = place.at("out");
    complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--inputs", &place.at("inputs.csv")]).output().unwrap(), 0);
    assert_eq!(column(&out, "floor.displacement.z"), [0.0, 2e-3, 4e-3]);
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["units"]["floor.displacement.z"], "m");
}

#[test]
fn settling_makes_at_most_the_steps_that_are_asked_for() {
    let place = Place::new("settle_steps");
    let scene = place.scene("end = 0.004", "");
    for steps in ["1", "10", "100"] {
        let state = place.at(&format!("settled_{steps}"));
        let said = complaint(&cograin(&[&"settle", &scene, &"-o", &state, &"--steps", &steps]).output().unwrap(), 1);
        assert!(said.contains(&format!("not settled after {steps} step")), "{said}");
    }
}

#[test]
fn a_lid_with_a_servo_presses_while_a_bed_settles() {
    let place = Place::new("settle_servo");
    let text = SCENE
        .replace("RUN", "end = 1.0\nsettle_tolerance = 1e-3")
        .replace("OUTPUT", "")
        .replace("gravity = [0.3,", "gravity = [0.0,")
        .replace("[boundary.x_low]", "[boundary.lid]\nplane = { point = [0.0, 0.0, 0.05], normal = [0.0, 0.0, -1.0] }\nmaterial = \"glass\"\nmotion = { servo = { z = { target = 0.5, speed = 0.1 } } }\n[boundary.x_low]");
    // One sphere alone, which the lid cannot push aside.
    let list = text.split("list = [").nth(1).unwrap().split("\n]").next().unwrap();
    let text = text.replace(list, "\n    { position = [0.005, 0.0, 0.0049], radius = 0.005 },");
    let (scene, state, out) = (place.at("scene.toml"), place.at("settled"), place.at("out"));
    fs::write(&scene, &text).unwrap();
    complaint(&cograin(&[&"settle", &scene, &"-o", &state]).output().unwrap(), 0);
    let done =
        cograin(&[&"run", &scene, &"-o", &out, &"--resume", &state, &"--set", &"run.end=0.001"]).output().unwrap();
    complaint(&done, 2);
    complaint(
        &cograin(&[&"run", &scene, &"-o", &out, &"--from", &state, &"--set", &"run.end=0.001"]).output().unwrap(),
        0,
    );
    let force = column(&out, "lid.force.z");
    assert!((force[0] - 0.5).abs() < 0.01, "the lid is pressed with {} N, to be 0.5 N", force[0]);
    // What is not there yet is told.
    let far = text.replace("speed = 0.1", "speed = 1e-5");
    fs::write(&scene, far).unwrap();
    let done = cograin(&[&"settle", &scene, &"-o", &state, &"--overwrite", &"--steps", &"20000"]).output().unwrap();
    let said = complaint(&done, 1);
    assert!(said.contains("[boundary.lid] servo: the particles press with "), "{said}");
}

#[cfg(unix)]
#[test]
fn a_unit_that_does_not_fit_on_the_disk_is_told_in_one_line() {
    let place = Place::new("full_unit");
    let scene = place.scene("end = 0.004\nstep = 2e-5", "");
    let program = env!("CARGO_BIN_EXE_cograin");
    let line = format!("ulimit -f 1; exec {program} export {} -o {}", scene.display(), place.at("a.fmu").display());
    let done = Command::new("sh").args(["-c", &line]).output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    if said.contains("library was not found") {
        println!("no library of units stands beside the program");
        return;
    }
    assert!(done.status.code() == Some(1) && said.lines().count() == 1 && !said.contains("ZipWriter"), "{said}");
    assert!(!place.at("a.fmu").exists());
}

#[test]
fn a_single_body_costs_by_the_particle() {
    let place = Place::new("marble");
    let scene = place.at("scene.toml");
    let text = SCENE.replace("RUN", "end = 0.05\nstep = 2e-5").replace("OUTPUT", "");
    let list = text.split("list = [").nth(1).unwrap().split("\n]").next().unwrap();
    fs::write(&scene, text.replace(list, "\n    { position = [0.0, 0.0, 0.016], radius = 0.005 },")).unwrap();
    let done = cograin(&[&"run", &scene, &"-o", &place.at("out")]).output().unwrap();
    complaint(&done, 0);
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    assert!(said.contains("ns per particle and step") && !said.contains("ns per contact"), "{said}");
}
