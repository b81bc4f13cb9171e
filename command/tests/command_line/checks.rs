//! What `check` tells.

use crate::ground::{Place, cograin, column, complaint, results, summary};
use std::fs;
use std::process::Command;

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
        "writes     2859 rows of history.csv",
        "a checkpoint of",
        // 2857 intervals of 35 µs with 4 steps each, and one of 5 µs.
        "steps      11429 up to t = 0.1 s, 11429 of them shortened to meet an output",
        "time       about ",
    ] {
        assert!(said.contains(part), "{part} is missing in:\n{said}");
    }
}

#[test]
fn check_tells_what_a_scene_could_drop() {
    let place = Place::new("unused");
    let scene = place.scene("end = 0.1\nstep = 1e-7", "energy = true");
    let needed = report(&scene);
    assert!(!needed.contains("friction is 0"), "{needed}");
    let text = fs::read_to_string(&scene).unwrap().replace("friction = ", "friction = 0.0 # ");
    fs::write(&scene, text).unwrap();
    let said = report(&scene);
    for part in [
        "unused     [contact.touch.tangential.history]: friction is 0 in all its pairs: without it a step takes ",
        "unused     [output] energy: the book is kept, and no row of history.csv has it, only summary.json: without",
        "unused     [run] step = 1e-7: ",
    ] {
        assert!(said.contains(part), "{part} is missing in:\n{said}");
    }
}

/// The text that `check` prints.
fn report(scene: &std::path::Path) -> String {
    let output = cograin(&[&"check", &scene]).output().unwrap();
    complaint(&output, 0);
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn rows_frames_and_steps_are_foretold_exactly_where_the_step_is_given() {
    let place = Place::new("foretold");
    let scene = place.scene("end = 0.05\nstep = 3e-5", "history_interval = 1e-3\nframe_interval = 7e-3\nenergy = true");
    let said = report(&scene);
    let out = place.at("out");
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    let steps = &summary(&out)["steps"];
    assert!(said.contains(&format!("steps      {steps} up to t = 0.05 s")), "{steps} steps made, foretold:\n{said}");
    let rows = column(&out, "time").len();
    assert!(said.contains(&format!("{rows} rows of history.csv")), "{rows} rows written, foretold:\n{said}");
    let files: Vec<_> = results(&out).into_iter().filter(|(name, _)| name.ends_with(".vtu")).collect();
    assert!(said.contains(&format!("{} frames of about", files.len())), "{} frames, foretold:\n{said}", files.len());
}

#[test]
fn steps_are_foretold_as_a_range_where_the_step_is_automatic() {
    let place = Place::new("foretold_range");
    let scene = place.scene("end = 0.2", "history_interval = 1e-3");
    let said = report(&scene);
    let out = place.at("out");
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    let steps = summary(&out)["steps"].as_u64().unwrap();
    let line = said.lines().find(|line| line.starts_with("steps ")).unwrap();
    let numbers: Vec<u64> =
        line.split_whitespace().filter_map(|word| word.trim_end_matches(',').parse().ok()).collect();
    let [expected, least, most] = numbers[..3] else { panic!("{line}") };
    assert!(least <= steps && steps <= most, "{steps} steps made; {line}");
    assert!(steps <= 2 * expected && expected <= 2 * steps, "{steps} steps made; {line}");
}

#[test]
fn a_step_that_outputs_shorten_is_tried_as_it_will_be_run() {
    let place = Place::new("long_step_short_intervals");
    // The step is far above the stable one, but no interval is that long.
    let said = report(&place.scene("end = 1e-3\nstep = 1e-5", "history_interval = 1e-6"));
    assert!(!said.contains("it stops"), "{said}");
}

#[test]
fn lists_that_need_more_memory_than_there_is_are_refused_before_they_are_made() {
    let place = Place::new("memory");
    let scene = place.scene("end = 0.1\nstep = 1e-5\nskin = 1e3", "");
    let many = "[particles.many]\nmaterial = \"glass\"\nlattice = { kind = \"simple_cubic\", origin = [1.0, 1.0, 1.0], \
                counts = [50, 50, 40], radius = 5e-3 }\n";
    let text = fs::read_to_string(&scene).unwrap();
    fs::write(
        &scene,
        format!(
            "{}{many}",
            text.replace("[boundary.x_high]", "[boundary.elsewhere]").replace("0.03, 0.0, 0.0]", "9.0, 0.0, 0.0]")
        ),
    )
    .unwrap();
    for command in ["check", "run"] {
        let mut call = cograin(&[&command, &scene]);
        if command == "run" {
            call.arg("-o").arg(place.at("out"));
        }
        let said = complaint(&call.output().unwrap(), 2);
        assert!(said.contains("near pairs with a [run] skin of 1e3 m need about"), "{said}");
        assert!(said.contains("are free") && said.lines().count() == 1, "{said}");
    }
    assert!(!place.at("out").exists());
}

/// What `check` says of a scene, refused, where the process may have so much memory \[kB\].
fn refused_within(kilobytes: u32, scene: &std::path::Path) -> String {
    let call = format!("ulimit -v {kilobytes}; exec \"$0\" check \"$1\"");
    let output = Command::new("sh").args(["-c", &call, env!("CARGO_BIN_EXE_cograin")]).arg(scene).output().unwrap();
    let said = complaint(&output, 2);
    assert_eq!(said.lines().count(), 1, "{said}");
    said
}

/// A scene with one material, and the rest of it.
fn with_files(place: &Place, name: &str, skin: &str, rest: &str) -> std::path::PathBuf {
    let scene = place.at(name);
    let text = format!(
        "[run]\nend = 1.0\nstep = 1e-6\n{skin}\n[material.a]\ndensity = 1.0\nyoungs_modulus = 1e6\npoissons_ratio = 0.2\n\
         [pair.a.a]\nrestitution = 0.9\n[contact.c.normal.hertz]\n{rest}"
    );
    fs::write(&scene, text).unwrap();
    scene
}

/// A flat mesh of two triangles for each of `count` × `count` squares, as a binary STL file.
fn write_mesh(path: &std::path::Path, count: u16) {
    let mut bytes = vec![0; 80];
    bytes.extend((2 * u32::from(count) * u32::from(count)).to_le_bytes());
    for square in 0..u32::from(count) * u32::from(count) {
        let [x, y] = [square % u32::from(count), square / u32::from(count)].map(|place| place as f32);
        for corners in [[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0]]] {
            bytes.extend([0_u8; 12]);
            corners
                .iter()
                .for_each(|[dx, dy]| [x + dx, y + dy, 0.0].iter().for_each(|part| bytes.extend(part.to_le_bytes())));
            bytes.extend([0_u8; 2]);
        }
    }
    fs::write(path, bytes).unwrap();
}

