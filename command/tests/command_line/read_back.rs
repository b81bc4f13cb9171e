//! Files that the program or others wrote, read as particles: what they say comes along, or is refused or told by name.

use crate::ground::{Place, cograin, complaint};
use cograin::scene::Scene;
use std::fs;
use std::path::PathBuf;

/// Three spheres: one with a density of its own, one of another material.
const SPHERES: &str = "[particles.p]\nmaterial = \"g\"\nlist = [\
    { position = [0.01, 0.01, 0.01], radius = 0.005, density = 7900.0 },\
    { position = [0.03, 0.01, 0.03], radius = 0.004 },\
    { position = [0.05, 0.01, 0.03], radius = 0.004, material = \"h\" }]\n";

/// Two clumps of two spheres.
const CLUMPS: &str = "[clump.c]\nspheres = [\
    { position = [0, 0, 0], radius = 0.005 }, { position = [0.01, 0, 0], radius = 0.004 }]\n\
    [particles.p]\nmaterial = \"g\"\nclump = \"c\"\nlist = [\
    { position = [0, 0, 0], scale = 0.5, density = 5000.0, velocity = [1.0, 2.0, 3.0] },\
    { position = [0.05, 0, 0], orientation = [0.5, 0.5, 0.5, 0.5], angular_velocity = [1.0, 0.0, 0.0] }]\n";

/// The clump of these, without a set.
fn clump() -> &'static str {
    CLUMPS.split("[particles").next().unwrap()
}

/// A scene of two materials with these keys in `[run]` and these tables.
fn text(run: &str, tables: &str) -> String {
    format!(
        "[run]\nend = 1e-4\nstep = 1e-5\n{run}\n[material.g]\ndensity = 2500.0\n[material.h]\ndensity = 8000.0\n\
         {tables}\n[output]\nframe_interval = 1e-4\n"
    )
}

/// The results of a scene.
fn first(place: &Place, run: &str, tables: &str) -> Scene {
    let (scene, out) = (place.at("first.toml"), place.at("first"));
    fs::write(&scene, text(run, tables)).unwrap();
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    Scene::read(&scene).unwrap().0
}

/// The scene that has these tables, or what is wrong with it.
fn second(place: &Place, run: &str, tables: &str) -> Result<Scene, String> {
    let scene = place.at("second.toml");
    fs::write(&scene, text(run, tables)).unwrap();
    Scene::read(&scene).map(|(scene, _)| scene).map_err(|error| error.to_string())
}

/// What is wrong with the scene that has these tables.
fn refusal(place: &Place, run: &str, tables: &str) -> String {
    second(place, run, tables).err().unwrap_or_else(|| panic!("nothing is wrong with\n{tables}"))
}

/// Refuses numbers that differ by more than rounding.
fn assert_near(found: &[f64], expected: &[f64]) {
    let near = |(found, expected): (&f64, &f64)| (found - expected).abs() <= 1e-14 * expected.abs().max(1.0);
    assert!(found.len() == expected.len() && found.iter().zip(expected).all(near), "{found:?} is not {expected:?}");
}

/// A set that reads a file.
fn again(file: &str) -> String {
    format!("[particles.p]\nfile = \"{file}\"\nmaterials = {{ 0 = \"g\", 1 = \"h\" }}\n")
}

#[test]
fn spheres_of_a_frame_keep_their_densities() {
    let place = Place::new("frame_densities");
    let before = first(&place, "", SPHERES);
    let after = second(&place, "", &again("first/particles_000001.vtu")).unwrap();
    let masses = |scene: &Scene| scene.particles.iter().map(|particle| 1e3 * particle.mass()).collect::<Vec<_>>();
    assert_near(&masses(&after), &masses(&before));
    assert!(after.unread.is_empty(), "{:?}", after.unread);
}

#[test]
fn a_frame_of_a_cell_brings_its_edges_along_or_is_refused() {
    let place = Place::new("frame_cell");
    let edges = "edges = [[0.06, 0, 0], [0.01, 0.06, 0], [0, 0, 0.06]]\nperiodic = [\"x\", \"y\"]\n";
    first(&place, "", &format!("[cell]\norigin = [0.0, 0.0, -0.01]\n{edges}{SPHERES}"));
    let frame = again("first/particles_000001.vtu");
    let after = second(&place, "", &format!("[cell]\nperiodic = [\"x\", \"y\"]\n{frame}")).unwrap();
    let lattice = after.cell.as_ref().unwrap().lattice;
    assert_eq!(lattice.edges, [[0.06, 0.0, 0.0], [0.01, 0.06, 0.0], [0.0, 0.0, 0.06]]);
    assert_eq!(lattice.origin, [0.0, 0.0, -0.01]);
    assert_near(&after.particles[2].position, &[0.05, 0.01, 0.03]);
    let other = edges.replace("[[0.06", "[[0.05");
    let told = refusal(&place, "", &format!("[cell]\n{other}{frame}"));
    assert!(told.contains("first/particles_000001.vtu") && told.contains("the edges of [cell]"), "{told}");
    let told = refusal(&place, "", &frame);
    assert!(told.contains("expected a [cell] in the scene") && told.contains("found a box that repeats"), "{told}");
}

