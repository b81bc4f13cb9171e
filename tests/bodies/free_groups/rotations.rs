//! Rotations that inputs and scenes drive.

use super::scenes::{FIRST, apart, group, paddle, row, top};
use crate::support::start;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::RunError;

#[test]
fn a_driven_rotation_takes_the_spheres_along_and_arrives() {
    let mut simulation = start(&top(1e-3, r#"{ driven = ["rotation.z"] }"#, "reference = [0.0, 0.0, 0.0]"));
    simulation.set_input(FIRST, 5, 3.5 * std::f64::consts::PI);
    simulation.advance(0.35).expect("it runs");
    let moved = group(&simulation);
    assert_eq!(moved.rotation[2], 3.5 * std::f64::consts::PI, "one axis turns by any angle");
    let w = 10.0 * std::f64::consts::PI;
    assert!((moved.angular_velocity[2] / w - 1.0).abs() < 1e-14, "{:?}", moved.angular_velocity);
    // The sphere at (0.3, 0.1, 0) has turned by −π/2, and moves with w × r.
    let particles = &simulation.state().particles;
    let slot = particles.slot[1] as usize;
    let [x, y, z, _] = particles.position[slot];
    assert!(apart([x, y, z], [0.1, -0.3, 0.0]) < 1e-14, "{x}, {y}, {z}");
    let [u, v, _, _] = particles.velocity[slot];
    assert!(apart([u, v, 0.0], [0.3 * w, 0.1 * w, 0.0]) < 1e-12 * w, "{u}, {v}");
    assert!((particles.angular_velocity[slot][2] / w - 1.0).abs() < 1e-14);
}

#[test]
fn a_driven_rotation_about_several_axes_turns_at_constant_angular_velocity() {
    let motion = r#"{ driven = ["rotation.x", "rotation.y", "rotation.z"] }"#;
    let mut simulation = start(&top(1e-3, motion, ""));
    for axis in 3..6 {
        simulation.set_input(FIRST, axis, 0.5);
    }
    simulation.advance(0.1).expect("it runs");
    simulation.set_input(FIRST, 3, -0.4);
    simulation.set_input(FIRST, 5, 0.1);
    simulation.advance(0.1).expect("it runs");
    let moved = group(&simulation);
    assert_eq!(moved.rotation, [-0.4, 0.5, 0.1]);
    // By matrices: exp(turn) exp(0.5, 0.5, 0.5) = exp(-0.4, 0.5, 0.1), and turn = w H.
    let w = moved.angular_velocity.map(|part| 0.1 * part);
    let there = turned(w, turned([0.5; 3], [1.0, 0.0, 0.0]));
    assert!(apart(there, turned([-0.4, 0.5, 0.1], [1.0, 0.0, 0.0])) < 1e-14, "{there:?}");
    assert!(apart(w, moved.turn) < 1e-15, "{w:?}, not {:?}", moved.turn);
}

/// Where a rotation vector takes a vector (Rodrigues).
fn turned(rotation: [f64; 3], vector: [f64; 3]) -> [f64; 3] {
    let angle = apart(rotation, [0.0; 3]);
    let n = rotation.map(|part| part / angle);
    let along: f64 = n.iter().zip(vector).map(|(a, b)| a * b).sum();
    let across =
        [n[1] * vector[2] - n[2] * vector[1], n[2] * vector[0] - n[0] * vector[2], n[0] * vector[1] - n[1] * vector[0]];
    [0, 1, 2].map(|k| vector[k] * angle.cos() + across[k] * angle.sin() + n[k] * along * (1.0 - angle.cos()))
}

#[test]
fn half_a_turn_about_several_axes_is_refused_and_changes_nothing() {
    let mut simulation = start(&top(1e-3, r#"{ driven = ["rotation.x", "rotation.y"] }"#, ""));
    simulation.set_input(FIRST, 3, 2.5);
    simulation.set_input(FIRST, 4, 2.5);
    let before = simulation.state().clone();
    let error = simulation.advance(0.1).expect_err("it is refused");
    assert!(matches!(error, RunError::Turn { .. }), "{error}");
    assert_eq!(
        error.to_string(),
        "boundary top: expected less than half a turn (pi) about several axes in one communication step, found \
         3.5355 rad at t = 0 s"
    );
    assert_eq!(*simulation.state(), before);
    simulation.set_input(FIRST, 4, 0.0);
    simulation.advance(0.1).expect("2.5 rad are less");
}

#[test]
fn a_prescribed_rotation_goes_on_for_ever() {
    let mut simulation = start(&top(1e-2, r#"{ prescribed = { "rotation.x" = 3.0 } }"#, ""));
    simulation.advance(10.0).expect("it runs");
    let moved = group(&simulation);
    assert!((moved.rotation[0] - 30.0).abs() < 1e-12, "{:?}", moved.rotation);
    assert_eq!(moved.angular_velocity, [3.0, 0.0, 0.0]);
}

#[test]
fn bonds_resist_a_driven_rotation_with_their_torsional_stiffness() {
    let straight = row("")
        .replace("0.0001, 0.0]", "0.0, 0.0]")
        .replace("0.0, 0.0002]", "0.0, 0.0]")
        .replace("0.0005, 0.0]", "0.0, 0.0]")
        .replace("angular_velocity = [400.0, 6000.0, -10000.0]\nvelocity = [0.0, 1.0, -0.5]", "")
        .replace("[bond.glue]", "[damping.all]\nlinear = 0.5\nangular = 0.5\n[bond.glue]");
    let held = "[boundary.clamp]\nparticles = { ids = [1] }\n[boundary.grip]\nparticles = { ids = [6] }\n";
    let mut simulation = start(&format!("{straight}{held}motion = {{ driven = [\"rotation.x\"] }}\n"));
    // Several turns: the twist is followed on.
    let angle = 10.0;
    simulation.set_input(BoundaryIndex(1), 3, angle);
    simulation.advance(2e-3).expect("it runs");
    simulation.advance(4e-3).expect("it comes to rest");
    // Five bonds in a row, each k_t J with J = π R⁴/2.
    let expected = -4.0e11 * 0.5 * std::f64::consts::PI * 1e-12 * angle / 5.0;
    let [clamp, grip] = [0, 1].map(|index| simulation.state().boundaries[index].moment[0]);
    assert!((grip / expected - 1.0).abs() < 1e-9, "{grip} N m, not {expected} N m");
    assert!((clamp / -expected - 1.0).abs() < 1e-9, "{clamp} N m, not {} N m", -expected);
}

#[test]
fn a_group_that_is_put_elsewhere_at_once_meets_what_is_there() {
    let text =
        paddle(r#"{ driven = ["x"] }"#, "input = \"hold\"").replace("0.0249", "0.0149").replace("0.0259", "0.0149");
    let text = text.replace("[-0.01, 0.0", "[-0.31, 0.0").replace("[0.0, 0.001", "[-0.3, 0.001");
    let mut simulation = start(&text.replace("[0.009, 0.0", "[-0.291, 0.0"));
    simulation.set_input(FIRST, 0, 0.2711);
    simulation.advance(2e-5).expect("it runs");
    assert!(apart(group(&simulation).force, [0.0; 3]) > 0.0, "it stands in the bed and feels nothing");
}