#[test]
fn files_that_need_more_memory_than_there_is_are_refused_before_it_is_asked_for() {
    let place = Place::new("large_files");
    let rows: String = (0..400_000).map(|k| format!("{k},0,2,0.4\n")).collect();
    fs::write(place.at("many.csv"), format!("x,y,z,radius\n{rows}")).unwrap();
    // One block of 300 MB that half a megabyte of text can well hold.
    let packed = format!(
        "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\">\
         <UnstructuredGrid><Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"><PointData>\
         <DataArray type=\"Float64\" Name=\"radius\" format=\"binary\">{}{}</DataArray></PointData></Piece></UnstructuredGrid></VTKFile>",
        "AQAAAACj4REAo+ERFAAAAA==",
        " ".repeat(700_000)
    );
    fs::write(place.at("packed.vtu"), packed).unwrap();
    write_mesh(&place.at("large.stl"), 300);
    let particles = "[particles.p]\nmaterial = \"a\"\n";
    let mesh = format!(
        "{particles}list = [{{ position = [1, 1, 2], radius = 0.5 }}]\n[boundary.m]\nmesh = {{ file = \"large.stl\" }}\nmaterial = \"a\"\n"
    );
    for (name, rest, expected) in [
        (
            "csv",
            format!("{particles}file = \"many.csv\"\n"),
            ", found 400000 particles, which need about 0.24 GB of memory",
        ),
        (
            "vtu",
            format!("{particles}file = \"packed.vtu\"\n"),
            "an array radius that needs about 2.70 GB of memory instead of what fits into",
        ),
        ("stl", mesh, ", found triangles that need about 0.12 GB of memory"),
    ] {
        let said = refused_within(
            if name == "stl" { 120_000 } else { 200_000 },
            &with_files(&place, &format!("{name}.toml"), "", &rest),
        );
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn lists_at_meshes_that_need_more_memory_than_there_is_are_refused_before_they_are_made() {
    let place = Place::new("mesh_lists");
    write_mesh(&place.at("mesh.stl"), 220);
    let rest = "[particles.p]\nmaterial = \"a\"\nlattice = { kind = \"simple_cubic\", origin = [1.0, 1.0, 2.0], counts = [10, 10, 3], \
                radius = 0.4 }\n[boundary.m]\nmesh = { file = \"mesh.stl\" }\nmaterial = \"a\"\n";
    let said = refused_within(300_000, &with_files(&place, "scene.toml", "skin = 1e4", rest));
    // 300 particles, 2 · 220² triangles, 12 bytes each.
    assert!(
        said.contains("2.90e7 parts of [boundary.m] near particles with a [run] skin of 1e4 m need about 0.3 GB"),
        "{said}"
    );
}

/// A floor that no law holds: the sphere fell through it, and only `check` and the summary said so.
#[test]
fn a_run_tells_its_remarks() {
    let place = Place::new("remarks");
    let scene = place.scene("end = 1e-4\nstep = 1e-5", "");
    let text = fs::read_to_string(&scene).unwrap();
    fs::write(&scene, text.replace("[contact.touch", "#[contact.touch")).unwrap();
    let output = cograin(&[&"run", &scene, &"-o", &place.at("out")]).output().unwrap();
    complaint(&output, 0);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("\nremark: [boundary.floor]: particles of "), "{said}");
}

#[test]
fn what_clumps_that_come_are_going_to_take_is_foretold() {
    let place = Place::new("coming");
    let scene = place.scene("end = 0.05", "frame_interval = 1e-2");
    let more = "[clump.pair]\nspheres = [{ position = [0.0, 0.0, 0.0], radius = 1e-3 }, { position = [1e-3, 0.0, 0.0], radius = 1e-3 }]\n\
                [region.mouth]\nbox = [[-0.01, -0.01, 0.1], [0.02, 0.02, 0.2]]\n\
                [insertion.feed]\nregion = \"mouth\"\nmaterial = \"glass\"\nsizes = { clump = \"pair\" }\ncount_rate = 40000.0\n";
    fs::write(&scene, fs::read_to_string(&scene).unwrap() + more).unwrap();
    let said = report(&scene);
    assert!(said.contains("insertion feed: ") && said.contains("clumps"), "{said}");
}
