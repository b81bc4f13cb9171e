//! What a scene with a cell cannot be.

use super::lattice::fault_of;
use super::{AXES, Cell, CellMotion, MOST_IMAGES};
use crate::base::document::Mistake;
use crate::base::geometry::lattice::STRAINS;
use crate::base::number::Vector;
use crate::scene::{Boundary, OutletPlace, SceneDraft};

/// Sine of an angle below which an edge lies in a plane.
const ALONG: f64 = 1e-9;

/// A table, a key, and what is wrong.
pub(super) type Objection = (String, &'static str, Mistake);

/// What a scene with a cell cannot be.
pub(in crate::scene) fn objections(scene: &SceneDraft) -> Vec<Objection> {
    let Some(cell) = &scene.cell else { return Vec::new() };
    let at_cell = |key, found: String, expected: &str| {
        ("cell".to_owned(), key, Mistake::Unexpected { found, expected: expected.to_owned() })
    };
    let periodic = cell.lattice.periodic;
    if let Some(expected) = fault_of(&cell.lattice) {
        return vec![at_cell("edges", format!("{:?}", cell.lattice.edges), expected)];
    }
    let mut found = Vec::new();
    if periodic == [false; 3] {
        found.push(at_cell("periodic", "none".to_owned(), "at least one edge along which the cell repeats"));
    }
    let largest = scene.radii().fold(0.0, f64::max);
    let heights = cell.lattice.heights();
    if let Some(edge) = (0..3).find(|&edge| periodic[edge] && heights[edge] < largest) {
        let narrow = format!("faces {:?} m apart along {}", heights[edge], AXES[edge]);
        found.push(at_cell("edges", narrow, &format!("at least the largest radius, {largest:?} m")));
    }
    for component in 0..6 {
        if cell.motion[component] != CellMotion::Fixed && !cell.repeats(component) {
            let name = STRAINS[component];
            found.push(at_cell(
                "motion",
                format!("{name}, where the cell does not repeat"),
                "components of edges that repeat",
            ));
        }
    }
    // What is further away than pairs reach has no image; an image of each edge up to there is made.
    let distance = scene.bonds.iter().filter_map(|bond| bond.create_distance()).fold(0.0, f64::max);
    let reach = (2.0 * largest + scene.run.skin.unwrap_or(0.0)).max(distance);
    if (0..3).any(|edge| periodic[edge] && heights[edge] * MOST_IMAGES < reach) {
        let found_reach = format!("pairs that reach {reach:?} m in a cell with faces {heights:?} m apart");
        found.push(at_cell("edges", found_reach, "a cell no narrower than a tenth of skin and create_distance"));
    }
    found.extend(beside(scene, cell));
    found
}

/// What does not go together with a cell.
fn beside(scene: &SceneDraft, cell: &Cell) -> Vec<Objection> {
    let refused = |table: String, key, message: &str| (table, key, Mistake::Refused { message: message.to_owned() });
    let mut found = Vec::new();
    for boundary in &scene.boundaries {
        let table = format!("boundary.{}", boundary.name);
        if let Some((key, message)) = refused_boundary(boundary, cell) {
            found.push(refused(table, if key.is_empty() { boundary.shape.key() } else { key }, message));
        }
    }
    for bond in &scene.bonds {
        let table = format!("bond.{}", bond.name);
        if bond.plane.is_some() {
            found.push(refused(
                table,
                "between",
                "expected bonds between particles beside [cell], found bonds at a plane",
            ));
        }
    }
    for outlet in &scene.outlets {
        if let OutletPlace::Beyond([_, normal]) = outlet.place
            && !lies_along(cell, normal)
        {
            let message = "expected a plane along the edges that repeat, found one that crosses them";
            found.push(refused(format!("outlet.{}", outlet.name), "beyond", message));
        }
    }
    let parts = (scene.regions.iter().map(|it| (format!("region.{}", it.name), it.shape.bounds())))
        .chain(scene.meters.iter().map(|it| (format!("flow_meter.{}", it.name), it.polygon.bounds())))
        .chain(scene.grids.iter().map(|it| (format!("grid.{}", it.name), it.shape.corners)));
    for (table, corners) in parts {
        let widths = cell.lattice.parts_of_box(corners).map(|[low, high]| high - low);
        if let Some(edge) = (0..3).find(|&edge| cell.lattice.periodic[edge] && widths[edge] > MOST_IMAGES) {
            let found_width = format!("one over {:.1} edges along {}", widths[edge], AXES[edge]);
            let expected = format!("a part of space over no more than {MOST_IMAGES} edges of the cell");
            found.push((table, "", Mistake::Unexpected { found: found_width, expected }));
        }
    }
    for grid in scene.grids.iter().filter(|_| cell.moves()) {
        let message =
            "expected a [cell] that keeps its shape beside a grid, whose cells stand still, found one that is deformed";
        found.push(refused(format!("grid.{}", grid.name), "", message));
    }
    if cell.moves() && (scene.gravity != [0.0; 3] || !scene.forces.is_empty()) {
        let message = "expected neither gravity nor [force] beside a [cell] that is deformed, found one: they would work on its streaming motion";
        found.push(refused("cell".to_owned(), "motion", message));
    }
    if scene.domain.is_some() {
        found.push(refused(
            "domain".to_owned(),
            "",
            "expected no [domain] beside [cell], whose particles come back into it, found one",
        ));
    }
    let named = scene
        .boundaries
        .iter()
        .map(|it| ("boundary", &it.name))
        .chain(scene.regions.iter().map(|it| ("region", &it.name)))
        .chain(scene.grids.iter().map(|it| ("grid", &it.name)))
        .chain(scene.insertions.iter().map(|it| ("insertion", &it.name)))
        .chain(scene.outlets.iter().map(|it| ("outlet", &it.name)))
        .chain(scene.meters.iter().map(|it| ("flow_meter", &it.name)))
        .chain(scene.probes.iter().map(|it| ("probe", &it.name)));
    for (kind, name) in named.filter(|(_, name)| *name == "cell") {
        let (found_name, expected) = ("that of [cell]".to_owned(), "a name of its own".to_owned());
        found.push((format!("{kind}.{name}"), "", Mistake::Unexpected { found: found_name, expected }));
    }
    found
}

/// What a boundary beside a cell cannot be: the key, if not that of the shape, and why.
fn refused_boundary(boundary: &Boundary, cell: &Cell) -> Option<(&'static str, &'static str)> {
    let edges = || {
        let edges = cell.lattice.edges.iter().zip(cell.lattice.periodic);
        edges.filter(|(_, periodic)| *periodic).map(|(edge, _)| Vector::from(*edge))
    };
    if cell.moves() {
        return Some((
            "",
            "expected no boundary beside a [cell] that is deformed, found one, which would not be deformed with it",
        ));
    }
    if boundary.driven_nodes() > 0 {
        return Some(("nodes", "expected rigid nodes beside [cell], found driven ones"));
    }
    // Images of particles turn with them; copies of a surface would go around with it.
    let about = |axis: usize| {
        let along = edges().all(|edge| (0..3).all(|other| other == axis || edge.to_array()[other] == 0.0));
        let across = (0..3).all(|edge| edge == axis || cell.lattice.edges[edge][axis] == 0.0);
        along && across || boundary.axes[3 + axis].is_fixed()
    };
    if boundary.shape.members().is_empty() && !(0..3).all(about) {
        let message = "expected a surface beside [cell] that turns only about the one edge that repeats, across its faces, found one that turns otherwise";
        return Some(("motion", message));
    }
    let plane = boundary.shape.plane()?;
    (!lies_along(cell, plane.normal))
        .then_some(("", "expected a plane along the edges that repeat, found one that crosses them"))
}

/// Whether a plane with this normal lies along all edges that repeat.
fn lies_along(cell: &Cell, normal: [f64; 3]) -> bool {
    let lies = |edge: Vector| edge.dot(normal.into()).abs() <= ALONG * edge.length();
    let edges = cell.lattice.edges.iter().zip(cell.lattice.periodic);
    edges.filter(|(_, periodic)| *periodic).all(|(edge, _)| lies(Vector::from(*edge)))
}
