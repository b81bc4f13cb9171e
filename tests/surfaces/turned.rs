//! Surfaces that have turned push as those that stood there before.

use super::scenes::{MESH, RADIUS, SMOOTH, assert_same, drum, force_at, hertz, scene, stl};
use crate::support::{Triangle, start_with};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use std::collections::BTreeMap;

#[test]
fn a_drum_of_facets_becomes_the_cylinder_with_the_square_of_their_number() {
    let expected = hertz(5e-5);
    let error = |count: u32| {
        let triangles = drum(count, 0.02);
        let angle = std::f64::consts::TAU / f64::from(count);
        // Over one facet at the bottom.
        let places: Vec<[f64; 3]> = (0..41)
            .map(|number| {
                let (sine, cosine) = (angle * f64::from(number) / 40.0).sin_cos();
                [(0.05 - RADIUS + 5e-5) * sine, 0.0, -(0.05 - RADIUS + 5e-5) * cosine]
            })
            .collect();
        let worst = |place: &[f64; 3]| {
            let found = force_at(*place, MESH, &[("wall.stl", triangles.clone())]);
            let towards = place.map(|part| -part / (0.05 - RADIUS + 5e-5) * expected);
            (0..3).map(|axis| (found[axis] - towards[axis]).powi(2)).sum::<f64>().sqrt() / expected
        };
        places.iter().map(worst).fold(0.0, f64::max)
    };
    let errors = [256, 512, 1024].map(error);
    assert!((errors[0] - 0.0570).abs() < 0.002, "{errors:?}");
    for two in errors.windows(2) {
        let order = (two[0] / two[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "order {order} of {errors:?}");
    }
}

#[test]
fn a_plane_that_turns_carries_a_sphere_like_one_that_stood_there_before() {
    let turned = "[boundary.wall]\nmaterial = \"wall\"\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n\
                  motion = { driven = [\"rotation.y\"] }\n";
    let (sine, cosine) = 0.3_f64.sin_cos();
    let near = RADIUS - 5e-5;
    let mut simulation = Simulation::new(scene(&[[near * sine, 0.0, near * cosine]], SMOOTH, turned, &[])).unwrap();
    simulation.set_input(BoundaryIndex(0), 4, 0.3);
    simulation.place(None).unwrap();
    let [x, y, z, _] = simulation.state().particles.force[0];
    assert_same([x, y, z], [sine, 0.0, cosine].map(|part| part * hertz(5e-5)), 1e-11);
}

#[test]
fn a_drum_that_has_turned_pushes_as_one_that_stood_there_before() {
    let (sine, cosine) = 3.5_f64.sin_cos();
    let turned: Vec<Triangle> = drum(48, 0.02)
        .iter()
        .map(|corners| corners.map(|[x, y, z]| [cosine * x + sine * z, y, cosine * z - sine * x]))
        .collect();
    let turning = format!("{MESH}reference = [0.0, 0.0, 0.0]\nmotion = {{ driven = [\"rotation.y\"] }}\n");
    for degrees in [0.0_f64, 3.0, 3.75, 50.0, 200.0] {
        let (x, z) = degrees.to_radians().sin_cos();
        let place = [x, 0.0, z].map(|part| (0.05 - RADIUS + 3e-5) * part);
        let mut simulation =
            Simulation::new(scene(&[place], SMOOTH, &turning, &[("wall.stl", drum(48, 0.02))])).unwrap();
        simulation.set_input(BoundaryIndex(0), 4, 3.5);
        simulation.place(None).unwrap();
        let [x, y, z, _] = simulation.state().particles.force[0];
        assert_same([x, y, z], force_at(place, MESH, &[("wall.stl", turned.clone())]), 1e-11);
    }
}

/// Heights over a wall at z = 0, which is this boundary, of a sticky sphere that flies off it across the middle, and the forces
/// along z: in each step \[m, N\].
fn pulled_off(boundary: &str) -> Vec<[f64; 2]> {
    let text = format!(
        r#"
[run]
step = 2e-7
threads = 1
[material.sphere]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.3
[material.wall]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.3
[pair.sphere.wall]
restitution = 0.5
friction = 0.4
surface_energy = 0.5
damping_coefficient = 0.1
tangential_damping_ratio = 0.5
[contact.touch]
between = ["sphere", "wall"]
[contact.touch.normal.jkr]
[contact.touch.tangential.history]
[particles.one]
material = "sphere"
list = [{{ position = [-2e-5, 1e-5, 4.98e-3], radius = {RADIUS:?}, velocity = [0.2, 0.0, 0.2] }}]
[boundary.wall]
material = "wall"
{boundary}
"#
    );
    let corners = [[-0.05, -0.05, 0.0], [0.05, -0.05, 0.0], [0.05, 0.05, 0.0], [-0.05, 0.05, 0.0]];
    let floor = [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    let files = BTreeMap::from([("floor.stl".to_owned(), stl(&floor))]);
    let mut simulation = start_with(&text, files);
    let step = |_| {
        simulation.advance(2e-7).unwrap_or_else(|error| panic!("{error}"));
        let particles = &simulation.state().particles;
        [particles.position[0][2], particles.force[0][2]]
    };
    (0..2000).map(step).collect()
}

#[test]
fn a_law_that_pulls_beyond_touch_does_so_at_a_mesh_and_at_a_plane_that_turns() {
    let plane = "plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n";
    let expected = pulled_off(plane);
    let beyond = expected.iter().filter(|[height, force]| *height > RADIUS && *force < 0.0).count();
    assert!(beyond > 10 && expected[1999][1] == 0.0, "{beyond} steps beyond touch, {:?} at the end", expected[1999]);
    let turning = format!("{plane}motion = {{ driven = [\"rotation.y\"] }}\n");
    for other in ["mesh = { file = \"floor.stl\" }\n", &turning] {
        for (found, expected) in pulled_off(other).iter().zip(&expected) {
            let apart = (found[0] - expected[0]).abs() / RADIUS;
            assert!(apart < 1e-12, "{found:?} found, {expected:?} expected, {other}");
            assert!(
                (found[1] - expected[1]).abs() < 1e-9 * expected[1].abs().max(1e-3),
                "{found:?}, {expected:?}, {other}"
            );
        }
    }
}
