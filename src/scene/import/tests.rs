//! Files of particles, in all formats.

use super::*;
use crate::scene::ParticleShape;
use std::path::Path;

/// Reads a text as a file of this name.
fn read_as(file: &str, bytes: &[u8]) -> Result<Rows, String> {
    let bodies = Bodies::Particles(ParticleShape::Sphere);
    let request = Request { file, bodies, extra: &[], format: None, units: None, timestep: None };
    let units = (file.ends_with("dump") || file.ends_with("data")).then_some(Units::Si);
    read(bytes, &Request { units, ..request }).map_err(|faults| format!("{faults:?}"))
}

/// The dump file of these columns and lines.
fn dump(faces: &str, columns: &str, lines: &[&str]) -> Result<Rows, String> {
    let text = format!(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {faces}\n0 2\n0 2\n0 2\nITEM: ATOMS {columns}\n{}\n",
        lines.len(),
        lines.join("\n")
    );
    read_as("a.dump", text.as_bytes())
}

#[test]
fn files_that_other_programs_wrote_give_the_same_grains() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/foreign/clouds");
    let mut read = 0;
    for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let name = path.file_name().unwrap().to_str().unwrap();
        if name == "readme" {
            continue;
        }
        read += 1;
        let rows = read_as(name, &std::fs::read(&path).unwrap()).unwrap_or_else(|faults| panic!("{name}: {faults}"));
        let expected =
            [[0.0, 0.0, 0.05, 0.005, 2500.0], [0.03, 0.01, 0.06, 0.01, 7800.0], [0.1, 0.05, 0.09, 0.005, 2500.0]];
        assert_eq!(rows.count, 3, "{name}");
        for (axis, column) in ["x", "y", "z", "radius", "density"].into_iter().enumerate() {
            let Some(found) = rows.columns.get(column) else {
                assert!(column == "density", "{name}: no {column}");
                continue;
            };
            // Texts have six digits.
            let right = found
                .iter()
                .zip(expected)
                .all(|(found, right)| (found - right[axis]).abs() <= 1e-6 * right[axis].max(1.0));
            let right = right
                || (axis == 4 && found.iter().zip(expected).all(|(found, it)| (found / it[axis] - 1.0).abs() < 1e-5));
            assert!(right, "{name}: {column} {found:?}");
        }
        let labels: Vec<&str> = rows.label.iter().map(|label| rows.labels[*label as usize].as_str()).collect();
        assert!(labels == ["1", "2", "1"] || labels == ["glass", "steel", "glass"], "{name}: {labels:?}");
    }
    assert!(read > 15, "{read}");
}

#[test]
fn velocities_that_stand_before_the_atoms_are_read() {
    let rows = read_as(
        "a.data",
        b"t, units = si\n\n1 atoms\n\nVelocities\n\n4 1 2 3 0 0 5\n\nAtoms # sphere\n\n4 1 0.1 2500 0 0 0\n",
    );
    let rows = rows.unwrap();
    assert_eq!((rows.columns["vx"][0], rows.columns["vz"][0], rows.columns["wz"][0]), (1.0, 3.0, 5.0));
}

#[test]
fn columns_that_say_the_same_twice_must_agree() {
    let right = dump(
        "ff ff ff",
        "id id type type xs ys zs x y z radius diameter",
        &["1 1 1 1 0.25 0 0 0.5 0 0 0.1 0.2", "2 2 2 2 0.5 0 0 1 0 0 0.1 0.2"],
    );
    let right = right.unwrap();
    assert_eq!((right.columns["x"][0], right.columns["x"][1], right.label), (0.5, 1.0, vec![0, 1]));
    let wrong = |columns: &str, line: &str, part: &str| {
        let found = dump("ff ff ff", columns, &[line]).unwrap_err();
        assert!(found.contains(part), "{found}");
    };
    wrong("id type type x y z radius", "1 1 2 0 0 0 0.1", "1 and 2 in two columns of this name");
    wrong("id id type x y z radius", "1 2 1 0 0 0 0.1", "1.0 of id and 2.0 of id");
    wrong("id type x x y z radius", "1 1 0.5 0.6 0 0 0.1", "0.5 of x and 0.6 of x");
    wrong("id type xs ys zs x y z radius", "1 1 0.25 0 0 0.75 0 0 0.1", "0.75 of x and 0.5 of xs");
    wrong("id type x y z radius diameter", "1 1 0 0 0 0.1 0.1", "0.1 of radius and 0.05 of diameter");
    wrong("id type x y z radius density mass", "1 1 0 0 0 0.1 2500 1", "2500.0 of density");
    wrong("id type x y z radius", "1 1 0 0 0 0.1 7", "6 numbers");
    let labels = read_as("a.csv", b"x,y,z,radius,type,material\n0,0,0,1,1,glass\n").unwrap_err();
    assert!(labels.contains("both columns material and type"), "{labels}");
}

/// Positions of a particle.
fn place(rows: &Rows, row: usize) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| rows.columns[axis][row])
}

