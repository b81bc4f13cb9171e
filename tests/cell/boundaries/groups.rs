//! Groups that go through the faces of a cell as one body.

use super::scenes::{EDGE, assert_alike, leaning, motion, scene};
use crate::support::{Files, cell, start_with};
use cograin::simulation::Simulation;

/// Spheres in a row along x, fixed to one another, that fill a cell or several.
fn row(cells: [i32; 2]) -> Vec<[[f64; 3]; 3]> {
    let at = |k: i32| [[0.002 + 0.005 * f64::from(k), 0.01, if k % 2 == 0 { 0.0 } else { 0.0015 }], [0.0; 3], [0.0; 3]];
    (8 * cells[0]..8 * cells[1]).map(at).collect()
}

#[test]
fn a_group_goes_through_the_faces_as_one_body() {
    let ball = [[0.0095, 0.0104, 0.0062], [0.1, 0.0, 0.0], [0.0; 3]];
    let motions = [
        "prescribed = { x = -0.6 }",
        "prescribed = { x = { sine = { amplitude = 0.03, frequency = 9.0 } } }",
        "prescribed = { x = 0.5 }, servo = { z = { target = -2.0, speed = 0.05 } }",
    ];
    for motion in motions {
        let text = |cells: [i32; 2], rest: &str| {
            let mut list = vec![ball];
            list.extend(row(cells));
            let group = format!(
                "[boundary.base]\nparticles = {{ box = [[-1.0, -1.0, -0.001], [1.0, 1.0, 0.002]] }}\nmotion = {{ {motion} }}\n"
            );
            scene(&list, &(group + rest))
        };
        let rails = "[boundary.front]\nmaterial = \"glass\"\nplane = { point = [0.0, 0.0065, 0.0], normal = [0.0, 1.0, 0.0] }\n\
                     [boundary.back]\nmaterial = \"glass\"\nplane = { point = [0.0, 0.0135, 0.0], normal = [0.0, -1.0, 0.0] }\n\
                     [boundary.lid]\nmaterial = \"glass\"\nplane = { point = [0.0, 0.0, 0.0095], normal = [0.0, 0.0, -1.0] }\n";
        let closed = text([0, 1], &(rails.to_owned() + &cell(leaning(), "periodic = [\"x\"]")));
        let (mut closed, mut open) =
            (start_with(&closed, Files::new()), start_with(&text([-3, 4], rails), Files::new()));
        for _ in 0..40 {
            closed.advance(2e-3).unwrap();
            open.advance(2e-3).unwrap();
            let (found, expected) = (motion_of_first(&closed), motion_of_first(&open));
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-7, "{motion}: {found:?} {expected:?}");
            }
            let force = |simulation: &Simulation| simulation.state().boundaries[0].mean_force;
            for (found, expected) in force(&closed).iter().zip(force(&open)) {
                assert!((found - expected).abs() < 1e-5, "{motion}: {found:?} {expected:?}");
            }
        }
        let cell = closed.state().cell.as_ref().unwrap();
        let crossed: i64 = cell.edges_away.iter().map(|away| away[0].abs()).sum();
        assert!(crossed >= 3, "{motion}: {crossed}");
    }
}

/// Motion of the first particle.
fn motion_of_first(simulation: &Simulation) -> Vec<f64> {
    motion(simulation)[..9].to_vec()
}

#[test]
fn a_rigid_body_that_flies_and_turns_through_the_faces_does_what_it_does_in_the_open() {
    let mut list = vec![[[0.045, 0.021, 0.003], [-3.0, 1.0, 2.0], [0.0; 3]]];
    for [x, y, z] in [[0.0, 0.0, 0.0], [0.005, 0.0, 0.0], [0.0, 0.004, 0.0], [0.0, 0.0, 0.005]] {
        list.push([[0.03 + x, 0.02 + y, 0.003 + z], [1.0, 0.4, -0.6], [0.0; 3]]);
    }
    let group = "[boundary.body]\nparticles = { box = [[0.025, 0.0, 0.0], [0.037, 0.03, 0.03]] }\n\
                 motion = { free = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }\n";
    let text = |rest: &str| scene(&list, &(group.to_owned() + rest)).replace("-9.81", "0.0");
    let closed = start_with(&text(&cell(leaning(), "periodic = [\"x\", \"y\", \"z\"]")), Files::new());
    // They meet once, before either meets an image.
    let open = start_with(&text(""), Files::new());
    assert!(open.elastic_energy() == 0.0);
    assert!(assert_alike(closed, open, 6, 1e-9) >= 4);
}

#[test]
fn a_force_on_a_sphere_of_a_group_turns_it_through_the_faces_as_in_the_open() {
    let mut list = Vec::new();
    for [x, y, z] in [[0.0, 0.0, 0.0], [0.005, 0.0, 0.0], [0.0, 0.004, 0.0], [0.0, 0.0, 0.005]] {
        list.push([[0.03 + x, 0.02 + y, 0.003 + z], [1.0, 0.4, -0.6], [0.0; 3]]);
    }
    let rest = "[force.push]\nparticles = { ids = [2] }\nforce = [0.0, 0.02, 0.01]\n\
                [damping.all]\nlinear = 0.1\nangular = 0.2\ngravity_damped = true\napplied_forces_damped = true\n\
                [boundary.body]\nparticles = { box = [[0.025, 0.0, 0.0], [0.037, 0.03, 0.03]] }\n\
                motion = { free = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }\n";
    let text = |more: &str| scene(&list, &(rest.to_owned() + more)).replace("-9.81", "0.0");
    let closed = start_with(&text(&cell(leaning(), "periodic = [\"x\", \"y\", \"z\"]")), Files::new());
    assert!(assert_alike(closed, start_with(&text(""), Files::new()), 10, 1e-9) >= 4);
}

#[test]
fn the_books_of_a_rigid_body_astride_a_face_close_and_its_stable_step_is_that_of_one_that_is_not() {
    let text = |shift: f64| {
        let mut list = vec![[[0.022 + shift, 0.0215, 0.013], [0.1, 0.0, -1.0], [0.0; 3]]];
        for [x, z] in [[0.0, 0.0], [0.005, 0.002]] {
            list.push([[0.0175 + x + shift, 0.02, 0.0029 + z], [0.3, 0.0, -1.0], [0.0; 3]]);
        }
        let group = "[boundary.body]\nparticles = { ids = [2, 3] }\n\
                     motion = { free = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }\n\
                     [boundary.floor]\nmaterial = \"glass\"\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n";
        let edges = [[EDGE, 0.0, 0.0], [0.0, EDGE, 0.0], [0.0, 0.0, EDGE]];
        scene(&list, &(group.to_owned() + &cell(edges, "periodic = [\"x\", \"y\"]")))
    };
    let inside = start_with(&text(0.0), Files::new());
    for shift in [-0.0222, 0.02, 1.02] {
        let mut astride = start_with(&text(shift), Files::new());
        let (stable, expected) = (astride.stable_step(), inside.stable_step());
        assert!((stable / expected - 1.0).abs() < 1e-9, "{shift}: {stable} {expected}");
        astride.advance(0.02).unwrap();
        let ledger = astride.state().ledger.as_ref().unwrap();
        let residual = astride.energy_residual().unwrap();
        assert!(residual.abs() < 1e-12 * ledger.turnover, "{shift}: {residual} of {}", ledger.turnover);
    }
}