#[test]
fn clumps_of_a_frame_come_back_as_clumps_and_never_as_single_spheres() {
    let place = Place::new("frame_clumps");
    let before = first(&place, "", CLUMPS);
    let told = refusal(&place, "", &again("first/particles_000000.vtu"));
    assert!(told.contains("clump: expected single spheres") && told.contains("which would come apart"), "{told}");
    let set = again("first/clumps_000000.vtu").replace(", 1 = \"h\"", "") + "clump = \"c\"\n";
    let after = second(&place, "", &format!("{}{set}", clump())).unwrap();
    assert!(after.unread.is_empty(), "{:?}", after.unread);
    for (before, after) in before.clumps.iter().zip(&after.clumps) {
        for [before, after] in [
            [before.position, after.position],
            [before.velocity, after.velocity],
            [before.angular_velocity, after.angular_velocity],
            [[before.mass, before.scale, 0.0], [after.mass, after.scale, 0.0]],
        ] {
            assert_near(&after, &before);
        }
        assert_near(&after.orientation, &before.orientation);
    }
    assert_eq!(after.clumps.len(), 2);
    let weighed = clump().replace("[clump.c]", "[clump.c]\nmass = 1.0");
    let told = refusal(&place, "", &format!("{weighed}{set}"));
    assert!(told.contains("mass: expected 0.125 kg, which [clump] says of this size"), "{told}");
}

#[test]
fn discs_of_a_frame_are_discs_or_refused() {
    let place = Place::new("frame_discs");
    let discs = "plane = \"xz\"\nplane_particles = \"discs\"";
    let before = first(&place, discs, SPHERES);
    let frame = again("first/particles_000001.vtu");
    let told = refusal(&place, "", &frame);
    assert!(told.contains("of density and ") && told.contains("of mass of spheres"), "{told}");
    let after = second(&place, discs, &frame).unwrap();
    let masses = |scene: &Scene| scene.particles.iter().map(|particle| particle.mass()).collect::<Vec<_>>();
    assert_near(&masses(&after), &masses(&before));
    fs::remove_dir_all(place.at("first")).unwrap();
    first(&place, "", SPHERES);
    assert!(second(&place, discs, &frame).is_ok_and(|scene| scene.particles[1].density < 100.0));
}

/// Columns that a file has and nothing reads: what they say is lost, and that is said.
#[test]
fn columns_that_change_the_meaning_are_taken_or_named() {
    let place = Place::new("left_out");
    let file = |name: &str, text: &str| fs::write(place.at(name), text).unwrap();
    file("a.csv", "x,y,z,radius,mass,inertia,molecule,group,fx\n0,0,0,0.01,0.02,1e-3,7,-1,5\n");
    let after = second(&place, "", "[particles.p]\nmaterial = \"g\"\nfile = \"a.csv\"\n").unwrap();
    assert_near(&[after.particles[0].mass()], &[0.02]);
    assert_eq!(after.unread, ["[particles.p] file: nothing reads inertia, molecule of a.csv"]);
    let both = "x,y,z,radius,mass,density\n0,0,0,0.01,0.02,2500\n";
    file("both.csv", both);
    let told = refusal(&place, "", "[particles.p]\nmaterial = \"g\"\nfile = \"both.csv\"\n");
    assert!(told.contains("both.csv, line 2") && told.contains("of mass of spheres"), "{told}");
    file(
        "a.data",
        "data, units = si\n\n1 atoms\n\nAtoms # bpm/sphere\n\n1 3 1 0.02 2500 0 0 0\n\nBonds\n\n1 1 1 2\n\nMasses\n\n1 1\n",
    );
    let after = second(&place, "", &again("a.data").replace("0 =", "1 =").replace(", 1 = \"h\"", "")).unwrap();
    let told = "[particles.p] file: nothing reads section Bonds, section Masses, molecule of a.data";
    assert_eq!(after.unread, [told]);
    let dump = |columns: &str, numbers: &str| {
        format!(
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n\
             ITEM: ATOMS id type x y z radius {columns}\n1 1 0 0 0 0.01 {numbers}\n"
        )
    };
    let set = "[particles.p]\nfile = \"a.dump\"\nunits = \"si\"\nmaterials = { 1 = \"g\" }\n";
    file("a.dump", &dump("q c_inertia id_multisphere", "0.5 2 -1"));
    let after = second(&place, "", set).unwrap();
    assert_eq!(after.unread, ["[particles.p] file: nothing reads q, c_inertia of a.dump"]);
    file("a.dump", &dump("id_multisphere", "4"));
    let told = refusal(&place, "", set);
    assert!(told.contains("expected single spheres") && told.contains("a sphere of body 4.0"), "{told}");
}

