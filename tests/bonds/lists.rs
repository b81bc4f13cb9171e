//! Bonds from lists of other programs, and by distance: the same bonds.

use crate::support::start_with;
use std::collections::BTreeMap;

/// A row of four spheres at a distance of 2 mm, numbered from 11.
const SCENE: &str = r#"
[run]
step = 1e-7
[material.ice]
density = 1000.0
[particles.row]
material = "ice"
list = [
    { id = 11, position = [0.0, 0.0, 0.0], radius = 1.0e-3 },
    { id = 12, position = [2.0e-3, 0.0, 0.0], radius = 1.0e-3 },
    { id = 13, position = [4.0e-3, 0.0, 0.0], radius = 1.0e-3 },
    { id = 14, position = [6.0e-3, 0.0, 0.0], radius = 1.0e-3 },
]
[bond.glue]
between = ["row", "row"]
create = CREATE
MORE
normal_stiffness = 1e10
tangential_stiffness = 4e9
"#;

/// The bonded pairs of that scene, by numbers.
fn bonds(create: &str, more: &str, files: &[(&str, &str)]) -> Vec<[u32; 2]> {
    let text = SCENE.replace("CREATE", create).replace("MORE", more);
    let files =
        files.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().into())).collect::<BTreeMap<_, _>>();
    let simulation = start_with(&text, files);
    let id = |index: u32| simulation.scene().particles[index as usize].id.0;
    let mut found: Vec<[u32; 2]> =
        simulation.bonds().iter().map(|bond| [id(bond.first), id(bond.second.expect("a particle"))]).collect();
    found.sort_unstable();
    found
}

#[test]
fn lists_of_other_programs_and_a_distance_give_the_same_bonds() {
    let expected = vec![[11, 12], [12, 13], [13, 14]];
    assert_eq!(bonds("\"start\"", "create_distance = 2.1e-3", &[]), expected);
    assert_eq!(bonds("{ pairs = [[12, 11], [13, 14], [12, 13]] }", "", &[]), expected);
    let files = [
        ("bonds.csv", "id1,id2\n11,12\n13,12\n13,14\n"),
        ("lammps.data", "LAMMPS data file\n\n4 atoms\n3 bonds\n\nBonds\n\n1 1 11 12\n2 1 12 13\n3 1 14 13\n"),
        (
            "liggghts.dump",
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ENTRIES id1 id2\n\
             11 14\nITEM: TIMESTEP\n100\nITEM: NUMBER OF ENTRIES\n3\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ENTRIES id1 id2\n\
             11 12\n13 12\n13 14\n",
        ),
    ];
    for (name, text) in files {
        assert_eq!(bonds(&format!("{{ file = \"{name}\" }}"), "", &[(name, text)]), expected, "{name}");
    }
}