#[test]
fn places_in_a_periodic_box_are_those_without_its_faces() {
    // Bounds are those around the leaning box: edges (2, 0, 0), (0.5, 2, 0), (0, 0, 2) from (0, 0, 0).
    let read = |columns: &str, line: &str| {
        let text = format!(
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp ff\n0 2.5 0.5\n0 2 0\n0 2 0\n\
             ITEM: ATOMS id type radius {columns}\n1 1 0.1 {line}\n"
        );
        read_as("a.dump", text.as_bytes())
    };
    let unwrapped = [0.5 + 2.0 * 3.0 - 0.5, 1.0 - 2.0, 1.5];
    for (columns, line) in [
        ("x y z ix iy iz", "0.5 1 1.5 3 -1 0"),
        ("xs ys zs ix iy iz", "0.125 0.5 0.75 3 -1 0"),
        ("xu yu zu", "6 -1 1.5"),
        ("xsu ysu zsu", "3.125 -0.5 0.75"),
        ("x y z xu yu zu", "0.5 1 1.5 6 -1 1.5"),
        ("xu yu zu x y z ix iy iz", "6 -1 1.5 0.5 1 1.5 3 -1 0"),
        ("xs ys zs xsu ysu zsu", "0.125 0.5 0.75 3.125 -0.5 0.75"),
        ("xs ys zs xu yu zu", "0.125 0.5 0.75 6 -1 1.5"),
    ] {
        let rows = read(columns, line).unwrap_or_else(|faults| panic!("{columns}: {faults}"));
        assert_eq!(place(&rows, 0), unwrapped, "{columns}");
        let around = rows.around.unwrap();
        assert_eq!(around.lattice.edges, [[2.0, 0.0, 0.0], [0.5, 2.0, 0.0], [0.0, 0.0, 2.0]]);
        assert_eq!((around.lattice.periodic, around.lattice.origin), ([true, true, false], [0.0; 3]));
    }
    assert_eq!(place(&read("x y z", "0.5 1 1.5").unwrap(), 0), [0.5, 1.0, 1.5]);
    for (columns, line, part) in [
        ("x y z ix iy iz", "0.5 1 1.5 0 0 1", "a particle that crossed a face"),
        ("x y z ix", "0.5 1 1.5 1", "ix without iy and iz"),
        ("xu yu zu x y z ix iy iz", "6 -1 1.5 0.5 1 1.5 2 -1 0", "of x and "),
        ("xu yu zu x y z", "6.1 -1 1.5 0.5 1 1.5", "whole edges of the box apart"),
        ("xu yu zu x y z", "6 -1 3.5 0.5 1 1.5", "whole edges of the box apart"),
        ("x yu z", "0.5 -1 1.5", "all of xu, yu, zu of a box that leans"),
        ("xs ysu zs", "0.125 -0.5 0.75", "all three"),
    ] {
        let found = read(columns, line).unwrap_err();
        assert!(found.contains(part), "{found}");
    }
    let general = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS abc origin pp pp pp\n2 0 0 0.1\n\
                   0.5 2 0 0.2\n0 0 2 0.3\nITEM: ATOMS id type radius xs ys zs\n1 1 0.1 0.5 0.5 0.5\n";
    let rows = read_as("a.dump", general.as_bytes()).unwrap();
    assert_eq!(place(&rows, 0), [0.1 + 1.25, 1.2, 1.3]);
    let turned = read_as("a.dump", general.replace("2 0 0 0.1", "2 1 0 0.1").as_bytes()).unwrap_err();
    assert!(turned.contains("a box with edges [[2.0, 1.0, 0.0]"), "{turned}");
}

#[test]
fn image_flags_of_a_data_file_lead_out_of_its_box() {
    let text = "t, units = si\n\n1 atoms\n0 2 xlo xhi\n0 2 ylo yhi\n0 2 zlo zhi\n0.5 0 0 xy xz yz\n\nAtoms # sphere\n\n\
                4 1 0.1 2500 0.5 1 1.5 3 -1 0\n";
    let rows = read_as("a.data", text.as_bytes()).unwrap();
    assert_eq!(place(&rows, 0), [6.0, -1.0, 1.5]);
    let around = rows.around.unwrap();
    assert!(around.is_crossed && !around.is_told && around.line == Some(11), "{around:?}");
    let without = read_as("a.data", text.replace("0 2 xlo xhi\n", "\n").as_bytes()).unwrap_err();
    assert!(without.contains("xlo xhi"), "{without}");
    let general = text.replace(
        "0 2 xlo xhi\n0 2 ylo yhi\n0 2 zlo zhi\n0.5 0 0 xy xz yz",
        "2 0 0 avec\n0.5 2 0 bvec\n0 0 2 cvec\n0 0 0 abc origin",
    );
    assert_eq!(place(&read_as("a.data", general.as_bytes()).unwrap(), 0), [6.0, -1.0, 1.5]);
}

#[test]
fn a_tilted_box_with_fixed_faces_is_read() {
    let line = ["1 1 0.5 0.5 0.5 0.1"];
    assert!(dump("xy xz yz ff ff ff", "id type x y z radius", &line).is_ok());
}
