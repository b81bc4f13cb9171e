//! What contacts leave behind: wear and losses on boundaries, and impacts from touch to parting.

mod books;
mod impacts;
mod refused;
mod wear;

use crate::support::{Files, start_with};
use cograin::simulation::Simulation;
use cograin::state::{FacetTraces, Loss, Traces};

/// Young's modulus 50 MPa, density 2500 kg/m³; spheres of 1 mm; no gravity.
pub(crate) const GRAINS: &str = r#"
[run]
end = 1.0
step = 1.0e-6
[material.stone]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.25
[pair.stone.stone]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
"#;

/// A floor in the plane z = 0.
pub(crate) const FLOOR: &str =
    "[boundary.floor]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"stone\"\n";

/// Mass of a sphere of 1 mm \[kg\].
pub(crate) fn mass() -> f64 {
    2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9
}

/// What contacts left behind.
pub(crate) fn traces(simulation: &Simulation) -> &Traces {
    simulation.state().traces.as_ref().expect("the scene asks for traces")
}

/// A sum over the facets of a boundary.
pub(crate) fn sum(simulation: &Simulation, boundary: usize, of: fn(&FacetTraces) -> &[f64]) -> f64 {
    of(&traces(simulation).boundaries[boundary]).iter().sum()
}

/// Volume worn off a boundary \[m³\].
pub(crate) fn worn(simulation: &Simulation, boundary: usize) -> f64 {
    sum(simulation, boundary, |facets| &facets.wear)
}

/// What contacts lost since the start, of which the book of losses tells \[J\].
pub(crate) fn lost(simulation: &Simulation) -> f64 {
    let causes = [
        Loss::NormalDamping,
        Loss::TangentialDamping,
        Loss::Sliding,
        Loss::Rolling,
        Loss::TangentialStiffness,
        Loss::Projection,
        Loss::Parting,
    ];
    let book = simulation.state().losses.as_ref().expect("losses are booked");
    causes.iter().map(|cause| book.taken[*cause as usize]).sum()
}

/// What impacts that ended have lost \[J\].
pub(crate) fn closed(simulation: &Simulation) -> f64 {
    traces(simulation).bins.iter().map(|bin| bin.lost[0] + bin.lost[1]).sum()
}

/// A square of 40 mm in the plane z = 0 as a file: split once, or into triangles about many points.
pub(crate) fn sheet(cells: usize) -> Files {
    let (mut text, size) = ("solid sheet\n".to_owned(), 40e-3 / cells as f64);
    let corner = |k: usize| -20e-3 + size * k as f64;
    for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
        let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| (corner(i), corner(j)));
        for triangle in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 1\nouter loop\n";
            triangle.iter().for_each(|(x, y)| text += &format!("vertex {x:?} {y:?} 0\n"));
            text += "endloop\nendfacet\n";
        }
    }
    Files::from([("sheet.stl".to_owned(), (text + "endsolid\n").into_bytes())])
}

/// A floor of a file.
pub(crate) const SHEET: &str = "[boundary.floor]\nmesh = { file = \"sheet.stl\" }\nmaterial = \"stone\"\n";

/// A simulation after a time \[s\].
pub(crate) fn after(text: &str, files: Files, time: f64) -> Simulation {
    let mut simulation = start_with(text, files);
    simulation.advance(time).unwrap_or_else(|error| panic!("{error}\n{text}"));
    simulation
}

/// Fails, with both values, unless they agree to `tolerance` of the expected one.
#[track_caller]
pub(crate) fn assert_close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found:e} found, {expected:e} expected");
}
