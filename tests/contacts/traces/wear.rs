//! Wear of surfaces.

use super::{FLOOR, GRAINS, SHEET, after, assert_close, mass, sheet, traces, worn};
use crate::support::Files;
use cograin::simulation::Simulation;

/// Archard's law with 1e-12/Pa, below a boundary.
const ARCHARD: &str = "[boundary.floor.wear.archard]\ncoefficient = 1.0e-12\n";

/// A sphere that is held while a floor goes by below it at 0.5 m/s: the same overlap of 10 µm at any time.
fn dragged(floor: &str, files: Files) -> Simulation {
    let text = format!(
        "{GRAINS}[particles.all]\nmaterial = \"stone\"\nlist = [{{ position = [8.5e-3, 0.3e-3, 0.99e-3], radius = 1e-3 }}]\n\
         [boundary.hand]\nparticles = {{ set = \"all\" }}\n{floor}motion = {{ prescribed = {{ x = 0.5, y = 0.25 }} }}\n{ARCHARD}"
    );
    after(&text, files, 20e-3)
}

/// Volume by Archard's law of the force on a sphere that is held \[m³\].
fn expected(simulation: &Simulation) -> f64 {
    let force = simulation.state().boundaries[0].force[2];
    1e-12 * force * (0.5_f64 * 0.5 + 0.25 * 0.25).sqrt() * 20e-3
}

#[test]
fn a_sphere_dragged_at_constant_force_wears_force_times_distance() {
    let simulation = dragged(FLOOR, Files::new());
    let modulus = 5.0e7 / (1.0 - 0.25 * 0.25) / 2.0;
    let hertz = 4.0 / 3.0 * modulus * (1e-3_f64 * 10e-6_f64.powi(3)).sqrt();
    assert_close(simulation.state().boundaries[0].force[2], hertz, 1e-9);
    assert_close(worn(&simulation, 1), expected(&simulation), 1e-12);
}

#[test]
fn how_a_face_is_divided_does_not_change_what_it_loses() {
    for cells in [1, 3, 16] {
        let simulation = dragged(SHEET, sheet(cells));
        assert_close(worn(&simulation, 1), expected(&simulation), 1e-9);
        let facets = &traces(&simulation).boundaries[1].wear;
        assert_eq!(facets.len(), 2 * cells * cells);
        let touched = facets.iter().filter(|wear| **wear > 0.0).count();
        // The sphere came from the corner of the sheet and crossed edges.
        assert!(cells < 16 || touched > 5, "{touched} of {} facets", facets.len());
    }
}

#[test]
fn a_facet_loses_what_passes_over_it() {
    // One cell of the sheet is 2.5 mm wide: below the sphere it moves by 10 mm along x and by 5 mm along y.
    let simulation = dragged(SHEET, sheet(16));
    let facets = &traces(&simulation).boundaries[1].wear;
    let of_column = |column: usize| facets[2 * 16 * column..2 * 16 * (column + 1)].iter().sum::<f64>();
    let whole = expected(&simulation);
    // The foot goes from 8.5 mm to −1.5 mm in the axes of the sheet: columns begin at −20 mm.
    let share = |column: usize| {
        let [from, to] = [column, column + 1].map(|edge| -20.0 + 2.5 * edge as f64);
        (to.min(8.5) - from.max(-1.5)).max(0.0) / 10.0
    };
    for column in 0..16 {
        assert!((of_column(column) - share(column) * whole).abs() < 1e-3 * whole, "column {column}");
    }
}

#[test]
fn rolling_wears_nothing_and_a_turning_drum_does() {
    // A sphere at rest on the inner side of a drum that turns under it.
    let drum = |spin: f64, velocity: f64| {
        let text = format!(
            "{GRAINS}[particles.all]\nmaterial = \"stone\"\nlist = [{{ position = [0.0, 0.0, -19.01e-3], radius = 1e-3 }}]\n\
             [boundary.hand]\nparticles = {{ set = \"all\" }}\nmotion = {{ prescribed = {{ \"rotation.y\" = {spin:?} }} }}\n\
             [boundary.floor]\ncylinder = {{ from = [0, -10e-3, 0], to = [0, 10e-3, 0], radius = 20e-3 }}\nmaterial = \"stone\"\n\
             motion = {{ prescribed = {{ \"rotation.y\" = {velocity:?} }} }}\n{ARCHARD}"
        );
        after(&text, Files::new(), 20e-3)
    };
    let turned = drum(0.0, 5.0);
    let force = turned.state().boundaries[0].force[2];
    // The drum presses the sphere towards its axis; the point of contact is half an overlap beyond its radius.
    assert!(force > 0.0);
    assert_close(worn(&turned, 1), 1e-12 * force * 5.0 * 20.005e-3 * 20e-3, 1e-6);
    // 64 facets of 0.098 rad: in 0.1 rad the foot has come to the second one.
    let touched = traces(&turned).boundaries[1].wear.iter().filter(|wear| **wear > 0.0).count();
    assert_eq!(touched, 2);
    // Sphere and drum turn so that their surfaces go alike.
    let rolling = drum(5.0 * 20.005 / 0.995, 5.0);
    assert!(worn(&rolling, 1) < 1e-3 * worn(&turned, 1), "{:e}", worn(&rolling, 1));
}

#[test]
fn a_cutting_impact_takes_the_volume_of_finnie() {
    let thrown = |floor: &str, files: Files, velocity: [f64; 3]| {
        let text = format!(
            "{GRAINS}[particles.all]\nmaterial = \"stone\"\n\
             list = [{{ position = [0.3e-3, 0.2e-3, 1.001e-3], radius = 1e-3, velocity = {velocity:?} }}]\n\
             {floor}[boundary.floor.wear.finnie]\nflow_stress = 1.0e9\n"
        );
        worn(&after(&text, files, 1e-3), 0)
    };
    // tan α = 4/3: m v²/(p ψ K) K/6 cos² α; tan α = 1/4: sin 2α − 3 sin² α = 5/17 of v² = 17.
    let steep = mass() * 25.0 / 4e9 / 3.0 * (9.0 / 25.0);
    let flat = mass() * 17.0 / 4e9 * (5.0 / 17.0);
    for (floor, files) in [(FLOOR, Files::new()), (SHEET, sheet(1)), (SHEET, sheet(7))] {
        assert_close(thrown(floor, files.clone(), [3.0, 0.0, -4.0]), steep, 1e-12);
        assert_close(thrown(floor, files, [4.0, 0.0, -1.0]), flat, 1e-12);
    }
}

#[test]
fn models_of_one_boundary_add_up() {
    let worn_by = |models: &str| {
        let text = format!(
            "{GRAINS}[particles.all]\nmaterial = \"stone\"\n\
             list = [{{ position = [0.3e-3, 0.2e-3, 1.001e-3], radius = 1e-3, velocity = [3.0, 0.0, -1.0] }}]\n{FLOOR}{models}"
        );
        worn(&after(&text, Files::new(), 1e-3), 0)
    };
    let finnie = "[boundary.floor.wear.finnie]\nflow_stress = 1.0e9\n";
    let [one, other] = [ARCHARD, finnie].map(worn_by);
    assert!(one > 0.0 && other > 0.0);
    assert_close(worn_by(&format!("{ARCHARD}{finnie}")), one + other, 1e-12);
}
