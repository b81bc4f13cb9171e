//! The meshes whose nodes the outside moves, as tables: which node has which number, and which triangles join them.

use super::names::{LONGEST, is_reserved};
use super::{PackageError, Resource};
use crate::scene::{Boundary, Scene};
use std::fmt::Write;

/// The tables of a scene: two for each mesh.
pub(super) fn tables(scene: &Scene) -> Vec<Resource> {
    let meshes = scene.boundaries.iter().filter(|boundary| boundary.driven_nodes() > 0);
    meshes.flat_map(|mesh| [nodes(mesh), triangles(mesh)]).collect()
}

/// Refuses names of meshes that cannot be those of files on every system.
pub(super) fn check_names(scene: &Scene) -> Result<(), PackageError> {
    let names = scene.boundaries.iter().filter(|boundary| boundary.driven_nodes() > 0).map(|mesh| &mesh.name);
    let mut known: Vec<&String> = Vec::new();
    for name in names {
        let twin = known.iter().find(|other| other.eq_ignore_ascii_case(name));
        let expected = match twin {
            _ if is_reserved(name) => "a name that no system keeps for a device".to_owned(),
            _ if name.len() > LONGEST => format!("a name of at most {LONGEST} letters"),
            Some(twin) => format!("a name that differs from {twin} in more than its case"),
            None => {
                known.push(name);
                continue;
            }
        };
        return Err(PackageError::Name { name: name.clone(), expected });
    }
    Ok(())
}

/// `<boundary>.nodes.csv`: number and place at time 0 of each node.
fn nodes(mesh: &Boundary) -> Resource {
    let mut table = "node,x,y,z\n".to_owned();
    for (number, place) in (1..).zip(mesh.shape.vertices()) {
        let [x, y, z] = place.to_array();
        // Writing to a string does not fail.
        let _ = writeln!(table, "{number},{x:?},{y:?},{z:?}");
    }
    Resource::new(format!("{}.nodes.csv", mesh.name), table)
}

/// `<boundary>.triangles.csv`: the nodes of each triangle, so that its normal is that of the surface.
fn triangles(mesh: &Boundary) -> Resource {
    let mut table = "a,b,c\n".to_owned();
    for [a, b, c] in mesh.shape.triangles() {
        let _ = writeln!(table, "{},{},{}", a + 1, b + 1, c + 1);
    }
    Resource::new(format!("{}.triangles.csv", mesh.name), table)
}