/// A box that cannot be used is no file without a box.
#[test]
fn a_box_of_a_data_file_that_cannot_be_used_is_refused() {
    let place = Place::new("boxes");
    for (lines, part) in [
        ("1 0.1 0 avec\n0 1 0 bvec\n0 0 1 cvec\n0 0 0 abc origin\n", "found a box with edges [[1.0, 0.1, 0.0]"),
        ("1 0 0 avec\n0 1 0 bvec\n0 0 1 cvec\n", "found a part of a box"),
        ("1 0 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n", "found a box with edges [[-1.0, 0.0, 0.0]"),
        ("0 1 xlo xhi\n0 1 ylo yhi\n", "found a part of a box"),
        ("0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo\n", "found a part of a box"),
        ("0 1 xlo xhi\n0 1 ylo yhi\n0 zlo zhi\n", "found \"0 zlo zhi\""),
        ("0.1 0 0 xy xz yz\n", "found a part of a box"),
        ("0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n1 0 0 avec\n", "found parts of two boxes"),
    ] {
        let text = format!("data, units = si\n\n1 atoms\n{lines}\nAtoms # sphere\n\n1 1 0.02 2500 0.1 0.1 0.1\n");
        fs::write(place.at("v.data"), text).unwrap();
        let set = "[particles.p]\nfile = \"v.data\"\nmaterials = { 1 = \"g\" }\n";
        for cell in ["", "[cell]\nedges = [[0.5, 0, 0], [0, 0.5, 0], [0, 0, 0.5]]\n"] {
            let told = refusal(&place, "", &format!("{cell}{set}"));
            assert!(told.contains("v.data, line ") && told.contains(part), "{lines}: {told}");
        }
    }
}

#[test]
fn a_clump_is_made_of_the_file_that_liggghts_reads_for_a_multisphere() {
    let place = Place::new("multisphere");
    let scene = |file: &str| {
        format!(
            "[clump.c]\nfile = \"{file}\"\n[particles.p]\nmaterial = \"g\"\nclump = \"c\"\nlist = [{{ position = [0, 0, 0] }}]\n"
        )
    };
    fs::write(place.at("two.multisphere"), "# x y z r\n0 0 0 0.005\n\n0.01 0 0 0.004\n").unwrap();
    let shape = &second(&place, "", &scene("two.multisphere")).unwrap().clump_shapes[0];
    assert_eq!(shape.spheres, [([0.0; 3], 0.005), ([0.01, 0.0, 0.0], 0.004)]);
    fs::write(place.at("two.multisphere"), "0 0 0 0.005 1\n0 0 x 0.004\n").unwrap();
    let told = refusal(&place, "", &scene("two.multisphere"));
    assert!(told.contains("line 1") && told.contains("x y z radius") && told.contains("found \"x\""), "{told}");
    fs::write(place.at("two.txt"), "0 0 0 0.005\n").unwrap();
    let told = refusal(&place, "", &scene("two.txt"));
    assert!(told.contains("a name that ends in .csv") && !told.contains("format ="), "{told}");
    let told = refusal(&place, "", "[particles.p]\nmaterial = \"g\"\nfile = \"two.multisphere\"\n");
    assert!(told.contains("[clump.<name>] file takes such a file"), "{told}");
    fs::write(place.at("two.data"), "t\n\n1 atoms\n\nAtoms # sphere\n\n1 1 0.02 2500 0 0 0\n").unwrap();
    let told = refusal(&place, "", &scene("two.data"));
    assert!(told.contains("expected units = si in the first line") && !told.contains("in the scene"), "{told}");
}

/// Numbers of the scene that count only where the file has what they are about.
#[test]
fn materials_that_no_particle_of_a_file_is_of_are_told() {
    let place = Place::new("idle_materials");
    fs::write(place.at("c.csv"), "x,y,z,radius\n0,0,0,0.01\n").unwrap();
    fs::write(place.at("t.csv"), "x,y,z,radius,type\n0,0,0,0.01,1\n").unwrap();
    let set = |file: &str| {
        format!(
            "{}[particles.p]\nmaterial = \"g\"\nclump = \"c\"\nfile = \"{file}\"\nmaterials = {{ 1 = \"h\", 2 = \"g\" }}\n",
            clump()
        )
    };
    let told = refusal(&place, "", &set("c.csv"));
    assert!(told.contains("materials: the file names no materials or types"), "{told}");
    let unread = second(&place, "", &set("t.csv")).unwrap().unread.clone();
    assert!(
        unread.contains(&"[particles.p] materials.2: nothing reads it; t.csv has none of it".to_owned()),
        "{unread:?}"
    );
}

/// Where a test looks for its file of results.
#[test]
fn a_frame_of_an_earlier_version_without_the_cell_is_refused_by_name() {
    let place = Place::new("old_frame");
    let edges = "[cell]\nedges = [[0.06, 0, 0], [0, 0.06, 0], [0, 0, 0.06]]\n";
    first(&place, "", &format!("{edges}{SPHERES}"));
    let frame: PathBuf = place.at("first/particles_000001.vtu");
    let whole = fs::read_to_string(&frame).unwrap();
    let (before, rest) = whole.split_once("<FieldData>").unwrap();
    fs::write(&frame, format!("{before}{}", rest.split_once("</FieldData>").unwrap().1)).unwrap();
    let told = refusal(&place, "", &format!("{edges}{}", again("first/particles_000001.vtu")));
    assert!(told.contains("found an array unwrapped of a periodic cell without the field cell"), "{told}");
}
