//! What has elements with numbers, as tables: meshes whose nodes the outside moves, and grids.

use super::names::{LONGEST, is_reserved};
use super::{PackageError, Resource};
use crate::scene::{Boundary, Grid, Scene};
use std::fmt::Write;

/// The tables of a scene: two for each mesh, one for each grid, one for the fluid on a grid.
pub(super) fn tables(scene: &Scene) -> Vec<Resource> {
    let meshes = scene.boundaries.iter().filter(|boundary| boundary.driven_nodes() > 0);
    let grids = scene.grids.iter().map(|grid| cells(&grid.name, grid));
    let fluid = fluid(scene).map(|(name, grid)| cells(name, grid));
    meshes.flat_map(|mesh| [nodes(mesh), triangles(mesh)]).chain(grids).chain(fluid).collect()
}

/// The name of the fluid, and its grid.
fn fluid(scene: &Scene) -> Option<(&String, &Grid)> {
    scene.fluid.as_ref().and_then(|fluid| Some((&fluid.name, &scene.grids[fluid.grid?])))
}

/// Refuses names of meshes, grids and fluids that cannot be those of files on every system.
pub(super) fn check_names(scene: &Scene) -> Result<(), PackageError> {
    let meshes = scene.boundaries.iter().filter(|boundary| boundary.driven_nodes() > 0).map(|mesh| &mesh.name);
    let names = meshes.chain(scene.grids.iter().map(|grid| &grid.name)).chain(fluid(scene).map(|(name, _)| name));
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

/// `<grid>.cells.csv` and `<fluid>.cells.csv`: number, centre and volume of each cell.
fn cells(name: &str, grid: &Grid) -> Resource {
    let (mut table, volume) = ("cell,x,y,z,volume\n".to_owned(), grid.shape.cell_volume());
    for cell in 0..grid.shape.cells() {
        let [x, y, z] = grid.shape.centre(cell);
        let _ = writeln!(table, "{},{x:?},{y:?},{z:?},{volume:?}", cell + 1);
    }
    Resource::new(format!("{name}.cells.csv"), table)
}
